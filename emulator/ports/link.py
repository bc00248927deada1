"""The symbolic link by which hosts find the pseudo-terminal.

A link is only ever replaced when the pseudo-terminal it leads to is dead. Numbers of dead ones are soon used again, by
somebody's terminal window for instance, so "the target exists" is not enough: a device node that was made after the
link cannot be the one the link was made for. The directory is locked while looking and linking, so that two
emulators starting at once never take each other's name.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from emulator.ports.errors import PortError

MAX_AUTO_LINKS = 1000


def make_link(path: Path, target: str) -> Path:
    """Make `path` a link to `target`; returns it absolute. PortError if something that is not a dead link is there."""
    path = path.expanduser().absolute()
    try:
        with _locked(path.parent):
            _require_free(path, target)
            _replace(path, target)
    except OSError as error:
        raise PortError(f"--pty {path}: cannot make the link ({error.strerror})") from None
    return path


def make_auto_link(directory: Path, target: str) -> Path:
    """The first of `tty0`, `tty1`, ... in `directory` (made, mode 0700, if missing) that no live one holds."""
    try:
        directory.mkdir(mode=0o700, parents=True, exist_ok=True)
        with _locked(directory):
            path = next(path for path in _names(directory) if _is_free(path, target))
            _replace(path, target)
    except OSError as error:
        raise PortError(f"--pty auto: cannot make a link in {directory} ({error.strerror})") from None
    except StopIteration:
        raise PortError(f"--pty auto: all names in {directory} are taken") from None
    return path


def remove_link(path: Path, target: str) -> None:
    """Remove the link if it still leads to `target`; somebody else's stays."""
    with contextlib.suppress(OSError):
        if os.readlink(path) == target:
            path.unlink()


def _names(directory: Path) -> Iterator[Path]:
    return (directory / f"tty{number}" for number in range(MAX_AUTO_LINKS))


def _require_free(path: Path, target: str) -> None:
    if _is_free(path, target):
        return
    if path.is_symlink():
        raise PortError(
            f"--pty {path}: the link is in use, it leads to {os.readlink(path)} (remove it if it should not)"
        )
    raise PortError(f"--pty {path}: something that is not a link is there already")


def _is_free(path: Path, target: str) -> bool:
    """Nothing is there, or a link to a pseudo-terminal that is dead or, its number reused, our own."""
    try:
        link = path.lstat()
    except FileNotFoundError:
        return True
    if not path.is_symlink():
        return False
    if os.readlink(path) == target:
        return True
    try:
        node = path.stat()
    except FileNotFoundError:
        return _looks_like_terminal(os.readlink(path))
    return _looks_like_terminal(os.readlink(path)) and node.st_ctime_ns > link.st_mtime_ns


def _looks_like_terminal(target: str) -> bool:
    return target.startswith(("/dev/pts/", "/dev/tty"))


def _replace(path: Path, target: str) -> None:
    """Put the link in place in one step, whatever was there."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    with contextlib.suppress(FileNotFoundError):
        temporary.unlink()
    temporary.symlink_to(target)
    temporary.replace(path)


@contextlib.contextmanager
def _locked(directory: Path) -> Iterator[None]:
    """Hold an advisory lock on the directory."""
    import fcntl

    fd = os.open(directory, os.O_RDONLY)
    try:
        fcntl.flock(fd, fcntl.LOCK_EX)
        yield
    finally:
        os.close(fd)
