"""A thumbwheel module on the unit's terminals: select lines choose a digit, data lines carry it in BCD.

It is wired as the sets of INSTW and OUTTW say at that moment, so tests and panels need no wiring list of their own.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from emulator.controller.wires.thumbwheels import BITS_PER_DIGIT, MOST_DIGITS, SETS

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


class ThumbwheelBank:
    """Eight BCD digits with a sign, most significant digit selected first."""

    def __init__(self, controller: Controller, set_number: int, value: int = 0) -> None:
        self._controller = controller
        self.set_number = set_number
        self.value = value

    def __call__(self, outputs: str) -> Mapping[int, bool]:
        """The contacts the module closes for these outputs."""
        inputs, select = self._controller.thumbwheels.wires(self.set_number)
        at_once = len(inputs.lines) // BITS_PER_DIGIT
        chosen = sum(1 << place for place, line in enumerate(select.lines) if outputs[line - 1] == "1")
        digits = f"{abs(self.value):0{MOST_DIGITS}d}"[chosen * at_once : (chosen + 1) * at_once]
        bits = [bool(int(digit) >> place & 1) for digit in reversed(digits) for place in range(BITS_PER_DIGIT)]
        contacts = dict(zip(inputs.lines, bits, strict=False))
        if inputs.third:
            contacts[inputs.third] = self.value < 0
        return contacts


def dial(controller: Controller, set_number: int, value: int) -> None:
    """Dial a number; the module is wired on at the first.

    Raises:
        KeyError: a set there is not.
        ValueError: more than eight digits.
    """
    if not 1 <= set_number <= SETS:
        raise KeyError(f"no thumbwheel set {set_number}; there are 1 to {SETS}")
    if abs(value) >= 10**MOST_DIGITS:
        raise ValueError(f"{value} has more than {MOST_DIGITS} digits")
    bank = controller.thumbwheels.bank(set_number)
    if bank is None:
        controller.thumbwheels.attach(ThumbwheelBank(controller, set_number, value))
    else:
        bank.value = value
        controller.thumbwheels.let_devices_answer()
