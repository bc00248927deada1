"""Gain sets: kept, recalled at rest and in motion without a step of the integral, and not proof against mistakes."""

from __future__ import annotations

import numpy as np
import pytest

from emulator.controller.motion.gain_sets import SavedGains
from emulator.engine.trace import Source
from tests.controller.session import Session, both_on

SERVO_S = 280e-6
SOFT, STIFF = ("SGP2", "SGI20", "SGV5"), ("SGP6", "SGI80", "SGV1")


def gains(session: Session, command: str) -> list[str]:
    """The lines of TGAIN or TSGSET."""
    session.read()
    return session.ask(command).removesuffix("\r\r\n> ").replace("\r\n", " ").split()


def test_the_manuals_example() -> None:
    """hardware-and-servo 9: two sets, axis 1 takes one and axis 2 the other."""
    session = both_on("SGP5,5", "SGI.1,.1", "SGV50,60", "SGVF5,6", "SGAF0,0", "SGSET3")
    session.ok("SGP75,75", "SGI5,5", "SGV1,.45", "SGVF0,8", "SGAF0,0", "SGSET1", "SGENB1,3")
    shown = ["*SGP75,5", "*SGI5,0.1", "*SGV1,60", "*SGVF0,6", "*SGAF0,0", "*SGILIM200,200"]
    assert gains(session, "TGAIN") == shown


def test_a_set_holds_offset_and_error_limit_too() -> None:
    session = both_on("SGILIM4,5", "SOFFS.1,.2", "SMPER77,88", "SGSET2", "SGILIM9,9", "SOFFS0,0", "SMPER0,0")
    session.ok("SGENB,2")
    assert session.query("SOFFS") == "SOFFS0.000,0.200"
    assert session.query("SMPER") == "SMPER0,88"
    assert session.query("SGILIM") == "SGILIM9,5"
    session.advance(0.01)
    assert session.unit.controller.engine.terms(1)["offset"] == 0.2


@pytest.mark.parametrize("number", range(1, 6))
def test_five_sets(number: int) -> None:
    session = both_on(f"SGP{number},{number}", f"SGSET{number}", "SGP.5,.5", f"SGENB{number},{number}")
    assert session.query("SGP") == f"SGP{number},{number}"


def test_what_is_refused() -> None:
    session = both_on("SGSET1")
    assert session.error("SGENB2") == "INVALID CONDITIONS FOR COMMAND"
    assert session.error("SGENB1,2") == "INVALID CONDITIONS FOR COMMAND"
    assert session.error("SGENB0") == "INVALID DATA-FIELD 1"
    assert session.error("SGENB1,6") == "INVALID DATA-FIELD 2"
    assert session.error("SGSET0") == "INVALID DATA"
    assert session.error("TSGSET6") == "INVALID DATA"


def test_tgain_is_the_last_set_enabled_or_value_commanded() -> None:
    session = both_on("SGP3,3", "SGSET1", "SGP.5,.5", "SGENB1,1", "1SGP4")
    assert gains(session, "TGAIN")[0] == "*SGP4,3"
    assert gains(session, "TSGSET1")[0] == "*SGP3,3"


def test_they_are_kept_as_plain_data_and_outlive_the_power() -> None:
    session = both_on("SGP3,4", "SGSET2")
    session.unit.do("cut_power")
    session.unit.do("restore_power")
    session.read()
    saved = session.unit.controller.gain_sets
    assert list(saved) == [2]
    assert all(isinstance(axis, SavedGains) for axis in saved[2])
    assert [axis.source for axis in saved[2]] == [1, 1]
    assert [float(axis.values["SGP"].value) for axis in saved[2]] == [3, 4]
    assert session.query("SGP") == "SGP0.5,0.5"
    session.ok("SGENB2,2")
    assert session.query("SGP") == "SGP3,4"


@pytest.mark.parametrize("when", ["at rest", "accelerating", "cruising", "decelerating"])
def test_no_step_of_the_integral(when: str) -> None:
    """0.5 V of offset wound into the integrator: SGENB goes on with that voltage, whatever the new SGI is.

    From one sample to the next the state moves by no more than SGI e Ts.
    """
    session = Session()
    session.ok("DRIVE10", "COMEXC1", "SMPER0", "SOFFS0.5", *STIFF, "SGSET1", *SOFT, "SGSET2")
    session.advance(2)
    wait = {"at rest": None, "accelerating": 0.15, "cruising": 0.6, "decelerating": 1.15}[when]
    if wait is not None:
        session.ok("A5", "V1.5", "D6000", "GO1")
        session.advance(wait)
    engine = session.unit.controller.engine
    columns = [Source("term_i", 0), Source("commanded_counts", 0, "feedback_counts"), Source("integral_v", 0)]
    engine.scope.arm(columns, rows=400)
    session.advance(0.05)
    session.ok("SGENB1")
    session.advance(0.1)
    integral, error, gain = (np.asarray(column, float) for column in engine.scope.read().columns)
    assert abs(integral[0]) > 0.1
    assert {round(value, 6) for value in gain} == {0.02, 0.08}, "the change lies inside the recording"
    assert np.diff(integral) == pytest.approx((gain * error * SERVO_S)[1:], abs=1e-12)


def test_a_change_in_motion_takes_effect() -> None:
    """The trailing error at constant velocity becomes that of the new gain: v / (K SGP)."""
    session = Session()
    session.ok("DRIVE10", "COMEXC1", "SMPER0", "SGP4", "SGSET4", "SGP1", "MC1", "V1", "A100", "GO1")
    session.advance(1)
    staircase = 4000 * 3 * SERVO_S / 2
    assert session.number("axis1.position.error") == pytest.approx(100 + staircase, abs=4)
    session.ok("!SGENB4")
    session.advance(0.5)
    assert session.number("axis1.position.error") == pytest.approx(25 + staircase, abs=4)
    assert session.axis_bit(1)


def test_a_set_of_the_other_source_is_enabled_as_it_is() -> None:
    """The mistake the guide warns of: gains for encoder counts on an axis that ANI feeds back."""
    session = Session("[options]\nani = true\n")
    session.ok("SGP3", "SGSET1", "SFB2", "SGP20", "SGSET2")
    assert [axis.source for axis in session.unit.controller.gain_sets[1]] == [1, 1]
    assert [axis.source for axis in session.unit.controller.gain_sets[2]] == [2, 1]
    session.ok("SGENB1")
    assert session.query("1SGP") == "1SGP3"
    session.ok("SFB1", "SGENB2")
    assert session.query("1SGP") == "1SGP20"
    session.ok("SFB2")
    assert session.query("1SGP") == "1SGP3", "what was enabled there stayed there"


def test_tsgset_of_one_axis() -> None:
    session = Session()
    session.ok("SGP3,4", "SGSET1", "INDAX1")
    assert gains(session, "TSGSET1")[0] == "*SGP3"
    assert gains(session, "TGAIN")[0] == "*SGP3"
