"""`oem6250 serve --units N`: a chain on a TCP port, as a host meets it."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from emulator.cli import main
from tests.ports.served import REPOSITORY, Host

PATIENCE_S = 60.0


def test_a_host_talks_to_three_units(tmp_path: Path) -> None:
    machine = tmp_path / "chain.toml"
    machine.write_text("[defaults]\nERRLVL = 1\n")
    arguments = ("serve", str(machine), "--units", "3", "--tcp", "127.0.0.1:0", "--pty", "none", "--announce", "-")
    command = [sys.executable, "-m", "emulator", *arguments]
    with subprocess.Popen(command, cwd=REPOSITORY, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            address = json.loads(process.stdout.readline())["tcp"][0]
            with Host(socket.create_connection(address.rsplit(":", 1), timeout=PATIENCE_S)) as host:
                host.sock.sendall(b"2_1D77\r3_1D\r")
                assert host.read_until(b"*+4000\r") == b"2_1D77\r\n3_1D\r\n*+4000\r"
                host.sock.sendall(b"2_1D\r")
                assert host.read_until(b"*+77\r\n") == b"2_1D\r\n*+77\r\n"
        finally:
            process.send_signal(signal.SIGTERM)
        assert process.wait(PATIENCE_S) == 0


@pytest.mark.parametrize("number", ["0", "100", "-1", "two"])
def test_a_chain_has_1_to_99_units(number: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["serve", "--units", number])
    assert stopped.value.code == 2
    assert "from 1 to 99" in capsys.readouterr().err
