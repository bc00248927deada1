"""Random sessions that are recorded: programs, motion, packets cut anywhere, several connections, wires that change."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from random import Random

from emulator import Emulator, Machine
from emulator.emulator import Unit
from tests.fuzz.grammar import session

WIRES = ("enable", "axis1.positive_limit", "axis2.negative_limit", "axis1.home", "input.1", "input.2", "trigger.a")
OPENING = b"!C\r!K\rDRIVE11:A50:V5:D4000:GO11\r"


def packets(random: Random, commands: int) -> list[bytes]:
    """What hosts send, cut into packets that end anywhere."""
    text = OPENING + "".join(f"{line}\r" for line in session(random, commands)).encode("latin-1")
    cuts = sorted({0, len(text), *(random.randrange(len(text)) for _ in range(commands // 3))})
    return [text[start:end] for start, end in pairwise(cuts)]


def play(emulator: Emulator, random: Random, *, commands: int) -> None:
    """Send a random session to every unit, and do things to their wires on the way."""
    for unit in emulator.units:
        for packet in packets(random, commands):
            unit.send(packet, channel=random.choice((0, 0, 0, 1)))
            if random.random() < 0.2:
                act(unit, random)
            if random.random() < 0.1:
                unit.read()
            emulator.advance(random.choice((0.0, 1e-9, 0.0005, 0.05)))
        unit.send(b"\r!K\r!HALT\r!K\r1TPE\r", channel=0)
        emulator.advance(0.3)


def act(unit: Unit, random: Random) -> None:
    """Something a person does to a unit."""
    match random.randrange(6):
        case 0:
            unit.do("set_analog", channel=random.randint(1, 3), volts=random.random() * 2.5)
        case 1:
            unit.do("advance_time", seconds=0.001)
        case _:
            unit.do("set_wire", name=random.choice(WIRES), closed=random.random() < 0.6)


def record(path: Path, seed: int, *, commands: int = 40, machine: str = "", units: int = 1) -> None:
    """A random session of the Python face into a file."""
    machines = [Machine.parse(machine)] * units
    with Emulator(machines, record=path) as emulator:
        play(emulator, Random(seed), commands=commands)
