"""Gains as people write them: `SGP=15,SGV=2`, the commands that set them, and the ranges the unit takes."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal

from emulator.controller.motion.servo import GAIN_COMMANDS
from emulator.engine import Gains
from protocol.catalogue import commands

DECIMALS = 8
"""Decimals that a gain can be typed with."""

GainValues = tuple[float, float, float, float, float, float]


def row_of(gains: Gains) -> GainValues:
    """Gains in the order of GAIN_COMMANDS."""
    return (
        gains.proportional_mv_per_count,
        gains.integral_mv_per_count_s,
        gains.velocity_uv_per_count_s,
        gains.velocity_feedforward_uv_per_count_s,
        gains.acceleration_feedforward_uv_per_count_s2,
        gains.integral_limit_v,
    )


def changed(gains: Gains, values: Mapping[str, float]) -> Gains:
    """The gains with some commands' values changed."""
    own = dict(zip(GAIN_COMMANDS, row_of(gains), strict=True))
    return Gains(*(own | dict(values)).values())


def value_of(gains: Gains, name: str) -> float:
    """The value of one gain command."""
    return row_of(gains)[GAIN_COMMANDS.index(name)]


def checked(name: str, value: float) -> float:
    """A value a gain command takes; ValueError for an unknown name or a value out of its range."""
    if name not in GAIN_COMMANDS:
        raise ValueError(f"{name!r} is not a gain; there are {', '.join(GAIN_COMMANDS)}")
    fields = commands()[name].fields
    lowest, highest = float(fields.min or 0.0), float(fields.max or 0.0)
    if not lowest <= value <= highest:
        raise ValueError(f"{name} {value:g} is out of range, {lowest:g} to {highest:,.0f}")
    return value


def parse_gains(text: str) -> dict[str, float]:
    """`SGP=15,SGV=2` as values by command; ValueError, in one line, for what is not that."""
    values: dict[str, float] = {}
    for part in text.split(","):
        name, sign, number = (piece.strip() for piece in part.partition("="))
        if not sign:
            raise ValueError(f"{part.strip()!r} is not NAME=VALUE, as in SGP=15,SGV=2")
        try:
            value = float(number)
        except ValueError:
            raise ValueError(f"{number!r} is not a number ({name.upper()})") from None
        if name.upper() in values:
            raise ValueError(f"{name.upper()} is given twice in {text!r}")
        values[name.upper()] = checked(name.upper(), value)
    return values


def tidy(value: float) -> str:
    """A number as one types it: no exponent, at most DECIMALS decimals."""
    text = format(round(Decimal(repr(float(value))), DECIMALS), "f")
    return (text.rstrip("0").rstrip(".") if "." in text else text) or "0"


def gain_commands(gains: Gains, axis_index: int) -> list[str]:
    """The commands that set the gains of one axis, the other left alone: `SGP15`, or `SGP,15` for axis 2."""
    lead = "," * axis_index
    return [f"{name}{lead}{tidy(value)}" for name, value in zip(GAIN_COMMANDS, row_of(gains), strict=True)]


def short(gains: Gains) -> str:
    """The gains that are not zero in one line: `SGP 15  SGV 2`; a SGILIM only where it limits anything."""
    shown = [
        f"{name} {tidy(value)}"
        for name, value in zip(GAIN_COMMANDS, row_of(gains), strict=True)
        if (value and name != "SGILIM") or (name == "SGILIM" and value < 10.0 and gains.integral_mv_per_count_s)
    ]
    return "  ".join(shown) or "all gains 0"
