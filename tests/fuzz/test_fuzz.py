"""Random valid programs: nothing raises, nothing hangs, the same session gives the same bytes at the same times."""

from __future__ import annotations

from random import Random

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emulator import Machine
from protocol.command import parse_command
from protocol.errors import CommandError
from tests.fuzz.grammar import session
from tests.fuzz.motion_grammar import motion_session
from tests.fuzz.session import DIRECTION, MACHINE, TURNING, play

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


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.integers(0, 2**32), st.sampled_from([MACHINE, TURNING]))
def test_random_motion(seed: int, machine: Machine) -> None:
    play(motion_session(Random(seed), 2 * COMMANDS), machine, of_motion=True)


def test_the_sessions_of_motion_start_every_kind_of_it() -> None:
    lines = motion_session(Random(1), 5000)
    assert not [line for line in lines if not line.startswith(DIRECTION) and not _is_well_formed(line)]
    begun = ("GO", "GOL", "PRUN", "HOM", "JOG", "FSHFC", "FSHFD", "FGADV", "GOWHEN", "TRGFN")
    assert all(sum(command in line for line in lines) >= 5 for command in begun)


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
