"""INSELP: programs chosen and started by inputs, in BCD (letter B) or one input a program (letter P).

While no program runs and the selection lines have kept their state for the strobe time, the program they name is
started; when it has ended the lines are looked at again, so a line that stays active repeats its program.  Commands of
the host are still taken in between (assumed).  !INSELP0 leaves; so do kill, and stop unless COMEXS2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles, store_setting
from protocol.command import Command
from protocol.errors import invalid_data_field

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

OFF, BCD, ONE_TO_ONE = 0, 1, 2
BCD_LETTER, ONE_TO_ONE_LETTER = "B", "P"
LINES_PER_DIGIT = 4
"""Lowest-numbered input is worth 1, the next 2, 4, 8, then 10, 20, 40, 80 (assumed M)."""

NS_PER_MS = 1_000_000


class ProgramSelect:
    """Program selection of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._due_ns = 0
        self.looking = False
        """Selection is on: whoever lets programs run asks ``look`` afterwards."""

    @property
    def mode(self) -> int:
        """OFF, BCD or ONE_TO_ONE; SS bit 18 shows that it is not off."""
        return self._controller.settings.integer("INSELP")

    def begin(self) -> None:
        """INSELP1 or INSELP2: the strobe time begins now."""
        self.looking = self.mode != OFF
        self.note_change()

    def leave(self) -> None:
        """Selection off, whatever the host had set."""
        settings = self._controller.settings
        self.looking = False
        settings.store("INSELP", 0, settings.setting("INSELP")._replace(value=settings.number("INSELP") * 0))

    def note_change(self) -> None:
        """A selection line changed: its new state must last for the strobe time."""
        if self.mode == OFF:
            return
        strobe_ns = self._controller.settings.integer("INSELP", 1) * NS_PER_MS
        self._due_ns = self._controller.system_update_at(self._controller.now_ns + strobe_ns)
        self._controller.alarms.at(self._due_ns, self.look)

    def look(self) -> None:
        """Start the program selected, if one is and nothing runs."""
        controller = self._controller
        if self.mode == OFF or controller.programs.running or controller.interpreter.wait is not None:
            return
        if controller.now_ns < self._due_ns or controller.programs.defining is not None:
            return
        name = self.selected()
        if name is None:
            return
        controller.interpreter.start_program(name)
        controller.interpreter.run()
        if not controller.programs.running:
            self.note_change()

    def selected(self) -> str | None:
        """The stored program the lines name now; None for none."""
        return self._by_bcd() if self.mode == BCD else self._by_line()

    def _by_bcd(self) -> str | None:
        inputs = self._controller.inputs
        lines = self._controller.input_functions.numbers(BCD_LETTER)
        total = sum(line_weight(place) for place, line in enumerate(lines) if inputs.active(line))
        return self._program(str(total))

    def _by_line(self) -> str | None:
        functions = self._controller.input_functions
        for line in functions.numbers(ONE_TO_ONE_LETTER):
            if self._controller.inputs.active(line):
                return self._program(functions.of(line).program)
        return None

    def _program(self, name: str) -> str | None:
        """A program by name or by its number in TDIR."""
        names = self._controller.programs.names
        if name.isdigit():
            return names[int(name) - 1] if 1 <= int(name) <= len(names) else None
        return name if name in names else None


def line_weight(place: int) -> int:
    """What a BCD line is worth by its place from 0: 1, 2, 4, 8, 10, 20 ..."""
    digit, bit = divmod(place, LINES_PER_DIGIT)
    return int(10**digit * 2**bit)


@handles("INSELP")
def select_program(controller: Controller, command: Command) -> Lines:
    """INSELP mode,strobe."""
    if command.is_query:
        return controller.settings.report(command)
    mode = controller.substitute(command).values[0]
    if mode not in (None, OFF, BCD, ONE_TO_ONE):
        raise invalid_data_field(1)
    store_setting(controller, command)
    controller.program_select.begin()
    return None


def security_locked(controller: Controller) -> bool:
    """Program security: an input is assigned to it (INFNCi-Q), functions are enabled and none of those is active."""
    functions = controller.input_functions
    return controller.settings.flag("INFEN") and bool(functions.numbers("Q")) and not functions.active("Q")
