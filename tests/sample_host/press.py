"""A small machine control program, as a customer might write it: a feeder axis with a home switch, a press cycle that
the controller runs by itself, and what to do when a drive reports a fault.

It knows a line that bytes go through and nothing of an emulator.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from clients.lines import Line

PROMPTS = (b"\r\n> ", b"\r\n? ", b"\r\n- ")
COUNTS_PER_REV = 4000
POLL_S = 0.5

MOVING, HOMED, DRIVE_OFF, FAULTED = 1, 5, 13, 14
HARD_LIMITS = (15, 16)

CYCLE = (
    "A20",
    "V2",
    "L10",
    "D80000",
    "GO1",
    "OUT1",
    "T1.5",
    "OUT0",
    "D-80000",
    "GO1",
    "T0.5",
    "VAR1=VAR1+1",
    "LN",
)
"""Ten strokes of 20 revolutions forth and back."""


class Refused(Exception):
    """The unit has refused a command."""


class Stopped(Exception):
    """Motion was stopped by something else than the program; `bits` are the status bits of the axis."""

    def __init__(self, bits: set[int]) -> None:
        super().__init__(f"stopped, AS bits {sorted(bits)}")
        self.bits = bits


class Press:
    """The machine. `pause` waits between polls."""

    def __init__(self, line: Line, pause: Callable[[float], None]) -> None:
        self._line = line
        self._pause = pause
        self._unread = b""

    def set_up(self) -> None:
        """What must be so before anything else, and the program the controller is to run."""
        self._line.read(0.2)
        for command in ("!ECHO0", "INFEN1", "COMEXC1", "LH3,0", "HOMBAC10", "HOMV1", "HOMVF0.1", "HOMA20"):
            self.tell(command)

    def download(self, name: str, lines: tuple[str, ...]) -> None:
        """Store a program and read it back."""
        self.tell(f"DEL {name}")
        for line in (f"DEF {name}", *lines, "END"):
            self.tell(line)
        stored = [text.lstrip("*") for text in self.ask(f"TPROG {name}").split()]
        if stored != [line.replace(" ", "") for line in lines]:
            raise Refused(f"{name} was stored as {stored}")

    def switch_on(self) -> None:
        self.tell("DRIVE1")

    def home(self) -> None:
        """Find the home switch; Stopped if it is not found."""
        self.tell("HOM0")
        self.wait_for_rest()
        if HOMED not in self.axis_bits():
            raise Stopped(self.axis_bits())

    def move_to(self, revolutions: float) -> None:
        self.tell("MA1")
        self.tell("A20")
        self.tell("V2")
        self.tell(f"D{round(revolutions * COUNTS_PER_REV)}")
        self.tell("GO1")
        self.wait_for_rest()
        self.tell("MA0")

    def run_cycles(self) -> int:
        """Ten strokes; how many have been made in all."""
        self.tell("COMEXC0")
        self._line.write(b"CYCLE\r")
        self._pause(POLL_S)
        while self.ask("!TSS.3") != "*0":
            self._pause(POLL_S)
            if stopped := self.axis_bits() & {FAULTED, DRIVE_OFF, *HARD_LIMITS}:
                raise Stopped(stopped)
        self.tell("COMEXC1")
        return self.strokes()

    def strokes(self) -> int:
        found = re.search(r"=\+(\d+)", self.ask("VAR1"))
        return int(found[1]) if found else 0

    def recover(self) -> None:
        """After a fault: wait until the drive reports none, switch on, find home again."""
        while self.ask("!1TASX.4") != "*0":
            self._pause(POLL_S)
        self.tell("!K")
        self.tell("COMEXC1")
        self.switch_on()
        self.move_to_home_side()
        self.home()

    def move_to_home_side(self) -> None:
        """The search begins on the negative side of the switch."""
        self.tell("MA0")
        self.tell("V2")
        self.tell("D-120000")
        self.tell("GO1")
        self.wait_for_rest()

    def wait_for_rest(self) -> None:
        while MOVING in (bits := self.axis_bits()):
            self._pause(POLL_S)
        if bits & {FAULTED, DRIVE_OFF}:
            raise Stopped(bits)

    def axis_bits(self) -> set[int]:
        word = self.ask("!1TAS").removeprefix("*1TAS").replace("_", "")
        return {number for number, digit in enumerate(word, start=1) if digit == "1"}

    def position(self) -> int:
        return int(self.ask("!1TPE").removeprefix("*1TPE"))

    def tell(self, command: str) -> None:
        self.ask(command)

    def ask(self, command: str) -> str:
        """The answer without framing and prompt; what the unit has said by itself meanwhile is passed over."""
        self._unread = self._line.read(0.0)[:0]
        self._line.write(command.encode("ascii") + b"\r")
        received = self._unread
        while not (end := max((received.find(each) + len(each)) * (each in received) for each in PROMPTS)):
            more = self._line.read(5.0)
            if not more:
                raise TimeoutError(f"no answer to {command}: {received!r}")
            received += more
        answer, self._unread = received[: end - 4], received[end:]
        if received[end - 4 : end] == PROMPTS[1]:
            raise Refused(f"{command}: {answer!r}")
        return answer.decode("ascii").strip()
