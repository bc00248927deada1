"""Conditions as in ``WAIT(1AS.1=b0 AND VAR1>3)``: read into a tree, evaluated with whatever reads the operands.

In a pattern X matches anything and the leading ``b`` may be missing (seen in a host: ``WAIT(6AS=XXXX1)``); a pattern
shorter than the word compares only its first bits."""

from __future__ import annotations

from protocol.bitwise import hex_bits
from protocol.expression import Condition, Joined, Not, Operand, Read, Relation, Value, relations
from protocol.expression_text import MAX_EXPRESSION, parse_condition

__all__ = [
    "MAX_EXPRESSION",
    "Condition",
    "Joined",
    "Not",
    "Operand",
    "Relation",
    "Value",
    "evaluate",
    "hex_bits",
    "parse_condition",
    "relations",
]


def evaluate(condition: Condition, read: Read) -> bool:
    """Whether the condition holds; ``read`` gives the present value of an operand.

    Raises:
        CommandError: whatever reading raises; INVALID DATA where arithmetic in the condition has no result.
    """
    return condition.test(read)
