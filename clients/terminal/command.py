"""The command line of the terminal: `python -m clients PORT` and `oem6250 terminal PORT`."""

from __future__ import annotations

import argparse
import asyncio
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from clients.errors import LineLost
from clients.lines import DEFAULT_BAUD

DESCRIPTION = "An interactive terminal for a 6000 Series controller, emulated or physical."
EPILOG = """\
examples:
  oem6250 terminal /dev/ttyUSB0
  oem6250 terminal tcp://127.0.0.1:6250
  oem6250 terminal rfc2217://terminal-server:4001 --baud 19200
"""
MISSING = "the terminal needs prompt_toolkit: pip install 'oem6250[terminal]'"
NO_SCREEN = "the terminal needs a terminal to run in; a program uses clients.OEM6250 (docs/client.md)"


INTERRUPTED = 130
"""As shells report a program that SIGINT has ended."""


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")


def add_terminal(commands: Any) -> None:
    """The command of `oem6250`."""
    parser = commands.add_parser(
        "terminal",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    _add_options(parser)


def main(arguments: Sequence[str] | None = None) -> int:
    """`python -m clients`; the exit status."""
    parser = _Parser(
        prog="python -m clients",
        description=DESCRIPTION,
        epilog=EPILOG.replace("oem6250 terminal", "python -m clients"),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    _add_options(parser)
    parsed = parser.parse_args(arguments)
    return run(parsed)


def _add_options(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("port", metavar="PORT", help="/dev/ttyUSB0, COM3, tcp://host:port, rfc2217://host:port, or a URL of pyserial's")
    add("--baud", type=_baud, default=DEFAULT_BAUD, metavar="N", help="of a serial port, 8N1 (default: 9600)")
    add("--address", type=_address, metavar="N", help="the unit of a daisy chain that /download, /upload, /watch and "
        "/sync are for; typed lines are sent as they are (default: none)")  # fmt: skip
    add("--raw", action="store_true", help="ask the unit nothing that is not typed, not even on connecting")
    add("--history", type=Path, metavar="FILE", help="where typed lines are kept (default: in your state directory)")
    parser.set_defaults(carry_out=run)


def run(parsed: argparse.Namespace) -> int:
    """Open the port and talk until the user leaves; 2 for what cannot be done, said in one line."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        return _refuse(NO_SCREEN)
    try:
        from clients.terminal.console import Console, kept_history
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "prompt_toolkit":
            raise
        return _refuse(MISSING)
    from clients.terminal.conversation import Conversation

    conversation = Conversation(
        parsed.port, show=lambda lines: None, baud=parsed.baud, address=parsed.address, ask=not parsed.raw
    )
    history = kept_history(parsed.history or history_file())

    async def talk() -> None:
        console = Console(conversation, history=history)
        await conversation.open()
        await console.run()

    try:
        asyncio.run(talk())
    except (LineLost, ValueError) as error:
        return _refuse(f"cannot open {parsed.port}: {error.__cause__ or error}")
    except KeyboardInterrupt:
        return INTERRUPTED
    return 0


def history_file() -> Path:
    """Where typed lines are kept unless told otherwise."""
    import platformdirs

    return Path(platformdirs.user_state_dir("oem6250", appauthor=False)) / "terminal-history"


def _refuse(text: str) -> int:
    print(f"oem6250 terminal: {text}", file=sys.stderr)
    return 2


def _baud(text: str) -> int:
    if not (text.isascii() and text.isdigit() and 0 < int(text) <= 4_000_000):
        raise argparse.ArgumentTypeError(f"{text!r} is not a baud rate")
    return int(text)


def _address(text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text) <= 99):
        raise argparse.ArgumentTypeError(f"{text!r} is not a unit address from 0 to 99")
    return int(text)
