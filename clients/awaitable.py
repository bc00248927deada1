"""The parts of the asyncio face: the driver of a line, axes, status words, programs, variables."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from decimal import Decimal
from typing import TypeVar

from clients import gains as gain_sets
from clients import motion, programs, variables
from clients.async_lines import AsyncLine
from clients.effects import Converse, Procedure, Receive, Send
from clients.errors import ClientError, LineLost
from clients.faces import AwaitableFace
from clients.gains import Gains
from clients.status import ErrorFlags, ExtendedAxisFlags, FollowingFlags, OtherInputFlags
from clients.typed.awaitable import AxisCommands
from clients.typed.words import AxisWord, ErrorWord, ExtendedAxisWord, FollowingWord, OtherInputWord, SystemWord
from clients.values import Number, bits

T = TypeVar("T")


class AsyncDriver:
    """Carries procedures out on a line, one at a time."""

    def __init__(self, line: AsyncLine) -> None:
        self.line = line
        self._lock = asyncio.Lock()

    async def run(self, procedure: Procedure[T]) -> T:
        """Carry out what the procedure wants; its result. A cancelled task leaves the line in doubt, and the next
        command synchronises first."""
        async with self._lock:
            data = b""
            try:
                effect = next(procedure)
                while True:
                    if isinstance(effect, Converse):
                        await self._write(effect.data)
                        data = await self._read(effect.timeout_s)
                    elif isinstance(effect, Receive):
                        data = await self._read(effect.timeout_s)
                    elif isinstance(effect, Send):
                        await self._write(effect.data)
                        data = b""
                    else:
                        data = await self._pause(effect.seconds)
                    effect = procedure.send(data)
            except StopIteration as stop:
                result: T = stop.value
                return result

    async def _read(self, timeout_s: float) -> bytes:
        try:
            return await self.line.read(timeout_s)
        except OSError as error:
            raise self._lost(error) from error

    async def _write(self, data: bytes) -> None:
        try:
            await self.line.write(data)
        except OSError as error:
            raise self._lost(error) from error

    def _lost(self, error: OSError) -> Exception:
        return error if isinstance(error, ClientError) else LineLost(self.line.name, error)

    async def _pause(self, seconds: float) -> bytes:
        """Let time pass, and other tasks use the line meanwhile."""
        self._lock.release()
        try:
            return await self.line.pause(seconds)
        finally:
            await self._lock.acquire()


class AsyncAxis(AxisCommands):
    """One axis: its typed commands, and motion."""

    @property
    def number(self) -> int:
        """Counts from 1."""
        assert self._axis is not None
        return self._axis

    async def get_status(self) -> AxisWord:
        """AS."""
        return await self._run(motion.axis_status(self._session, self.number))

    async def get_gains(self) -> Gains:
        """The gains in force (TGAIN)."""
        return (await self._run(gain_sets.active(self._session)))[self.number - 1]

    async def set_gains(self, value: Gains) -> None:
        """SGP and the rest."""
        await self._run(gain_sets.put(self._session, self.number, value))

    async def move_to(
        self,
        position: Number,
        *,
        velocity: Number | None = None,
        acceleration: Number | None = None,
        deceleration: Number | None = None,
        wait: bool = True,
        timeout_s: float = motion.MOVE_TIMEOUT_S,
    ) -> None:
        """Move to an absolute position (leaves MA1, MC0 and D set), and wait until it has settled.

        Raises:
            UnitError: refused. MotionError: it ended elsewhere. NoAnswer: not over in time.
        """
        await self._move(position, True, velocity, acceleration, deceleration)
        if wait:
            await self.wait_until_settled(timeout_s=timeout_s)

    async def move_by(
        self,
        distance: Number,
        *,
        velocity: Number | None = None,
        acceleration: Number | None = None,
        deceleration: Number | None = None,
        wait: bool = True,
        timeout_s: float = motion.MOVE_TIMEOUT_S,
    ) -> None:
        """Move by a distance (leaves MA0, MC0 and D set), and wait; errors as `move_to`."""
        await self._move(distance, False, velocity, acceleration, deceleration)
        if wait:
            await self.wait_until_settled(timeout_s=timeout_s)

    async def _move(
        self, target: Number, absolute: bool, velocity: Number | None, acc: Number | None, dec: Number | None
    ) -> None:
        session, axis = self._session, self.number
        procedure = motion.begin_move(
            session, axis, target, absolute=absolute, velocity=velocity, acceleration=acc, deceleration=dec
        )
        await self._run(procedure)

    async def jog(
        self, velocity: Number, *, acceleration: Number | None = None, deceleration: Number | None = None
    ) -> None:
        """Run at a signed velocity until stopped (leaves MC1 and V set)."""
        procedure = motion.jog(
            self._session, self.number, velocity, acceleration=acceleration, deceleration=deceleration
        )
        await self._run(procedure)

    async def home(
        self, *, negative: bool = False, wait: bool = True, timeout_s: float = motion.MOVE_TIMEOUT_S
    ) -> None:
        """Search the home input, and wait until it is found; MotionError if it is not."""
        await self._run(
            motion.home(self._session, self.number, negative=negative, timeout_s=timeout_s if wait else None)
        )

    async def stop(self, *, wait: bool = False, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Decelerate and stop (!S)."""
        await self._run(motion.stop(self._session, [self.number]))
        if wait:
            await self.wait_until_stopped(timeout_s=timeout_s)

    async def kill(self) -> None:
        """Stop at once (!K)."""
        await self._run(motion.kill(self._session, [self.number]))

    async def wait_until_stopped(self, *, timeout_s: float = motion.MOVE_TIMEOUT_S) -> AxisWord:
        """Until no motion is commanded; NoAnswer if it goes on."""
        return await self._run(motion.wait_until_stopped(self._session, self.number, timeout_s=timeout_s))

    async def wait_until_settled(self, *, timeout_s: float = motion.MOVE_TIMEOUT_S) -> AxisWord:
        """Until the move is over and the axis in its target zone; MotionError, NoAnswer."""
        return await self._run(motion.wait_until_settled(self._session, self.number, timeout_s=timeout_s))


class Status(AwaitableFace):
    """The status words."""

    async def axis(self, axis: int) -> AxisWord:
        """AS of an axis (TAS)."""
        return await self._run(motion.axis_status(self._session, axis))

    async def extended_axis(self, axis: int) -> ExtendedAxisWord:
        """ASX of an axis (TASX)."""
        return ExtendedAxisWord(await self._run(bits(self._session, "TASX", axis)), ExtendedAxisFlags)

    async def following(self, axis: int) -> FollowingWord:
        """FS of an axis (TFS)."""
        return FollowingWord(await self._run(bits(self._session, "TFS", axis)), FollowingFlags)

    async def system(self) -> SystemWord:
        """SS (TSS)."""
        return await self._run(programs.system_status(self._session))

    async def error(self) -> ErrorWord:
        """ER (TER)."""
        return ErrorWord(await self._run(bits(self._session, "TER")), ErrorFlags)

    async def other_inputs(self) -> OtherInputWord:
        """INO (TINO)."""
        return OtherInputWord(await self._run(bits(self._session, "TINO")), OtherInputFlags)


class Programs(AwaitableFace):
    """The stored programs."""

    async def directory(self) -> list[programs.StoredProgram]:
        """What is stored (TDIR)."""
        return await self._run(programs.directory(self._session))

    async def exists(self, name: str) -> bool:
        """Whether a program is stored."""
        return any(entry.name == name.upper() for entry in await self.directory())

    async def upload(self, name: str) -> list[str]:
        """The commands of a program (TPROG); UnitError if there is none."""
        return await self._run(programs.upload(self._session, name))

    async def download(
        self,
        name: str,
        text: str | Iterable[str],
        *,
        replace: bool = True,
        verify: bool = True,
        progress: programs.Progress | None = None,
    ) -> int:
        """Store a program from its text (comments allowed) and compare the unit's listing; the number of commands.

        Raises:
            UnitError, VerificationError, InDefinition: see clients.programs.download.
        """
        procedure = programs.download(self._session, name, text, replace=replace, verify=verify, progress=progress)
        return await self._run(procedure)

    async def delete(self, name: str) -> None:
        """DEL."""
        await self._run(self._session.buffered(f"DEL {name}"))

    async def run(self, name: str, *, wait: bool = False, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Start a program (!RUN); UnitError if there is none."""
        await self._run(programs.run(self._session, name, timeout_s=timeout_s if wait else None))

    async def wait_until_ended(self, *, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Until no program runs; NoAnswer if one goes on."""
        await self._run(programs.wait_until_ended(self._session, timeout_s=timeout_s))

    async def halt(self) -> None:
        """End the running program; motion goes on (!HALT)."""
        await self._run(programs.halt(self._session))


class _Variables(AwaitableFace):
    """Variables by number, 1 first."""


class RealVariables(_Variables):
    """`ctl.var[1] = 2.5`; reading gives the exact Decimal."""

    async def get(self, index: int) -> Decimal:
        """The value of variable `index`."""
        return await self._run(variables.get_number(self._session, index))

    async def set(self, index: int, value: Number) -> None:
        """Set variable `index`."""
        await self._run(variables.set_number(self._session, index, value))


class BinaryVariables(_Variables):
    """`ctl.varb[1] = "11X0"` (bit 1 first) or an integer; reading gives 32 characters."""

    async def get(self, index: int) -> str:
        """The value of variable `index`."""
        return await self._run(variables.get_bits(self._session, index))

    async def set(self, index: int, value: str | int) -> None:
        """Set variable `index`."""
        await self._run(variables.set_bits(self._session, index, value))


class TextVariables(_Variables):
    """`ctl.vars[1] = "part"`."""

    async def get(self, index: int) -> str:
        """The value of variable `index`."""
        return await self._run(variables.get_text(self._session, index))

    async def set(self, index: int, value: str) -> None:
        """Set variable `index`."""
        await self._run(variables.set_text(self._session, index, value))


class Axes(AwaitableFace):
    """The axes by number, 1 first."""

    def __getitem__(self, axis: int) -> AsyncAxis:
        if axis < 1:
            raise IndexError(f"axes count from 1: {axis}")
        return AsyncAxis(self._run, self._session, axis)
