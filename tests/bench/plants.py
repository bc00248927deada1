"""What each plant costs: two axes in closed loop on it, holding, without a controller above them."""

from __future__ import annotations

from collections.abc import Mapping

from emulator.engine import (
    AxisHardware,
    ElasticCoupling,
    EncoderTraits,
    Engine,
    HydraulicCylinder,
    Plant,
    TorqueDrive,
    VelocityDrive,
    rates_for,
)
from tests.bench import processor
from tests.bench.figures import Effort, Figure, Reference
from tests.bench.kernel import AXES, NS_PER_S, SETTLE_NS, cpu_ns_of, run

PLANTS: Mapping[str, tuple[Plant, EncoderTraits]] = {
    "velocity drive": (VelocityDrive(), EncoderTraits(max_rate_counts_s=1.6e6)),
    "torque drive": (TorqueDrive(), EncoderTraits(max_rate_counts_s=1.6e6)),
    "elastic, torque": (ElasticCoupling(), EncoderTraits()),
    "elastic, velocity": (ElasticCoupling(drive="velocity"), EncoderTraits()),
    "elastic, dry friction": (ElasticCoupling(load_coulomb_nm=0.05), EncoderTraits()),
    "hydraulic cylinder": (HydraulicCylinder(overlap_v=0.1), EncoderTraits()),
    "backlash": (VelocityDrive(backlash_rev=0.001), EncoderTraits(on_load=True)),
    "encoder noise": (VelocityDrive(), EncoderTraits(noise_counts_rms=0.5)),
}


def measure(effort: Effort) -> list[Figure]:
    """Processor nanoseconds per axis and sample, of each plant."""
    return [_measure_plant(name, *parts, effort) for name, parts in PLANTS.items()]


def _measure_plant(name: str, plant: Plant, encoder: EncoderTraits, effort: Effort) -> Figure:
    engine = Engine([AxisHardware(plant, encoder=encoder)] * AXES, rates=rates_for(2, 4))
    for axis_index in range(AXES):
        engine.set_position_error_limit(axis_index, 0)
        engine.set_output(axis_index, offset_v=0.01)
        engine.enable(axis_index)
    run(engine, SETTLE_NS)
    span_ns = int(effort.of(10, 40) * NS_PER_S)
    pairs = [(cpu_ns_of(engine, span_ns), processor.multiply_add_ns()) for _ in range(effort.times(5, 15))]
    cpu_ns, multiply_add_ns = zip(*pairs, strict=True)
    samples = AXES * span_ns / engine.rates.servo_ns
    return Figure(
        name=f"plant, {name}",
        unit="ns/axis-sample",
        samples=[ns / samples for ns in cpu_ns],
        reference=Reference(name=processor.NAME, samples=multiply_add_ns),
    )
