"""The registers of an axis by tag: element, type, unit, default, range, and the page that says so."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from protocol.rmc.bits import AUTOSTOP_DEFAULT
from protocol.rmc.words import Number, RegisterType

GAIN_SET_STEP: Final = 67
"""Elements from a gain of the first set to that of the second (inferred; fits all pairs the manual prints)."""


@dataclass(frozen=True, slots=True)
class StatusRegister:
    """A read-only register of a status file."""

    tag: str
    element: int
    kind: RegisterType
    unit: str
    source: str


@dataclass(frozen=True, slots=True)
class Parameter:
    """A register of a parameter file. `frozen_while_enabled`: written only while disabled or in Direct Output."""

    tag: str
    element: int
    unit: str
    default: Number
    low: float
    high: float
    source: str
    kind: RegisterType = "REAL"
    frozen_while_enabled: bool = False

    def allows(self, value: Number) -> bool:
        """Whether a value may be written."""
        return math.isfinite(value) and self.low <= value <= self.high


_INF: Final = math.inf
_ASSUMED: Final = "assumed L"


def _status(tag: str, element: int, unit: str, source: str, kind: RegisterType = "REAL") -> StatusRegister:
    return StatusRegister(tag, element, kind, unit, source)


STATUS_REGISTERS: Final = (
    _status("StatusBits", 0, "", "H RegMap", "DWORD"),
    _status("ErrorBits", 1, "", "H RegMap", "DWORD"),
    _status("LastErrorNumber", 2, "", "H RegMap"),
    _status("ReadResponse", 4, "", "H RegMap"),
    _status("CurrentControlMode", 6, "", "H RegMap"),
    _status("NextControlMode", 7, "", "H RegMap"),
    _status("ActPos", 8, "pu", "H RegMap"),
    _status("ActVel", 9, "pu/s", "H RegMap"),
    _status("ActAcc", 10, "pu/s2", "H RegMap"),
    _status("Counts", 11, "counts", "H RegMap"),
    _status("RawCounts", 12, "counts", "H RegMap", "DINT"),
    _status("ControlOutput", 33, "V", "M889"),
    _status("PosError", 35, "pu", "M890"),
    _status("VelError", 36, "pu/s", "M890"),
    _status("TermP", 37, "%", _ASSUMED),
    _status("TermI", 38, "%", _ASSUMED),
    _status("TermD", 39, "%", _ASSUMED),
    _status("TermVFF", 40, "%", _ASSUMED),
    _status("TermAFF", 41, "%", _ASSUMED),
    _status("TermJFF", 42, "%", _ASSUMED),
    _status("TermDoubleDiff", 43, "%", _ASSUMED),
    _status("TermTripleDiff", 44, "%", _ASSUMED),
    _status("PFIDOutput", 45, "%", "H PFID_Output"),
    _status("TarPos", 53, "pu", "M899"),
    _status("TarVel", 54, "pu/s", _ASSUMED),
    _status("TarAcc", 55, "pu/s2", _ASSUMED),
    _status("CmdPos", 56, "pu", "M898"),
    _status("CmdVel", 57, "pu/s", "M899"),
)

GAINS: Final = (
    Parameter("ProportionalGain", 61, "%/pu, %/(pu/s)", 1.0, 0.0, _INF, "M974"),
    Parameter("IntegralGain", 62, "%/(pu s), %/((pu/s) s)", 0.0, 0.0, _INF, "M975"),
    Parameter("DifferentialGain", 63, "%/(pu/s), %/(pu/s2)", 0.0, 0.0, _INF, "M977"),
    Parameter("VelocityFF", 65, "%/(pu/s)", 0.0, 0.0, _INF, "M979"),
    Parameter("AccelerationFF", 66, "%/(pu/s2)", 0.0, 0.0, _INF, "M983"),
    Parameter("JerkFF", 67, "%/(pu/s3)", 0.0, 0.0, _INF, "M983"),
    Parameter("VelocityFFNegative", 68, "%/(pu/s)", 0.0, 0.0, _INF, "M981"),
    Parameter("DoubleDifferentialGain", 69, "%/(pu/s2), %/(pu/s3)", 0.0, 0.0, _INF, "M986"),
    Parameter("TripleDifferentialGain", 70, "%/(pu/s3)", 0.0, 0.0, _INF, "M987"),
)

PARAMETERS: Final = (
    Parameter("PosScale", 0, "pu/count", 1.0, -_INF, _INF, "M908", frozen_while_enabled=True),
    Parameter("PosOffset", 1, "pu", 0.0, -_INF, _INF, "M909", frozen_while_enabled=True),
    Parameter("PositionFilter", 2, "Hz", 0.0, 0.0, _INF, "M924"),
    Parameter("VelocityFilter", 3, "Hz", 100.0, 0.0, _INF, "M926"),
    Parameter("AccelerationFilter", 4, "Hz", 25.0, 0.0, _INF, "M928"),
    Parameter("StopThreshold", 5, "pu/s", 0.1, 0.0, _INF, "M919", frozen_while_enabled=True),
    Parameter("PriInputBits", 9, "", 0, 0, 2**32 - 1, "M919", "DWORD", frozen_while_enabled=True),
    Parameter("OutputBits", 32, "", 0, 0, 1, "M1003, element assumed L", "DWORD", frozen_while_enabled=True),
    Parameter("OutputBias", 33, "V", 0.0, -10.0, 10.0, "M1003"),
    Parameter("OutputScale", 38, "V/100 %", 10.0, -_INF, _INF, "M1008"),
    Parameter("DeadbandTolerance", 41, "pu", 0.0, 0.0, _INF, "H Deadband_Tolerance"),
    Parameter("OutputDeadband", 42, "V", 0.0, 0.0, 10.0, "M1004"),
    Parameter("InPositionTolerance", 56, "pu", 0.05, 0.0, _INF, "H In_Position_Tolerance"),
    Parameter("PositionErrorTolerance", 57, "pu", 0.25, 0.0, _INF, "M972"),
    Parameter("AtVelocityTolerance", 58, "pu/s", 0.1, 0.0, _INF, "M972"),
    Parameter("VelocityErrorTolerance", 59, "pu/s", 1.0, 0.0, _INF, "M973"),
    Parameter("PriControlBits", 60, "", 1, 0, 2**32 - 1, "M973, M990", "DWORD"),
    *GAINS,
    Parameter("PositiveTravelLimit", 92, "pu", 0.0, -_INF, _INF, "inferred"),
    Parameter("NegativeTravelLimit", 93, "pu", 0.0, -_INF, _INF, "H Negative_Travel_Limit"),
    Parameter("RequestedJerk", 94, "pu/s3", 100_000.0, 0.0, _INF, "H requested_jerk"),
    Parameter("AutoStopCfg1", 106, "", AUTOSTOP_DEFAULT, 0, 2**32 - 1, "M1018", "DWORD"),
    Parameter("AutoStopCfg2", 107, "", AUTOSTOP_DEFAULT, 0, 2**32 - 1, "M1018", "DWORD"),
    Parameter("AutoStopCfg3", 108, "", AUTOSTOP_DEFAULT, 0, 2**32 - 1, "M1018", "DWORD"),
    Parameter("SystemGain", 117, "(pu/s)/V", 1.0, 1e-30, _INF, "M965"),
    Parameter("NaturalFrequency", 118, "Hz, or s", 20.0, 1e-30, _INF, "M965"),
    Parameter("DampingFactor", 119, "", 0.5, 1e-30, 100.0, "M932, element assumed L"),
    Parameter("MaxCompression", 127, "", 0.0, -_INF, _INF, "M965"),
)

STATUS_BY_TAG: Final = {register.tag: register for register in STATUS_REGISTERS}
STATUS_BY_ELEMENT: Final = {register.element: register for register in STATUS_REGISTERS}
PARAMETER_BY_TAG: Final = {parameter.tag: parameter for parameter in PARAMETERS}
PARAMETER_BY_ELEMENT: Final = {parameter.element: parameter for parameter in PARAMETERS}

SIMULATOR_ELEMENTS: Final = range(117, 128)
"""Parameters of the simulator: writing one suspends the model until the last is written (M965)."""
LAST_SIMULATOR_ELEMENT: Final = 127
