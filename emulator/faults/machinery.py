"""What faults change about an axis's encoder and load: the one place that reaches into the engine for them.

Everything an engine can do to its machinery while it runs is asked of it here and nowhere else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.engine import ElasticCoupling, EncoderWiring, PlantError, TorqueDrive
from emulator.faults.fault import FaultError

if TYPE_CHECKING:
    from emulator.controller import Controller
    from emulator.engine.plants import Plant


def wire_encoder(controller: Controller, axis_index: int, wiring: EncoderWiring) -> None:
    """Connect an encoder rightly, with its channels exchanged, or not at all; its position does not jump."""
    controller.engine.wire_encoder(axis_index, wiring)


def slip_encoder(controller: Controller, axis_index: int, counts: int) -> None:
    """Turn an encoder on its shaft by whole counts, forwards positive."""
    controller.engine.slip_encoder(axis_index, counts)


def encoder_travel(controller: Controller, axis_index: int) -> int:
    """What the encoder itself shows, whatever is counted of it, counts."""
    return controller.engine.encoder_travel(axis_index)


def plant_of(controller: Controller, axis_index: int) -> Plant:
    """The drive and load of an axis."""
    return controller.engine.plant(axis_index)


def set_plant(controller: Controller, axis_index: int, plant: Plant) -> None:
    """Change the drive and load while the axis runs."""
    controller.engine.set_plant(axis_index, plant)


def with_torque(controller: Controller, axis_index: int, *, friction_nm: float = 0.0, load_nm: float = 0.0) -> Plant:
    """The plant of an axis with more dry friction and more load, Nm.

    Raises:
        FaultError: a machine that neither slows down, such as a velocity-mode drive, whose own loop hides them.
    """
    plant = plant_of(controller, axis_index)
    try:
        if friction_nm:
            plant = plant.with_friction(max(0.0, _friction_nm(plant) + friction_nm))
        if load_nm:
            plant = plant.with_load(getattr(plant, "load_torque_nm", 0.0) + load_nm)
    except PlantError as error:
        raise FaultError(f"axis {axis_index + 1}: {error}") from None
    return plant


def _friction_nm(plant: Plant) -> float:
    """The dry friction of a plant; on an elastic coupling that of the load."""
    if isinstance(plant, TorqueDrive):
        return plant.coulomb_nm
    return plant.load_coulomb_nm if isinstance(plant, ElasticCoupling) else 0.0
