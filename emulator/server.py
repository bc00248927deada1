"""From options to a running emulator and back: ports, machines, announcement, signals, exit status.

The order at the start: ports first (a port in use is told at once, not after the machine is built), then the machine,
in a thread, so that a signal is obeyed even while the servo kernel is being compiled; then the engine thread; then
the announcement. At the end: no new connections, engine thread stopped, everything closed.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from emulator.channel import ControllerLike
from emulator.clock import Clock
from emulator.logs import event_line, set_up_logging
from emulator.options import ServeOptions
from emulator.pacing import EngineThread
from emulator.ports import PortError, TcpPort

if TYPE_CHECKING:
    from emulator.state.memory import Memory

_log = logging.getLogger("oem6250.server")
Build = Callable[[ServeOptions], Sequence[ControllerLike]]
"""Makes the controllers of a server; runs in a thread of its own. Raises UserError for what is the user's to mend."""


class UserError(Exception):
    """Something the user can mend; the text is one line."""


class _Port(Protocol):
    def serve(self, loop: asyncio.AbstractEventLoop, engine: EngineThread, unit_index: int = 0) -> None: ...
    def stop_accepting(self) -> None: ...
    def close(self) -> None: ...


def serve(options: ServeOptions, build: Build | None = None) -> int:
    """Serve until a signal. Exit status: 0, 1 after a crash of the engine thread, 2 for a user's mistake."""
    set_up_logging(options.verbosity)
    try:
        with _memory(options.state if build is None else None) as memory:
            server = Server(options, build or partial(build_controllers, memory=memory), memory)
            with asyncio.Runner(loop_factory=asyncio.SelectorEventLoop) as runner:
                return runner.run(server.run())
    except (PortError, UserError) as error:
        print(f"oem6250: {error}", file=sys.stderr)
        return 2


@contextlib.contextmanager
def _memory(path: str | None) -> Iterator[Memory | None]:
    """The non-volatile memory in a file, if there is to be one."""
    if path is None:
        yield None
        return
    from emulator.state.memory import Memory, StateError

    try:
        memory = Memory(path)
    except StateError as error:
        raise UserError(f"--state {error}") from None
    with memory:
        yield memory


def build_controllers(options: ServeOptions, memory: Memory | None = None) -> Sequence[ControllerLike]:
    """The machine of the options, or a chain of several like it on the one line, with what `memory` has of them."""
    from emulator.chain import build_chain
    from emulator.machine import Machine, MachineError

    try:
        machine = Machine.load(Path(options.machine)) if options.machine else Machine.default()
    except MachineError as error:
        raise UserError(str(error)) from None
    chain = build_chain(machine.on_line(options.line_baud), options.units, on_build=_say)
    if memory is not None:
        memory.restore([chain])
        if options.record is not None:
            from emulator.recording.session import stored_memory

            memory.at_start = stored_memory(chain)
    chain.power_up()
    return [chain if options.units > 1 else chain.controllers[0]]


class Server:
    """One running emulator. `run` returns when it was told to stop."""

    def __init__(self, options: ServeOptions, build: Build, memory: Memory | None = None) -> None:
        self._options = options
        self._memory = memory
        self._build = build
        self._stop = asyncio.Event()
        self._tcp: list[TcpPort] = []
        self._pty: Any = None
        self._serial: list[Any] = []
        self._serving: tuple[EngineThread, Sequence[ControllerLike]] | None = None
        self._had_terminal = _has_terminal()
        self._end_recording: Callable[[], None] = lambda: None
        self._status = 0

    async def run(self) -> int:
        """Open, build, serve, close. Raises PortError and UserError."""
        loop = asyncio.get_running_loop()
        self._handle_signals(loop)
        try:
            self._open_ports()
            controllers = await self._build_or_stop(loop)
            if controllers is not None:
                await self._serve(loop, controllers)
        finally:
            for port in self._ports():
                port.close()
        return self._status

    def _ports(self) -> list[_Port]:
        return [*self._tcp, *([self._pty] if self._pty else []), *self._serial]

    def _open_ports(self) -> None:
        options = self._options
        for host, port in options.tcp:
            self._tcp.append(TcpPort(host, port, allow_remote=options.allow_remote))
        for host, port in options.telnet:
            self._tcp.append(TcpPort(host, port, negotiate=True, allow_remote=options.allow_remote))
        if self._options.pty is not None:
            self._pty = _open_pty(self._options.pty)
        for address in self._options.serial:
            from emulator.ports.serial_port import SerialPort

            self._serial.append(SerialPort(address))

    def _handle_signals(self, loop: asyncio.AbstractEventLoop) -> None:
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            if hasattr(signal, name):
                # Meant: the event loop of Windows has no signal handlers; there Ctrl-C ends the process.
                with contextlib.suppress(NotImplementedError):
                    loop.add_signal_handler(
                        getattr(signal, name), self._hang_up if name == "SIGHUP" else self._stop.set
                    )

    def _hang_up(self) -> None:
        """Read the machine file again, or end: without a file, and when the terminal was closed."""
        if self._options.machine is None or (self._had_terminal and not _has_terminal()):
            self._stop.set()
        elif self._serving is not None:
            from emulator.reload import reload_machine_file

            reload_machine_file(Path(self._options.machine), *self._serving, line_baud=self._options.line_baud)

    async def _build_or_stop(self, loop: asyncio.AbstractEventLoop) -> Sequence[ControllerLike] | None:
        """The controllers, or None if a signal came first (the thread that still builds dies with the process)."""
        built: asyncio.Future[Sequence[ControllerLike]] = loop.create_future()
        threading.Thread(target=self._build_there, args=(loop, built), name="build", daemon=True).start()
        stopped = asyncio.ensure_future(self._stop.wait())
        await asyncio.wait((built, stopped), return_when=asyncio.FIRST_COMPLETED)
        if built.done():
            stopped.cancel()
            return built.result()
        for port in self._ports():
            port.close()
        sys.stderr.flush()
        os._exit(0)

    def _build_there(self, loop: asyncio.AbstractEventLoop, built: asyncio.Future[Sequence[ControllerLike]]) -> None:
        try:
            controllers = self._build(self._options)
        except BaseException as error:
            loop.call_soon_threadsafe(built.set_exception, error)
        else:
            loop.call_soon_threadsafe(built.set_result, controllers)

    async def _serve(self, loop: asyncio.AbstractEventLoop, controllers: Sequence[ControllerLike]) -> None:
        strict_baud = _strict_baud(controllers)
        if self._options.record is not None:
            controllers, self._end_recording = _record(self._options, controllers, self._memory)
        start_ns = max((controller.now_ns for controller in controllers), default=0)
        clock = Clock(self._options.speed, start_ns=start_ns, report=self._too_slow)
        crashed = partial(_soon, loop, self._crashed)
        engine = EngineThread(
            controllers, clock, on_crash=crashed, shared_line=self._options.shared_line, memory=self._memory
        )
        for strict in (*self._tcp, *self._serial):
            strict.strict_baud = strict_baud
        for port in self._ports():
            port.serve(loop, engine)
        engine.start()
        self._serving = (engine, controllers)
        self._tell()
        try:
            await self._stop.wait()
        finally:
            for port in self._ports():
                port.stop_accepting()
            stopped = engine.stop() if self._memory is None else engine.stop(self._memory.stop_patience_s)
            _log.info(event_line("stopped", **engine.lateness()._asdict()))
            if stopped:
                self._end_recording()
        if not stopped:
            self._leave_at_once()

    def _leave_at_once(self) -> None:
        """A controller is stuck: descriptors it may still write to are left to the end of the process."""
        _log.error(event_line("engine thread does not end"))
        sys.stderr.flush()
        os._exit(1)

    def _crashed(self) -> None:
        self._status = 1
        self._stop.set()

    def _too_slow(self, factor: float) -> None:
        asked = "max" if self._options.speed is None else self._options.speed
        _log.warning(event_line("host too slow", asked_speed=asked, reached_speed=f"{factor:.3g}"))

    # What is said once it runs.

    def _addresses(self, *, negotiate: bool = False) -> list[str]:
        return [address for port in self._tcp if port.negotiate == negotiate for address in port.addresses]

    def _tell(self) -> None:
        options = self._options
        if remote := [address for port in self._tcp for address in port.remote_addresses]:
            _say(f"--allow-remote: whoever reaches {', '.join(remote)} commands the unit; there is no password")
        if options.announce is not None:
            announce(options.announce, self._announcement())
        else:
            telnet = self._addresses(negotiate=True)
            serial = [port.name for port in self._serial]
            _say_hints(self._addresses(), telnet=telnet, pty=self._pty and str(self._pty.path), serial=serial)

    def _announcement(self) -> str:
        speed = "max" if self._options.speed is None else self._options.speed
        pty = str(self._pty.path) if self._pty else None
        told: dict[str, object] = {"tcp": self._addresses(), "pty": pty, "pid": os.getpid(), "speed": speed}
        if telnet := self._addresses(negotiate=True):
            told["telnet"] = telnet
        if self._serial:
            told["serial"] = [port.address.device for port in self._serial]
        return json.dumps(told)


def _strict_baud(controllers: Sequence[ControllerLike]) -> int | None:
    """The unit's baud rate, if hosts at another one shall not understand it; None if all may."""
    chain: Any = controllers[0] if controllers else None
    machine = getattr(getattr(chain, "controllers", [chain])[0], "machine", None)
    if machine is None or not machine.serial.strict_baud:
        return None
    from emulator.ports.baud import unit_baud

    return unit_baud(machine)


def _record(
    options: ServeOptions, controllers: Sequence[ControllerLike], memory: Memory | None
) -> tuple[Sequence[ControllerLike], Callable[[], None]]:
    """The units to serve, recorded, and what to call when they have stopped."""
    from emulator.recording import RecordingError
    from emulator.recording.serving import record

    try:
        return record(options, controllers, state=None if memory is None else memory.at_start)
    except RecordingError as error:
        raise UserError(f"--record {error}") from None


def _soon(loop: asyncio.AbstractEventLoop, function: Callable[[], None]) -> None:
    loop.call_soon_threadsafe(function)


def _has_terminal() -> bool:
    """Whether the process belongs to a terminal (a service does not)."""
    try:
        os.close(os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY))
    except OSError:
        return False
    return True


def _open_pty(link: str) -> Any:
    try:
        from emulator.ports.pty import PtyPort
    except ImportError:
        raise PortError(f"--pty {link}: this system has no pseudo-terminals; use --pty none and --tcp") from None
    return PtyPort(link)


def announce(place: str, line: str) -> None:
    """One line on stdout, or a file that appears complete."""
    if place == "-":
        print(line, flush=True)
        return
    path = Path(place)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        temporary.write_text(line + "\n")
        temporary.replace(path)
    except OSError as error:
        raise UserError(f"--announce {place}: cannot be written ({error.strerror})") from None


def _say(message: str) -> None:
    """One line for the person who started it."""
    print(f"oem6250: {message}", file=sys.stderr, flush=True)


def _say_hints(addresses: Sequence[str], *, telnet: Sequence[str], pty: str | None, serial: Sequence[str] = ()) -> None:
    """Where to connect and what to type first; for a person, since programs use --announce.

    The dash before the port number has the telnet of Unix speak first, without which it would show its own echo
    beside the unit's.
    """
    lines = ["OEM6250 is up; Ctrl-C ends it."]
    if pty:
        lines.append(f"  serial port   {pty}   (any baud rate; try: python3 -m serial.tools.miniterm --eol CR {pty})")
    lines += [f"  serial port   {name}   (your host is on the other end of its cable)" for name in serial]
    for name, places, dash in (("TCP   ", addresses, "-"), ("telnet", telnet, "")):
        for host, _, port in (address.rpartition(":") for address in places):
            command = f"telnet {'-- ' if dash else ''}{host.strip('[]')} {dash}{port}"
            lines.append(f"  {name}        {host}:{port}   (try: {command})")
    lines.append("  then type     DRIVE11  D4000  GO1  1TPE   each with Enter: axis 1 makes one revolution")
    print("\n".join(lines), file=sys.stderr, flush=True)
