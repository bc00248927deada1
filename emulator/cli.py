"""The command line: `oem6250 serve [MACHINE.toml] [options]`.

argparse rather than a richer library, because `--help` and `--version` must answer within 0.15 s and importing one of
those takes longer than that by itself. For the same reason nothing heavy is imported before something is done. Each
command brings its function along as `carry_out`.
Every mistake of the user is one line on stderr and exit status 2.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, NoReturn

from emulator import __version__
from emulator.options import ServeOptions
from emulator.serial_address import SerialAddress, parse_serial

if TYPE_CHECKING:
    from emulator.server import Build

DEFAULT_DEVICE = "oem6250"
DEVICES = (DEFAULT_DEVICE, "rmc151")
NOT_OF_AN_RMC = ("tcp", "telnet", "no_tcp", "serial", "shared_line", "units", "line", "record")
"""Options that only an OEM6250 has, as far as giving them can be told from leaving them out."""
DEFAULT_TCP = ("127.0.0.1", 6250)
MAX_SPEED = 1e6
BAUD_RANGE = range(110, 921_601)
MAX_UNITS = 99
"""Units on one line (6000 PG p.72)."""

LATER: Mapping[str, tuple[str, str, str]] = {
    "scope": ("emulator.scope.command", "add_scope", "run commands and record signals at servo rate"),
    "tune": ("emulator.tuning.commands", "add_tune", "walk the guide's tuning procedure on an emulated axis"),
    "sweep": ("emulator.tuning.commands", "add_sweep", "try many gains and plants in parallel"),
    "replay": ("emulator.recording.commands", "add_replay", "run a recording again and compare what the unit sends"),
    "transcript": ("emulator.recording.commands", "add_transcript", "turn a recording into a test transcript"),
    "state": ("emulator.state.command", "add_state", "look at and change a file of non-volatile memory"),
    "terminal": ("clients.terminal.command", "add_terminal", "talk to a controller, emulated or physical, by hand"),
    "faults": ("emulator.fault_listing", "add_faults", "what can be made to go wrong, in tests and from Python"),
}
"""Commands whose options are only read in when one of them is asked for: module, function that adds them, sentence."""

EXAMPLES = """\
examples:
  oem6250 serve                          the default machine on 127.0.0.1:6250 and a virtual serial port
  oem6250 serve axis.toml --speed 20     a machine file, twenty times faster than real time
  oem6250 serve --tcp 127.0.0.1:0 --pty none --announce -    for a test: a free port, told as JSON on stdout
"""


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"oem6250: {message}\n")


def main(arguments: Sequence[str] | None = None, *, build: Build | None = None) -> int:
    """Run the command line; returns the exit status. `build` makes other controllers than the OEM6250 (tests do)."""
    arguments = sys.argv[1:] if arguments is None else arguments
    parser = _parser(arguments)
    parsed = parser.parse_args(arguments)
    if parsed.command is None:
        parser.print_help()
        return 0
    if parsed.command != "serve":
        return _carry_out(parsed)
    options = _serve_options(parsed)
    if options.device != DEFAULT_DEVICE:
        from emulator.rmc.serving import serve_rmc

        return serve_rmc(options)
    from emulator.server import serve

    return serve(options, build)


def _carry_out(parsed: argparse.Namespace) -> int:
    """Do what the command brought along; whoever reads its output may stop reading."""
    try:
        status = int(parsed.carry_out(parsed))
        sys.stdout.flush()
    except BrokenPipeError:
        # Python flushes stdout once more at its end, and would complain.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    return status


def parse_serve_options(arguments: Sequence[str]) -> ServeOptions:
    """What `oem6250 serve ...` with these arguments would be asked to do; SystemExit for a mistake."""
    return _serve_options(_parser(arguments).parse_args(arguments))


def _parser(arguments: Sequence[str] = ()) -> argparse.ArgumentParser:
    """The parser for these arguments: complete as far as they need it."""
    parser = _Parser(
        prog="oem6250",
        description="An emulator of the Parker OEM6250 motion controller.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"oem6250 {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=_Parser)
    _add_serve(commands)
    _add_commands(commands)
    _add_check(commands)
    asked = next((word for word in arguments if not word.startswith("-")), None)
    for name, (module, add_options, sentence) in LATER.items():
        if name == asked:
            getattr(import_module(module), add_options)(commands)
        else:
            commands.add_parser(name, help=sentence)
    return parser


def _add_serve(commands: argparse._SubParsersAction[_Parser]) -> None:
    serve = commands.add_parser(
        "serve",
        help="run one controller and let hosts connect to it",
        description="Run one controller and let hosts connect to it, until SIGINT or SIGTERM.",
        allow_abbrev=False,
    )
    add = serve.add_argument
    add("machine", nargs="?", metavar="MACHINE.toml", help="machine file (default: two wired axes)")
    add("--device", choices=DEVICES, default=DEFAULT_DEVICE, help="what to be (default: oem6250)")
    add("--modbus", type=_address, metavar="HOST:PORT", help="where an rmc151 listens (default: port 502, or rmc.port "
        "of the machine file)")  # fmt: skip
    add("--tcp", action="append", type=_address, metavar="HOST:PORT", help="listen here; may be repeated, port 0 picks "
        "a free one (default: 127.0.0.1:6250)")  # fmt: skip
    add("--telnet", action="append", type=_address, metavar="HOST:PORT", help="listen here and speak telnet first, for "
        "people; may be repeated (default: none; --tcp understands telnet clients that speak first)")  # fmt: skip
    add("--no-tcp", action="store_true", help="do not open the --tcp port")
    add("--allow-remote", action="store_true", help="let --tcp and --telnet listen where other machines reach them")
    add("--pty", default="auto", metavar="PATH|auto|none", help="virtual serial port: where to put the link to it "
        "(default: auto, in your runtime directory)")  # fmt: skip
    add("--serial", action="append", type=_serial, metavar="DEVICE[:BAUD[:FRAMING]]", help="a serial port of this "
        "machine, like /dev/ttyUSB0:9600:8N1 or COM3:19200; may be repeated (default: none; 9600:8N1)")  # fmt: skip
    add("--shared-line", action="store_true", help="every connection hears all the unit sends, as on a Y-cable "
        "(default: only what it asked for)")  # fmt: skip
    add("--units", type=_units, default=1, metavar="N", help="chain N like units, addressed 1 to N, on the one line; "
        "ERRLVL1 first (default: 1)")  # fmt: skip
    add("--speed", type=_speed, default=1.0, metavar="1|N|max", help="virtual over real time (default: 1)")
    add("--line", type=_line, default=None, metavar="instant|BAUD", help="speed of the serial line "
        "(default: serial.baud of the machine file, else instant)")  # fmt: skip
    add("--state", default="none", metavar="FILE|none", help="file of the non-volatile memory (default: none)")
    add("--record", metavar="FILE", help="write the session there, for `oem6250 replay` (default: none)")
    add("--announce", metavar="-|FILE", help="once ready, write where to connect as one line of JSON")
    add("-v", dest="verbosity", action="count", default=0, help="log what happens and the traffic; -vv logs all")
    add("--version", action="version", version=f"oem6250 {__version__}")


def _add_commands(commands: argparse._SubParsersAction[_Parser]) -> None:
    show = commands.add_parser(
        "commands",
        help="what of the command language this unit does",
        description="What of the command language this unit does, how that is known, and which transcripts show it.",
        allow_abbrev=False,
    )
    show.add_argument("name", nargs="?", metavar="NAME", help="one command or operand, in full")
    show.add_argument("--table", action="store_true", help="the whole conformance table, as Markdown")
    show.set_defaults(carry_out=_show_commands)


def _show_commands(parsed: argparse.Namespace) -> int:
    from emulator import conformance

    if parsed.name is not None:
        found = conformance.find(parsed.name)
        if found is None:
            _parser().error(f"no command or operand is called {parsed.name!r}")
        print(conformance.describe(found))
        return 0
    rows = conformance.table()
    text = conformance.render(rows) if parsed.table else conformance.overview(rows)
    sys.stdout.write(text)
    return 0


def _add_check(commands: argparse._SubParsersAction[_Parser]) -> None:
    check = commands.add_parser(
        "check",
        help="whether machine files can be used",
        description="Whether machine files can be used: one line each, what it would be or what is wrong with it.",
        epilog="Exit status 2 if any cannot.",
        allow_abbrev=False,
    )
    check.add_argument("machines", nargs="+", metavar="MACHINE.toml", help="machine file")
    check.set_defaults(carry_out=_do_check)


def _do_check(parsed: argparse.Namespace) -> int:
    from emulator.check import check_files

    return check_files(parsed.machines)


def _serve_options(parsed: argparse.Namespace) -> ServeOptions:
    _refuse_foreign_options(parsed)
    if parsed.no_tcp and parsed.tcp:
        _parser().error("argument --no-tcp: not allowed with --tcp")
    tcp = () if parsed.no_tcp else tuple(parsed.tcp or (DEFAULT_TCP,))
    pty = None if parsed.pty == "none" or (parsed.pty == "auto" and sys.platform == "win32") else parsed.pty
    return ServeOptions(
        device=parsed.device,
        modbus=parsed.modbus,
        machine=parsed.machine,
        tcp=tcp,
        telnet=tuple(parsed.telnet or ()),
        allow_remote=parsed.allow_remote,
        pty=pty,
        speed=parsed.speed,
        line_baud=parsed.line,
        state=None if parsed.state == "none" else parsed.state,
        announce=parsed.announce,
        record=parsed.record,
        verbosity=parsed.verbosity,
        units=parsed.units,
        serial=tuple(parsed.serial or ()),
        shared_line=parsed.shared_line,
    )


def _refuse_foreign_options(parsed: argparse.Namespace) -> None:
    """Options of one device do not go with the other."""
    if parsed.device == DEFAULT_DEVICE:
        if parsed.modbus is not None:
            _parser().error("argument --modbus: only with --device rmc151")
        return
    for name in NOT_OF_AN_RMC:
        if getattr(parsed, name) not in (None, False, 1):
            _parser().error(f"argument --{name.replace('_', '-')}: not allowed with --device {parsed.device}")
    if parsed.state != "none":
        _parser().error(f"argument --state: not allowed with --device {parsed.device}")


def _address(text: str) -> tuple[str, int]:
    """`127.0.0.1:6250`, `localhost:0`, `[::1]:6250`, `:6250` (every interface)."""
    host, colon, port = text.rpartition(":")
    bracketed = host.startswith("[") and host.endswith("]")
    if not colon or not port.isascii() or not port.isdigit() or int(port) > 65535 or (":" in host and not bracketed):
        raise argparse.ArgumentTypeError(f"{text!r} is not HOST:PORT with a port from 0 to 65535 (IPv6: [::1]:6250)")
    return (host[1:-1] if bracketed else host), int(port)


def _serial(text: str) -> SerialAddress:
    try:
        return parse_serial(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _speed(text: str) -> float | None:
    if text == "max":
        return None
    try:
        speed = float(text)
    except ValueError:
        speed = 0.0
    if not 1 / MAX_SPEED <= speed <= MAX_SPEED:
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number (at most {MAX_SPEED:.0f}) or max")
    return speed


def _units(text: str) -> int:
    if not (text.isascii() and text.isdigit() and 1 <= int(text) <= MAX_UNITS):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of units from 1 to {MAX_UNITS}")
    return int(text)


def _line(text: str) -> int | None:
    if text == "instant":
        return 0
    if not (text.isascii() and text.isdigit() and int(text) in BAUD_RANGE):
        raise argparse.ArgumentTypeError(f"{text!r} is neither instant nor a baud rate (110 to 921600)")
    return int(text)
