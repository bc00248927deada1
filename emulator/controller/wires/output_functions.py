"""OUTFNC: what drives each output, and the word that results.

An output is, from the weakest to the strongest: its OUT bit, its function (while OUTFEN1), a thumbwheel strobe, and
OUTEN.  Functions are read from the unit's state when the word is asked for, so they cost nothing while nobody looks and
are never older than the last system update.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.wires.input_functions import axis_of, check_letter
from protocol.command import Command
from protocol.errors import ALREADY_DEFINED_FOR_THUMBWHEELS, INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.reply import ReplyLine
from protocol.status import AxisStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

PROGRAMMABLE = "A"
ON_POSITION = "H"
AXIS_ALLOWED = frozenset("BDG")
AUXILIARY_OUTPUTS = 2
"""OUT-A and OUT-B, the bits after the programmable outputs."""

FUNCTION_NAMES = {
    "A": "PROGRAMMABLE OUTPUT",
    "B": "MOVING/NOT MOVING",
    "C": "PROGRAM IN PROGRESS",
    "D": "END-OF-TRAVEL LIMIT HIT",
    "F": "FAULT OUTPUT",
    "G": "POSITION ERROR EXCEEDED",
    "H": "OUTPUT ON POSITION",
}
"""What OUTFNC prints of each letter; the wording of A is the reference's, the rest assumed L after its meanings."""

LIMITS_HIT = (
    AxisStatus.POSITIVE_HARD_LIMIT_HIT.mask
    | AxisStatus.NEGATIVE_HARD_LIMIT_HIT.mask
    | AxisStatus.POSITIVE_SOFT_LIMIT_HIT.mask
    | AxisStatus.NEGATIVE_SOFT_LIMIT_HIT.mask
)

_ASSIGNMENT = re.compile(r"(\d)?([A-Z])", re.ASCII)


@dataclass(frozen=True, slots=True)
class OutputFunction:
    """One assignment; ``axis_index`` None means every axis."""

    letter: str
    axis_index: int | None = None

    @property
    def code(self) -> str:
        """As OUTFNC takes and prints it."""
        return self.letter if self.axis_index is None else f"{self.axis_index + 1}{self.letter}"


class OutputFunctions:
    """The outputs of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.count = controller.machine.io.outputs + AUXILIARY_OUTPUTS
        self._assigned: list[OutputFunction] = []
        self.power_up()

    def power_up(self) -> None:
        """All outputs are programmable."""
        self._assigned = [OutputFunction(PROGRAMMABLE)] * self.count

    def of(self, number: int) -> OutputFunction:
        """The function of an output (from 1)."""
        return self._assigned[number - 1]

    def assign(self, number: int, function: OutputFunction) -> None:
        """OUTFNC: give an output a function."""
        self._assigned[number - 1] = function

    @property
    def assigned_numbers(self) -> frozenset[int]:
        """Outputs that are not programmable any more."""
        return frozenset(n for n, function in enumerate(self._assigned, start=1) if function.letter != PROGRAMMABLE)

    def bits(self) -> str:
        """OUT: one digit an output, 1 = on."""
        controller = self._controller
        settings = controller.settings
        states = settings.bits("OUT")[: self.count]
        if settings.flag("OUTFEN"):
            states = "".join(self._state(number, state) for number, state in enumerate(states, start=1))
        strobes = controller.thumbwheels.driven
        if strobes:
            states = "".join(strobes.get(number, state) for number, state in enumerate(states, start=1))
        overrides = settings.bits("OUTEN")[: self.count]
        if "0" in overrides or "1" in overrides:
            states = "".join(o if o in "01" else s for s, o in zip(states, overrides, strict=True))
        return states

    def sinking_bits(self) -> str:
        """Which outputs sink current at their terminals: on with OUTLVL0, off with OUTLVL1."""
        levels = self._controller.settings.bits("OUTLVL")[: self.count]
        return "".join("1" if s != level else "0" for s, level in zip(self.bits(), levels, strict=True))

    def _state(self, number: int, programmed: str) -> str:
        function = self._assigned[number - 1]
        if function.letter == PROGRAMMABLE:
            return programmed
        if function.letter == ON_POSITION:
            auxiliary = number - 1 - self._controller.machine.io.outputs
            return "1" if self._controller.on_position[auxiliary].on else "0"
        return "1" if _STATES[function.letter](self._controller, function.axis_index) else "0"

    def report(self, number: int) -> ReplyLine:
        """``*OUTFNC1-A PROGRAMMABLE OUTPUT - STATUS OFF``."""
        function = self.of(number)
        state = "ON" if self.bits()[number - 1] == "1" else "OFF"
        return ReplyLine("OUTFNC", f"{number}-{function.code} {FUNCTION_NAMES[function.letter]} - STATUS {state}")


def _axes(controller: Controller, axis_index: int | None) -> range:
    return range(controller.settings.axes) if axis_index is None else range(axis_index, axis_index + 1)


def _moving(controller: Controller, axis_index: int | None) -> bool:
    """With STRGTE1 an axis moves until it is in the target zone or has been given up."""
    engine = controller.engine
    return any(engine.is_moving(i) or engine.is_settling(i) for i in _axes(controller, axis_index))


def _any_status(mask: int) -> Callable[[Controller, int | None], bool]:
    return lambda controller, axis_index: any(controller.engine.status(i) & mask for i in _axes(controller, axis_index))


def _in_program(controller: Controller, axis_index: int | None) -> bool:
    return controller.programs.running


def _fault(controller: Controller, axis_index: int | None) -> bool:
    """A drive fault, or a user-fault or kill input held active."""
    functions = controller.input_functions
    return any(controller.drive_faulted) or functions.active("F") or functions.active("C")


_STATES: dict[str, Callable[[Controller, int | None], bool]] = {
    "B": _moving,
    "C": _in_program,
    "D": _any_status(LIMITS_HIT),
    "F": _fault,
    "G": _any_status(AxisStatus.POSITION_ERROR_EXCEEDED.mask),
}


@handles("OUTFNC")
def output_function(controller: Controller, command: Command) -> Lines:
    """OUTFNC lists all outputs, OUTFNCi one, OUTFNCi-<a>c assigns."""
    functions = controller.output_functions
    if not command.argument:
        return [functions.report(number) for number in range(1, functions.count + 1)]
    digits, _, code = command.argument.partition("-")
    number = int(digits)
    if not 1 <= number <= functions.count:
        raise CommandError(INVALID_DATA)
    if not code:
        return [functions.report(number)]
    function = _read_function(controller, number, code)
    if function.letter != PROGRAMMABLE and number in controller.thumbwheels.output_numbers:
        raise CommandError(ALREADY_DEFINED_FOR_THUMBWHEELS)
    functions.assign(number, function)
    return None


def _read_function(controller: Controller, number: int, code: str) -> OutputFunction:
    found = _ASSIGNMENT.fullmatch(code)
    if found is None:
        raise CommandError(INCORRECT_DATA)
    digit, letter = found.groups()
    check_letter(letter, "outfnc")
    if letter == ON_POSITION and number <= controller.machine.io.outputs:
        raise CommandError(INVALID_DATA)
    return OutputFunction(letter, axis_of(controller, digit, allowed=letter in AXIS_ALLOWED))
