"""The parts of the blocking face: the driver of a line, axes, status words, programs, variables."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from decimal import Decimal
from typing import TypeVar

from clients import gains as gain_sets
from clients import motion, programs, variables
from clients.effects import Converse, Procedure, Receive, Send
from clients.errors import ClientError, LineLost
from clients.faces import BlockingFace
from clients.gains import Gains
from clients.lines import Line
from clients.status import ErrorFlags, ExtendedAxisFlags, FollowingFlags, OtherInputFlags
from clients.typed.blocking import AxisCommands
from clients.typed.words import AxisWord, ErrorWord, ExtendedAxisWord, FollowingWord, OtherInputWord, SystemWord
from clients.values import Number, bits

T = TypeVar("T")


class Driver:
    """Carries procedures out on a line, one at a time."""

    def __init__(self, line: Line) -> None:
        self.line = line
        self.lock = threading.RLock()
        self._sleep: Callable[[float], None] | None = getattr(line, "sleep", None)

    def run(self, procedure: Procedure[T]) -> T:
        """Carry out what the procedure wants; its result."""
        with self.lock:
            data = b""
            try:
                effect = next(procedure)
                while True:
                    if isinstance(effect, Converse):
                        data = self._converse(effect.data, effect.timeout_s)
                    elif isinstance(effect, Receive):
                        data = self._read(effect.timeout_s)
                    elif isinstance(effect, Send):
                        self._write(effect.data)
                        data = b""
                    else:
                        data = self._pause(effect.seconds)
                    effect = procedure.send(data)
            except StopIteration as stop:
                result: T = stop.value
                return result

    def _converse(self, data: bytes, timeout_s: float) -> bytes:
        try:
            self.line.write(data)
            return self.line.read(timeout_s)
        except OSError as error:
            raise self._lost(error) from error

    def _read(self, timeout_s: float) -> bytes:
        try:
            return self.line.read(timeout_s)
        except OSError as error:
            raise self._lost(error) from error

    def _write(self, data: bytes) -> None:
        try:
            self.line.write(data)
        except OSError as error:
            raise self._lost(error) from error

    def _lost(self, error: OSError) -> Exception:
        return error if isinstance(error, ClientError) else LineLost(self.line.name, error)

    def _pause(self, seconds: float) -> bytes:
        """Let time pass, and others use the line meanwhile. A line with a time of its own and no `sleep` passes time
        by reading."""
        if self._sleep is None:
            return self._read_for(seconds)
        self.lock.release()
        try:
            self._sleep(seconds)
        finally:
            self.lock.acquire()
        return b""

    def _read_for(self, seconds: float) -> bytes:
        end, got = self.line.clock() + seconds, b""
        while (left := end - self.line.clock()) > 0:
            got += self._read(left)
        return got


class Axis(AxisCommands):
    """One axis: its typed commands, and motion."""

    @property
    def number(self) -> int:
        """Counts from 1."""
        assert self._axis is not None
        return self._axis

    @property
    def status(self) -> AxisWord:
        """AS."""
        return self._run(motion.axis_status(self._session, self.number))

    @property
    def gains(self) -> Gains:
        """The gains in force (TGAIN); setting them sends SGP and the rest."""
        return self._run(gain_sets.active(self._session))[self.number - 1]

    @gains.setter
    def gains(self, value: Gains) -> None:
        self._run(gain_sets.put(self._session, self.number, value))

    def move_to(
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
        self._move(position, True, velocity, acceleration, deceleration)
        if wait:
            self.wait_until_settled(timeout_s=timeout_s)

    def move_by(
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
        self._move(distance, False, velocity, acceleration, deceleration)
        if wait:
            self.wait_until_settled(timeout_s=timeout_s)

    def _move(
        self, target: Number, absolute: bool, velocity: Number | None, acc: Number | None, dec: Number | None
    ) -> None:
        session, axis = self._session, self.number
        procedure = motion.begin_move(
            session, axis, target, absolute=absolute, velocity=velocity, acceleration=acc, deceleration=dec
        )
        self._run(procedure)

    def jog(self, velocity: Number, *, acceleration: Number | None = None, deceleration: Number | None = None) -> None:
        """Run at a signed velocity until stopped (leaves MC1 and V set)."""
        procedure = motion.jog(
            self._session, self.number, velocity, acceleration=acceleration, deceleration=deceleration
        )
        self._run(procedure)

    def home(self, *, negative: bool = False, wait: bool = True, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Search the home input, and wait until it is found; MotionError if it is not."""
        self._run(motion.home(self._session, self.number, negative=negative, timeout_s=timeout_s if wait else None))

    def stop(self, *, wait: bool = False, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Decelerate and stop (!S)."""
        self._run(motion.stop(self._session, [self.number]))
        if wait:
            self.wait_until_stopped(timeout_s=timeout_s)

    def kill(self) -> None:
        """Stop at once (!K)."""
        self._run(motion.kill(self._session, [self.number]))

    def wait_until_stopped(self, *, timeout_s: float = motion.MOVE_TIMEOUT_S) -> AxisWord:
        """Until no motion is commanded; NoAnswer if it goes on."""
        return self._run(motion.wait_until_stopped(self._session, self.number, timeout_s=timeout_s))

    def wait_until_settled(self, *, timeout_s: float = motion.MOVE_TIMEOUT_S) -> AxisWord:
        """Until the move is over and the axis in its target zone; MotionError, NoAnswer."""
        return self._run(motion.wait_until_settled(self._session, self.number, timeout_s=timeout_s))


class Status(BlockingFace):
    """The status words."""

    def axis(self, axis: int) -> AxisWord:
        """AS of an axis (TAS)."""
        return self._run(motion.axis_status(self._session, axis))

    def extended_axis(self, axis: int) -> ExtendedAxisWord:
        """ASX of an axis (TASX)."""
        return ExtendedAxisWord(self._run(bits(self._session, "TASX", axis)), ExtendedAxisFlags)

    def following(self, axis: int) -> FollowingWord:
        """FS of an axis (TFS)."""
        return FollowingWord(self._run(bits(self._session, "TFS", axis)), FollowingFlags)

    def system(self) -> SystemWord:
        """SS (TSS)."""
        return self._run(programs.system_status(self._session))

    def error(self) -> ErrorWord:
        """ER (TER)."""
        return ErrorWord(self._run(bits(self._session, "TER")), ErrorFlags)

    def other_inputs(self) -> OtherInputWord:
        """INO (TINO)."""
        return OtherInputWord(self._run(bits(self._session, "TINO")), OtherInputFlags)


class Programs(BlockingFace):
    """The stored programs."""

    def directory(self) -> list[programs.StoredProgram]:
        """What is stored (TDIR)."""
        return self._run(programs.directory(self._session))

    def __contains__(self, name: str) -> bool:
        return any(entry.name == name.upper() for entry in self.directory())

    def upload(self, name: str) -> list[str]:
        """The commands of a program (TPROG); UnitError if there is none."""
        return self._run(programs.upload(self._session, name))

    def download(
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
        return self._run(procedure)

    def delete(self, name: str) -> None:
        """DEL."""
        self._run(self._session.buffered(f"DEL {name}"))

    def run(self, name: str, *, wait: bool = False, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Start a program (!RUN); UnitError if there is none."""
        self._run(programs.run(self._session, name, timeout_s=timeout_s if wait else None))

    def wait_until_ended(self, *, timeout_s: float = motion.MOVE_TIMEOUT_S) -> None:
        """Until no program runs; NoAnswer if one goes on."""
        self._run(programs.wait_until_ended(self._session, timeout_s=timeout_s))

    def halt(self) -> None:
        """End the running program; motion goes on (!HALT)."""
        self._run(programs.halt(self._session))


class _Variables(BlockingFace):
    """Variables by number, 1 first."""


class RealVariables(_Variables):
    """`ctl.var[1] = 2.5`; reading gives the exact Decimal."""

    def __getitem__(self, index: int) -> Decimal:
        return self._run(variables.get_number(self._session, index))

    def __setitem__(self, index: int, value: Number) -> None:
        self._run(variables.set_number(self._session, index, value))


class BinaryVariables(_Variables):
    """`ctl.varb[1] = "11X0"` (bit 1 first) or an integer; reading gives 32 characters."""

    def __getitem__(self, index: int) -> str:
        return self._run(variables.get_bits(self._session, index))

    def __setitem__(self, index: int, value: str | int) -> None:
        self._run(variables.set_bits(self._session, index, value))


class TextVariables(_Variables):
    """`ctl.vars[1] = "part"`."""

    def __getitem__(self, index: int) -> str:
        return self._run(variables.get_text(self._session, index))

    def __setitem__(self, index: int, value: str) -> None:
        self._run(variables.set_text(self._session, index, value))


class Axes(BlockingFace):
    """The axes by number, 1 first."""

    def __getitem__(self, axis: int) -> Axis:
        if axis < 1:
            raise IndexError(f"axes count from 1: {axis}")
        return Axis(self._run, self._session, axis)
