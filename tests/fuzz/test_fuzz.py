"""Random valid programs: nothing raises, nothing hangs, the same session gives the same bytes at the same times."""

from __future__ import annotations

from random import Random

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from protocol.command import parse_command
from protocol.errors import CommandError
from tests.fuzz.grammar import session
from tests.fuzz.session import play

COMMANDS = 60


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.integers(0, 2**32))
def test_random_programs(seed: int) -> None:
    play(session(Random(seed), COMMANDS))


@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.integers(0, 2**32))
def test_the_same_session_twice(seed: int) -> None:
    lines = session(Random(seed), COMMANDS)
    assert play(lines) == play(lines)


def test_most_of_what_the_grammar_writes_is_well_formed() -> None:
    lines = session(Random(1), 3000)
    assert sum(map(_is_well_formed, lines)) > 0.95 * len(lines)
    assert sum(line.startswith("DEF ") for line in lines) > 30


def _is_well_formed(line: str) -> bool:
    try:
        parse_command(line)
    except CommandError:
        return False
    return True
