"""One command and the bytes that come back: finds the echo, the reply, a refusal and the prompt among whatever else the
unit says, however the bytes are cut.

Where every command ends with a prompt (ERRLVL 4 and 3) a reply counts when its head, its form, EOT and a prompt fit
together; a prompt that an earlier command owed may come before the reply or in the middle of it. Below that a reply
ends with EOT, or, when it may have several lines or EOT is nothing, when the line stays quiet.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from clients.errors import Garbled, LinkError, NoAnswer, UnitError
from clients.link import Link, Prompts
from clients.plan import Answer, Kind, Plan
from protocol.reply_shapes import reply_value

MOST_BYTES = 262_144
"""More than that is no answer of a unit with 40 kB of memory (ours)."""

SLOWEST_ANSWER = 4
"""Quiet times (0.2 s) that a unit may take to begin an answer, where it may as well give none (ours)."""

_LINE_ENDS = b"\r\n"

_COMMANDS = re.compile(rb"[^:]*:|[^:]+\Z")
"""The commands of a line, each with the colon that ends it."""

_MESSAGE = re.compile(rb"\*((?:[A-Z]{2,}|WARNING:)(?:[ _:-][A-Z0-9_ :-]*[A-Z0-9])+)[\r\n\x00]*$")
"""An error message as it looks: words in capitals, with blanks (6000) or underscores (Gemini) between them."""


class Exchange:
    """One exchange under way. `take` what comes; `quiet` when nothing came for a while; `expired` when time is over."""

    def __init__(self, plan: Plan, link: Link, prompts: Prompts, owed: list[str]) -> None:
        """`owed`: earlier commands that were not waited for and whose prompt or refusal may still come."""
        self._plan, self._link, self._prompts, self._owed = plan, link, prompts, owed
        self._refused: str | None = None
        self._empty = False
        # ERRBAD0 at ERRLVL4: messages come without a prompt that would mark them.
        self._unmarked = link.framing.rules.error_text and not link.bad_prompt
        self.received = b""
        self.other = b""

    @property
    def settles(self) -> int:
        """After how many quiet times silence tells something; 0: never."""
        if not self.received:
            silent = self._plan.kind is Kind.LINK or (self._unmarked and self._plan.kind is Kind.SETTING)
            return SLOWEST_ANSWER if silent else 0
        return int(self._refused is not None or self._empty or self._plan.kind is Kind.LINK or not self._link.prompting)

    def begin(self) -> Answer | None:
        """The answer, where none comes: a setting below ERRLVL3 without echo."""
        if self._plan.kind is Kind.SETTING and not (self._link.prompting or self._link.echo or self._unmarked):
            return Answer(self._plan.line)
        return None

    def take(self, data: bytes) -> Answer | None:
        """Bytes came; the answer once it is complete.

        Raises:
            UnitError: the unit refused the command.
            Garbled: far more came than any answer has.
        """
        if not self.received and not self._owed and (answer := self._plan.quick(data)):
            return answer
        self.received += data
        if len(self.received) > MOST_BYTES:
            raise Garbled(self._expected(), self.received, "no end of it: is this port a 6000 Series controller's?")
        return self._finished(self._look(at_rest=False))

    def quiet(self) -> Answer | None:
        """Nothing more came for the quiet time."""
        answer = self._look(at_rest=True)
        if answer is None and self._refused is not None:
            raise UnitError(self._refused, self._plan.line)
        return self._finished(answer)

    def expired(self, timeout_s: float) -> LinkError:
        """What to raise when time is over."""
        body = self._after_echo()
        rest = (self.received if body is None else body).strip(b"\r\n\x00")
        if not rest:
            only = "only the echo came: " if self.received else ""
            advice = f"{only}is it the unit's port, at its baud rate, with this address? Waited {timeout_s:g} s"
            return NoAnswer(self._expected(), self.received, advice)
        return Garbled(self._expected(), self.received, "check baud rate and framing, or synchronise() again")

    def _expected(self) -> str:
        plan = self._plan
        if plan.kind is Kind.SETTING:
            return f"the prompt after {plan.line!r}" if self._link.prompting else f"the echo of {plan.line!r}"
        head = plan.heads[0].decode("latin-1") if plan.heads else ""
        return f"a reply {head + '...' if head else ''} to {plan.line!r}".replace("  ", " ")

    def _finished(self, answer: Answer | None) -> Answer | None:
        if answer is not None and self._refused is not None:
            names = ", ".join(self._owed) or "an earlier command"
            self._owed.clear()
            raise UnitError(self._refused, names, late=True)
        return answer

    def _after_echo(self) -> bytes | None:
        """What follows the echo; None as long as it is awaited."""
        if not self._link.echo:
            return self.received
        start = self._link.skip_echo(self.received, self._plan.echoed)
        if start < 0:
            return self._among_echoes() if self._plan.count > 1 else None
        return self.received[start:]

    def _among_echoes(self) -> bytes | None:
        """What stands between and after the echoes of several commands: each may be answered at its colon.

        An asterisk before it shows the name in a reply, which is no echo.
        """
        *pieces, last = _COMMANDS.findall(self._plan.echoed)
        rest, kept = self.received, []
        for piece in pieces:
            found = re.search(rb"(?<!\*)" + re.escape(piece), rest, re.IGNORECASE)
            if found is None:
                return None
            kept.append(rest[: found.start()])
            rest = rest[found.end() :]
        found = re.search(rb"(?<!\*)" + re.escape(last), rest, re.IGNORECASE)
        if found is None:
            return None
        kept.append(rest[: found.start()])
        end = found.start() + self._link.skip_echo(rest[found.start() :], last)
        return b"".join([*kept[1:], rest[end:]])

    def _look(self, *, at_rest: bool) -> Answer | None:
        body = self._after_echo()
        kind = self._plan.kind
        if kind is Kind.LINK:
            return self._changed(body) if at_rest else None
        if body is None:
            if kind is Kind.SETTING or not self._link.framing.rules.asterisk:
                return None
            body = self.received
        body = self._without_refusals(body)
        if self._link.prompting:
            return self._acknowledged(body) if kind is Kind.SETTING else self._prompted(body, at_rest=at_rest)
        if self._unmarked and at_rest and (message := _MESSAGE.search(body)):
            raise UnitError(message[1].decode("ascii"), self._plan.line)
        if kind is Kind.SETTING:
            return None if self._unmarked and not at_rest else Answer(self._plan.line, text=body.decode("latin-1"))
        return self._unprompted(body, at_rest=at_rest)

    def _changed(self, body: bytes | None) -> Answer:
        """After a command that changes the form of answers: anything but a refusal will do."""
        body = self.received if body is None else body
        bad = self._link.bad_prompt
        if bad and body.endswith(bad):
            raise UnitError(last_message(body.removesuffix(bad).removesuffix(self._link.framing.eot)), self._plan.line)
        return Answer(self._plan.line, text=body.decode("latin-1"))

    def _without_refusals(self, body: bytes) -> bytes:
        """The bytes without error messages and their prompts; a refusal of this very command is raised."""
        bad, start, kept = self._link.bad_prompt, 0, b""
        while bad and (end := body.find(bad, start)) >= 0:
            text, begin = _split_message(body[start:end].removesuffix(self._link.framing.eot))
            if not self._owed:
                raise UnitError(text, self._plan.line)
            self._refused = text
            kept, start = kept + body[start : start + begin], end + len(bad)
        return kept + body[start:]

    def _acknowledged(self, body: bytes) -> Answer | None:
        """A setting: as many prompts as there are commands, and those owed before a buffered one."""
        wanted = self._plan.count + (0 if self._plan.immediate else len(self._owed))
        matches = list(self._all_prompts(body))
        if len(matches) < wanted:
            return None
        if not self._plan.immediate:
            self._owed.clear()
        last = matches[wanted - 1]
        self.other = self._prompts.removed(body[last.end() :])
        text = self._prompts.removed(body[: last.start()]).decode("latin-1")
        return Answer(self._plan.line, _plain_lines(text), "", self._prompts.kind(last), text)

    def _all_prompts(self, body: bytes) -> Iterator[re.Match[bytes]]:
        start = 0
        while match := self._prompts.find(body, start):
            yield match
            start = match.end()

    def _prompted(self, body: bytes, *, at_rest: bool) -> Answer | None:
        """A reply, EOT and a prompt in a row; prompts of earlier commands may come before it or in its middle."""
        matches = list(self._all_prompts(body))
        start = 0
        for match in matches:
            if answer := self._reply_in(body[start : match.start()], match):
                self._set_aside(body[:start], body[match.end() :])
                return answer
            start = match.end()
        if len(matches) > 1:
            mended = self._prompts.removed(body[: matches[-1].start()])
            if answer := self._reply_in(mended, matches[-1]):
                del self._owed[: len(matches) - 1]
                self._set_aside(b"", body[matches[-1].end() :])
                return answer
        self._empty = self._plan.kind is Kind.LINES and bool(matches) and b"*" not in body
        if at_rest and self._empty:
            return Answer(self._plan.line, prompt=self._prompts.kind(matches[-1]), row=self._plan.row)
        return None

    def _reply_in(self, piece: bytes, prompt: re.Match[bytes]) -> Answer | None:
        eot = self._link.framing.eot
        if eot and not piece.endswith(eot):
            return None
        text = piece[: len(piece) - len(eot)]
        for head in self._plan.heads:
            at = text.find(head) if self._plan.form is None else text.rfind(head)
            value = text[at + len(head) :]
            if at >= 0 and (self._plan.form is None or self._plan.form.fullmatch(value)):
                self._set_aside(text[:at], b"")
                return self._answer(head, value, self._prompts.kind(prompt))
        return None

    def _unprompted(self, body: bytes, *, at_rest: bool) -> Answer | None:
        framing, plan = self._link.framing, self._plan
        body = body.removeprefix(framing.bot)
        if not body:
            return None
        for head in plan.heads:
            at = body.find(head)
            if at < 0:
                continue
            if plan.form is None:
                return self._answer(head, _cut(body[at + len(head) :], framing.eot), "") if at_rest else None
            if answer := self._line_in(body, head, at, at_rest=at_rest):
                return answer
        return None

    def _line_in(self, body: bytes, head: bytes, at: int, *, at_rest: bool) -> Answer | None:
        """A line of known form from `at` on, ended by EOT (a later unit of a chain makes EOL of it) or by silence."""
        form, framing = self._plan.form, self._link.framing
        assert form is not None
        for match in form.finditer(body, at + len(head)) if not head else _one(form.match(body, at + len(head))):
            ended = any(end and body.startswith(end, match.end()) for end in (framing.eot, framing.eol))
            if ended or (at_rest and (not framing.eot or match.end() == len(body))):
                self._set_aside(body[:at], body[match.end() :])
                return self._answer(head, match[0], "")
        return None

    def _answer(self, head: bytes, value: bytes, prompt: str) -> Answer:
        label = head.decode("latin-1").removeprefix("*")
        text = value.decode("latin-1")
        if self._plan.kind is not Kind.LINES:
            return Answer(self._plan.line, (label + text,), text, prompt, label + text, self._plan.row)
        eol = self._link.framing.eol.decode("latin-1")
        lines = tuple(line.removeprefix("*") for line in (text.split(eol) if eol else [text]))
        row = self._plan.row
        bare = reply_value(text, row) if row is not None and len(lines) == 1 else text
        return Answer(self._plan.line, lines, bare, prompt, text, row)

    def _set_aside(self, before: bytes, after: bytes) -> None:
        """Keep what is not the answer, without prompts and line ends."""
        ends = self._link.framing.eot + self._link.framing.eol + _LINE_ENDS
        for part in (before, after):
            found = len(list(self._all_prompts(part)))
            del self._owed[:found]
            self.other += self._prompts.removed(part).strip(ends)


def _one(match: re.Match[bytes] | None) -> list[re.Match[bytes]]:
    return [match] if match else []


def _cut(value: bytes, eot: bytes) -> bytes:
    """Without EOT; what a program says later is not cut off."""
    return (value.removesuffix(eot) if eot else value).rstrip(_LINE_ENDS)


def _split_message(data: bytes) -> tuple[str, int]:
    """The error message at the end of some bytes, and where it begins."""
    begin = data.rfind(b"*")
    if begin < 0:
        return "", len(data)
    return data[begin + 1 :].strip(b"\r\n\x00").decode("latin-1"), begin


def last_message(data: bytes) -> str:
    """The error message at the end of some bytes, "" if there is none."""
    return _split_message(data)[0]


def _plain_lines(text: str) -> tuple[str, ...]:
    return tuple(line for line in text.splitlines() if line)
