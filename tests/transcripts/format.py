r"""Transcripts: sessions with the unit as plain text, one documented exchange or session a file.

A file starts with headers, then come the steps. `#` at the start of a line is a comment.

    title: what this shows, one line
    source: where it is documented or seen (may be given several times)
    machine:                 optional: indented TOML, the machine file of the session
        [defaults]
        ECHO = 0
    virtual-only: reason     optional: not run over real ports (a long wait, the sign-on ...)
    sign-on: shown           optional: the power-up text is part of the session (virtual only)

    > 1TPE\r                 the host sends; may be repeated, one packet each
    < *1TPE+0\r{ok}          exactly this comes next, at once; consecutive lines are joined
    ~ \*1TPE\+400[0-2]\r     a bytes regular expression, for what no document fixes
    at 1.1s +-0.003s         when the line above it must have left the unit, from the last `>`
    @ 2.5s                   virtual time passes

Everything the unit sends must be expected before the next `>` and before the end: silence is checked
too. Escapes in `>` and `<` lines: \r \n \t \b \0 \\ \{ \xHH and \s, a blank; {ok} {bad} {def} stand
for the default prompts `\r\n> `, `\r\n? `, `\r\n- `. Blanks at the ends of a line do not count.
In `~` lines {ok} {bad} {def} stand for the same prompts; the rest is the regular expression.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

PROMPTS = {"ok": b"\r\n> ", "bad": b"\r\n? ", "def": b"\r\n- "}
_HEADER = re.compile(r"(title|source|machine|virtual-only|sign-on):\s*(.*)")
_TOKEN = re.compile(r"\\x([0-9A-Fa-f]{2})|\\(.)|\{(ok|bad|def)\}|([^\\{])", re.DOTALL)
_ESCAPES = {"r": b"\r", "n": b"\n", "t": b"\t", "b": b"\b", "0": b"\0", "\\": b"\\", "{": b"{", "s": b" "}
_AT = re.compile(r"([0-9.]+)s\s+\+-([0-9.]+)s")
_SPAN = re.compile(r"\+?([0-9.]+)s")


class TranscriptError(ValueError):
    """A transcript that cannot be read; `str()` begins with file and line."""


@dataclass(frozen=True, slots=True)
class Timing:
    """When something must leave the unit: `at_s` after the last send, give or take `within_s`."""

    at_s: float
    within_s: float


@dataclass(frozen=True, slots=True)
class Send:
    """The host sends `data` in one packet."""

    line: int
    data: bytes


@dataclass(frozen=True, slots=True)
class Expect:
    """The unit sends exactly `data`, at once unless `timing` or a `Pass` says otherwise."""

    line: int
    data: bytes
    timing: Timing | None = None


@dataclass(frozen=True, slots=True)
class Match:
    """The unit sends something that `pattern` matches from its first byte on."""

    line: int
    pattern: re.Pattern[bytes]
    timing: Timing | None = None


@dataclass(frozen=True, slots=True)
class Pass:
    """`seconds` of virtual time pass."""

    line: int
    seconds: float


Step = Send | Expect | Match | Pass


@dataclass(frozen=True, slots=True)
class Transcript:
    """One file, read."""

    path: Path
    title: str
    sources: tuple[str, ...]
    machine: str
    virtual_only: str | None
    sign_on_shown: bool
    steps: tuple[Step, ...]

    @property
    def duration_s(self) -> float:
        """Virtual time that passes at least, by the file itself."""
        passed = sum(step.seconds for step in self.steps if isinstance(step, Pass))
        return passed + sum(s.timing.at_s for s in self.steps if isinstance(s, Expect | Match) and s.timing)


def load(path: Path) -> Transcript:
    """Read the transcript at `path`; TranscriptError if it cannot be understood."""
    return parse(path.read_text(encoding="utf-8"), path=path)


def parse(text: str, *, path: Path) -> Transcript:
    """Read a transcript from `text`; `path` is for error messages and kept in the result."""
    lines = [(number, line.rstrip()) for number, line in enumerate(text.splitlines(), start=1)]
    lines = [(number, line) for number, line in lines if line and not line.startswith("#")]
    headers = _headers(lines, path)
    steps = tuple(_steps(lines[headers.used :], path))
    if not headers.title or not headers.sources:
        raise TranscriptError(f"{path}:1: a transcript needs a title and a source")
    return Transcript(
        path=path,
        title=headers.title,
        sources=tuple(headers.sources),
        machine="\n".join(headers.machine),
        virtual_only="the sign-on is shown" if headers.sign_on_shown else headers.virtual_only,
        sign_on_shown=headers.sign_on_shown,
        steps=steps,
    )


class _Headers:
    def __init__(self) -> None:
        self.title = ""
        self.sources: list[str] = []
        self.machine: list[str] = []
        self.virtual_only: str | None = None
        self.sign_on_shown = False
        self.used = 0


def _headers(lines: list[tuple[int, str]], path: Path) -> _Headers:
    found = _Headers()
    key = ""
    for number, line in lines:
        if line.startswith(" ") and key == "machine":
            found.machine.append(line.strip())
        elif header := _HEADER.fullmatch(line):
            key = header[1]
            _take_header(found, key, header[2], f"{path}:{number}")
        else:
            break
        found.used += 1
    return found


def _take_header(found: _Headers, key: str, value: str, where: str) -> None:
    if key == "machine" and value in ("", "default"):
        return
    if key == "sign-on" and value == "shown":
        found.sign_on_shown = True
    elif key == "title" and value:
        found.title = value
    elif key == "source" and value:
        found.sources.append(value)
    elif key == "virtual-only" and value:
        found.virtual_only = value
    else:
        raise TranscriptError(f"{where}: {key}: {value!r} is not understood")


def _steps(lines: list[tuple[int, str]], path: Path) -> Iterator[Step]:
    pending: Expect | Match | None = None
    for number, line in lines:
        where = f"{path}:{number}"
        mark, _, rest = line.partition(" ")
        if mark == "at":
            pending = _timed(pending, rest, where)
            continue
        step = _step(mark, rest.strip(), number, where)
        if isinstance(pending, Expect) and isinstance(step, Expect) and pending.timing is None:
            pending = replace(pending, data=pending.data + step.data)
            continue
        if pending is not None:
            yield pending
        pending = step if isinstance(step, Expect | Match) else None
        if pending is None:
            yield step
    if pending is not None:
        yield pending


def _timed(step: Expect | Match | None, text: str, where: str) -> Expect | Match:
    found = _AT.fullmatch(text.strip())
    if step is None or found is None:
        raise TranscriptError(f"{where}: 'at' follows a < or ~ line and reads 'at 1.1s +-0.003s', not {text!r}")
    return replace(step, timing=Timing(at_s=float(found[1]), within_s=float(found[2])))


def _step(mark: str, text: str, number: int, where: str) -> Step:
    if mark == ">":
        return Send(number, unescape(text, where=where))
    if mark == "<":
        return Expect(number, unescape(text, where=where))
    if mark == "~":
        return Match(number, _pattern(text, where))
    if mark == "@" and (span := _SPAN.fullmatch(text)):
        return Pass(number, float(span[1]))
    raise TranscriptError(f"{where}: {mark + ' ' + text!r} is neither > < ~ @ nor at")


def _pattern(text: str, where: str) -> re.Pattern[bytes]:
    for name, prompt in PROMPTS.items():
        text = text.replace("{" + name + "}", re.escape(prompt).decode())
    try:
        return re.compile(text.encode("latin-1"))
    except re.error as error:
        raise TranscriptError(f"{where}: {error}") from None


def unescape(text: str, *, where: str) -> bytes:
    """The bytes that `text` stands for; TranscriptError beginning with `where` if an escape is unknown."""
    data, position = b"", 0
    while position < len(text):
        token = _TOKEN.match(text, position)
        piece = _piece(token) if token else None
        if token is None or piece is None:
            raise TranscriptError(f"{where}: {text[position : position + 4]!r} is not an escape; see the format")
        data += piece
        position = token.end()
    return data


def _piece(token: re.Match[str]) -> bytes | None:
    code, escape, prompt, plain = token.groups()
    if code:
        return bytes([int(code, 16)])
    if escape:
        return _ESCAPES.get(escape)
    return PROMPTS[prompt] if prompt else plain.encode("latin-1")
