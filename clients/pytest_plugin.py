"""pytest fixtures for tests of host programs: an emulated OEM6250 on virtual time, and one behind real ports.

    def test_moves(oem6250):
        oem6250.client.axis[1].move_to(4000)

    def test_my_program(oem6250_server):
        run_my_program(port=oem6250_server.port)

pytest loads this module in every project it is installed beside, so it imports nothing but pytest until a fixture is
used.  docs/testing.md is the guide.
"""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from pathlib import Path

    from clients.testing import Emulated, EmulatedRmc, Served

TAIL_LINES = 40
"""Lines of traffic shown of a failing test, unless it is told otherwise."""

MARKER = (
    "oem6250(machine=None, units=1, chain=1, speed='waiting', names={}, quiet_ms=5): the emulated unit of this test: "
    "a Machine, a machine file's text or path; units side by side (oem6250 alone) or chain on one line; "
    "how time passes behind ports: 'waiting', 'max' or N; names for inputs and outputs; see docs/testing.md"
)
RMC_MARKER = "rmc151(machine=None): the machine of this test's emulated RMC151; see docs/rmc.md"
_KNOWN = frozenset({"machine", "units", "chain", "speed", "names", "quiet_ms", "process"})
_IN_TEST = pytest.StashKey[list["Emulated | Served"]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options and ini settings."""
    group = parser.getgroup("oem6250", "emulated OEM6250 motion controllers")
    group.addoption(
        "--oem6250-speed",
        metavar="waiting|N|max",
        help="how time passes behind ports (oem6250_server) where a test does not say: only while the host waits "
        "(the default), N times the wall's, or as fast as possible",
    )
    group.addoption(
        "--oem6250-record", metavar="DIR", help="write the session of each failing test there, for `oem6250 replay`"
    )
    group.addoption(
        "--oem6250-update", action="store_true", help="write the files of assert_transcript instead of comparing"
    )
    group.addoption(
        "--oem6250-lines", metavar="N", type=int, help=f"traffic shown of a failing test (default: {TAIL_LINES} lines)"
    )
    parser.addini("oem6250_speed", "as --oem6250-speed", default="waiting")
    parser.addini("oem6250_record", "as --oem6250-record", default="")
    parser.addini("oem6250_lines", "as --oem6250-lines", default=str(TAIL_LINES))


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known, and refuse a speed that is none before anything runs."""
    config.addinivalue_line("markers", MARKER)
    config.addinivalue_line("markers", RMC_MARKER)
    _speed_of(_option(config, "speed"))


@pytest.fixture
def oem6250_machine() -> Any:
    """The machine of the emulated units; override it in a module, class or conftest.py.

    A Machine, the text of a machine file or its path, a list of those for several units, or None for the default
    machine. ``@pytest.mark.oem6250(machine=...)`` at a test goes before it.
    """
    return None


@pytest.fixture
def oem6250(request: pytest.FixtureRequest, oem6250_machine: Any) -> Iterator[Emulated]:
    """An emulator in this process on virtual time, with a connected client."""
    from clients.testing import Emulated

    wishes = _wishes(request)
    machine = wishes.get("machine", oem6250_machine)
    units, chain = wishes.get("units", 1), wishes.get("chain", 1)
    with Emulated(machine, units=units, chain=chain, names=wishes.get("names")) as emu:
        _remember(request, emu)
        yield emu


@pytest.fixture
def oem6250_server(request: pytest.FixtureRequest, oem6250_machine: Any) -> Iterator[Any]:
    """An emulator behind a virtual serial port and a TCP port, for host code that opens a port itself.

    With ``@pytest.mark.oem6250(process=True)`` it is a process of its own (a ServedProcess).
    """
    wishes = _wishes(request)
    machine = wishes.get("machine", oem6250_machine)
    speed = _speed_of(str(wishes.get("speed", _option(request.config, "speed"))))
    if wishes.get("process"):
        from clients.testing.process import ServedProcess

        with ServedProcess(machine, chain=wishes.get("chain", 1), speed=speed) as process:
            yield process
        return
    from clients.testing import Served

    quiet = {"quiet_ms": wishes["quiet_ms"]} if "quiet_ms" in wishes else {}
    with Served(machine, chain=wishes.get("chain", 1), speed=speed, names=wishes.get("names"), **quiet) as server:
        _remember(request, server)
        yield server


@pytest.fixture
def rmc151_machine() -> Any:
    """The machine of the emulated RMC, as `oem6250_machine`; ``@pytest.mark.rmc151(machine=...)`` goes before it."""
    return None


@pytest.fixture
def rmc151(request: pytest.FixtureRequest, rmc151_machine: Any) -> Iterator[EmulatedRmc]:
    """A Delta RMC151 in this process on virtual time, with a connected client (docs/rmc.md)."""
    from clients.testing import EmulatedRmc

    marker = request.node.get_closest_marker("rmc151")
    if marker is not None and (marker.args or not set(marker.kwargs) <= {"machine"}):
        raise pytest.UsageError("@pytest.mark.rmc151 takes machine by name")
    with EmulatedRmc(rmc151_machine if marker is None else marker.kwargs.get("machine", rmc151_machine)) as emu:
        yield emu


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add to the report of a failing test what its units said and where they stand."""
    report = yield
    if report.failed:
        for emulated in item.stash.get(_IN_TEST, []):
            _report(report, item, emulated)
    return report


def _report(report: pytest.TestReport, item: pytest.Item, emulated: Emulated | Served) -> None:
    count = int(_option(item.config, "lines"))
    report.sections.append(("oem6250 traffic", "\n".join(_carefully(lambda: emulated.traffic.tail(count)))))
    report.sections.append(("oem6250 axes", "\n".join(_carefully(lambda: [emulated.describe()]))))
    directory = _option(item.config, "record")
    if directory and report.when == "call":
        path = item.config.rootpath / directory / f"{_file_name(item.nodeid)}.rec"
        report.sections.append(("oem6250 recording", "\n".join(_carefully(lambda: _write(path, emulated)))))


def _write(path: Path, emulated: Emulated | Served) -> list[str]:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(emulated.recording())
    return [f"{path}", f"(oem6250 replay {path})"]


def _carefully(lines: Any) -> list[str]:
    """A report of a failing test must not fail in its turn, whatever state the test has left."""
    try:
        found: list[str] = lines()
    except Exception as error:
        return [f"not to be had: {error}"]
    return found


def _file_name(nodeid: str) -> str:
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", nodeid).strip("-")[-200:]


def _remember(request: pytest.FixtureRequest, emulated: Emulated | Served) -> None:
    emulated.update_transcripts = request.config.getoption("oem6250_update")
    request.node.stash.setdefault(_IN_TEST, []).append(emulated)


def _wishes(request: pytest.FixtureRequest) -> Mapping[str, Any]:
    """What the markers of a test ask for; the nearest one counts, key by key."""
    wishes: dict[str, Any] = {}
    for marker in request.node.iter_markers("oem6250"):
        if marker.args or not set(marker.kwargs) <= _KNOWN:
            raise pytest.UsageError(f"@pytest.mark.oem6250 takes {', '.join(sorted(_KNOWN))} by name")
        wishes = {**marker.kwargs, **wishes}
    return wishes


def _option(config: pytest.Config, name: str) -> str:
    given = config.getoption(f"oem6250_{name}")
    return str(config.getini(f"oem6250_{name}")) if given is None else str(given)


def _speed_of(text: str) -> Any:
    """``waiting``, ``max``, or a number above 0."""
    if text in ("waiting", "max"):
        return text
    try:
        speed = float(text)
    except ValueError:
        speed = 0.0
    if not 0.0 < speed < 1e6:
        raise pytest.UsageError(f"speed {text!r} of the emulated OEM6250 is not waiting, max or a number above 0")
    return speed
