"""The unit's variables as procedures: VAR (real), VARB (32 bits), VARS (text)."""

from __future__ import annotations

from decimal import Decimal

from clients.effects import Procedure
from clients.errors import Garbled
from clients.session import Session
from clients.values import Number, ask, number_text, quoted, write
from protocol.errors import ReplyError
from protocol.numbers import parse_number
from protocol.reply import bits_word, ungroup_bits, word_bits

WORD_BITS = 32


def _asked(session: Session, name: str, index: int) -> Procedure[str]:
    if index < 1:
        raise ValueError(f"variables count from 1: {index}")
    answer = yield from ask(session, name, None, str(index))
    return answer.value


def get_number(session: Session, index: int) -> Procedure[Decimal]:
    """VAR, exactly as the unit says it."""
    value = yield from _asked(session, "VAR", index)
    try:
        return parse_number(value)
    except ReplyError as error:
        raise Garbled(f"the value of VAR{index}", value.encode("latin-1"), str(error)) from error


def set_number(session: Session, index: int, value: Number) -> Procedure[None]:
    """VARn=value."""
    yield from write(session, "VAR", None, f"{index}={number_text(value)}")


def get_bits(session: Session, index: int) -> Procedure[str]:
    """VARB as 32 characters 0, 1 or X, bit 1 first."""
    value = yield from _asked(session, "VARB", index)
    try:
        return ungroup_bits(value)
    except ReplyError as error:
        raise Garbled(f"the value of VARB{index}", value.encode("latin-1"), str(error)) from error


def set_bits(session: Session, index: int, value: str | int) -> Procedure[None]:
    """VARBn=b...: a text of 0, 1 and X (bit 1 first), or an integer of 32 bits (bit 1 is 1)."""
    bits = word_bits(value, WORD_BITS) if isinstance(value, int) else value.replace("_", "").upper()
    if not bits or set(bits) - set("01X"):
        raise ValueError(f"not bits 0, 1, X: {value!r}")
    yield from write(session, "VARB", None, f"{index}=b{bits}")


def as_integer(bits: str) -> int:
    """The bits of a VARB as an integer; X counts as 0."""
    return bits_word(bits)


def get_text(session: Session, index: int) -> Procedure[str]:
    """VARS, without its quotes."""
    value = yield from _asked(session, "VARS", index)
    return value.removeprefix('"').removesuffix('"')


def set_text(session: Session, index: int, value: str) -> Procedure[None]:
    """VARSn="text"."""
    yield from write(session, "VARS", None, f"{index}={quoted(value)}")
