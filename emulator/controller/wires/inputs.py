"""Programmable inputs as the unit sees them: debounced, turned by their active level, overridden for tests.

A contact that changes is noticed at the next system update and recognised when it has kept its new state for the time
of INDEB, rounded up to whole system updates; both times pass without anyone looking.  Contacts of the joystick
connector are treated like general inputs.  INEN acts behind the filter and so at once (assumed).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import applies
from protocol.command import Command
from protocol.status import OtherInputs

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NS_PER_MS = 1_000_000
GENERAL, TRIGGER = 0, 1
"""The fields of INDEB."""


class Inputs:
    """The programmable inputs of one unit and the digital inputs of its joystick connector."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._sampled = self._recognised = controller.engine.inputs
        self._due_ns: dict[int, int] = {}
        self._bits = ""

    def power_up(self) -> None:
        """Contacts count as they stand; nothing is filtered yet."""
        self._sampled = self._recognised = self._controller.engine.inputs
        self._due_ns.clear()
        self._bits = ""

    # What others read.

    @property
    def bits(self) -> str:
        """IN: one digit an input, 1 = active; the triggers are the last two."""
        if not self._bits:
            self._bits = self._read(self._recognised)
        return self._bits

    @property
    def undebounced_bits(self) -> str:
        """As ``bits`` for a reader that waits for its data to settle itself (thumbwheels)."""
        return self._read(self._controller.engine.inputs)

    def active(self, number: int) -> bool:
        """Whether an input (from 1) is active; a number of 0 means none is connected."""
        return number > 0 and self.bits[number - 1] == "1"

    def joystick(self, contact: OtherInputs) -> bool:
        """Whether a digital input of the joystick connector is closed, which sinks its current."""
        return bool(self._recognised & self._controller.wiring.joystick_mask(contact))

    def function_active(self, letter: str, axis_index: int | None = None) -> bool:
        """Whether an input with this INFNC letter (for this axis) is active and INFEN1 lets it act."""
        return self._controller.input_functions.active(letter, axis_index)

    def _read(self, contacts: int) -> str:
        settings, wiring = self._controller.settings, self._controller.wiring
        count = wiring.input_count
        return wiring.input_bits(
            contacts, active_levels=settings.bits("INLVL")[:count], overrides=settings.bits("INEN")[:count]
        )

    # What changes them.

    def sample(self) -> None:
        """A contact differs from the last system update: start the filter of those that changed."""
        controller = self._controller
        if not controller.powered:
            return
        present = controller.engine.inputs
        changed, self._sampled = present ^ self._sampled, present
        for bit in _bits_of(changed):
            if (present ^ self._recognised) >> bit & 1:
                due_ns = self._due_ns[bit] = controller.now_ns + self._filter_ns(bit)
                controller.alarms.at(due_ns, self._recognise)
            else:
                self._due_ns.pop(bit, None)

    def _filter_ns(self, bit: int) -> int:
        controller = self._controller
        wiring = controller.wiring
        field = TRIGGER if wiring.inputs <= bit < wiring.input_count else GENERAL
        period_ns = controller.engine.rates.system_ns
        return -(-controller.settings.integer("INDEB", field) * NS_PER_MS // period_ns) * period_ns

    def _recognise(self) -> None:
        now_ns = self._controller.now_ns
        for bit in [bit for bit, due_ns in self._due_ns.items() if due_ns <= now_ns]:
            del self._due_ns[bit]
            self._recognised ^= 1 << bit
        self.refresh()

    def refresh(self) -> None:
        """Levels, overrides or recognised contacts changed: input functions act."""
        self._bits = ""
        self._controller.input_functions.refresh()
        self._controller.joystick.refresh()
        self._controller.held_starts.look()


def _bits_of(mask: int) -> list[int]:
    return [bit for bit in range(mask.bit_length()) if mask >> bit & 1]


@applies("INEN", "INLVL")
def apply_input_levels(controller: Controller, command: Command, changed: list[int]) -> None:
    """INEN or INLVL changed."""
    controller.inputs.refresh()
