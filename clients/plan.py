"""What to expect of a unit after one line of a host: worked out once from the catalogue, used for every exchange."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import Enum
from typing import Final, NamedTuple

from clients.link import LINK_COMMANDS, Link
from protocol.catalogue import CommandRow
from protocol.command import Command, is_immediate_text, parse_command
from protocol.errors import CommandError
from protocol.line import LineAssembler, TokenKind
from protocol.reply_shapes import ParsedReply, parse_reply_line

LONGEST_LINE: Final = 100_000
"""Lines are checked command by command by the unit; this only bounds what is looked at here."""


class Kind(Enum):
    """How the end of an answer is recognised."""

    SETTING = "a prompt, where the level sends one"
    REPLY = "one line of a known form"
    LINES = "any number of lines"
    LINK = "nothing but silence: answers change their form with this command"


_NO_WAY = b"\xff\xff"
"""No answer begins and ends with this."""

_NUMBERS = re.compile(rb"[ AB]*[-+0-9.][-+0-9.,]*")
_MASK = re.compile(rb"[ AB]*[01X]+")
_WORD = re.compile(rb"[01XE]+(?:_[01XE]+)*")
_BIT = re.compile(rb"[01X]")

_CLOSED_FORMS = {"numbers": _NUMBERS, "mask": _MASK, "word": _WORD, "limits": _WORD}
"""Replies of one line whose characters are known, so that their end shows by itself."""

_VARIABLE_FORMS = {"VAR": _NUMBERS, "VARB": _WORD}

_MANY_LINES = ("table", "lines", "text")


class Answer(NamedTuple):
    """What came back for a line: `value` is the reply without asterisk, axis number and name (a reply of several lines
    whole, as it came), `lines` the whole reply line by line without asterisks, `prompt` the kind of prompt that ended
    it ("" if none did), `text` everything between echo and prompt as it came."""

    command: str
    lines: tuple[str, ...] = ()
    value: str = ""
    prompt: str = ""
    text: str = ""
    row: CommandRow | None = None

    def parsed(self) -> ParsedReply:
        """The reply read by its row of the catalogue.

        Raises:
            ReplyError: it has not the form the row calls for.
        """
        if self.row is None:
            raise ValueError(f"{self.command!r} is no query of the catalogue")
        return parse_reply_line(self.value, self.row)


@dataclass(frozen=True)
class Plan:
    """What a line is and how its answer looks under one `Link`."""

    line: str
    data: bytes
    kind: Kind
    commands: tuple[Command, ...]
    count: int
    immediate: bool
    echoed: bytes
    heads: tuple[bytes, ...] = ()
    form: re.Pattern[bytes] | None = None
    row: CommandRow | None = None
    label: str = ""
    whole: re.Pattern[bytes] | None = None
    """The usual answer to a query as a whole, with echo and prompt; its group is the value."""
    confirmation: bytes = _NO_WAY
    """The usual answer to a setting."""
    tells_itself: bool = False
    """Whether the answer cannot be taken for anything that may have come before: it has a name and a prompt."""

    def quick(self, received: bytes) -> Answer | None:
        """The usual case, everything in one piece and nothing else on the line; None: look closer."""
        if self.whole is None:
            return self._confirmed if received == self.confirmation else None
        match = self.whole.fullmatch(received)
        if match is None:
            return None
        value = match[1].decode("ascii")
        text = self.label + value
        return Answer(self.line, (text,), value, "good", text, self.row)

    @property
    def _confirmed(self) -> Answer:
        return Answer(self.line, prompt="good")


def make_plan(line: str, prefix: str, link: Link) -> Plan:
    """The plan of a line (without delimiter) under a link; `prefix` is the unit address (`3_`) or nothing.

    Raises:
        ValueError: the line holds a delimiter or characters that cannot be sent.
    """
    if set(line) & set("\r\n") or len(line) > LONGEST_LINE:
        raise ValueError(f"one line at a time, without CR and LF: {line!r}")
    commands, count = _read(line)
    sent = (prefix + line).encode("latin-1") if line else prefix.encode("latin-1")
    immediate = count == 1 and is_immediate_text(line)
    only = commands[0] if len(commands) == 1 and count == 1 else None
    kind = _kind(commands, only)
    heads, form = _shape(only, link) if only is not None and kind is Kind.REPLY else ((), None)
    if kind is Kind.LINES:
        heads = (b"*" if link.framing.rules.asterisk else b"",)
    plan = Plan(line, sent + b"\r", kind, commands, max(1, count), immediate, sent, heads, form)
    return _with_quick_way(plan, link)


def _read(line: str) -> tuple[tuple[Command, ...], int]:
    """The commands of a line that can be read, and how many there are in all."""
    texts = [token.text for token in LineAssembler().feed(line.encode("latin-1") + b"\r") if _is_command(token.kind)]
    read = []
    for text in texts:
        try:
            read.append(parse_command(text))
        except CommandError:
            continue
    return tuple(read), len(texts)


def _is_command(kind: TokenKind) -> bool:
    return kind in (TokenKind.COMMAND, TokenKind.TOO_LONG)


def _kind(commands: tuple[Command, ...], only: Command | None) -> Kind:
    if any(command.name in LINK_COMMANDS and _changes(command) for command in commands):
        return Kind.LINK
    if only is None or only.row is None or not _asks(only):
        return Kind.SETTING
    if only.bit is not None:
        return Kind.REPLY
    if only.row.reply in _MANY_LINES or (only.row.reply == "word" and only.row.fields.per_axis and only.axis is None):
        return Kind.LINES
    return Kind.REPLY


def _changes(command: Command) -> bool:
    return command.name == "RESET" or bool(command.argument)


def _asks(command: Command) -> bool:
    """Whether a reply comes: reports always, settings without a field, `VAR1` without an equals sign."""
    row = command.row
    assert row is not None
    if row.kind == "report":
        return True
    if row.kind != "setting" or row.reply == "none":
        return False
    if row.reply == "assignment":
        return "=" not in command.argument and not command.bit_value
    if row.reply == "text" and command.argument.isdigit():
        return True
    return command.is_query or command.argument in ("A", "B")


def _shape(command: Command, link: Link) -> tuple[tuple[bytes, ...], re.Pattern[bytes] | None]:
    """What the reply line begins with, at the level in force, and its form where its characters are known."""
    row = command.row
    assert row is not None
    rules = link.framing.rules
    star = "*" if rules.asterisk else ""
    if command.bit is not None:
        return (star.encode(),), _BIT
    form = _VARIABLE_FORMS.get(row.name) or _CLOSED_FORMS.get(row.reply)
    if not rules.names:
        return (star.encode(),), form
    index = f"{command.argument}=" if row.reply == "assignment" else ""
    names = dict.fromkeys((row.name, command.spelled))
    axes = dict.fromkeys((str(command.axis or ""), ""))
    return tuple(f"{star}{axis}{name}{index}".encode() for name in names for axis in axes), form


def _with_quick_way(plan: Plan, link: Link) -> Plan:
    """The plan with the usual answer worked out, where each command ends with a prompt."""
    row = plan.commands[0].row if plan.kind in (Kind.REPLY, Kind.LINES) else None
    plan = replace(plan, row=row)
    if not link.prompting or plan.count != 1:
        return plan
    echo = plan.echoed.upper() + link.framing.eol if link.echo else b""
    if plan.kind is Kind.SETTING:
        return replace(plan, confirmation=echo + link.good_prompt)
    if plan.form is None:
        return plan
    head = echo + link.framing.bot + plan.heads[0]
    tail = link.framing.eot + link.good_prompt
    whole = re.compile(re.escape(head) + b"(" + plan.form.pattern + b")" + re.escape(tail))
    label = plan.heads[0].decode("latin-1").removeprefix("*")
    return replace(plan, whole=whole, label=label, tells_itself=bool(label))
