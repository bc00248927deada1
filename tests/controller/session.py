"""A host's side of one unit in virtual time: commands in, what came back and when, refusals recognised.

The tests of this folder speak to whole units only through this face and the control registry, so that what they prove
is what a host sees.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from emulator import Emulator, Machine
from emulator.registry import Value

OK = "\r\n> "
SIGN_ON = "*PARKER OEM6250 MOTION CONTROLLER\r\n*NO REMOTE PANEL\r\r\n> "
ERROR = re.compile(r"\r\n\*([^\r]*)\r\r\n\? ")
REPLY = re.compile(r"\*([^\r]*)\r\r\n[>-] ")

MS = 1_000_000
S = 1_000_000_000

TRAJECTORY_NS = 1_120_000
SYSTEM_NS = 2_240_000
"""Updates at SSFR4, INDAX2: the defaults (settled, section 9)."""

ONE_UPDATE_EACH_NS = TRAJECTORY_NS + SYSTEM_NS


class Stamped(NamedTuple):
    """Text that left the unit and when, ns after it was last asked for."""

    at_ns: int
    text: str


class Session:
    """One unit without echo, signed on, and whoever talks to it on channel 0."""

    def __init__(self, machine: str = "", **defaults: str | int) -> None:
        settings = {"ECHO": 0, **defaults}
        rows = "\n".join(f'{name} = "{value}"' for name, value in settings.items())
        self.emulator = Emulator(Machine.parse(f"{machine}\n[defaults]\n{rows}\n"))
        self.unit = self.emulator.unit(0)
        self.sign_on = self.unit.read().decode("latin-1")

    # Talking.

    def ask(self, text: str, *, wait_s: float = 0.0, channel: int = 0) -> str:
        """One line to the unit and all it sends within the time."""
        self.unit.send(text.encode("latin-1") + b"\r", channel=channel)
        if wait_s:
            self.emulator.advance(wait_s)
        return self.read(channel=channel)

    def read(self, *, channel: int = 0) -> str:
        return self.unit.read(channel=channel).decode("latin-1")

    def ok(self, *commands: str, wait_s: float = 0.0) -> None:
        """Commands that must each draw the bare prompt."""
        for text in commands:
            answer = self.ask(text, wait_s=wait_s)
            assert answer == OK, (text, answer)

    def query(self, text: str) -> str:
        """The text of a one-line reply, without its asterisk."""
        answer = self.ask(text)
        match = REPLY.fullmatch(answer)
        assert match, (text, answer)
        return match[1]

    def look(self, text: str) -> str:
        """As ``query``, whatever the unit has sent before."""
        self.read()
        return self.query(text)

    def error(self, text: str) -> str:
        """The error text a command draws."""
        answer = self.ask(text)
        match = ERROR.fullmatch(answer)
        assert match, (text, answer)
        return match[1]

    def timed(self, text: str, *, wait_s: float) -> list[Stamped]:
        """One line to the unit and what it sends within the time, each with the time since the line."""
        self.unit.take_output()
        start_ns = self.now_ns
        self.unit.send(text.encode("latin-1") + b"\r")
        self.emulator.advance(wait_s)
        self.unit.read()
        return [Stamped(o.at_ns - start_ns, o.data.decode("latin-1")) for o in self.unit.take_output()]

    def advance(self, seconds: float) -> None:
        self.emulator.advance(seconds)

    # Looking.

    @property
    def now_ns(self) -> int:
        return self.unit.controller.now_ns

    def axis_bits(self, axis: int = 1) -> str:
        """AS without separators: bit n is ``[n - 1]``."""
        return self.look(f"!{axis}TAS").removeprefix(f"{axis}TAS").replace("_", "")

    def axis_bit(self, number: int, axis: int = 1) -> bool:
        return self.axis_bits(axis)[number - 1] == "1"

    def error_bit(self, number: int) -> bool:
        return self.look(f"!TER.{number}") == "1"

    def system_bit(self, number: int) -> bool:
        return self.look(f"!TSS.{number}") == "1"

    def position(self, axis: int = 1) -> int:
        return int(self.look(f"!{axis}TPC").removeprefix(f"{axis}TPC"))

    def signal(self, name: str) -> Value:
        return self.unit.signals[name]

    def number(self, name: str) -> float:
        value = self.unit.signals[name]
        assert isinstance(value, float | int)
        return float(value)

    def until_rest(self, axis: int = 1, *, timeout_s: float = 60.0) -> None:
        """Let time pass until the profile of an axis is over."""
        assert self.emulator.run_until(lambda: not self.signal(f"axis{axis}.moving"), timeout_s=timeout_s)

    # The outside world.

    def set_wire(self, name: str, *, closed: bool) -> None:
        """Change a contact and let the unit see it."""
        self.unit.do("set_wire", name=name, closed=closed)
        self.advance(2 * SYSTEM_NS / S)


def both_on(*commands: str, **defaults: str | int) -> Session:
    """A unit with both drives on and some commands carried out."""
    session = Session("", **defaults)
    session.ok("DRIVE11", *commands)
    return session
