"""Python values to field texts and replies to Python values: what the generated properties and methods call.

Reports and settings are asked and set with `!` wherever the language allows it, so that they act now, also while a
program runs or a move holds the buffer (COMEXC0).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from decimal import Decimal
from enum import IntEnum
from functools import lru_cache
from typing import TypeVar

from clients.effects import Procedure
from clients.errors import Garbled
from clients.plan import Answer
from clients.session import Session
from protocol.catalogue import CommandRow, commands
from protocol.errors import ReplyError
from protocol.reply_shapes import ParsedReply

Number = float | int | Decimal
T = TypeVar("T")
E = TypeVar("E", bound=IntEnum)


def number_text(value: Number) -> str:
    """A number as a field: plain decimals, never an exponent.

    Raises:
        ValueError: not a finite number. TypeError: not a number.
    """
    if isinstance(value, bool):
        return "1" if value else "0"
    if not isinstance(value, (int, float, Decimal)):
        raise TypeError(f"not a number: {value!r}")
    exact = value if isinstance(value, Decimal) else Decimal(repr(value) if isinstance(value, float) else int(value))
    if not exact.is_finite():
        raise ValueError(f"not a finite number: {value!r}")
    return format(exact, "f")


def field_text(value: Number | str) -> str:
    """A number, or a text as it is."""
    return value if isinstance(value, str) else number_text(value)


def _row(name: str) -> CommandRow:
    return commands()[name]


@lru_cache(maxsize=1024)
def _line(name: str, axis: int | None, text: str) -> str:
    mark = "!" if _row(name).immediate == "either" else ""
    return f"{mark}{'' if axis is None else axis}{name}{text}"


def ask(session: Session, name: str, axis: int | None = None, text: str = "") -> Procedure[Answer]:
    """Ask a report or a setting."""
    answer = yield from session.command(_line(name, axis, text))
    return answer


def write(session: Session, name: str, axis: int | None, *values: Number | str) -> Procedure[None]:
    """Set a setting, or carry out an action with these fields."""
    line = _line(name, axis, ",".join(map(field_text, values)))
    yield from session.command(line) if line.startswith("!") else session.buffered(line)


def _read(answer: Answer, take: Callable[[ParsedReply], T]) -> T:
    """The value of a reply; Garbled if it has not the form of its command."""
    try:
        return take(answer.parsed())
    except (ReplyError, IndexError, ValueError) as error:
        raise Garbled(f"a reply to {answer.command!r}", answer.text.encode("latin-1"), str(error)) from error


def decimals(session: Session, name: str, axis: int | None = None, text: str = "") -> Procedure[tuple[Decimal, ...]]:
    """All numbers of a reply, exactly as sent."""
    answer = yield from ask(session, name, axis, text)
    return _read(answer, lambda reply: reply.numbers)


def real(session: Session, name: str, axis: int | None = None, text: str = "") -> Procedure[float]:
    """A number with decimals."""
    answer = yield from session.command(_line(name, axis, text))
    try:
        return float(answer.value)
    except ValueError:
        return _read(answer, lambda reply: float(reply.numbers[0]))


def whole(session: Session, name: str, axis: int | None = None, text: str = "") -> Procedure[int]:
    """A whole number."""
    answer = yield from ask(session, name, axis, text)
    return _read(answer, lambda reply: int(reply.numbers[0]))


def reals(session: Session, name: str, axis: int | None = None) -> Procedure[tuple[float, ...]]:
    """Numbers with decimals, one a field."""
    numbers = yield from decimals(session, name, axis)
    return tuple(map(float, numbers))


def wholes(session: Session, name: str, axis: int | None = None) -> Procedure[tuple[int, ...]]:
    """Whole numbers, one a field."""
    numbers = yield from decimals(session, name, axis)
    return tuple(map(int, numbers))


def choice(session: Session, name: str, axis: int | None, kind: type[E]) -> Procedure[E]:
    """A whole number that has a name."""
    answer = yield from ask(session, name, axis)
    return _read(answer, lambda reply: kind(int(reply.numbers[0])))


def flag(session: Session, name: str, axis: int | None = None) -> Procedure[bool]:
    """One switch."""
    answer = yield from ask(session, name, axis)
    return _read(answer, lambda reply: reply.bits[0] == "1")


def bits(session: Session, name: str, axis: int | None = None) -> Procedure[str]:
    """Switches or status bits, bit 1 first, without separators."""
    answer = yield from ask(session, name, axis)
    return _read(answer, lambda reply: reply.bits)


def text_of(session: Session, name: str, axis: int | None = None, text: str = "") -> Procedure[str]:
    """A name or a text of one line."""
    answer = yield from ask(session, name, axis, text)
    return _read(answer, lambda reply: reply.text)


def lines_of(session: Session, name: str, axis: int | None = None, text: str = "") -> Procedure[tuple[str, ...]]:
    """A report of several lines."""
    answer = yield from ask(session, name, axis, text)
    return answer.lines


def quoted(text: str) -> str:
    """A text between double quotes.

    Raises:
        ValueError: it holds a double quote or a control character (write those as backslash codes).
    """
    if '"' in text or not text.isprintable() or not text.isascii():
        raise ValueError(f"a quoted text has no double quote and no control character (use \\nnn): {text!r}")
    return f'"{text}"'


def mask(axes: Sequence[int], value: str = "1", other: str = "X") -> str:
    """`GO` and its like for several axes: `value` for those, `other` for the rest; axes count from 1."""
    if not axes or min(axes) < 1:
        raise ValueError(f"axes count from 1: {axes!r}")
    return "".join(value if axis in axes else other for axis in range(1, max(axes) + 1))
