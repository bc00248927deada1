"""Reading expressions and conditions from the text of a command (blanks already out, upper case).

One grammar serves assignments (``VAR1=(VAR2+5)*3``) and conditions (``IF(1PE>4000 AND NOT IN.3=b1)``): a parenthesis
may hold either, and which one it was is known when it closes.  Operators and the words AND, OR have no precedence;
NOT takes the one term behind it.
"""

from __future__ import annotations

import re
from decimal import Decimal
from functools import lru_cache

from protocol import bitwise, catalogue
from protocol.arithmetic import ENTERED_PLACES, LARGEST, PI
from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.expression import (
    Complement,
    Condition,
    Expression,
    Function,
    Joined,
    Not,
    Operand,
    Operation,
    Relation,
    is_bits,
)
from protocol.numbers import truncate

MAX_EXPRESSION = 80
"""Longest condition, characters (Gem6K CR p.337)."""

INDEXED_OPERANDS = frozenset({"VAR", "VARB", "DAT", "TW", "READ"})
"""Operands followed by a number: which variable, data program, thumbwheel set, prompt string."""

CAPTURED_OPERANDS = frozenset({"PCE", "PCC", "PCA"})
"""Operands that may end in the letter of a trigger, which becomes their index: A is 1, B is 2."""

TRIGGER_LETTERS = "AB"

SETTING_OPERANDS = frozenset({"A", "AD", "V", "D"})
"""Settings that can be read as operands."""


class _BareDigits(str):
    """Digits that are a number beside a number and a bit pattern beside bits: ``MOV=000000``, ``VAR1=10``."""

    __slots__ = ()


_Part = Expression | Condition

_END = r"(?=[-+*/&|^<>=)]|AND|OR|$)"
_PATTERNS = (
    (re.compile(rf"B([01X]+){_END}", re.ASCII), str),
    (re.compile(rf"H([0-9A-F]+?){_END}", re.ASCII), bitwise.hex_bits),
    (re.compile(rf"([01X]*X[01X]*){_END}", re.ASCII), str),
)
_BARE = re.compile(rf"[01]+{_END}", re.ASCII)
_NUMBER = re.compile(rf"[+-]?(?:\d+\.?\d*|\.\d+){_END}", re.ASCII)
_OPERAND = re.compile(rf"(\d)?([A-Z]+?)(?:(\d{{1,9}})|\(VAR(\d{{1,9}})\))?(?:\.(\d{{1,9}}))?{_END}", re.ASCII)
_FUNCTION = re.compile(r"(SIN|COS|TAN|ATAN|SQRT|VCVT)\(")
_SIGN = re.compile(r"<<|>>|[-+*/&|^]")
_RELATION = re.compile(r"<>|<=|>=|=|<|>")
_JOINING_WORD = re.compile("AND|OR")
_NOT = re.compile("NOT")
_COMPLEMENT = re.compile("~")
_OPEN = re.compile(r"\(")
_CLOSE = re.compile(r"\)")


@lru_cache(maxsize=4096)
def parse_condition(text: str) -> Condition:
    """Read the condition between the outer parentheses of WAIT, IF, WHILE, UNTIL.

    Raises:
        CommandError: INCORRECT DATA for what is no condition, INVALID DATA for one that is too long or compares a
            number with a bit pattern.
    """
    if len(text) > MAX_EXPRESSION:
        raise CommandError(INVALID_DATA)
    return _condition(_Reader(text).whole())


@lru_cache(maxsize=4096)
def parse_number_expression(text: str) -> Expression:
    """Read what is assigned to a VAR; a lone number keeps eight decimals, the rest are cut off.

    Raises:
        CommandError: INCORRECT DATA for what is no expression, INVALID DATA for a bit pattern or a number out of range.
    """
    found = _number(_Reader(text).whole())
    if isinstance(found, Decimal):
        found = truncate(found, ENTERED_PLACES)
        if abs(found) > LARGEST:
            raise CommandError(INVALID_DATA)
    return found


@lru_cache(maxsize=4096)
def parse_bits_expression(text: str) -> Expression:
    """Read what is assigned to a VARB.

    Raises:
        CommandError: INCORRECT DATA for what is no expression, INVALID DATA for a number or more than 32 bits.
    """
    found = _bits(_Reader(text).whole())
    if isinstance(found, str) and len(found) > bitwise.WORD:
        raise CommandError(INVALID_DATA)
    return found


def _condition(part: _Part) -> Condition:
    if isinstance(part, Relation | Not | Joined):
        return part
    raise CommandError(INCORRECT_DATA)


def _expression(part: _Part) -> Expression:
    if isinstance(part, Relation | Not | Joined):
        raise CommandError(INCORRECT_DATA)
    return part


def _number(part: _Part) -> Expression:
    if isinstance(part, _BareDigits):
        return Decimal(part)
    if is_bits(_expression(part)):
        raise CommandError(INVALID_DATA)
    return _expression(part)


def _bits(part: _Part) -> Expression:
    if isinstance(part, _BareDigits):
        return str(part)
    if not is_bits(_expression(part)):
        raise CommandError(INVALID_DATA)
    return _expression(part)


def _means_bits(part: _Part) -> bool:
    return not isinstance(part, _BareDigits) and is_bits(_expression(part))


class _Reader:
    """Recursive descent over the text of one expression."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def whole(self) -> _Part:
        part = self._joined()
        if self._at != len(self._text):
            raise CommandError(INCORRECT_DATA)
        return part

    def _joined(self) -> _Part:
        part = self._term()
        while (word := self._take(_JOINING_WORD)) is not None:
            part = Joined(_condition(part), word[0], _condition(self._term()))
        return part

    def _term(self) -> _Part:
        if self._take(_NOT):
            return Not(_condition(self._term()))
        left = self._chain()
        sign = self._take(_RELATION)
        if sign is None:
            return left
        if isinstance(left, Decimal | str):
            raise CommandError(INCORRECT_DATA)
        return _relation(left, sign[0], self._chain())

    def _chain(self) -> _Part:
        part = self._atom()
        while (sign := self._take(_SIGN)) is not None:
            part = _operation(part, sign[0], self._atom())
        return part

    def _atom(self) -> _Part:
        if self._take(_COMPLEMENT):
            term = self._atom()
            return Complement(_bits(term) if _means_bits(term) else _number(term))
        if (function := self._take(_FUNCTION)) is not None:
            return self._function(function[1])
        if self._take(_OPEN):
            inside = self._joined()
            self._expect(_CLOSE)
            return inside
        literal = self._literal()
        return self._operand() if literal is None else literal

    def _function(self, name: str) -> Function:
        argument = self._chain()
        self._expect(_CLOSE)
        if name == "VCVT" and _means_bits(argument):
            return Function(name, _bits(argument))
        return Function(name, _number(argument))

    def _literal(self) -> Decimal | str | None:
        for pattern, bits_of in _PATTERNS:
            match = self._take(pattern)
            if match is not None:
                return bits_of(match[1])
        bare = self._take(_BARE)
        if bare is not None:
            return _BareDigits(bare[0])
        match = self._take(_NUMBER)
        return None if match is None else Decimal(match[0])

    def _operand(self) -> Expression:
        axis, name, index, holder, bit = self._expect(_OPERAND).groups()
        if name == "PI" and not (axis or index or holder or bit):
            return PI
        if name[:-1] in CAPTURED_OPERANDS and name[-1] in TRIGGER_LETTERS and not (index or holder):
            name, index = name[:-1], str(TRIGGER_LETTERS.index(name[-1]) + 1)
        number = index or holder
        operand = Operand(
            name,
            axis=int(axis) if axis else None,
            index=int(number) if number else None,
            bit=int(bit) if bit else None,
            indirect=holder is not None,
        )
        return _known(operand)

    def _take(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        match = pattern.match(self._text, self._at)
        if match is not None:
            self._at = match.end()
        return match

    def _expect(self, pattern: re.Pattern[str]) -> re.Match[str]:
        match = self._take(pattern)
        if match is None:
            raise CommandError(INCORRECT_DATA)
        return match


def _known(operand: Operand) -> Operand:
    name = operand.name
    known = name in INDEXED_OPERANDS or name in SETTING_OPERANDS or name in catalogue.operands()
    indexed = operand.index is not None and (name not in CAPTURED_OPERANDS or operand.indirect)
    if not known or indexed != (name in INDEXED_OPERANDS) or (operand.bit is not None and not is_bits(operand)):
        raise CommandError(INCORRECT_DATA)
    return operand


def _operation(left: _Part, sign: str, right: _Part) -> Operation:
    if sign in bitwise.SHIFTS:
        return Operation(_bits(left), sign, _number(right))
    if sign in bitwise.OPERATORS and (_means_bits(left) or _means_bits(right)):
        return Operation(_bits(left), sign, _bits(right))
    return Operation(_number(left), sign, _number(right))


def _relation(left: _Part, sign: str, right: _Part) -> Relation:
    if not _means_bits(left) and not _means_bits(right):
        return Relation(_number(left), sign, _number(right))
    if sign not in ("=", "<>"):
        raise CommandError(INCORRECT_DATA)
    return Relation(_bits(left), sign, _bits(right))
