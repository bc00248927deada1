"""PLOOP and PLN: loops of segments planned pass by pass, and run through without unrolling them.

What a segment becomes depends on how fast it is entered, and the first pass through a loop may be entered differently
from the others.  So a loop is planned until a pass ends as it began; that pass then stands for all the rest, be they a
thousand million.  The same for segments over time (entered at a velocity) and over master travel (at a ratio).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import count, repeat
from typing import Generic, NamedTuple, Protocol, TypeVar

Move = TypeVar("Move")
Move_contra = TypeVar("Move_contra", contravariant=True)
Piece = TypeVar("Piece")
Speed = TypeVar("Speed", float, Fraction)

MOST_UNLIKE_PASSES = 4
"""Passes that may differ from each other before a loop has to repeat itself (ours)."""


class Unsteady(ValueError):
    """A loop whose passes never come to be alike, or take no time at all."""


class Planner(Protocol[Move_contra, Piece, Speed]):
    """Turns a segment as written into pieces, given how fast it is entered."""

    def plan(self, move: Move_contra, entry: Speed) -> tuple[tuple[Piece, ...], Speed]:
        """The pieces of a segment and the speed at its end."""
        ...

    def travel(self, pieces: tuple[Piece, ...]) -> Fraction:
        """Counts that pieces move the axis."""
        ...

    def lasts(self, piece: Piece) -> bool:
        """Whether a piece takes any time or master travel."""
        ...


@dataclass(slots=True)
class Loop(Generic[Move]):
    """A loop as written: its passes (None = endless) and what lies between PLOOP and PLN."""

    passes: int | None
    body: list[Move | Loop[Move]] = field(default_factory=list)


class Planned(NamedTuple, Generic[Piece]):
    """Segments in a row: passes that differ, then one that repeats itself.

    A segment by itself has ``pieces`` and no passes.  ``repeats`` is how often the steady pass comes, None = endlessly.
    ``travel`` is what all of it moves the axis, counts; meaningless where it is endless.
    """

    leading: tuple[Sequence[Planned[Piece]], ...]
    steady: Sequence[Planned[Piece]]
    repeats: int | None
    pieces: tuple[Piece, ...]
    travel: Fraction

    @property
    def endless(self) -> bool:
        """Whether it never comes to an end."""
        return self.repeats is None


def plan_segment(planner: Planner[Move, Piece, Speed], move: Move, entry: Speed) -> tuple[Planned[Piece], Speed]:
    """One segment and the speed at its end."""
    pieces, speed = planner.plan(move, entry)
    return Planned((), (), 0, pieces, planner.travel(pieces)), speed


def plan_loop(planner: Planner[Move, Piece, Speed], loop: Loop[Move], entry: Speed) -> tuple[Planned[Piece], Speed]:
    """A whole loop and the speed after its last pass.  Raises Unsteady."""
    leading: list[Sequence[Planned[Piece]]] = []
    passes = count() if loop.passes is None else range(loop.passes)
    for done in passes:
        body, leaving = _plan_pass(planner, loop, entry)
        if body[-1].endless:
            return _looped(leading, body, None), leaving
        if leaving == entry:
            repeats = None if loop.passes is None else loop.passes - done
            return _looped(leading, body, repeats), leaving
        if done == MOST_UNLIKE_PASSES:
            raise Unsteady("the loop is never entered as it is left")
        leading.append(body)
        entry = leaving
    return _looped(leading, (), 0), entry


def _plan_pass(
    planner: Planner[Move, Piece, Speed], loop: Loop[Move], entry: Speed
) -> tuple[Sequence[Planned[Piece]], Speed]:
    planned: list[Planned[Piece]] = []
    for node in loop.body:
        following, entry = (
            plan_loop(planner, node, entry) if isinstance(node, Loop) else plan_segment(planner, node, entry)
        )
        planned.append(following)
        if following.endless:
            break
    if not any(planner.lasts(piece) for piece in _once(planned)):
        raise Unsteady("a pass of the loop takes no time")
    return planned, entry


def _looped(
    leading: list[Sequence[Planned[Piece]]], steady: Sequence[Planned[Piece]], repeats: int | None
) -> Planned[Piece]:
    before = sum((node.travel for body in leading for node in body), Fraction(0))
    each = sum((node.travel for node in steady), Fraction(0))
    return Planned(tuple(leading), steady, repeats, (), before + each * (repeats or 0))


def _once(nodes: Sequence[Planned[Piece]]) -> Iterator[Piece]:
    """The pieces of one way through, every steady pass once."""
    for node in nodes:
        yield from node.pieces
        for body in (*node.leading, node.steady):
            yield from _once(body)


def pieces_of(nodes: Sequence[Planned[Piece]]) -> Iterator[Piece]:
    """Every piece in turn, loops as often as they are passed through."""
    for node in nodes:
        yield from node.pieces
        for body in node.leading:
            yield from pieces_of(body)
        passes = repeat(None) if node.repeats is None else repeat(None, node.repeats)
        if node.steady:
            for _ in passes:
                yield from pieces_of(node.steady)
