"""What socat printed about a line, replayed."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from emulator.cli import main
from emulator.recording import RecordingError
from emulator.recording.format import Received, Sent
from emulator.recording.socat import SocatReader

PLAIN = """\
> 2026/11/22 17:37:33.000392176  length=5 from=0 to=4
 31 54 50 45 0d
< 2026/11/22 17:37:33.000412551  length=20 from=0 to=19
 31 54 50 45 0d 0a 2a 31 54 50 45 2b 30 0d 0d 0a 3e 20 31 32
"""
WITH_TEXT = """\
> 2026/11/22 17:37:33.392176  length=5 from=0 to=4
 31 54 50 45 0d                                   1TPE.
--
< 2026/11/22 17:37:33.412551  length=18 from=0 to=17
 31 54 50 45 0d 0a                                1TPE..
 2a 31 54 50 45 2b 30 0d                          *1TPE+0.
 0d 0a                                            ..
 3e 20                                            > 
--
"""  # noqa: W291 socat writes it so
NOON_NS = 1_795_369_053 * 1_000_000_000


@pytest.mark.parametrize("text", [PLAIN.replace("length=20", "length=18").replace("3e 20 31 32", "3e 20"), WITH_TEXT])
def test_packets_with_their_times(tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "s.txt"
    file.write_text(text)
    with SocatReader(file) as reader:
        assert reader.header.from_line
        first, second = reader
    assert first == Received(NOON_NS + 392_176_000, 0, 0, b"1TPE\r")
    assert second == Sent(NOON_NS + 412_551_000, 0, None, b"1TPE\r\n*1TPE+0\r\r\n> ")
    assert main(["replay", "--socat", str(file)]) == 0
    assert "the same: 1 inputs, 18 bytes" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("hello\n", "no packet"),
        (PLAIN.replace("length=5", "length=6"), ":1: a packet of 6 bytes has 5"),
        (PLAIN.replace(" 31 54 50 45 0d\n", "1TPE\\r\n"), ":2: .* was it socat -x"),
    ],
)
def test_other_text_is_refused(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "s.txt").write_text(text)
    with pytest.raises(RecordingError, match=said):
        list(SocatReader(tmp_path / "s.txt"))


@pytest.mark.skipif(shutil.which("socat") is None, reason="socat is not installed")
@pytest.mark.parametrize("options", [["-x"], ["-x", "-v"]])
def test_what_the_socat_of_this_computer_writes(tmp_path: Path, options: list[str]) -> None:
    data = bytes(range(256)) + b"line\nline\r\n--\n"
    done = subprocess.run(["socat", *options, "-", "EXEC:cat"], input=data, capture_output=True, timeout=20, check=True)
    (tmp_path / "s.txt").write_bytes(done.stderr)
    entries = list(SocatReader(tmp_path / "s.txt"))
    assert b"".join(entry.data for entry in entries if isinstance(entry, Received)) == data
    assert b"".join(entry.data for entry in entries if isinstance(entry, Sent)) == data
