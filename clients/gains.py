"""Servo gains as values: those in force (TGAIN, SGP ...), and the five sets a unit keeps (SGSET, SGENB, TSGSET)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

from clients.effects import Procedure
from clients.errors import Garbled
from clients.session import Session
from clients.values import ask, write
from protocol.errors import ReplyError
from protocol.numbers import parse_number


@dataclass(frozen=True)
class Gains:
    """The gains of one axis; the last two are told by saved sets only."""

    proportional: float
    """SGP, mV/count"""
    integral: float
    """SGI, mV/(count s)"""
    velocity: float
    """SGV, uV/(count/s)"""
    velocity_feedforward: float
    """SGVF, uV/(count/s)"""
    acceleration_feedforward: float
    """SGAF, uV/(count/s^2)"""
    integral_limit: float
    """SGILIM, volts"""
    output_offset: float | None = None
    """SOFFS, volts"""
    maximum_position_error: float | None = None
    """SMPER, counts"""


COMMANDS = ("SGP", "SGI", "SGV", "SGVF", "SGAF", "SGILIM", "SOFFS", "SMPER")
"""The lines of TSGSET in order; TGAIN has the first six (layout assumed: settled by no page at hand)."""


def active(session: Session) -> Procedure[tuple[Gains, ...]]:
    """TGAIN: the gains in force, one an axis."""
    answer = yield from ask(session, "TGAIN")
    return parse(answer.lines)


def saved(session: Session, number: int) -> Procedure[tuple[Gains, ...]]:
    """TSGSET: a saved set, one an axis.

    Raises:
        UnitError: there is no such set.
    """
    answer = yield from ask(session, "TSGSET", None, str(number))
    return parse(answer.lines)


def parse(lines: Sequence[str]) -> tuple[Gains, ...]:
    """The lines of TGAIN or TSGSET, with or without names.

    Raises:
        Garbled: lines or fields are missing.
    """
    columns: list[list[float]] = []
    try:
        for command, line in zip(COMMANDS, lines, strict=False):
            texts = line.strip().removeprefix(command).split(",")
            columns.append([float(parse_number(text)) for text in texts])
        return tuple(Gains(*row) for row in zip(*columns, strict=True))
    except (ReplyError, TypeError, ValueError) as error:
        raise Garbled("a list of gains", "\n".join(lines).encode("latin-1"), str(error)) from error


def put(session: Session, axis: int, gains: Gains) -> Procedure[None]:
    """Set the gains of an axis; offset and position error only where given."""
    for command, field in zip(COMMANDS, fields(Gains), strict=True):
        value = getattr(gains, field.name)
        if value is not None:
            yield from write(session, command, axis, value)


def save(session: Session, number: int) -> Procedure[None]:
    """SGSET: keep the gains in force of both axes as a set, 1 to 5."""
    yield from write(session, "SGSET", None, number)
