"""The virtual serial port: a pseudo-terminal that host software opens like any serial device.

A pseudo-terminal differs from a cable in four ways, each made good here:

- When the last process closes the slave, the kernel resets its settings and our reads fail. So we hold it open.
- It comes up as a terminal, with echo and line editing. It is set to raw, and again after each host, because hosts
  leave their own settings behind. Baud rates are remembered by the kernel and mean nothing.
- It keeps what nobody reads, and the next host would find it. While no host has it open output is lost, as on a cable
  with nothing on its other end; when the last host closes it, what it has not read is flushed.
- It blocks the writer when it is full. Output beyond a small bound is discarded instead, and commands go on.

That a host has come or gone takes its turn in the channel, in order with the bytes: replies to a host that has left
meanwhile are computed before the next one is let in, and so are lost. Half a command of a host that
closed is forgotten; motion, settings and complete commands stay. When one host closes and another opens before we have
looked, the unread bytes in the kernel cannot be told apart and count as the new host's: a reply too many, as on a
cable, is better than one too few.
"""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import os
import termios
import warnings
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import platformdirs

from emulator.channel import Channel
from emulator.pacing import EngineThread
from emulator.ports.errors import PortError
from emulator.ports.link import make_auto_link, make_link, remove_link
from emulator.ports.outlet import Outlet
from emulator.ports.presence import Presence

BACKLOG_BYTES = 64 * 1024
"""Unread output kept beside the kernel's 4 to 20 KiB: the longest listing of a full memory (design choice)."""
READ_BYTES = 4096
READS_AT_CLOSE = 64
"""The kernel holds no more than this many portions of a host that wrote and closed."""


class PtyPort:
    """One pseudo-terminal with a link to it. `link` is a path or "auto". Raises PortError if it cannot be made."""

    def __init__(self, link: str = "auto") -> None:
        try:
            self._master, self._slave = os.openpty()
        except OSError as error:
            raise PortError(f"--pty {link}: no pseudo-terminal to be had ({error.strerror})") from None
        self.node = os.ttyname(self._slave)
        os.set_blocking(self._master, False)
        _set_raw(self._slave)
        self._presence = Presence(self.node)
        self._seen_present = False
        self._host_present = not self._presence.known
        self._loop: asyncio.AbstractEventLoop | None = None
        try:
            self.path = _make(link, self.node)
        except PortError:
            self._close_descriptors()
            raise

    def serve(self, loop: asyncio.AbstractEventLoop, engine: EngineThread, unit_index: int = 0) -> None:
        """Connect it to a unit."""
        self._loop, self._engine = loop, engine
        write = partial(os.write, self._master)
        self._outlet = Outlet(
            loop, self._master, write, name=f"pty:{self.path}", on_broken=lambda: None, limit_bytes=BACKLOG_BYTES
        )
        self._channel = engine.attach(unit_index, self)

    @property
    def descriptors(self) -> tuple[int, ...]:
        """The master, and what tells of openings and closings."""
        return (self._master, self._presence.fileno()) if self._presence.known else (self._master,)

    def stop_accepting(self) -> None:
        """Remove the link, if it is still ours; whoever has the port open keeps it."""
        remove_link(self.path, self.node)

    def close(self) -> None:
        """Close everything. The engine thread must have ended, or never have begun."""
        self.stop_accepting()
        if self._loop is not None:
            self._outlet.close()
            self._loop = None
        self._close_descriptors()

    # Engine thread.

    def send(self, data: bytes) -> None:
        """To the host, if there is one."""
        if self._host_present:
            self._outlet.send(data)

    def arrived(self, channel: Channel) -> None:
        """First who has come and gone, then bytes, so that these never arrive before the host they come from."""
        before, change = self._seen_present, self._presence.poll()
        self._seen_present = change.present
        if change.left and not change.present:
            self._take_leave(channel)
            return
        if change.left:
            channel.waiting.append(self._let_out)
        if change.present and (change.left or not before):
            channel.waiting.append(self._let_in)
        self._append(channel, self._read())

    def _take_leave(self, channel: Channel) -> None:
        """What the host wrote before it closed is still executed, unless it may be the next one's already."""
        data = b"".join(self._last_words())
        change = self._presence.poll()
        self._seen_present = change.present
        if not change.present:
            self._append(channel, data)
            channel.waiting.append(self._let_out)
        else:
            channel.waiting.extend((self._let_out, self._let_in))
            self._append(channel, data)

    def _append(self, channel: Channel, data: bytes) -> None:
        if data:
            channel.waiting.append(data)

    def _read(self) -> bytes:
        """One portion; empty when there is none. (EIO cannot be: we hold the other side open.)"""
        try:
            return os.read(self._master, READ_BYTES)
        except OSError:
            return b""

    def _last_words(self) -> Iterator[bytes]:
        for _ in range(READS_AT_CLOSE):
            data = self._read()
            if not data:
                return
            yield data

    def _let_in(self) -> None:
        self._flush_unread()
        self._host_present = True

    def _let_out(self) -> None:
        self._host_present = False
        self._outlet.void_backlog()
        self._flush_unread()
        with contextlib.suppress(OSError, termios.error):
            fcntl.ioctl(self._slave, termios.TIOCNXCL)
            _set_raw(self._slave)
        self._engine.forget(self._channel)

    def _flush_unread(self) -> None:
        with contextlib.suppress(OSError, termios.error):
            termios.tcflush(self._slave, termios.TCIFLUSH)

    def _close_descriptors(self) -> None:
        self._presence.close()
        for fd in (self._master, self._slave):
            with contextlib.suppress(OSError):
                os.close(fd)
        self._master = self._slave = -1


def _make(link: str, node: str) -> Path:
    if link != "auto":
        return make_link(Path(link), node)
    with warnings.catch_warnings():
        # Where there is no XDG_RUNTIME_DIR the library falls back to a directory of its own, which serves.
        warnings.simplefilter("ignore")
        directory = Path(platformdirs.user_runtime_dir("oem6250"))
    return make_auto_link(directory, node)


def _set_raw(fd: int) -> None:
    """Eight bits through in both directions: no echo, no line editing, no translation, no signals, no flow control."""
    settings = termios.tcgetattr(fd)
    settings[0] = settings[1] = settings[3] = 0
    settings[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
    settings[4] = settings[5] = termios.B9600
    settings[6][termios.VMIN], settings[6][termios.VTIME] = 1, 0
    termios.tcsetattr(fd, termios.TCSANOW, settings)
