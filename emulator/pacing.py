"""The engine thread: the one thread that owns the machines.

It sleeps until bytes arrive or a tick is due. Bytes run their controller up to *now* first (a position read must not
be as old as the last tick). A tick runs every controller up to now: each millisecond while anything is under way, so
that output which comes by itself is punctual, and each twenty otherwise, when nothing can happen but input.

The thread waits on the connections itself, reads them and writes to them, without ever blocking. The event loop accepts
and closes them and deals with whatever is slow. Passing each request from the loop to this thread and each reply back
was measured at two to three times the round trip of a bare echo and half its throughput, because two threads then
wake each other and wait for the interpreter lock four times per request.

A controller that raises is logged with the bytes and the virtual time that did it and goes on; one that raises again
and again is taken out of service. The others never notice.
"""

from __future__ import annotations

import contextlib
import logging
import select
import selectors
import socket
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from itertools import count
from queue import SimpleQueue
from typing import Protocol, TypeVar

from emulator.channel import Channel, ControllerLike, HearsOfConnections, Item, OutputLike, Wire
from emulator.clock import Clock, Lateness
from emulator.logs import event_line

BUSY_TICK_NS = 1_000_000
IDLE_TICK_NS = 20_000_000
STAY_AWAKE_NS = 100_000
"""After input the thread looks for more this long before it sleeps: hosts often ask again at once, and waking a
sleeping processor costs more than the answer (a host that polls a hundred times a second pays one per cent for it)."""
FINE_WAIT_S = 0.0015
"""Waits up to this long are kept to the microsecond."""
MAX_LINGERING = 64
"""Half-closed connections that may wait for a busy unit; beyond it the oldest is closed (design choice)."""
FAILURES_TO_RETIRE = 10
FAILURE_SPAN_NS = 10_000_000_000
"""Ten exceptions within ten seconds take a unit out of service (design choice)."""

T = TypeVar("T")
_log = logging.getLogger("oem6250.engine")


class MemoryLike(Protocol):
    """Non-volatile memory in a file, on the engine thread; see `emulator.state.memory.Memory`."""

    def run(
        self, *, post: Callable[[Callable[[], None]], None], release: Callable[[int, Sequence[OutputLike]], None]
    ) -> None: ...
    def hold_back(self, line_index: int, outputs: Sequence[OutputLike]) -> Sequence[OutputLike]: ...
    def holds(self, line_index: int) -> bool: ...
    def finish(self) -> None: ...


class _Unit:
    """A controller, its channels, and how often it has failed of late."""

    def __init__(self, index: int, controller: ControllerLike) -> None:
        self.index = index
        self.controller = controller
        self.channels: dict[int | None, Channel] = {}
        self.failures: deque[int] = deque(maxlen=FAILURES_TO_RETIRE)
        self.in_service = True

    @property
    def busy(self) -> bool:
        return self.in_service and self.controller.busy


class EngineThread:
    """Runs `controllers` to the clock's time and moves their bytes. Start it once, stop it once.

    `on_crash` is called on the engine thread if the thread itself, not a controller, fails. With `shared_line` every
    connection of a unit hears everything the unit sends. With `memory` output waits until what precedes it is durable.
    """

    def __init__(
        self,
        controllers: Sequence[ControllerLike],
        clock: Clock,
        *,
        on_crash: Callable[[], None] = lambda: None,
        shared_line: bool = False,
        memory: MemoryLike | None = None,
    ) -> None:
        self.clock = clock
        self._memory = memory
        if memory is not None:
            memory.run(post=self._post, release=self._release)
        self._shared_line = shared_line
        self._units = [_Unit(index, controller) for index, controller in enumerate(controllers)]
        self._inbox: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._bell, self._ring = socket.socketpair()
        self._selector = selectors.DefaultSelector()
        self._turns: deque[Channel] = deque()
        self._lingering: deque[Channel] = deque()
        self._held: list[Channel] = []
        self._outgoing: dict[Channel, list[bytes]] = {}
        self._numbers = count()
        self._on_crash = on_crash
        self._stopping = False
        self._busy = False
        self._next_tick_ns = 0
        self._awake_until_ns = 0
        self._bell.setblocking(False)
        self._ring.setblocking(False)
        self._selector.register(self._bell, selectors.EVENT_READ, None)
        self._selector_fd: int | None = getattr(self._selector, "fileno", lambda: None)()
        self._traffic = _log if _log.isEnabledFor(logging.INFO) else None
        self._thread = threading.Thread(target=self._run, name="engine", daemon=True)

    # What any thread may call.

    def start(self) -> None:
        self._thread.start()

    def stop(self, timeout_s: float = 0.5) -> bool:
        """End the thread; calls that have not run are cancelled. False if it did not end in time."""
        self._post(self._stop_here)
        self._thread.join(timeout_s)
        ended = not self._thread.is_alive()
        if ended:
            self._selector.close()
            self._bell.close()
            self._ring.close()
        return ended

    def attach(self, unit_index: int, wire: Wire) -> Channel:
        """A new channel of a unit; from now on `wire` is read, and the unit's output, also the sign-on, reaches it."""
        channel = Channel(unit_index, next(self._numbers), wire)
        self._post(lambda: self._attach_here(channel))
        return channel

    def put(self, channel: Channel, item: Item) -> None:
        """Bytes or a function for a channel, after what waits there: for hosts within this process."""
        self._post(lambda: self._enqueue(channel, item))

    def drop(self, channel: Channel, done: Callable[[], None]) -> None:
        """The connection is lost: execute what was received, detach, call `done` on the engine thread.

        After `done` the wire is never called again, and its descriptors are no longer watched.
        """
        self.put(channel, lambda: self._detach(channel, done))

    def call(self, function: Callable[[], T]) -> Future[T]:
        """Run `function` on the engine thread with all machines at the present time; the future has its result.

        While catching up, the present is one slice nearer. Never wait for the future on the engine thread
        itself. It is cancelled if the thread has ended or ends first.
        """
        future: Future[T] = Future()
        self._post(lambda: self._call_here(function, future))
        if self._stopping and not self._thread.is_alive():
            self._cancel_calls()
        return future

    def lateness(self) -> Lateness:
        """How old the machines were at the latest ticks, in wall nanoseconds (busy ticks only)."""
        return self.clock.lateness.read()

    # What a wire calls on the engine thread.

    def finish(self, channel: Channel, done: Callable[[], None]) -> None:
        """The host will send no more: execute and answer what waits, detach, then call `done` here."""
        self._stop_reading(channel)
        channel.on_finished = done
        channel.waiting.append(lambda: self._linger(channel))

    def lose(self, channel: Channel, done: Callable[[], None]) -> None:
        """The connection is gone: execute what waits, detach, then call `done` here."""
        self._stop_reading(channel)
        channel.waiting.append(lambda: self._detach(channel, done))

    def unplug(self, channel: Channel) -> None:
        """The wire has lost its descriptors for a while; call it while it still names them.

        What waits is executed, half a command after it is dropped, and the channel stays attached.
        """
        self._stop_reading(channel)
        channel.waiting.append(lambda: self.forget(channel))

    def replug(self, channel: Channel) -> None:
        """An unplugged wire has descriptors again; to be called in the channel's turn (`put`)."""
        self._read(channel)

    def forget(self, channel: Channel) -> None:
        """Drop half a command of this channel, which stays attached."""
        self._guarded(self._units[channel.unit_index], channel, b"", self._detach_controller)

    # The loop.

    def _run(self) -> None:
        try:
            while not self._stopping:
                self._collect(self._patience_s())
                self._tick_if_due()
                for _ in range(len(self._turns)):
                    self._take_turn(self._turns.popleft())
                    self._tick_if_due()
                self._send_out()
            self._send_out()
            if self._memory is not None:
                self._memory.finish()
                self._send_out()
        except Exception:
            _log.critical(event_line("engine thread failed"), exc_info=True)
            self._on_crash()
        finally:
            self._cancel_calls()

    def _patience_s(self) -> float:
        """How long the thread may sleep: until the next tick, not at all while there is work."""
        now_ns = time.monotonic_ns()
        if self._turns or now_ns < self._awake_until_ns:
            return 0.0
        return max(0.0, (self._next_tick_ns - now_ns) * 1e-9)

    def _collect(self, patience_s: float) -> None:
        """Wait until something has arrived, and queue it."""
        for key, _ in self._wait(patience_s):
            channel: Channel | None = key.data
            if channel is None:
                self._answer_bell()
            elif not channel.waiting:
                channel.wire.arrived(channel)
                self._awake_until_ns = time.monotonic_ns() + STAY_AWAKE_NS
                if channel.waiting:
                    self._turns.append(channel)

    def _wait(self, patience_s: float) -> list[tuple[selectors.SelectorKey, int]]:
        """What is readable, within the patience.

        epoll counts in milliseconds and rounds up, too coarse for a tick of one; select on epoll's descriptor counts in
        microseconds, for the price of a second system call. An idle unit does without.
        """
        if 0.0 < patience_s <= FINE_WAIT_S and self._selector_fd is not None:
            if not select.select((self._selector_fd,), (), (), patience_s)[0]:
                return []
            patience_s = 0.0
        return self._selector.select(patience_s)

    def _post(self, function: Callable[[], None]) -> None:
        """Have the engine thread do it, soon and in order."""
        self._inbox.put(function)
        with contextlib.suppress(OSError):
            self._ring.send(b"!")

    def _answer_bell(self) -> None:
        with contextlib.suppress(OSError):
            self._bell.recv(4096)
        while not self._inbox.empty():
            self._inbox.get()()

    def _enqueue(self, channel: Channel, item: Item) -> None:
        if not channel.waiting:
            self._turns.append(channel)
        channel.waiting.append(item)

    def _take_turn(self, channel: Channel) -> None:
        if not channel.waiting:
            # Detached since it was put in line: a lingering connection that was let go and turned out to be lost.
            return
        if isinstance(channel.waiting[0], bytes) and self._full(channel):
            self._stop_reading(channel)
            self._held.append(channel)
            return
        item = channel.take()
        if isinstance(item, bytes):
            self._feed(channel, item)
        else:
            self._send_out()
            item()
        if channel.waiting:
            self._turns.append(channel)

    def _full(self, channel: Channel) -> bool:
        return self._units[channel.unit_index].controller.input_full(channel.number)

    def _release_held(self) -> None:
        """Read on from connections whose unit has worked off enough of what they sent."""
        for channel in [channel for channel in self._held if not self._full(channel)]:
            self._held.remove(channel)
            if channel.on_finished is None:
                self._read(channel)
            self._turns.append(channel)

    def _feed(self, channel: Channel, data: bytes) -> None:
        unit = self._units[channel.unit_index]
        if self._traffic:
            self._note("received", unit, channel.number, data, max(unit.controller.now_ns, self.clock.input_ns()))
        self._guarded(unit, channel, data, self._receive)
        if unit.busy and not self._busy:
            self._busy = True
            self._next_tick_ns = min(self._next_tick_ns, time.monotonic_ns() + BUSY_TICK_NS)

    def _tick_if_due(self) -> None:
        if time.monotonic_ns() >= self._next_tick_ns:
            self._tick()

    def _tick(self) -> None:
        began_ns = time.monotonic_ns()
        at_ns = self.clock.tick_ns()
        for unit in self._units:
            self._guarded(unit, None, b"", lambda unit, *_: self._advance(unit, at_ns))
        self._busy = any(unit.busy for unit in self._units)
        self.clock.ran_to(at_ns, busy=self._busy)
        if self._lingering:
            self._release_lingering()
        if self._held:
            self._release_held()
        self._next_tick_ns = self._tick_after(began_ns)

    def _tick_after(self, began_ns: int) -> int:
        """When the next tick is due; busy ones on a grid of milliseconds, so that wake-up delays do not add up."""
        if self.clock.behind or self.clock.free_running:
            return began_ns
        if not self._busy:
            return began_ns + IDLE_TICK_NS
        return began_ns + BUSY_TICK_NS - began_ns % BUSY_TICK_NS

    # What is done to a controller, each under `_guarded`.

    def _receive(self, unit: _Unit, channel: Channel, data: bytes) -> None:
        at_ns = max(unit.controller.now_ns, self.clock.input_ns())
        unit.controller.receive(data, at_ns=at_ns, channel=channel.number)

    def _advance(self, unit: _Unit, at_ns: int) -> None:
        if at_ns > unit.controller.now_ns:
            unit.controller.advance(at_ns)

    def _detach_controller(self, unit: _Unit, channel: Channel, data: bytes) -> None:
        unit.controller.detach(channel.number)

    def _guarded(self, unit: _Unit, channel: Channel | None, data: bytes, step: Callable[..., None]) -> None:
        """Do one step to a controller, then deliver what it has to say; keep its exceptions to itself."""
        if not unit.in_service:
            return
        try:
            step(unit, channel, data)
            outputs = unit.controller.take_output()
        except Exception:
            self._failed(unit, channel, data)
            return
        if self._memory is not None:
            outputs = self._memory.hold_back(unit.index, outputs)
        if outputs:
            self._deliver(unit, outputs)

    def _release(self, unit_index: int, outputs: Sequence[OutputLike]) -> None:
        self._deliver(self._units[unit_index], outputs)

    def _failed(self, unit: _Unit, channel: Channel | None, data: bytes) -> None:
        now_ns = time.monotonic_ns()
        number = None if channel is None else channel.number
        fields = {"unit": unit.index, "channel": number, "at_ns": unit.controller.now_ns, "data": data}
        _log.error(event_line("controller raised", **fields), exc_info=True)
        unit.failures.append(now_ns)
        if len(unit.failures) == FAILURES_TO_RETIRE and now_ns - unit.failures[0] < FAILURE_SPAN_NS:
            unit.in_service = False
            _log.error(event_line("unit taken out of service", unit=unit.index, failures=FAILURES_TO_RETIRE))

    def _deliver(self, unit: _Unit, outputs: Sequence[OutputLike]) -> None:
        """Each channel's output in its order, in one piece."""
        if self._traffic:
            for output in outputs:
                self._note("sent", unit, output.channel, output.data, output.at_ns)
        for output in outputs:
            for number in unit.channels if output.channel is None or self._shared_line else (output.channel,):
                channel = unit.channels.get(number)
                if channel is not None:
                    self._outgoing.setdefault(channel, []).append(output.data)

    def _send_out(self) -> None:
        """Give every channel what has been said to it, in one piece: after all who had their turn, because the first
        write wakes the hosts' processor and the others then find it awake."""
        for channel, parts in self._outgoing.items():
            channel.wire.send(parts[0] if len(parts) == 1 else b"".join(parts))
        self._outgoing.clear()

    def _note(self, event: str, unit: _Unit, channel: int | None, data: bytes, at_ns: int) -> None:
        place = "all" if channel is None else channel
        _log.info(event_line(event, at_s=f"{at_ns * 1e-9:.6f}", unit=unit.index, channel=place, data=data))

    # The end of channels, calls and the thread.

    def _attach_here(self, channel: Channel) -> None:
        unit = self._units[channel.unit_index]
        unit.channels[channel.number] = channel
        if isinstance(unit.controller, HearsOfConnections):
            unit.controller.attach(channel.number)
        self._read(channel)

    def _read(self, channel: Channel) -> None:
        for descriptor in channel.wire.descriptors:
            self._selector.register(descriptor, selectors.EVENT_READ, channel)

    def _stop_reading(self, channel: Channel) -> None:
        for descriptor in channel.wire.descriptors:
            with contextlib.suppress(KeyError):
                self._selector.unregister(descriptor)

    def _linger(self, channel: Channel) -> None:
        self._lingering.append(channel)
        self._release_lingering()

    def _release_lingering(self) -> None:
        """Let go of half-closed connections whose unit has nothing more to say, and of the oldest if they are many."""
        for channel in list(self._lingering):
            if len(self._lingering) > MAX_LINGERING or not self._has_more_to_say(self._units[channel.unit_index]):
                self._detach(channel, channel.on_finished or (lambda: None))

    def _has_more_to_say(self, unit: _Unit) -> bool:
        return unit.busy or (self._memory is not None and self._memory.holds(unit.index))

    def _detach(self, channel: Channel, done: Callable[[], None]) -> None:
        self._send_out()
        unit = self._units[channel.unit_index]
        if channel.number in unit.channels:
            self._stop_reading(channel)
            self._guarded(unit, channel, b"", self._detach_controller)
            del unit.channels[channel.number]
            channel.waiting.clear()
        if channel in self._lingering:
            self._lingering.remove(channel)
        done()

    def _call_here(self, function: Callable[[], T], future: Future[T]) -> None:
        if self._stopping or not future.set_running_or_notify_cancel():
            future.cancel()
            return
        self._tick()
        try:
            future.set_result(function())
        except BaseException as error:
            future.set_exception(error)
        self._tick()

    def _stop_here(self) -> None:
        self._stopping = True

    def _cancel_calls(self) -> None:
        """Whatever has not run will not: futures are cancelled."""
        self._stopping = True
        while not self._inbox.empty():
            self._inbox.get()()
