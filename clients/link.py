"""What a client has to know of a unit's serial settings to find the answers in what it sends."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import Any

from protocol.command import Command
from protocol.reply import LEVEL_RULES, Framing, character_codes

FRAMING_COMMANDS = {
    "EOT": "eot",
    "EOL": "eol",
    "BOT": "bot",
    "ERROK": "good_prompt",
    "ERRBAD": "bad_prompt",
    "ERRDEF": "defining_prompt",
}
"""The settings that are character codes, and where `Framing` keeps them."""

LINK_COMMANDS = frozenset({*FRAMING_COMMANDS, "ECHO", "ERRLVL", "RESET"})
"""Commands after which answers look different."""

_ECHO_ENDS = (b"\r\n", b"\r", b"\n")


@dataclass(frozen=True)
class Link:
    """Echo, error level and framing in force; the default is a unit at power-up."""

    echo: bool = True
    level: int = 4
    framing: Framing = field(default_factory=Framing)

    @property
    def good_prompt(self) -> bytes:
        """What ends a command that was accepted; empty where nothing does."""
        return self.framing.prompt(good=True)

    @property
    def defining_prompt(self) -> bytes:
        """What ends a line between DEF and END; empty where nothing does."""
        return self.framing.prompt(good=True, defining=True)

    @property
    def bad_prompt(self) -> bytes:
        """What ends a command that was refused; empty where nothing does."""
        return self.framing.prompt(good=False)

    @property
    def prompting(self) -> bool:
        """Whether every accepted command is confirmed by a prompt."""
        return bool(self.good_prompt)

    @property
    def uses_nul(self) -> bool:
        """Whether NUL means something (code 256); else it is ignored, as telnet ports send CR NUL for CR."""
        framing = self.framing
        return b"\x00" in framing.eot + framing.eol + framing.bot + framing.good_prompt

    def with_level(self, level: int) -> Link:
        """The same at another ERRLVL."""
        return replace(self, level=level, framing=replace(self.framing, rules=LEVEL_RULES[level]))

    def with_codes(self, command: str, codes: tuple[int, ...]) -> Link:
        """The same after one of FRAMING_COMMANDS."""
        changed: dict[str, Any] = {FRAMING_COMMANDS[command]: character_codes(codes)}
        return replace(self, framing=replace(self.framing, **changed))

    def after(self, command: Command) -> Link:
        """The same after one of LINK_COMMANDS was accepted (RESET: the power-up settings)."""
        if command.name == "RESET":
            return Link()
        if command.name == "ECHO":
            return replace(self, echo=command.mask == "1") if command.mask in ("0", "1") else self
        values = tuple(int(str(value)) if value is not None else 0 for value in command.values)
        return self.with_level(values[0]) if command.name == "ERRLVL" else self.with_codes(command.name, values)

    def skip_echo(self, received: bytes, sent: bytes) -> int:
        """Where what follows the echo of a line begins, -1 as long as it is not there.

        The delimiter comes back as the EOL characters or as it was sent; hosts have seen both.
        """
        at = received.upper().find(sent.upper())
        if at < 0:
            return -1
        end = at + len(sent)
        for ending in (self.framing.eol, *_ECHO_ENDS):
            if ending and received.startswith(ending, end):
                return end + len(ending)
        return end


class Prompts:
    """Finds the prompts of a link in received bytes."""

    def __init__(self, link: Link) -> None:
        self.kinds = {
            text: kind
            for text, kind in (
                (link.bad_prompt, "bad"),
                (link.defining_prompt, "defining"),
                (link.good_prompt, "good"),
            )
            if text
        }
        texts = sorted(self.kinds, key=len, reverse=True)
        self._pattern = re.compile(b"|".join(map(re.escape, texts))) if texts else None

    def find(self, data: bytes, start: int = 0) -> re.Match[bytes] | None:
        """The next prompt from `start` on."""
        return self._pattern.search(data, start) if self._pattern else None

    def kind(self, match: re.Match[bytes]) -> str:
        """`good`, `bad` or `defining`."""
        return self.kinds[match[0]]

    def removed(self, data: bytes) -> bytes:
        """The bytes without the prompts in them."""
        return self._pattern.sub(b"", data) if self._pattern else data
