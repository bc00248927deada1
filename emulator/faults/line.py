"""Faults between a unit and its line: noise, lost characters, a unit that says or hears nothing, a slow one; and power.

Chance is drawn once for every character in the order in which they pass, from a sequence that the seed begins: the same
session with the same seed loses the same characters, however the bytes are cut into pieces.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import TYPE_CHECKING

from emulator.controller.line.disturbances import Spoil
from emulator.faults.fault import Effect, Fault, FaultError
from emulator.parameters import Parameter

if TYPE_CHECKING:
    from emulator.controller import Controller

NS_PER_S = 1_000_000_000
DIRECTIONS = ("both", "to_unit", "from_unit")


def _spoil(controller: Controller, direction: str, spoil: Callable[[bytes], tuple[bytes, int]]) -> Effect:
    """Have the characters of a direction pass through a function that returns them with how many it spoiled."""
    if direction not in DIRECTIONS:
        raise FaultError(f"direction must be {', '.join(DIRECTIONS)}, not {direction!r}")

    def counted(at_ns: int, data: bytes) -> bytes:
        spoiled, count = spoil(data)
        effect.note(at_ns, count)
        return spoiled

    heard: Spoil | None = counted if direction != "from_unit" else None
    said: Spoil | None = counted if direction != "to_unit" else None
    effect = Effect(controller.now_ns, lift=controller.disturbances.add(heard=heard, said=said))
    return effect


def _check_chance(chance: float) -> None:
    if not 0.0 <= chance <= 1.0:
        raise FaultError(f"chance must be 0 to 1, not {chance}")


def _noise(controller: Controller, chance: float, direction: str, seed: int) -> Effect:
    """One bit of a character turned over, as a glitch within it does."""
    _check_chance(chance)
    dice = random.Random(seed)

    def spoil(data: bytes) -> tuple[bytes, int]:
        turned = [1 << dice.randrange(8) if dice.random() < chance else 0 for _ in data]
        return bytes(byte ^ bit for byte, bit in zip(data, turned, strict=True)), sum(map(bool, turned))

    return _spoil(controller, direction, spoil)


def _drop(controller: Controller, chance: float, direction: str, seed: int) -> Effect:
    _check_chance(chance)
    dice = random.Random(seed)

    def spoil(data: bytes) -> tuple[bytes, int]:
        kept = bytes(byte for byte in data if dice.random() >= chance)
        return kept, len(data) - len(kept)

    return _spoil(controller, direction, spoil)


def _lose_all(data: bytes) -> tuple[bytes, int]:
    return b"", len(data)


def _silence(controller: Controller) -> Effect:
    return _spoil(controller, "from_unit", _lose_all)


def _deafen(controller: Controller) -> Effect:
    return _spoil(controller, "to_unit", _lose_all)


def _slow_down(controller: Controller, delay_s: float) -> Effect:
    if not 0.0 <= delay_s < 1e6:
        raise FaultError(f"delay_s must be 0 or more seconds, not {delay_s}")
    effect = Effect(controller.now_ns, lift=controller.disturbances.no_delay)
    controller.disturbances.delay(round(delay_s * NS_PER_S), effect.note)
    return effect


def _cut_power(controller: Controller) -> Effect:
    was_on = controller.powered
    controller.power_down()

    def restore() -> None:
        if not controller.powered:
            controller.power_up()

    return Effect(controller.now_ns, count=int(was_on), lift=restore)


_CHANCE = Parameter("chance", float, "of each character, 0 to 1", unit="1", default=0.01)
_DIRECTION = Parameter("direction", str, "both, to_unit or from_unit", default="both")
_SEED = Parameter("seed", int, "of the sequence of chances", default=1)

LINE_FAULTS = (
    Fault(
        name="line_noise",
        sentence="noise on the line turns over one bit of a character now and then",
        shows="commands that are refused or mean something else (SS bit 11), replies and prompts that cannot be read",
        counts="characters spoiled",
        begin=_noise,
        parameters=(_CHANCE, _DIRECTION, _SEED),
    ),
    Fault(
        name="bytes_dropped",
        sentence="characters get lost on the line",
        shows="commands that are refused or mean something else (SS bit 11), replies and prompts with gaps",
        counts="characters lost",
        begin=_drop,
        parameters=(_CHANCE, _DIRECTION, _SEED),
    ),
    Fault(
        name="unit_silent",
        sentence="the unit stops answering but goes on obeying: its transmit wire is off",
        shows="nothing reaches the hosts; motion, programs and settings go on",
        counts="characters nobody heard",
        begin=_silence,
    ),
    Fault(
        name="unit_deaf",
        sentence="the unit stops answering because it hears nothing: its receive wire is off",
        shows="no echo, no reply; motion and programs that are under way go on",
        counts="characters the unit did not hear",
        begin=_deafen,
    ),
    Fault(
        name="unit_slow",
        sentence="everything the unit says arrives late",
        shows="echo, replies and prompts later by the delay, in their order",
        counts="pieces of output delayed",
        begin=_slow_down,
        parameters=(Parameter("delay_s", float, "of all output", unit="s"),),
    ),
    Fault(
        name="power_cut",
        sentence="the unit is switched off and its motors coast; lifting it switches it on",
        shows="silence; then the sign-on, settings at their power-up values, what is non-volatile kept",
        counts="cuts",
        begin=_cut_power,
    ),
)
