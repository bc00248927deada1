"""Replies and prompts as bytes: the characters around them are programmable, what is said depends on ERRLVL.

Order at ERRLVL4: BOT, ``*``, text, EOT, then the ERROK prompt; several lines have EOL between them and EOT after the
last (GemCR p.112, p.117).  An error: BOT, CR LF, ``*``, message, EOT, then ERRBAD.  Lower levels drop parts:

=====  ==================  ==========  =================
level  reply               error text  prompts
=====  ==================  ==========  =================
4      ``*1TPE+0``         sent        all
3      ``*1TPE+0``         none        all
2      ``*1TPE+0``         none        ERRBAD only
1      ``*+0``             none        none
0      ``+0``              none        none
=====  ==================  ==========  =================

Level 4 is documented, the missing prompts of level 1 too (6000 PG p.72) and its missing names seen in a host driver;
levels 3, 2 and 0 are assumed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from protocol.errors import ReplyError

NULL_CODE = 256
"""A framing field of 256 sends a NUL; 0 sends nothing (GemCR p.112)."""


class ReplyLine(NamedTuple):
    """One line of a reply: ``label`` (axis number and command name) is what ERRLVL 1 and 0 leave out."""

    label: str
    value: str


@dataclass(frozen=True, slots=True)
class LevelRules:
    """What one ERRLVL sends."""

    names: bool
    asterisk: bool
    error_text: bool
    good_prompt: bool
    bad_prompt: bool
    defining_prompt: bool


def _level(*, names: bool, asterisk: bool, error_text: bool, prompts: bool, bad_prompt: bool) -> LevelRules:
    return LevelRules(names, asterisk, error_text, good_prompt=prompts, bad_prompt=bad_prompt, defining_prompt=prompts)


LEVEL_RULES = (
    _level(names=False, asterisk=False, error_text=False, prompts=False, bad_prompt=False),
    _level(names=False, asterisk=True, error_text=False, prompts=False, bad_prompt=False),
    _level(names=True, asterisk=True, error_text=False, prompts=False, bad_prompt=True),
    _level(names=True, asterisk=True, error_text=False, prompts=True, bad_prompt=True),
    _level(names=True, asterisk=True, error_text=True, prompts=True, bad_prompt=True),
)
"""The rules of ERRLVL 0 to 4, by level."""


def character_codes(codes: Sequence[int]) -> bytes:
    """The bytes a framing setting sends: ``13,10,0`` is CR LF, 256 a NUL."""
    return bytes(0 if code == NULL_CODE else code for code in codes if code)


@dataclass(frozen=True, slots=True)
class Framing:
    """The framing in force, as bytes, and what the error level in force sends."""

    bot: bytes = b""
    eol: bytes = b"\r\n"
    eot: bytes = b"\r"
    good_prompt: bytes = b"\r\n> "
    bad_prompt: bytes = b"\r\n? "
    defining_prompt: bytes = b"\r\n- "
    error_lead: bytes = b"\r\n"
    rules: LevelRules = LEVEL_RULES[4]

    def reply(self, lines: Sequence[ReplyLine]) -> bytes:
        """A whole reply, without prompt."""
        rules = self.rules
        star = "*" if rules.asterisk else ""
        if len(lines) == 1:
            text = f"{star}{lines[0].label}{lines[0].value}" if rules.names else f"{star}{lines[0].value}"
            return self.bot + text.encode("latin-1") + self.eot
        texts = [f"{star}{line.label if rules.names else ''}{line.value}".encode("latin-1") for line in lines]
        return self.bot + self.eol.join(texts) + self.eot

    def error(self, text: str) -> bytes:
        """An error message without prompt; nothing below level 4."""
        if not self.rules.error_text:
            return b""
        return self.bot + self.error_lead + b"*" + text.encode("latin-1") + self.eot

    def prompt(self, *, good: bool, defining: bool = False) -> bytes:
        """The prompt that ends a command; empty where the level sends none."""
        if not good:
            return self.bad_prompt if self.rules.bad_prompt else b""
        if defining:
            return self.defining_prompt if self.rules.defining_prompt else b""
        return self.good_prompt if self.rules.good_prompt else b""


def group_bits(bits: str, size: int = 4) -> str:
    """``00001000`` as ``0000_1000``; bit 1 first."""
    return "_".join(bits[start : start + size] for start in range(0, len(bits), size))


def ungroup_bits(text: str, size: int = 4) -> str:
    """The reverse of ``group_bits``.

    Raises:
        ReplyError: not groups of ``size`` of the digits 0, 1, X, E.
    """
    bits = text.replace("_", "")
    if not bits or set(bits) - set("01XE") or group_bits(bits, size) != text:
        raise ReplyError(f"not a bit pattern in groups of {size}: {text!r}")
    return bits


def word_bits(word: int, count: int) -> str:
    """An integer status word as text, bit 1 (least significant) first."""
    return format(word & ((1 << count) - 1), f"0{count}b")[::-1]


def bits_word(bits: str) -> int:
    """The reverse of ``word_bits``; X counts as 0."""
    return int(bits[::-1].replace("X", "0"), 2)
