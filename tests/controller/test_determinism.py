"""The same bytes at the same times give the same bytes at the same times, however both are cut up.

A scripted session of five virtual minutes visits moves, waits, programs, faults, limits and errors.  It is played
whole and in one go, then with its input split and its time sliced otherwise; every byte must leave at the same
nanosecond.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import NamedTuple

import pytest

from emulator import Emulator, Machine
from emulator.controller import Output
from emulator.engine.machine_code import MODE_VARIABLE

MS = 1_000_000
S = 1_000_000_000

MACHINE = "[axis1.encoder]\nphase = 0.25\n[axis2.plant]\nkind = 'torque_drive'\n"


class Step(NamedTuple):
    """Something that happens at a time: bytes on a channel, or a contact that changes."""

    at_ns: int
    data: bytes = b""
    channel: int = 0
    wire: str = ""
    closed: bool = True


SET_UP = (
    b"ECHO0\rDRIVE11\rCOMEXC1\rERROR111111111111\rSGP,20:SGV,400:SGI2,5\rSTRGTE11\rDEF TOUR:D4000,-4000:GO11:"
    b"WAIT(1AS.1=b0 AND 2AS.1=b0):T.05:D~,~:GO11:1TPE:END\r"
)

ROUND = (
    Step(0, b"1TPE:2TPE:TAS\rV5,5:A100,50:AD80\r"),
    Step(137 * MS, b"GO11\r"),
    Step(170 * MS, b"TPE\r", channel=1),
    Step(171 * MS, b"1TPC:1TVELA:TD", channel=1),
    Step(300 * MS, b"AC\r1TAS\r", channel=1),
    Step(411 * MS, b"!V2:!GO1\rTPER\r"),
    Step(900 * MS, b"TOUR\r"),
    Step(1100 * MS, b"!TPE\r!TAS\r!TSS\r", channel=1),
    Step(3100 * MS, b"TPE:TER:XYZZY:V999\r"),
    Step(3500 * MS, b"MC1X:GO1:T.3:1TPC:S1\r"),
    Step(3600 * MS, wire="axis1.positive_limit", closed=False),
    Step(3900 * MS, b"!TAS\r"),
    Step(4300 * MS, wire="axis1.positive_limit", closed=True),
    Step(4400 * MS, b"\x0bMC00:COMEXC0:D100,100:GO11:1TPE:COMEXC1\r"),
    Step(5000 * MS, b"SMPER,3\r2D40000:2GO1\r"),
    Step(5500 * MS, b"TAS:SMPER,4000:@DRIVE1:TPE\r"),
    Step(5700 * MS, wire="enable", closed=False),
    Step(5800 * MS, b"DRIVE11:TAS:TER\r"),
    Step(5900 * MS, wire="enable", closed=True),
    Step(6000 * MS, b"@DRIVE1:PSET0,0:TPE\r"),
)
ROUND_NS = 6111 * MS


def session(length_s: float) -> list[Step]:
    steps = [Step(5 * MS, SET_UP)]
    start_ns = 50 * MS
    while start_ns + ROUND_NS < length_s * S:
        steps += [step._replace(at_ns=start_ns + step.at_ns) for step in ROUND]
        start_ns += ROUND_NS + 777
    return steps


Slicer = Callable[[int, int], Iterator[int]]


def in_one_go(start_ns: int, end_ns: int) -> Iterator[int]:
    yield end_ns


def never(start_ns: int, end_ns: int) -> Iterator[int]:
    """Time passes only because bytes arrive."""
    yield from ()


def every_second(start_ns: int, end_ns: int) -> Iterator[int]:
    yield from range(start_ns - start_ns % S + S, end_ns, S)
    yield end_ns


def at_random(seed: int) -> Slicer:
    """Slices from a nanosecond to some seconds, all lengths alike often."""
    dice = random.Random(seed)

    def slices(start_ns: int, end_ns: int) -> Iterator[int]:
        now_ns = start_ns
        while now_ns < end_ns:
            now_ns = min(end_ns, now_ns + int(10 ** dice.uniform(0, 9.5)))
            yield now_ns

    return slices


Splitter = Callable[[bytes], Iterator[bytes]]


def whole(data: bytes) -> Iterator[bytes]:
    yield data


def byte_by_byte(data: bytes) -> Iterator[bytes]:
    yield from (bytes((byte,)) for byte in data)


def split_at_random(seed: int) -> Splitter:
    dice = random.Random(seed)

    def split(data: bytes) -> Iterator[bytes]:
        while data:
            length = dice.randint(1, 9)
            yield data[:length]
            data = data[length:]

    return split


def play(
    length_s: float, *, slices: Slicer = in_one_go, split: Splitter = whole, machine: str = MACHINE
) -> list[tuple[int, int, int | None]]:
    """Every byte that left the unit, with its time and channel."""
    emulator = Emulator(Machine.parse(machine))
    unit, controller = emulator.unit(0), emulator.unit(0).controller
    sent: list[Output] = []
    for step in [*session(length_s), Step(round(length_s * S))]:
        for until_ns in slices(controller.now_ns, step.at_ns):
            controller.advance(until_ns)
        for piece in split(step.data):
            controller.receive(piece, at_ns=step.at_ns, channel=step.channel)
        if step.wire:
            unit.do("set_wire", name=step.wire, closed=step.closed)
        sent += controller.take_output()
    return [(output.at_ns, byte, output.channel) for output in sent for byte in output.data]


@pytest.fixture(scope="module")
def five_minutes() -> list[tuple[int, int, int | None]]:
    return play(300)


def test_the_script_visits_what_it_is_meant_to(five_minutes: list[tuple[int, int, int | None]]) -> None:
    text = bytes(byte for _, byte, _ in five_minutes).decode("latin-1")
    for seen in ("UNDEFINED LABEL", "INVALID DATA-FIELD 1", "ENABLE INPUT INACTIVE", "*1TPE", "*TDAC"):
        assert text.count(seen) > 40, seen
    assert len({at_ns for at_ns, _, _ in five_minutes}) > 600
    assert max(at_ns for at_ns, _, _ in five_minutes) > 290 * S


def test_twice_the_same(five_minutes: list[tuple[int, int, int | None]]) -> None:
    assert play(300) == five_minutes


@pytest.mark.parametrize(
    ("slices", "split"),
    [
        (every_second, byte_by_byte),
        (at_random(1), split_at_random(1)),
        (at_random(2), byte_by_byte),
        (never, whole),
    ],
)
def test_cut_otherwise(slices: Slicer, split: Splitter, five_minutes: list[tuple[int, int, int | None]]) -> None:
    assert play(300, slices=slices, split=split) == five_minutes


def test_in_slices_of_single_nanoseconds() -> None:
    """Around the moments where something is due."""

    def slices(start_ns: int, end_ns: int) -> Iterator[int]:
        yield from range(max(start_ns, end_ns - 3000), end_ns + 1)

    assert play(14, slices=slices) == play(14)


@pytest.mark.parametrize(
    "machine",
    [
        MACHINE.replace("0.25", "0.75"),
        MACHINE + "[axis1.plant]\nkind = 'velocity_drive'\nloop_time_constant_s = 0.004\n",
        MACHINE + "[servo]\ndac_bits = 12\n",
    ],
)
def test_another_machine_says_something_else(machine: str) -> None:
    """The comparison can fail: a quarter of a count, a slower drive or a coarser converter shows."""
    assert play(14, machine=machine) != play(14)


def test_interpreted_and_compiled_kernels_say_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled = play(1.5)
    assert Emulator().unit(0).controller.engine.kernel_origin != "interpreted"
    monkeypatch.setenv(MODE_VARIABLE, "interpreted")
    assert Emulator().unit(0).controller.engine.kernel_origin == "interpreted"
    assert play(1.5) == compiled
