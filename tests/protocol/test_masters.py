"""FOLMAS values against the source table of the 6000 Series Programmer's Guide p.195."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.errors import CommandError
from protocol.masters import Master, MasterKind, check_masters, read_master

ENCODER, ANI, COMMANDED = MasterKind.ENCODER, MasterKind.ANI, MasterKind.COMMANDED


def read(value: int, *, ani_fitted: bool = False) -> Master | None:
    return read_master(value, axes=2, ani_fitted=ani_fitted)


@pytest.mark.parametrize(
    ("value", "master"),
    [
        (0, None),
        (21, Master(1, ENCODER, 1)),
        (-21, Master(1, ENCODER, -1)),
        (24, Master(1, COMMANDED, 1)),
        (11, Master(0, ENCODER, 1)),
        (-14, Master(0, COMMANDED, -1)),
    ],
)
def test_axis_source_and_sign_are_read(value: int, master: Master | None) -> None:
    assert read(value) == master


@pytest.mark.parametrize("value", [1, 4, 10, 13, 15, 16, 20, 23, 25, 26, 31, -31, 41, 44, 91, 99, 121, 210])
def test_axes_and_sources_the_unit_does_not_have_are_refused(value: int) -> None:
    with pytest.raises(CommandError, match="INVALID FOLMAS SPECIFIED"):
        read(value, ani_fitted=True)


def test_the_ani_input_is_a_master_only_when_it_is_fitted() -> None:
    assert read(22, ani_fitted=True) == Master(1, ANI, 1)
    with pytest.raises(CommandError, match="INVALID FOLMAS SPECIFIED"):
        read(22)


def check(first: int, second: int, feedback: tuple[int, int] = (1, 1)) -> None:
    check_masters([read(first, ani_fitted=True), read(second, ani_fitted=True)], feedback)


@pytest.mark.parametrize(("first", "second"), [(21, 0), (24, 0), (0, 11), (0, 14), (-21, -11), (24, 14), (21, 14)])
def test_the_other_axis_may_be_followed(first: int, second: int) -> None:
    check(first, second)


@pytest.mark.parametrize(
    ("first", "second", "feedback"),
    [
        (14, 0, (1, 1)),
        (0, -24, (1, 1)),
        (11, 0, (1, 1)),
        (0, 21, (1, 1)),
        (12, 0, (2, 1)),
        (14, 0, (2, 2)),
    ],
)
def test_no_axis_follows_itself(first: int, second: int, feedback: tuple[int, int]) -> None:
    with pytest.raises(CommandError, match="INVALID FOLMAS SPECIFIED"):
        check(first, second, feedback)


def test_an_axis_may_follow_its_own_sensor_that_is_not_its_feedback() -> None:
    check(11, 0, (2, 1))
    check(12, 0, (1, 1))


def test_two_slaves_of_one_master_axis_must_count_the_same_source() -> None:
    check(11, 11, (2, 1))
    with pytest.raises(CommandError, match="INVALID FOLMAS SPECIFIED"):
        check(11, 14, (2, 1))


@given(st.integers(-99, 99), st.integers(-99, 99))
def test_what_is_accepted_never_follows_itself(first: int, second: int) -> None:
    try:
        check(first, second)
    except CommandError:
        return
    assert abs(first) not in (11, 14)
    assert abs(second) not in (21, 24)
