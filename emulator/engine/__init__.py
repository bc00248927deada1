"""The servo engine: profiles, control law, drives and loads, and the fused cycle that runs them in virtual time.

It knows nothing of commands or ports. `Engine` is its face; `plan_preset`, `plan_continuous` and `plan_stop` make the
profiles it runs.
"""

from .control_law import Gains, UnitFactors
from .encoder import AnalogSensor, EncoderTraits, EncoderWiring
from .engine import DriveShutDown, Engine
from .events import ENABLE_MASK, Event, Relation, Signal, Wire, wire_mask
from .machinery import AxisHardware
from .plants import ElasticCoupling, HydraulicCylinder, Plant, PlantError, TorqueDrive, VelocityDrive
from .profile import (
    InvalidSCurve,
    Segment,
    Segments,
    State,
    TargetOvershot,
    evaluate,
    plan_continuous,
    plan_preset,
    plan_stop,
    profile_duration,
)
from .rates import RATES, RateTable, ServoRates, rates_for
from .travel import Travel
from .trigger_capture import MarkSensor
from .trigger_inputs import CapturedPositions

__all__ = [
    "ENABLE_MASK",
    "RATES",
    "AnalogSensor",
    "AxisHardware",
    "CapturedPositions",
    "DriveShutDown",
    "ElasticCoupling",
    "EncoderTraits",
    "EncoderWiring",
    "Engine",
    "Event",
    "Gains",
    "HydraulicCylinder",
    "InvalidSCurve",
    "MarkSensor",
    "Plant",
    "PlantError",
    "RateTable",
    "Relation",
    "Segment",
    "Segments",
    "ServoRates",
    "Signal",
    "State",
    "TargetOvershot",
    "TorqueDrive",
    "Travel",
    "UnitFactors",
    "VelocityDrive",
    "Wire",
    "evaluate",
    "plan_continuous",
    "plan_preset",
    "plan_stop",
    "profile_duration",
    "rates_for",
    "wire_mask",
]
