"""What may be replaced by a link to our pseudo-terminal and what may not."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from emulator.ports import PortError

pytest.importorskip("termios")
from emulator.ports.link import make_auto_link, make_link, remove_link


@pytest.fixture
def node() -> Iterator[str]:
    """A live pseudo-terminal, standing for another emulator's or a terminal window."""
    master, slave = os.openpty()
    yield os.ttyname(slave)
    os.close(master)
    os.close(slave)


DEAD = "/dev/pts/987654"


def test_the_link_leads_to_the_node_and_goes_again(tmp_path: Path) -> None:
    path = make_link(tmp_path / "tty", DEAD)
    assert os.readlink(path) == DEAD
    remove_link(path, DEAD)
    assert os.listdir(tmp_path) == []


def test_a_link_to_a_dead_terminal_is_replaced(tmp_path: Path, node: str) -> None:
    (tmp_path / "tty").symlink_to(DEAD)
    assert os.readlink(make_link(tmp_path / "tty", node)) == node


def test_a_live_link_is_refused(tmp_path: Path, node: str) -> None:
    (tmp_path / "tty").symlink_to(node)
    with pytest.raises(PortError, match="in use") as refusal:
        make_link(tmp_path / "tty", DEAD)
    assert "\n" not in str(refusal.value)
    assert os.readlink(tmp_path / "tty") == node


def test_a_link_older_than_its_terminal_is_stale(tmp_path: Path, node: str) -> None:
    """The number of a dead pseudo-terminal has been given to somebody else since."""
    (tmp_path / "tty").symlink_to(node)
    os.utime(tmp_path / "tty", (1, 1), follow_symlinks=False)
    assert os.readlink(make_link(tmp_path / "tty", DEAD)) == DEAD


@pytest.mark.parametrize("make", [Path.touch, Path.mkdir, lambda path: path.symlink_to("/etc/hostname-of-nobody")])
def test_what_is_not_ours_to_replace_is_refused(tmp_path: Path, make: object) -> None:
    assert callable(make)
    make(tmp_path / "tty")
    with pytest.raises(PortError):
        make_link(tmp_path / "tty", DEAD)
    assert os.path.lexists(tmp_path / "tty")


def test_a_missing_directory_is_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(PortError, match=r"^--pty .*/no/tty: cannot make the link \(No such file or directory\)$"):
        make_link(tmp_path / "no" / "tty", DEAD)


def test_somebody_elses_link_is_not_removed(tmp_path: Path, node: str) -> None:
    (tmp_path / "tty").symlink_to(node)
    remove_link(tmp_path / "tty", DEAD)
    assert (tmp_path / "tty").is_symlink()


def test_auto_takes_the_first_free_name_in_a_private_directory(tmp_path: Path, node: str) -> None:
    directory = tmp_path / "run" / "oem6250"
    assert make_auto_link(directory, node).name == "tty0"
    assert make_auto_link(directory, DEAD).name == "tty1"
    assert make_auto_link(directory, "/dev/pts/987655").name == "tty1"
    assert directory.stat().st_mode & 0o777 == 0o700
