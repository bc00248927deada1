"""Thumbwheels and other BCD devices: INSTW and OUTTW (TW1 to TW4), INPLC and OUTPLC (TW5 to TW8).

Reading one goes in steps of virtual time: the strobe outputs choose a digit, the strobe time passes, the data inputs
are read.  A TM8 module (OUTTW) is told the digit's number in binary, any other device (OUTPLC) gets one strobe line a
step; four data inputs carry one BCD digit, eight two, most significant first (assumed L).  The data inputs are read
without debounce: the strobe time is the device's own time to settle (assumed).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING, cast

from emulator.controller.dispatch import Lines, handles
from emulator.controller.variables.store import Store, supplies
from protocol.command import Command
from protocol.errors import (
    DEFINED_WITH_ANOTHER_TW,
    INCORRECT_DATA,
    INVALID_CONDITIONS,
    INVALID_DATA,
    CommandError,
    invalid_data_field,
)
from protocol.expression import Operand
from protocol.reply import ReplyLine
from protocol.status import SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.wires.thumbwheel_bank import ThumbwheelBank

SETS = 4
BITS_PER_DIGIT = 4
MOST_DIGITS = 8
"""A TM8 has eight digits."""

LONGEST_STROBE_MS = 5_000
"""Largest strobe time (assumed L, as INSELP's)."""

DATA_VALID_POLL_NS = 1
"""A device that is not ready is looked at again at the next system update."""

NS_PER_MS = 1_000_000

_FIELDS_OF = {"INSTW": 3, "OUTTW": 4, "INPLC": 4, "OUTPLC": 4}
_RANGE = re.compile(r"(\d{1,3})-(\d{1,3})", re.ASCII)


@dataclass(frozen=True, slots=True)
class WireSet:
    """One set of INSTW, OUTTW, INPLC or OUTPLC: a run of inputs or outputs (0-0 = none) and the two further fields.

    For inputs these are the sign input and the data-valid input, for outputs the enable line and the strobe time in
    ms; 0 means there is none.
    """

    first: int = 0
    last: int = 0
    third: int = 0
    fourth: int = 0

    @property
    def lines(self) -> list[int]:
        """The numbers of the run, lowest first."""
        return list(range(self.first, self.last + 1)) if self.first else []


Device = Callable[[str], Mapping[int, bool]]
"""Something wired to outputs and inputs: takes the output bits, says which inputs it closes and which it opens."""


class Thumbwheels:
    """The thumbwheel sets of one unit and the strobes of the one being read."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._sets: dict[str, list[WireSet]] = {}
        self._devices: list[Device] = []
        self.driven: dict[int, str] = {}
        """Outputs that a strobe drives now: number and digit."""
        self.power_up()

    def power_up(self) -> None:
        """No set is defined; devices stay wired."""
        self._sets = {name: [WireSet()] * SETS for name in _FIELDS_OF}
        self.driven = {}

    def attach(self, device: Device) -> None:
        """Wire a device to the terminals."""
        self._devices.append(device)
        self.let_devices_answer()

    def detach(self, device: Device) -> None:
        """Take a device's wires off; the inputs stay as it left them."""
        self._devices.remove(device)

    def wires(self, number: int) -> tuple[WireSet, WireSet]:
        """The input and the output set that TWn reads (n from 1 to 8)."""
        inputs, outputs = ("INSTW", "OUTTW") if number <= SETS else ("INPLC", "OUTPLC")
        index = (number - 1) % SETS
        return self._sets[inputs][index], self._sets[outputs][index]

    @property
    def input_numbers(self) -> frozenset[int]:
        """Inputs that belong to a set."""
        return frozenset(
            n for name in ("INSTW", "INPLC") for wires in self._sets[name] for n in _inputs_of(name, wires)
        )

    @property
    def output_numbers(self) -> frozenset[int]:
        """Outputs that belong to a set."""
        return frozenset(n for name in ("OUTTW", "OUTPLC") for wires in self._sets[name] for n in _outputs_of(wires))

    def define(self, name: str, number: int, wires: WireSet) -> bool:
        """Give a set its wires; whether another set has some of them too."""
        self._sets[name][number - 1] = WireSet()
        shared = set(self._numbers(name, wires)) & (self.input_numbers if _is_input(name) else self.output_numbers)
        self._sets[name][number - 1] = wires
        return bool(shared)

    def _numbers(self, name: str, wires: WireSet) -> list[int]:
        return _inputs_of(name, wires) if _is_input(name) else _outputs_of(wires)

    def report(self, name: str, number: int) -> ReplyLine:
        """``*INSTW1,0-0,0``."""
        wires = self._sets[name][number - 1]
        fields = [f"{number}", f"{wires.first}-{wires.last}", str(wires.third), str(wires.fourth)]
        return ReplyLine(name, ",".join(fields[: _FIELDS_OF[name]]))

    # Reading.

    def read(self, number: int, deliver: Callable[[Decimal], None]) -> ThumbwheelRead:
        """Begin to read TWn (1 to 8); ``deliver`` gets the value when all digits are in.

        Raises:
            CommandError: INVALID DATA for a number there is not, INVALID CONDITIONS while the sets are not defined.
        """
        if not 1 <= number <= 2 * SETS:
            raise CommandError(INVALID_DATA)
        inputs, outputs = self.wires(number)
        if not inputs.lines or len(inputs.lines) % BITS_PER_DIGIT:
            raise CommandError(INVALID_CONDITIONS)
        patterns = _binary_strobes(outputs, inputs) if number <= SETS else _line_strobes(outputs)
        return ThumbwheelRead(self._controller, inputs, outputs, patterns, deliver)

    def drive(self, outputs: Mapping[int, str]) -> None:
        """Switch strobe outputs (none: all back to what they were); the devices answer."""
        self.driven = dict(outputs)
        self.let_devices_answer()

    def release(self) -> None:
        """A reading was given up: strobes off."""
        if self.driven:
            self.drive({})

    def bank(self, set_number: int) -> ThumbwheelBank | None:
        """The thumbwheel module wired to a set, if there is one."""
        for device in self._devices:
            if getattr(device, "set_number", None) == set_number:
                return cast("ThumbwheelBank", device)
        return None

    def let_devices_answer(self) -> None:
        """Devices see the outputs and move their inputs."""
        if not self._devices:
            return
        bits = self._controller.output_functions.sinking_bits()
        for device in self._devices:
            for number, closed in device(bits).items():
                self._controller.wiring.set(self._controller.wiring.input_name(number), closed=closed)


class ThumbwheelRead:
    """The wait for a thumbwheel: one strobe step after another."""

    status_bit: SystemStatus | None = SystemStatus.LOADING_THUMBWHEEL_DATA

    def __init__(
        self,
        controller: Controller,
        inputs: WireSet,
        outputs: WireSet,
        patterns: list[dict[int, str]],
        deliver: Callable[[Decimal], None],
    ) -> None:
        self._inputs = inputs
        self._strobe_ns = outputs.fourth * NS_PER_MS
        self._enable = {outputs.third: "1"} if outputs.third else {}
        self._patterns = patterns or [{}]
        self._deliver = deliver
        self._digits = ""
        self._step = 0
        self.look_again_ns = 0
        self._strobe(controller)

    def _strobe(self, controller: Controller) -> None:
        controller.thumbwheels.drive({**self._patterns[self._step], **self._enable})
        self.look_again_ns = controller.system_update_at(controller.now_ns + self._strobe_ns)

    def over(self, controller: Controller) -> bool:
        """Take the digits that are due; True once the value has been delivered."""
        while controller.now_ns >= self.look_again_ns:
            bits = controller.inputs.undebounced_bits
            if self._inputs.fourth and bits[self._inputs.fourth - 1] != "1":
                self.look_again_ns = controller.system_update_at(controller.now_ns + DATA_VALID_POLL_NS)
                return False
            self._digits += read_digits(bits, self._inputs.lines)
            self._step += 1
            if self._step == len(self._patterns):
                self._finish(controller, bits)
                return True
            self._strobe(controller)
        return False

    def _finish(self, controller: Controller, bits: str) -> None:
        negative = self._inputs.third and bits[self._inputs.third - 1] == "1"
        controller.thumbwheels.drive({})
        self._deliver(-Decimal(self._digits) if negative else Decimal(self._digits))


def read_digits(bits: str, lines: list[int]) -> str:
    """BCD digits from data inputs, the highest four first; within a digit the lowest input is worth 1.

    A code above nine is a digit that is not there and counts as 0 (assumed L).
    """
    digits = ""
    for start in range(len(lines) - BITS_PER_DIGIT, -1, -BITS_PER_DIGIT):
        value = sum(1 << place for place in range(BITS_PER_DIGIT) if bits[lines[start + place] - 1] == "1")
        digits += str(value if value <= 9 else 0)
    return digits


def _binary_strobes(outputs: WireSet, inputs: WireSet) -> list[dict[int, str]]:
    """One step for each group of digits, its number in binary on the select lines, lowest line worth 1."""
    lines = outputs.lines
    steps = min(1 << len(lines), MOST_DIGITS * BITS_PER_DIGIT // len(inputs.lines))
    return [{line: str(step >> place & 1) for place, line in enumerate(lines)} for step in range(steps)]


def _line_strobes(outputs: WireSet) -> list[dict[int, str]]:
    """One step for each strobe line, that line alone on."""
    return [{line: "1" if line == chosen else "0" for line in outputs.lines} for chosen in outputs.lines]


def _is_input(name: str) -> bool:
    return name.startswith("IN")


def _inputs_of(name: str, wires: WireSet) -> list[int]:
    single = [wires.third, wires.fourth] if name == "INPLC" else [wires.third]
    return [*wires.lines, *(number for number in single if number)]


def _outputs_of(wires: WireSet) -> list[int]:
    return [*wires.lines, *([wires.third] if wires.third else [])]


@handles(*_FIELDS_OF)
def define_wires(controller: Controller, command: Command) -> Lines:
    """INSTW, OUTTW, INPLC, OUTPLC: alone all four sets, with a number one, with more fields a definition.

    A set that shares wires with another is defined all the same, with a warning: sets may share a device.
    """
    thumbwheels, name = controller.thumbwheels, command.name
    if not command.argument:
        return [thumbwheels.report(name, number) for number in range(1, SETS + 1)]
    texts = command.argument.split(",")
    if not texts[0].isdigit() or len(texts) > _FIELDS_OF[name]:
        raise CommandError(INCORRECT_DATA)
    number = int(texts[0])
    if not 1 <= number <= SETS:
        raise invalid_data_field(1)
    if len(texts) == 1:
        return [thumbwheels.report(name, number)]
    wires = _read_wires(controller, name, texts)
    if _assigned(controller, name, wires):
        raise CommandError(INVALID_CONDITIONS)
    if thumbwheels.define(name, number, wires):
        raise CommandError(DEFINED_WITH_ANOTHER_TW)
    return None


def _read_wires(controller: Controller, name: str, texts: list[str]) -> WireSet:
    """The fields after the set number; those left out are 0.

    Raises:
        CommandError: INCORRECT DATA for what is no run of wires or no number, INVALID DATA-FIELD n out of range.
    """
    run = _RANGE.fullmatch(texts[1])
    if run is None or any(not text.isdigit() for text in texts[2:] if text):
        raise CommandError(INCORRECT_DATA)
    first, last = int(run[1]), int(run[2])
    third, fourth = ([int(text or 0) for text in texts[2:]] + [0, 0])[:2]
    count = controller.wiring.input_count if _is_input(name) else controller.output_functions.count
    if (first, last) != (0, 0) and not 1 <= first <= last <= count:
        raise invalid_data_field(2)
    if third > count:
        raise invalid_data_field(3)
    if fourth > (count if _is_input(name) else LONGEST_STROBE_MS):
        raise invalid_data_field(4)
    return WireSet(first, last, third, fourth)


def _assigned(controller: Controller, name: str, wires: WireSet) -> bool:
    """Whether one of the wires has another function already."""
    if _is_input(name):
        numbers = _inputs_of(name, wires)
        return any(controller.input_functions.of(number).letter != "A" for number in numbers)
    return bool(controller.output_functions.assigned_numbers & set(_outputs_of(wires)))


@supplies("TW")
def read_thumbwheels(controller: Controller, operand: Operand, store: Store) -> None:
    """VARn=TWi."""
    controller.interpreter.wait_for(controller.thumbwheels.read(operand.index or 0, store))
