r"""One line of a recording, read and written.

    12.345678901 u0 c3 > "1TPE\r"                            a host's bytes, when the unit received them
    12.345678901 u0 c3 < "*1TPE+0\r"                         the unit's bytes, when they left it; c* is every connection
    12.400000000 u0 c3 attached                              a connection comes, or is detached
    13.000000000 u0 ! set_wire name="enable" closed=false    an action of the registry; u0.2: the third unit of a chain
    14.000000000 end                                         the recording was closed at this time

Times are virtual seconds with nine decimals. In byte strings printable ASCII stands for itself; `\r \n \t \" \\` and
`\xHH` stand for the rest. A line counts only with the line feed that ends it, so that a file cut anywhere is usable up
to the cut. Lines that begin with `#` and empty lines mean nothing. Who writes a recording by hand may leave out
`u0`, `c0` and decimals.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

NS_PER_S = 1_000_000_000
Value = float | int | bool | str


class RecordingError(ValueError):
    """A recording that cannot be used; the text is one line."""


@dataclass(frozen=True, slots=True)
class Received:
    """Bytes of a host, at the virtual time at which the unit received them."""

    at_ns: int
    unit: int
    channel: int
    data: bytes
    line: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Sent:
    """Bytes of the unit, at the virtual time at which they left it; channel None is every connection."""

    at_ns: int
    unit: int
    channel: int | None
    data: bytes
    line: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Attached:
    """A connection was made."""

    at_ns: int
    unit: int
    channel: int
    line: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Detached:
    """A connection is gone."""

    at_ns: int
    unit: int
    channel: int
    line: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Done:
    """An action of the registry that was carried out; `member` is the place in a daisy chain, from 0."""

    at_ns: int
    unit: int
    member: int
    action: str
    parameters: Mapping[str, Value]
    line: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class End:
    """The recording was closed: nothing else happened up to this time."""

    at_ns: int
    line: int = field(default=0, compare=False)


Entry = Received | Sent | Attached | Detached | Done | End

_PLAIN = {code: chr(code) if 0x20 <= code < 0x7F else f"\\x{code:02x}" for code in range(256)}
_ESCAPED = _PLAIN | {0x0D: "\\r", 0x0A: "\\n", 0x09: "\\t", 0x22: '\\"', 0x5C: "\\\\"}
_UNESCAPED = {"r": b"\r", "n": b"\n", "t": b"\t", '"': b'"', "\\": b"\\", "0": b"\0", "b": b"\b"}
_LINE = re.compile(
    r"([0-9]{1,18})(?:\.([0-9]{1,9}))?"
    r"(?: +u([0-9]{1,9})(?:\.([0-9]{1,9}))?)?"
    r"(?: +c(-?[0-9]{1,9}|\*))?"
    r" +(>|<|!|attached|detached|end)(?: +(.*?))? *"
)
_STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')
_PIECE = re.compile(r"\\x([0-9A-Fa-f]{2})|\\(.)|([^\\]+)", re.DOTALL)
_ACTION = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)")
_PARAMETER = re.compile(r' +([A-Za-z_][A-Za-z0-9_]*)=("(?:[^"\\]|\\.)*"|[^ "]+)')


def escaped(data: bytes) -> str:
    r"""Bytes as they stand between the quotes: `1TPE\r`."""
    return data.decode("latin-1").translate(_ESCAPED)


def unescaped(text: str) -> bytes:
    """The bytes that stand between the quotes. Raises RecordingError for an unknown escape or a wide character."""
    parts = []
    for code, letter, plain in _PIECE.findall(text):
        if code:
            parts.append(bytes((int(code, 16),)))
        elif letter and letter not in _UNESCAPED:
            raise RecordingError(f'\\{letter} is not an escape; there are \\r \\n \\t \\" \\\\ \\xHH')
        elif not plain.isascii():
            raise RecordingError(f"{plain!r} holds more than ASCII; write bytes above 7F as \\xHH")
        else:
            parts.append(_UNESCAPED[letter] if letter else plain.encode("ascii"))
    return b"".join(parts)


def seconds(at_ns: int) -> str:
    """`12.345678901`, exact."""
    return f"{at_ns // NS_PER_S}.{at_ns % NS_PER_S:09d}"


def received_line(at_ns: int, unit: int, channel: int, data: bytes) -> bytes:
    """A host's bytes as a line."""
    return f'{at_ns // NS_PER_S}.{at_ns % NS_PER_S:09d} u{unit} c{channel} > "{escaped(data)}"\n'.encode("ascii")


def sent_line(at_ns: int, unit: int, channel: int | None, data: bytes) -> bytes:
    """The unit's bytes as a line."""
    place = "*" if channel is None else channel
    return f'{at_ns // NS_PER_S}.{at_ns % NS_PER_S:09d} u{unit} c{place} < "{escaped(data)}"\n'.encode("ascii")


def format_entry(entry: Entry) -> bytes:
    """Any entry as a line, its line feed included."""
    match entry:
        case Received(at_ns, unit, channel, data):
            return received_line(at_ns, unit, channel, data)
        case Sent(at_ns, unit, to, data):
            return sent_line(at_ns, unit, to, data)
        case Attached(at_ns, unit, channel):
            return f"{seconds(at_ns)} u{unit} c{channel} attached\n".encode("ascii")
        case Detached(at_ns, unit, channel):
            return f"{seconds(at_ns)} u{unit} c{channel} detached\n".encode("ascii")
        case Done():
            return _action_line(entry)
        case End(at_ns):
            return f"{seconds(at_ns)} end\n".encode("ascii")


def _action_line(done: Done) -> bytes:
    place = f"u{done.unit}.{done.member}" if done.member else f"u{done.unit}"
    words = [seconds(done.at_ns), place, "!", done.action]
    words += [f"{name}={json.dumps(value)}" for name, value in done.parameters.items()]
    return (" ".join(words) + "\n").encode("ascii")


def parse_entry(text: str, *, line: int = 0) -> Entry | None:
    """The entry of a line without its line feed; None for a comment or an empty line.

    Raises:
        RecordingError: the line is none of a recording's.
    """
    if not text.strip() or text.startswith("#"):
        return None
    found = _LINE.fullmatch(text)
    if found is None:
        raise RecordingError(f"{_shortened(text)} is no line of a recording")
    whole, decimals, unit, member, channel, kind, rest = found.groups()
    at_ns = int(whole) * NS_PER_S + int((decimals or "").ljust(9, "0"))
    if (kind in "<>!") == (rest is None):
        raise RecordingError(f"{_shortened(text)} has {'nothing' if rest is None else 'too much'} after {kind}")
    if member is not None and kind != "!":
        raise RecordingError(f"{_shortened(text)}: only an action names a unit within a chain")
    if kind == "end":
        return End(at_ns, line)
    if kind == "!":
        name, parameters = _action(rest)
        return Done(at_ns, int(unit or 0), int(member or 0), name, parameters, line)
    return _of_connection(kind, at_ns, int(unit or 0), channel or "0", rest, line)


def _of_connection(kind: str, at_ns: int, unit: int, channel: str, rest: str | None, line: int) -> Entry:
    if kind == "<":
        return Sent(at_ns, unit, None if channel == "*" else int(channel), _bytes(rest), line)
    if channel == "*":
        raise RecordingError(f"c* stands before < only, not before {kind}")
    if kind == ">":
        return Received(at_ns, unit, int(channel), _bytes(rest), line)
    return (Attached if kind == "attached" else Detached)(at_ns, unit, int(channel), line)


def _bytes(text: str | None) -> bytes:
    found = _STRING.fullmatch(text or "")
    if found is None:
        raise RecordingError(f"{_shortened(text or '')} is not bytes in double quotes")
    return unescaped(found[1])


def _action(text: str) -> tuple[str, dict[str, Value]]:
    name = _ACTION.match(text)
    if name is None:
        raise RecordingError(f"{_shortened(text)} does not begin with the name of an action")
    parameters: dict[str, Value] = {}
    position = name.end()
    while position < len(text):
        found = _PARAMETER.match(text, position)
        if found is None:
            raise RecordingError(f"{_shortened(text[position:])} is not name=value")
        parameters[found[1]] = _value(found[2])
        position = found.end()
    return name[1], parameters


def _value(text: str) -> Value:
    try:
        value = json.loads(text)
    except ValueError:
        value = None
    if not isinstance(value, bool | int | float | str):
        raise RecordingError(f"{_shortened(text)} is no number, text in quotes, true or false")
    return value


def _shortened(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "...")
