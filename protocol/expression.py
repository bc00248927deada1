"""Expressions as trees, and trees as functions.

An expression is worked strictly from left to right.  Its parts are of three kinds: numbers (``Decimal``), bit patterns
(``str`` of 0, 1, X) and truths; which kind a part is shows in its text, so everything that does not fit together is
refused when it is read.  A tree is turned into one function of ``read`` (whatever gives the present value of an
operand) once, and that function is what a loop of a program pays for.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import cached_property

from protocol import arithmetic, bitwise
from protocol.errors import INVALID_DATA, CommandError


@dataclass(frozen=True, slots=True)
class Operand:
    """``2PE``, ``AS.1``, ``VAR3``: axis digit or None, name, index of a variable, bit of a word.

    ``indirect``: the index is the number of the VAR that holds it, as in ``VAR(VAR3)``.
    """

    name: str
    axis: int | None = None
    index: int | None = None
    bit: int | None = None
    indirect: bool = False


Value = Decimal | str
"""What an operand reads as: a number, or a bit text with bit 1 first."""

Read = Callable[[Operand], Value]
Evaluator = Callable[[Read], Value]
Test = Callable[[Read], bool]

RADIAN_MODE = Operand("RADIAN")
"""What a trigonometric function asks its reader for: 1 while angles are radians."""


@dataclass(frozen=True, slots=True)
class Complement:
    """``~`` of a term."""

    term: Expression


@dataclass(frozen=True, slots=True)
class Function:
    """``SIN(...)`` and its like, VCVT too."""

    name: str
    argument: Expression


@dataclass(frozen=True, slots=True)
class Operation:
    """Two terms joined by an arithmetic sign, a boolean sign or a shift."""

    left: Expression
    sign: str
    right: Expression


Expression = Decimal | str | Operand | Complement | Function | Operation


@dataclass(frozen=True)
class Relation:
    """Two expressions compared; bit patterns know only ``=`` and ``<>``."""

    left: Expression
    sign: str
    right: Expression

    @cached_property
    def test(self) -> Test:
        """The relation as a function."""
        return _relation_test(self)


@dataclass(frozen=True)
class Not:
    """The complement of a condition."""

    term: Condition

    @cached_property
    def test(self) -> Test:
        """The condition as a function."""
        test = self.term.test
        return lambda read: not test(read)


@dataclass(frozen=True)
class Joined:
    """Two conditions joined by AND or OR; both sides are always worked."""

    left: Condition
    word: str
    right: Condition

    @cached_property
    def test(self) -> Test:
        """The condition as a function."""
        left, right = self.left.test, self.right.test
        if self.word == "AND":
            return lambda read: left(read) & right(read)
        return lambda read: left(read) | right(read)


Condition = Relation | Not | Joined

BIT_OPERANDS = frozenset(
    {"AS", "ASX", "SS", "ER", "US", "FS", "IN", "INO", "OUT", "LIM", "MOV", "SC", "VARB"},
)
"""Operands that read as bit patterns; all others are numbers."""

_COMPARE: Mapping[str, Callable[..., bool]] = {
    "=": operator.eq,
    "<>": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}


def is_bits(expression: Expression) -> bool:
    """Whether an expression yields a bit pattern rather than a number."""
    match expression:
        case str():
            return True
        case Decimal():
            return False
        case Operand(name=name):
            return name in BIT_OPERANDS
        case Complement(term=term):
            return is_bits(term)
        case Function(name=name, argument=argument):
            return name == "VCVT" and not is_bits(argument)
        case Operation(left=left):
            return is_bits(left)


def operands_in(expression: Expression) -> Iterator[Operand]:
    """Every operand of an expression: what its value depends on."""
    match expression:
        case Operand():
            yield expression
        case Complement(term=term) | Function(argument=term):
            yield from operands_in(term)
        case Operation(left=left, right=right):
            yield from operands_in(left)
            yield from operands_in(right)


def relations(condition: Condition) -> Iterator[Relation]:
    """Every relation in a condition: what has to be watched for it to change."""
    if isinstance(condition, Relation):
        yield condition
    elif isinstance(condition, Not):
        yield from relations(condition.term)
    else:
        yield from relations(condition.left)
        yield from relations(condition.right)


def evaluator(expression: Expression) -> Evaluator:
    """An expression as a function.  What it returns raises CommandError (INVALID DATA) for a division by zero, a root
    of a negative number, a result that does not fit into a variable."""
    match expression:
        case Operand():
            return _operand_evaluator(expression)
        case Complement(term=term):
            return _unary(bitwise.complement if is_bits(term) else arithmetic.complement, term)
        case Function():
            return _function_evaluator(expression)
        case Operation():
            return _operation_evaluator(expression)
        case _:
            return lambda read: expression


def _operand_evaluator(operand: Operand) -> Evaluator:
    if not operand.indirect:
        return lambda read: read(operand)
    holder = Operand("VAR", index=operand.index)

    def look_up(read: Read) -> Value:
        number = read(holder)
        if not isinstance(number, Decimal) or number != int(number):
            raise CommandError(INVALID_DATA)
        return read(replace(operand, index=int(number), indirect=False))

    return look_up


def _unary(work: Callable[..., Value], term: Expression) -> Evaluator:
    value = evaluator(term)
    return lambda read: work(value(read))


def _function_evaluator(function: Function) -> Evaluator:
    name, argument = function.name, function.argument
    if name == "VCVT":
        return _unary(_checked_number if is_bits(argument) else bitwise.bits_of, argument)
    if name == "SQRT":
        return _unary(arithmetic.square_root, argument)
    work, value = arithmetic.TRIGONOMETRY[name], evaluator(argument)
    return lambda read: work(value(read), radians=read(RADIAN_MODE) == 1)


def _checked_number(bits: str) -> Decimal:
    return arithmetic.rounded(bitwise.number_of(bits))


def _operation_evaluator(operation: Operation) -> Evaluator:
    work = _work_of(operation)
    left, right = evaluator(operation.left), evaluator(operation.right)
    constant = operation.right
    if isinstance(constant, Decimal):
        return lambda read: work(left(read), constant)
    return lambda read: work(left(read), right(read))


def _work_of(operation: Operation) -> Callable[..., Value]:
    sign = operation.sign
    if sign in bitwise.SHIFTS:
        return bitwise.SHIFTS[sign]
    if is_bits(operation.left):
        return bitwise.OPERATORS[sign]
    return arithmetic.OPERATORS[sign]


def _relation_test(relation: Relation) -> Test:
    left, right = evaluator(relation.left), evaluator(relation.right)
    if is_bits(relation.left):
        wanted = relation.sign == "="
        return lambda read: bitwise.matches(str(left(read)), str(right(read))) is wanted
    compare = _COMPARE[relation.sign]
    constant = relation.right
    if isinstance(constant, Decimal):
        if isinstance(relation.left, Operand) and not relation.left.indirect:
            operand = relation.left
            return lambda read: compare(read(operand), constant)
        return lambda read: compare(left(read), constant)
    return lambda read: compare(left(read), right(read))
