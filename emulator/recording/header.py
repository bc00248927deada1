"""The head of a recording: what is needed to set up the same machine again.

    oem6250 recording 1
    program = "0.1.0"
    ...
    [machine u0]
    | [defaults]
    | ECHO = 0
    begin

`key = "value"` lines (a JSON string; by hand also without the quotes), and texts: a name in brackets, then the
text's lines verbatim behind `| `. `begin` ends the head; without it nothing can be replayed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from emulator.recording.format import RecordingError

VERSION = 1
FIRST_LINE = "oem6250 recording"
BEGIN = "begin"
_KEY = re.compile(r"([a-z][a-z0-9_.-]*) *= *(.*?) *")
_TEXT = re.compile(r"\[([a-z][a-z0-9_. -]*)\] *")


@dataclass(frozen=True, slots=True)
class Header:
    """`fields` are one-line values, `texts` whole files (`machine u0`, `state u0`), both in the order written."""

    fields: Mapping[str, str] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)

    @property
    def from_line(self) -> bool:
        """A recording of a real unit's line: wall times, no machine file."""
        return self.fields.get("source") == "line"

    def number(self, key: str, default: int) -> int:
        """A field that counts something. Raises RecordingError if it is no number from 1 to 999."""
        text = self.fields.get(key, str(default))
        if not (text.isascii() and text.isdigit() and 1 <= int(text) <= 999):
            raise RecordingError(f"{key} = {text!r} in the head is not a number from 1 to 999")
        return int(text)


def format_header(header: Header) -> bytes:
    """The head as it stands in the file, `begin` included."""
    lines = [f"{FIRST_LINE} {VERSION}"]
    lines += [f"{key} = {json.dumps(value)}" for key, value in header.fields.items()]
    for name, text in header.texts.items():
        lines += [f"[{name}]", *(f"| {line}" for line in text.split("\n"))]
    return ("\n".join([*lines, BEGIN]) + "\n").encode("utf-8", "surrogateescape")


def check_first_line(text: str) -> None:
    """Raises RecordingError unless `text` begins a recording of a version that can be read."""
    name, _, version = text.strip().rpartition(" ")
    if name != FIRST_LINE or not version.isdigit():
        raise RecordingError(f"not a recording: its first line is not '{FIRST_LINE} {VERSION}'")
    if int(version) != VERSION:
        raise RecordingError(f"a recording of version {version}; this program reads version {VERSION}")


class HeaderReader:
    """Takes the lines after the first, one by one, until `begin`."""

    def __init__(self) -> None:
        self._fields: dict[str, str] = {}
        self._texts: dict[str, list[str]] = {}
        self._text: list[str] | None = None

    def take(self, line: str) -> Header | None:
        """The head once it is complete. Raises RecordingError for a line that does not belong there."""
        if line.strip() == BEGIN:
            return Header(self._fields, {name: "\n".join(lines) for name, lines in self._texts.items()})
        if line.startswith("|") and self._text is not None:
            self._text.append(line[2:])
        elif found := _TEXT.fullmatch(line):
            self._text = self._texts[found[1]] = []
        elif found := _KEY.fullmatch(line):
            self._text = None
            self._fields[found[1]] = _unquoted(found[2])
        elif line.strip() and not line.startswith("#"):
            raise RecordingError(f"{line[:60]!r} does not belong into the head of a recording")
        return None


def _unquoted(text: str) -> str:
    if not text.startswith('"'):
        return text
    try:
        return str(json.loads(text))
    except ValueError:
        raise RecordingError(f"{text[:60]} is not a text in double quotes") from None
