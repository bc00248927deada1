"""The servo engine: profiles, control law, drives and loads, and the fused cycle that runs them in virtual time.

It knows nothing of commands or ports. `Engine` is its face; `plan_preset`, `plan_continuous` and `plan_stop` make the
profiles it runs.
"""

from .control_law import Gains, UnitFactors
from .encoder import AnalogSensor, EncoderTraits, EncoderWiring
from .encoder_motion import EncoderMotion
from .engine import Engine
from .events import ENABLE_MASK, Event, Relation, Signal, Wire, wire_mask
from .following_axes import MasterMeasurement, MasterSource, NoMaster
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
from .ratio_profile import (
    DistanceMismatch,
    RatioSegment,
    RatioSegments,
    master_travel,
    plan_ratio_change,
    plan_ratio_preset,
    ratio_at,
    slave_at,
)
from .readings import DriveShutDown
from .travel import Travel
from .trigger_capture import MarkSensor
from .trigger_inputs import CapturedPositions

__all__ = [
    "ENABLE_MASK",
    "RATES",
    "AnalogSensor",
    "AxisHardware",
    "CapturedPositions",
    "DistanceMismatch",
    "DriveShutDown",
    "ElasticCoupling",
    "EncoderMotion",
    "EncoderTraits",
    "EncoderWiring",
    "Engine",
    "Event",
    "Gains",
    "HydraulicCylinder",
    "InvalidSCurve",
    "MarkSensor",
    "MasterMeasurement",
    "MasterSource",
    "NoMaster",
    "Plant",
    "PlantError",
    "RateTable",
    "RatioSegment",
    "RatioSegments",
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
    "master_travel",
    "plan_continuous",
    "plan_preset",
    "plan_ratio_change",
    "plan_ratio_preset",
    "plan_stop",
    "profile_duration",
    "rates_for",
    "ratio_at",
    "slave_at",
    "wire_mask",
]
