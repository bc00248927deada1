"""`AsyncOEM6250`: the asyncio face of the client library.

    async with await AsyncOEM6250.open("tcp://127.0.0.1:6250") as ctl:
        await ctl.axis[1].set_velocity(5.0)
        await ctl.axis[1].move_to(40000)
        print(await ctl.axis[1].get_position())

It has the surface of `OEM6250`; what is a property there is a pair of methods here, `get_velocity` and `set_velocity`,
because an assignment cannot be awaited. Any number of tasks may use one client: each command with its answer, and each
procedure of several commands, has the line to itself; waiting for a move lets the others in between two polls.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import TracebackType
from typing import Self, Unpack

from clients import gains as gain_sets
from clients import motion
from clients.async_lines import AsyncLine, as_async, open_async_line
from clients.awaitable import AsyncDriver, Axes, BinaryVariables, Programs, RealVariables, Status, TextVariables
from clients.gains import Gains
from clients.lines import DEFAULT_BAUD, Line
from clients.opening import ConnectOptions, Options, connect, end_definition
from clients.plan import Answer
from clients.session import Session, Wire
from clients.synchronising import Synchronised
from clients.typed.awaitable import UnitActions, UnitReports, UnitSettings
from clients.values import Number


class AsyncOEM6250:
    """An asyncio connection to a unit; see the module."""

    def __init__(self, line: AsyncLine | Line, **options: Unpack[ConnectOptions]) -> None:
        """A client on a line, not yet synchronised: `async with AsyncOEM6250(line) as ctl`, or `connect`.

        A blocking `Line` is used from a thread of its own; wrap one that never waits in clients.async_lines.DirectLine.
        """
        chosen = Options.of(options)
        wire = Wire(line.clock, timeout_s=chosen.timeout_s, quiet_s=chosen.quiet_s, retries=chosen.retries)
        self._begin(AsyncDriver(as_async(line)), Session(wire, address=chosen.address), chosen)

    def _begin(self, driver: AsyncDriver, session: Session, options: Options) -> None:
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
        self._connected = False

    async def connect(self) -> None:
        """Synchronise with the unit.

        Raises:
            NoAnswer, Garbled, LineLost, InDefinition: see clients.errors; the line stays open.
        """
        await self._driver.run(connect(self.session, self._options))
        self._connected = True

    @classmethod
    async def open(cls, url: str, *, baud: int = DEFAULT_BAUD, **options: Unpack[ConnectOptions]) -> Self:
        """Connect to `tcp://host:port`, `rfc2217://host:port`, `/dev/ttyUSB0`, `COM3`, or any URL of pyserial's.

        Raises:
            LineLost: the port cannot be opened. ValueError: the URL is not understood. The rest as the constructor's.
        """
        client = cls(await open_async_line(url, baud=baud), **options)
        try:
            await client.connect()
        except BaseException:
            await client.close()
            raise
        return client

    async def unit(self, address: int) -> AsyncOEM6250:
        """Another unit of the same daisy chain, on the same line and lock; it is synchronised with first."""
        other = object.__new__(AsyncOEM6250)
        other._begin(self._driver, Session(self.session.wire, address=address), self._options)
        await other.connect()
        return other

    @property
    def changed(self) -> tuple[str, ...]:
        """The commands that connecting had to send which changed something of the unit."""
        return tuple(self.session.changed)

    async def send(self, line: str, *, timeout_s: float | None = None) -> Answer:
        """Send a line as it is and wait for what it draws: a prompt, a reply.

        Raises:
            UnitError: refused. NoAnswer, Garbled, LineLost.
        """
        return await self._driver.run(self.session.command(line, timeout_s=timeout_s))

    async def query(self, line: str, *, timeout_s: float | None = None) -> str:
        """The value of a reply, without asterisk, axis number and name: `query("1TPE")` is `+0`."""
        return (await self.send(line, timeout_s=timeout_s)).value

    async def post(self, line: str) -> None:
        """Send a line and do not wait (a `GO` that answers when the move is over); a refusal is raised later."""
        await self._driver.run(self.session.post(line))

    async def move_to(
        self, targets: Mapping[int, Number], *, wait: bool = True, timeout_s: float = motion.MOVE_TIMEOUT_S
    ) -> None:
        """Move several axes to absolute positions, started together: `move_to({1: 4000, 2: 0})`."""
        await self._driver.run(motion.begin_moves(self.session, targets, absolute=True))
        if wait:
            await self.wait_until_settled(*targets, timeout_s=timeout_s)

    async def move_by(
        self, targets: Mapping[int, Number], *, wait: bool = True, timeout_s: float = motion.MOVE_TIMEOUT_S
    ) -> None:
        """Move several axes by distances, started together."""
        await self._driver.run(motion.begin_moves(self.session, targets, absolute=False))
        if wait:
            await self.wait_until_settled(*targets, timeout_s=timeout_s)

    async def wait_until_settled(self, *axes: int, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Until these axes have settled, one after another."""
        for axis in axes:
            await self.axis[axis].wait_until_settled(timeout_s=timeout_s)

    async def stop(self) -> None:
        """Stop all motion, and the program (!S)."""
        await self._driver.run(motion.stop(self.session, None))

    async def kill(self) -> None:
        """Kill all motion, and the program (!K)."""
        await self._driver.run(motion.kill(self.session, None))

    async def gains(self) -> tuple[Gains, ...]:
        """The gains in force, axis 1 first (TGAIN)."""
        return await self._driver.run(gain_sets.active(self.session))

    async def saved_gains(self, number: int) -> tuple[Gains, ...]:
        """A saved gain set, axis 1 first (TSGSET)."""
        return await self._driver.run(gain_sets.saved(self.session, number))

    async def save_gains(self, number: int) -> None:
        """Save the gains in force as set 1 to 5 (SGSET); `axis[n].use_gain_set(number)` brings them back."""
        await self._driver.run(gain_sets.save(self.session, number))

    async def take_output(self) -> str:
        """What the unit has said unasked since last time: WRITE in programs, the sign-on."""
        await self._driver.run(self.session.listen())
        return self.session.take_output()

    async def check(self) -> None:
        """Raise UnitError if the unit has refused a command since last asked; needed at ERRLVL 0 to 2 only."""
        await self._driver.run(self.session.check())

    async def synchronise(self) -> Synchronised:
        """Find out again how the unit talks, after somebody else has used its line."""
        return await self._driver.run(self.session.synchronise())

    async def end_definition(self) -> None:
        """END, if a program definition is open."""
        await self._driver.run(end_definition(self.session))

    async def close(self) -> None:
        """Let go of the line; the unit goes on by itself, a move included."""
        await self._driver.line.close()

    async def __aenter__(self) -> Self:
        if not self._connected:
            await self.connect()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()
