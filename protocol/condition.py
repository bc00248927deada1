"""Conditions as in ``WAIT(1AS.1=b0 AND VAR1>3)``: read into a tree, evaluated with whatever reads the operands.

Relations compare an operand (axis digit, name, optional bit) with a number or a bit pattern; ``AND``, ``OR`` and
``NOT`` are full words, worked strictly left to right; parentheses group.  In a pattern X matches anything and the
leading ``b`` may be missing (seen in a host: ``WAIT(6AS=XXXX1)``); a pattern shorter than the word compares only its
first bits."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import Decimal

from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError

MAX_EXPRESSION = 80
"""Longest expression, characters (Gem6K CR p.337)."""


@dataclass(frozen=True, slots=True)
class Operand:
    """``2PE``, ``AS.1``, ``VAR3``: axis digit or None, name, index of a variable or bit of a word."""

    name: str
    axis: int | None = None
    index: int | None = None
    bit: int | None = None


@dataclass(frozen=True, slots=True)
class Relation:
    """An operand compared with a number, a pattern (text of 0, 1, X) or another operand."""

    left: Operand
    sign: str
    right: Decimal | str | Operand


@dataclass(frozen=True, slots=True)
class Not:
    """The complement of a term."""

    term: Condition


@dataclass(frozen=True, slots=True)
class Joined:
    """Two conditions joined by AND or OR."""

    left: Condition
    word: str
    right: Condition


Condition = Relation | Not | Joined
Value = Decimal | str
"""What an operand reads as: a number, or a bit text with bit 1 first."""

_JOINING_WORD = re.compile("AND|OR")
_CLOSE = re.compile(r"\)")
_SIGN = re.compile(r"<>|<=|>=|=|<|>")
_OPERAND = re.compile(r"(\d)?([A-Z]+?)(\d+)?(?:\.(\d+))?(?=[=<>)]|AND|OR|$)")

_COMPARE: dict[str, Callable[[Decimal, Decimal], bool]] = {
    "=": lambda left, right: left == right,
    "<>": lambda left, right: left != right,
    "<": lambda left, right: left < right,
    ">": lambda left, right: left > right,
    "<=": lambda left, right: left <= right,
    ">=": lambda left, right: left >= right,
}


def parse_condition(text: str) -> Condition:
    """Read the condition between the outer parentheses of WAIT, IF, WHILE, UNTIL (blanks already out, upper case).

    Raises:
        CommandError: INCORRECT DATA for what is no condition, INVALID DATA for one that is too long.
    """
    if len(text) > MAX_EXPRESSION:
        raise CommandError(INVALID_DATA)
    reader = _Reader(text)
    condition = reader.joined()
    if not reader.at_end:
        raise CommandError(INCORRECT_DATA)
    return condition


def evaluate(condition: Condition, read: Callable[[Operand], Value]) -> bool:
    """Whether the condition holds; ``read`` gives the present value of an operand."""
    if isinstance(condition, Not):
        return not evaluate(condition.term, read)
    if isinstance(condition, Joined):
        left = evaluate(condition.left, read)
        right = evaluate(condition.right, read)
        return (left and right) if condition.word == "AND" else (left or right)
    return _holds(condition, read)


def relations(condition: Condition) -> Iterator[Relation]:
    """Every relation in a condition: what has to be watched for it to change."""
    if isinstance(condition, Relation):
        yield condition
    elif isinstance(condition, Not):
        yield from relations(condition.term)
    else:
        yield from relations(condition.left)
        yield from relations(condition.right)


def _holds(relation: Relation, read: Callable[[Operand], Value]) -> bool:
    left = read(relation.left)
    right = read(relation.right) if isinstance(relation.right, Operand) else relation.right
    if isinstance(left, str):
        pattern = right if isinstance(right, str) else format(right, "f")
        same = all(wanted in ("X", bit) for wanted, bit in zip(pattern, left, strict=False))
        return same if relation.sign == "=" else not same
    number = Decimal(right) if isinstance(right, str) and right.isdigit() else right
    if isinstance(number, str):
        raise CommandError(INVALID_DATA)
    return _COMPARE[relation.sign](left, number)


def hex_bits(digits: str) -> str:
    """``7FAD`` as bits, bit 1 first: each digit has its own four bits reversed (Gem6K PG p.32)."""
    return "".join(format(int(digit, 16), "04b")[::-1] for digit in digits).ljust(32, "0")


class _Reader:
    """Recursive descent over the text of one condition."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    @property
    def at_end(self) -> bool:
        return self._at == len(self._text)

    def joined(self) -> Condition:
        condition = self._term()
        while (word := self._joining_word()) is not None:
            condition = Joined(condition, word, self._term())
        return condition

    def _joining_word(self) -> str | None:
        match = _JOINING_WORD.match(self._text, self._at)
        if match is None:
            return None
        self._at = match.end()
        return match[0]

    def _term(self) -> Condition:
        if self._text.startswith("NOT", self._at):
            self._at += len("NOT")
            return Not(self._term())
        if self._text.startswith("(", self._at):
            self._at += 1
            condition = self.joined()
            self._expect(_CLOSE)
            return condition
        left = self._operand()
        sign = self._expect(_SIGN)[0]
        return Relation(left, sign, self._right_side())

    def _operand(self) -> Operand:
        match = self._expect(_OPERAND)
        axis, name, index, bit = match.groups()
        return Operand(name, int(axis) if axis else None, int(index) if index else None, int(bit) if bit else None)

    def _right_side(self) -> Decimal | str | Operand:
        for pattern, convert in _RIGHT_SIDES:
            match = pattern.match(self._text, self._at)
            if match is not None:
                self._at = match.end()
                return convert(match[0])
        return self._operand()

    def _expect(self, pattern: re.Pattern[str]) -> re.Match[str]:
        match = pattern.match(self._text, self._at)
        if match is None:
            raise CommandError(INCORRECT_DATA)
        self._at = match.end()
        return match


_END = r"(?=\)|AND|OR|$)"
_RIGHT_SIDES: tuple[tuple[re.Pattern[str], Callable[[str], Decimal | str]], ...] = (
    (re.compile(rf"B[01X]+{_END}"), lambda text: text[1:]),
    (re.compile(rf"H[0-9A-F]+?{_END}"), lambda text: hex_bits(text[1:])),
    (re.compile(rf"(?:[01X]*X[01X]*|[01]{{2,}}){_END}"), lambda text: text),
    (re.compile(rf"[+-]?(?:\d+\.?\d*|\.\d+){_END}"), Decimal),
)
