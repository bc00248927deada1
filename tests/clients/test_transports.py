"""The client over every wire there is to a served unit, and what threads may do with it."""

from __future__ import annotations

import itertools
import os
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from clients import OEM6250, AsyncOEM6250, LineLost, NoAnswer, UnitError, open_line
from clients.lines import tcp_address
from tests.ports.served import OEM6250 as COMMAND
from tests.ports.served import Served

WIRES = ("tcp", "socket", "rfc2217", "pty", "telnet")


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("client")
    pty = ["--pty", str(folder / "tty")] if hasattr(os, "openpty") else ["--pty", "none"]
    options = ["--tcp", "127.0.0.1:0", "--telnet", "127.0.0.1:0", "--speed", "20", *pty]
    with Served(*options, announce=folder / "announce", command=COMMAND) as server:
        yield server


def url_of(served: Served, wire: str) -> str:
    if wire == "pty":
        if served.pty is None:
            # Meant: Windows has none.
            pytest.skip("no pseudo-terminals here")
        return str(served.pty)
    kind = "telnet" if wire == "telnet" else "tcp"
    address = served.announced[kind][0]
    return f"{'tcp' if wire == 'telnet' else wire}://{address}"


def tell(served: Served, commands: str) -> None:
    """Another host's commands; its own output shows that the unit has taken them in."""
    with served.connect() as other:
        other.sock.settimeout(5)
        other.sock.sendall(f'{commands}\r!WRITE"\\126"\r'.encode())
        said = b""
        while b"~" not in said:
            said += other.sock.recv(1000)


SETTINGS = ("ECHO1:ERRLVL4", "ECHO0:ERRLVL1", "ECHO1:ERRLVL2:EOT10,0,0")
USUAL = {(WIRES[0], setting) for setting in SETTINGS} | {
    ("socket", SETTINGS[2]),
    ("rfc2217", SETTINGS[0]),
    ("pty", SETTINGS[1]),
    ("telnet", SETTINGS[0]),
}
"""Played in the default run; the rest with --runslow. A telnet port makes CR LF of an LF alone."""
CASES = [
    pytest.param(wire, setting, marks=() if (wire, setting) in USUAL else pytest.mark.slow)
    for wire in WIRES
    for setting in SETTINGS
    if (wire, setting) != ("telnet", SETTINGS[2])
]


@pytest.mark.parametrize(("wire", "setting"), CASES)
def test_every_wire(served: Served, wire: str, setting: str) -> None:
    tell(served, setting)
    try:
        with OEM6250.open(url_of(served, wire)) as ctl:
            axis = ctl.axis[1]
            axis.drive_enabled = True
            axis.velocity, axis.acceleration = 20, 500
            start = axis.commanded_position
            axis.move_by(500)
            assert axis.commanded_position == start + 500
            ctl.programs.download("WIRE", ['WRITE"HI"', "D100"])
            assert ctl.programs.upload("WIRE") == ['WRITE"HI"', "D100"]
            ctl.vars[2] = f"over {wire}"
            assert ctl.vars[2] == f"over {wire}"
            assert ctl.changed == ()
    finally:
        tell(served, "ECHO1:ERRLVL4:EOT13,0,0")


EOTS = ("13,0,0", "13,10,0", "10,0,0", "0,0,0", "3,0,0")


def in_default_run(wire: str, level: int, echo: int, eot: str) -> bool:
    """Each level, echo and EOT once on each wire; the whole product with --runslow."""
    place = WIRES.index(wire) + level
    return echo == place % 2 and eot == EOTS[place % len(EOTS)]


FRAMINGS = [
    pytest.param(*case, marks=() if in_default_run(*case) else pytest.mark.slow, id="-".join(map(str, case)))
    for case in itertools.product(WIRES, range(5), (0, 1), EOTS)
    if (case[0], case[3]) != ("telnet", "10,0,0")
]


@pytest.mark.parametrize(("wire", "level", "echo", "eot"), FRAMINGS)
def test_every_wire_at_every_level_echo_and_eot(served: Served, wire: str, level: int, echo: int, eot: str) -> None:
    tell(served, f"ECHO{echo}:EOT{eot}:ERRLVL{level}")
    try:
        with OEM6250.open(url_of(served, wire)) as ctl:
            link = ctl.session.link
            assert (link.level, link.echo) == (level, bool(echo))
            ctl.axis[2].velocity = 2.5
            assert ctl.axis[2].velocity == 2.5
            assert not ctl.status.axis(2).moving
            assert ctl.query("!2TAS.1") == "0"
            ctl.vars[3] = "part *7"
            assert ctl.vars[3] == "part *7"
            if (
                level >= 2
            ):  # below that the reason has to be asked for, which takes its time; tests/clients/test_emulated.py
                with pytest.raises(UnitError) as refusal:
                    ctl.send("!TPROG NONE")
                assert refusal.value.command == "!TPROG NONE"
            assert ctl.axis[2].position == pytest.approx(0, abs=50)
            assert ctl.changed == ()
    finally:
        tell(served, "ECHO1:ERRLVL4:EOT13,0,0")


@pytest.mark.parametrize("wire", ["tcp", "socket", "rfc2217", "pty"])
def test_a_disconnect_during_a_move(tmp_path: Path, wire: str) -> None:
    pty = ["--pty", str(tmp_path / "tty")] if hasattr(os, "openpty") else ["--pty", "none"]
    with Served("--tcp", "127.0.0.1:0", *pty, announce=tmp_path / "announce", command=COMMAND) as server:
        ctl = OEM6250.open(url_of(server, wire))
        axis = ctl.axis[1]
        axis.drive_enabled = True
        axis.move_to(400_000, wait=False)
        cut = threading.Timer(0.2, server.process.kill)
        cut.start()
        began = time.monotonic()
        with pytest.raises(LineLost, match="the unit goes on with whatever it was doing, a move included"):
            axis.wait_until_settled(timeout_s=30)
        assert time.monotonic() - began < 10
        with pytest.raises(LineLost):
            axis.stop()
        ctl.close()
        cut.join()


@pytest.mark.parametrize("wire", ["tcp", "pty", "rfc2217"])
async def test_the_asyncio_face_over_streams_and_threads(served: Served, wire: str) -> None:
    async with await AsyncOEM6250.open(url_of(served, wire)) as ctl:
        await ctl.axis[2].set_velocity(7)
        assert await ctl.axis[2].get_velocity() == 7
        with pytest.raises(UnitError, match="UNDEFINED LABEL"):
            await ctl.programs.run("NONE")


def test_threads_share_a_client_and_never_get_each_other_s_answers(served: Served) -> None:
    wrong: list[str] = []
    with OEM6250.open(url_of(served, "tcp")) as ctl:
        ctl.var[1], ctl.var[2], ctl.var[3] = 1, 2, 3

        def ask(index: int) -> None:
            wrong.extend(f"{index}" for _ in range(60) if ctl.var[index] != index)

        threads = [threading.Thread(target=ask, args=(index,)) for index in (1, 2, 3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(20)
        assert not wrong
        with ctl.locked():
            assert ctl.var[1] + ctl.var[2] == ctl.var[3]


def test_another_thread_stops_a_move_that_one_waits_for(served: Served) -> None:
    with OEM6250.open(url_of(served, "tcp")) as ctl:
        axis = ctl.axis[1]
        axis.drive_enabled = True
        ended = threading.Event()

        def move() -> None:
            axis.move_by(9_000_000, velocity=5, timeout_s=30)
            ended.set()

        mover = threading.Thread(target=move)
        mover.start()
        while not axis.status.moving and mover.is_alive():
            pass
        axis.stop()
        assert ended.wait(10)
        mover.join()


def test_a_server_that_ends_is_a_lost_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        line = open_line(f"tcp://127.0.0.1:{server.getsockname()[1]}")
        server.accept()[0].close()
        with pytest.raises(LineLost, match="closed the connection"):
            OEM6250(line)
        line.close()


def test_a_port_that_listens_and_is_silent() -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        pytest.raises(NoAnswer, match="is it the unit's port, at its baud rate"),
    ):
        OEM6250.open(f"tcp://127.0.0.1:{server.getsockname()[1]}", timeout_s=0.1)


@pytest.mark.parametrize("url", ["tcp://127.0.0.1:1", "/dev/no-such-port", "rfc2217://127.0.0.1:1"])
def test_a_port_that_cannot_be_opened(url: str) -> None:
    with pytest.raises(LineLost, match="is gone"):
        OEM6250.open(url)


@pytest.mark.parametrize("url", ["tcp://", "tcp://host", "tcp://host:x", "tcp://:1"])
def test_a_bad_url_is_refused(url: str) -> None:
    with pytest.raises(ValueError, match="tcp://host:port"):
        tcp_address(url)


# Meant: Windows has none, and the library is to be tested there too.
@pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")
def test_a_pty_whose_unit_goes_away() -> None:
    import tty

    from tests.clients.peers import FamilyUnit

    ours, theirs = os.openpty()

    def serve() -> None:
        unit = FamilyUnit(values={"1TPE": "+5"})
        while b"TPC" not in (data := os.read(ours, 1000)):
            for _, part in unit.answer(data):
                os.write(ours, part)
        os.close(ours)

    tty.setraw(theirs)
    server = threading.Thread(target=serve)
    server.start()
    with OEM6250.open(os.ttyname(theirs)) as ctl:
        os.close(theirs)
        assert ctl.axis[1].position == 5
        with pytest.raises(LineLost):
            ctl.axis[1].commanded_position  # noqa: B018
    server.join(5)
