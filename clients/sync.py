"""`OEM6250`: the blocking face of the client library.

    with OEM6250.open("/dev/ttyUSB0") as ctl:
        ctl.axis[1].velocity = 5.0
        ctl.axis[1].drive_enabled = True
        ctl.axis[1].move_to(40000)
        print(ctl.axis[1].position, ctl.status.axis(1).in_target_zone)

Threads: one lock a line. Each command with its answer, and each procedure of several commands (a download, the set-up
of a move), holds it from its first byte to its last; waiting for a move or a program lets go of it between two polls,
so that another thread can stop the axis. `with ctl.locked():` keeps several commands of your own together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import TracebackType
from typing import Self, Unpack

from clients import gains as gain_sets
from clients import motion
from clients.blocking import Axes, BinaryVariables, Driver, Programs, RealVariables, Status, TextVariables
from clients.gains import Gains
from clients.lines import DEFAULT_BAUD, Line, close_quietly, open_line
from clients.opening import ConnectOptions, Options, connect, end_definition
from clients.plan import Answer
from clients.session import Session, Wire
from clients.synchronising import Synchronised
from clients.typed.blocking import UnitActions, UnitReports, UnitSettings
from clients.values import Number


class OEM6250:
    """A blocking connection to a unit; see the module for threads."""

    def __init__(self, line: Line, **options: Unpack[ConnectOptions]) -> None:
        """Synchronise with the unit at the other end of `line`; see ConnectOptions.

        Raises:
            NoAnswer, Garbled, LineLost, InDefinition: see clients.errors; the line stays open.
        """
        chosen = Options.of(options)
        wire = Wire(line.clock, timeout_s=chosen.timeout_s, quiet_s=chosen.quiet_s, retries=chosen.retries)
        self._begin(Driver(line), Session(wire, address=chosen.address), chosen)

    def _begin(self, driver: Driver, session: Session, options: Options) -> None:
        self._driver, self._options, self.session = driver, options, session
        run = driver.run
        self.axis = Axes(run, session)
        self.status = Status(run, session)
        self.settings = UnitSettings(run, session)
        self.reports = UnitReports(run, session)
        self.actions = UnitActions(run, session)
        self.programs = Programs(run, session)
        self.var = RealVariables(run, session)
        self.varb = BinaryVariables(run, session)
        self.vars = TextVariables(run, session)
        run(connect(session, options))

    @classmethod
    def open(cls, url: str, *, baud: int = DEFAULT_BAUD, **options: Unpack[ConnectOptions]) -> Self:
        """Connect to `tcp://host:port`, `rfc2217://host:port`, `/dev/ttyUSB0`, `COM3`, or any URL of pyserial's.

        Raises:
            LineLost: the port cannot be opened. ValueError: the URL is not understood. The rest as the constructor's.
        """
        line = open_line(url, baud=baud)
        try:
            return cls(line, **options)
        except BaseException:
            close_quietly(line)
            raise

    def unit(self, address: int) -> OEM6250:
        """Another unit of the same daisy chain, on the same line and lock; it is synchronised with first."""
        other = object.__new__(OEM6250)
        other._begin(self._driver, Session(self.session.wire, address=address), self._options)
        return other

    @property
    def changed(self) -> tuple[str, ...]:
        """The commands that connecting had to send which changed something of the unit."""
        return tuple(self.session.changed)

    def send(self, line: str, *, timeout_s: float | None = None) -> Answer:
        """Send a line as it is and wait for what it draws: a prompt, a reply.

        Raises:
            UnitError: refused. NoAnswer, Garbled, LineLost.
        """
        return self._driver.run(self.session.command(line, timeout_s=timeout_s))

    def query(self, line: str, *, timeout_s: float | None = None) -> str:
        """The value of a reply, without asterisk, axis number and name: `query("1TPE")` is `+0`."""
        return self.send(line, timeout_s=timeout_s).value

    def post(self, line: str) -> None:
        """Send a line and do not wait (a `GO` that answers when the move is over); a refusal is raised later."""
        self._driver.run(self.session.post(line))

    def move_to(
        self, targets: Mapping[int, Number], *, wait: bool = True, timeout_s: float = motion.MOVE_TIMEOUT_S
    ) -> None:
        """Move several axes to absolute positions, started together: `move_to({1: 4000, 2: 0})`."""
        self._driver.run(motion.begin_moves(self.session, targets, absolute=True))
        if wait:
            self.wait_until_settled(*targets, timeout_s=timeout_s)

    def move_by(
        self, targets: Mapping[int, Number], *, wait: bool = True, timeout_s: float = motion.MOVE_TIMEOUT_S
    ) -> None:
        """Move several axes by distances, started together."""
        self._driver.run(motion.begin_moves(self.session, targets, absolute=False))
        if wait:
            self.wait_until_settled(*targets, timeout_s=timeout_s)

    def wait_until_settled(self, *axes: int, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Until these axes have settled, one after another."""
        for axis in axes:
            self.axis[axis].wait_until_settled(timeout_s=timeout_s)

    def stop(self) -> None:
        """Stop all motion, and the program (!S)."""
        self._driver.run(motion.stop(self.session, None))

    def kill(self) -> None:
        """Kill all motion, and the program (!K)."""
        self._driver.run(motion.kill(self.session, None))

    def gains(self) -> tuple[Gains, ...]:
        """The gains in force, axis 1 first (TGAIN)."""
        return self._driver.run(gain_sets.active(self.session))

    def saved_gains(self, number: int) -> tuple[Gains, ...]:
        """A saved gain set, axis 1 first (TSGSET)."""
        return self._driver.run(gain_sets.saved(self.session, number))

    def save_gains(self, number: int) -> None:
        """Save the gains in force as set 1 to 5 (SGSET); `axis[n].use_gain_set(number)` brings them back."""
        self._driver.run(gain_sets.save(self.session, number))

    def take_output(self) -> str:
        """What the unit has said unasked since last time: WRITE in programs, the sign-on."""
        self._driver.run(self.session.listen())
        return self.session.take_output()

    def check(self) -> None:
        """Raise UnitError if the unit has refused a command since last asked; needed at ERRLVL 0 to 2 only."""
        self._driver.run(self.session.check())

    def synchronise(self) -> Synchronised:
        """Find out again how the unit talks, after somebody else has used its line."""
        return self._driver.run(self.session.synchronise())

    def end_definition(self) -> None:
        """END, if a program definition is open."""
        self._driver.run(end_definition(self.session))

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other threads off the line."""
        with self._driver.lock:
            yield

    def close(self) -> None:
        """Let go of the line; the unit goes on by itself, a move included."""
        close_quietly(self._driver.line)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
