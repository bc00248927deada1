"""Commands as a table and as something done to an axis, whatever is written."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.rmc.commands import CARRIED
from emulator.rmc.registers import BadAddress, Connection, Registers
from protocol.rmc.bits import ErrorBits
from protocol.rmc.commands import COMMANDS
from protocol.rmc.maps import COMMAND_REGISTERS
from protocol.rmc.registers import PARAMETERS, STATUS_REGISTERS
from protocol.rmc.words import bits_of, from_words, halves, joined, to_words, value_of
from tests.rmc.rig import command, device, run


def test_every_command_is_carried_out_or_said_to_be_left_out() -> None:
    built = {each.name for each in COMMANDS if each.built and each.number}
    assert set(CARRIED) == built
    assert len({each.number for each in COMMANDS}) == len(COMMANDS)
    assert all(len(each.fields) < COMMAND_REGISTERS for each in COMMANDS)
    assert all(each.source for each in COMMANDS)


def test_registers_are_named_once() -> None:
    for rows in (STATUS_REGISTERS, PARAMETERS):
        assert len({row.tag for row in rows}) == len({row.element for row in rows}) == len(rows)
        assert all(row.source for row in rows)


@given(st.integers(0, 2**32 - 1), st.sampled_from(["low_first", "high_first"]))
def test_words_come_back(bits: int, order: str) -> None:
    assert joined(*halves(bits, order), order) == bits  # type: ignore[arg-type]
    assert from_words(to_words([bits], order), order) == [bits]  # type: ignore[arg-type]


@given(st.floats(width=32, allow_nan=False))
def test_reals_come_back(value: float) -> None:
    assert value_of(bits_of(value)) == value or math.isinf(value)


@given(st.integers(-(2**31), 2**31 - 1))
def test_whole_numbers_come_back(value: int) -> None:
    assert value_of(bits_of(value, "DINT"), "DINT") == value


def test_an_odd_number_of_words_is_no_register() -> None:
    with pytest.raises(ValueError, match="3 Modbus registers"):
        from_words([1, 2, 3])


RIG = device()
VIEW = Registers(RIG)


@settings(deadline=None)
@given(st.integers(0, 65_535), st.integers(1, 125))
def test_every_read_is_answered_or_refused(address: int, count: int) -> None:
    try:
        words = VIEW.read(address, count, Connection())
    except BadAddress:
        return
    assert len(words) == count
    assert all(0 <= word <= 0xFFFF for word in words)


@settings(deadline=None, max_examples=300)
@given(
    st.sampled_from([each.number for each in COMMANDS]),
    st.lists(st.floats(width=32) | st.sampled_from([0.0, 1.0, 2.0, 10.0, 32_801.0, 229_376.0]), max_size=9),
    st.booleans(),
)
def test_nothing_written_to_an_axis_breaks_it(number: int, values: list[float], request: bool) -> None:
    """Whatever comes, positions and outputs stay finite numbers within their limits, and the axis can be had back."""
    words = to_words([bits_of(value) for value in [float(number + (256 if request else 0)), *values]])
    VIEW.write(20_480, words, Connection())
    run(RIG, 0.05)
    axis = RIG.axes[0]
    assert abs(axis["control_v"]) <= 10.0
    for field in ("actual_position", "target_position", "target_velocity", "pfid"):
        assert not math.isnan(axis[field])
    command(RIG, 3.0)
    run(RIG, 0.2)
    command(RIG, 4.0)
    assert axis["control_v"] == 0.0
    command(RIG, 97.0, 1.0)
    command(RIG, 49.0, 0.0)


@settings(deadline=None)
@given(st.integers(0, 255), st.integers(0, 2**32 - 1))
def test_no_parameter_breaks_it(element: int, bits: int) -> None:
    rig = device()
    view = Registers(rig)
    view.write(2 * (24 * 256 + element), to_words([bits]), Connection())
    command(rig, 20.0, 1.0, 1.0, 10.0, 10.0)
    run(rig, 0.1)
    assert not math.isnan(rig.axes[0]["control_v"])
    assert abs(rig.axes[0]["control_v"]) <= 10.0


def test_a_refused_command_leaves_the_motion_alone() -> None:
    rig = device(VelocityFF=3.33, AutoStopCfg2=0o1111111111)
    command(rig, 37.0, 1.0, 10.0, 10.0, 4.0)
    run(rig, 0.5)
    for refused in ((25.0, 229_376.0, 0.0, 1.0, 5e3, 6e3, 1.0), (30.0, 1.0, 0.0, 229_376.0, 1.0), (36.0, -5.0, 1.0)):
        command(rig, *refused)
        assert rig.axes[0].integer("errors") & ErrorBits.COMMAND
        run(rig, 0.1)
        assert rig.axes[0]["target_velocity"] == 1.0
        command(rig, 4.0)


def test_the_committed_table_is_what_the_code_says() -> None:
    from emulator.rmc.conformance import render

    committed = (Path(__file__).parents[2] / "docs" / "rmc-conformance.md").read_text(encoding="utf-8")
    assert committed == render(), "run: python -m emulator.rmc.conformance > docs/rmc-conformance.md"
