"""From bytes to command texts: what the unit does with each character it receives.

CR, LF and colon end a command; the LF straight after a CR is swallowed.  A semicolon starts a comment that runs to the
next CR or LF, colons included.  NUL is ignored (telnet sends CR NUL for Enter), BS deletes the last character of the
command under way, XON and XOFF never belong to a command, Ctrl-K kills at once without waiting for a delimiter.
A command longer than the limit is dropped whole and reported once, so memory stays bounded whatever arrives.

The assembler works in one pass over the bytes however they are cut: feeding a session byte by byte or whole gives
the same tokens, except that echo may be cut into different pieces.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum
from functools import lru_cache
from typing import NamedTuple

NUL, BS, LF, CTRL_K, CR, XON, XOFF = 0, 8, 10, 11, 13, 17, 19
COLON, SEMICOLON = ord(":"), ord(";")

DEFAULT_MAX_COMMAND = 100
"""Characters between delimiters, blanks not counted (assumed L: hosts use buffers of 80 to 120)."""

BLANKS_KEPT_PER_CHARACTER = 4
"""Blanks are neutral but stay editable by BS until the delimiter; this bounds how many stay (ours, not the unit's)."""

USUAL_LINE = 64
"""Packets up to this length that hold whole lines are remembered: hosts send the same few over and over."""

_LINE_ENDS = (b"\r", b"\n")
_SPECIAL = re.compile(rb"[\x00\x08\x0b\x11\x13\r\n:;]")


class TokenKind(Enum):
    """What a stretch of received bytes amounts to."""

    CHARACTERS = "characters"
    COMMAND = "command"
    EMPTY_LINE = "empty line"
    EMPTY = "empty"
    TOO_LONG = "too long"
    KILL = "kill"


class Token(NamedTuple):
    """``echo``: the characters as received, upper-cased, without the delimiter; ``ends_line``: CR or LF ended it,
    else a colon (or nothing yet); ``text``: the command without delimiter and comment, as typed; ``delimiter``: the
    character that ended it, as received."""

    kind: TokenKind
    echo: bytes
    ends_line: bool
    text: str
    delimiter: bytes = b""


class LineAssembler:
    """Assembles the commands of one connection; keeps half a command until the rest arrives."""

    def __init__(self, max_command: int = DEFAULT_MAX_COMMAND) -> None:
        self.max_command = max_command
        self._max_kept = max_command * BLANKS_KEPT_PER_CHARACTER
        self.clear()

    def clear(self) -> None:
        """Forget a half-typed command."""
        self._text = bytearray()
        self._too_long = False
        self._in_comment = False
        self._after_cr = False
        self._line_had_colon = False

    @property
    def pending(self) -> int:
        """Characters of the command under way that are kept."""
        return len(self._text)

    def feed(self, data: bytes) -> Iterator[Token]:
        """Yield the tokens of ``data`` in order; the caller acts on each before the next is made (an ECHO0 inside
        a packet silences the rest of it)."""
        if len(data) <= USUAL_LINE and data[-1:] in _LINE_ENDS and data[:1] != b"\n" and self._is_clear:
            self._after_cr = data[-1] == CR
            yield from _tokens_of_lines(data, self.max_command)
        else:
            yield from self._scan(data)

    def _scan(self, data: bytes) -> Iterator[Token]:
        position = 0
        while position < len(data):
            match = _SPECIAL.search(data, position)
            end = match.start() if match else len(data)
            run = data[position:end]
            if run:
                self._after_cr = False
                self._append(run)
            if match is None:
                yield Token(TokenKind.CHARACTERS, run.upper(), False, "")
                return
            position = end + 1
            token = self._special(data[end], run.upper())
            if token is not None:
                yield token

    @property
    def _is_clear(self) -> bool:
        """Nothing of an earlier packet matters for the next, but a CR."""
        return not (self._text or self._too_long or self._in_comment or self._line_had_colon)

    def _append(self, run: bytes) -> None:
        if self._in_comment or self._too_long:
            return
        self._text += run
        if len(self._text) > self.max_command:
            self._check_length()

    def _check_length(self) -> None:
        used = len(self._text) - self._text.count(b" ") - self._text.count(b"\t")
        if used > self.max_command or len(self._text) > self._max_kept:
            self._too_long = True
            self._text.clear()

    def _special(self, byte: int, echo: bytes) -> Token | None:
        if byte == LF and self._after_cr:
            self._after_cr = False
            return Token(TokenKind.CHARACTERS, echo, False, "") if echo else None
        if byte in (NUL, XON, XOFF):
            return Token(TokenKind.CHARACTERS, echo, False, "") if echo else None
        self._after_cr = byte == CR
        if byte in (CR, LF):
            return self._end_line(echo, bytes((byte,)))
        if byte == COLON:
            return self._end_command_at_colon(echo)
        if byte == BS:
            if self._text and not self._in_comment:
                del self._text[-1]
            return Token(TokenKind.CHARACTERS, echo + b"\b", False, "")
        if byte == SEMICOLON:
            self._in_comment = True
            return Token(TokenKind.CHARACTERS, echo + b";", False, "")
        return Token(TokenKind.KILL, echo, False, "!K")

    def _end_command_at_colon(self, echo: bytes) -> Token:
        if self._in_comment:
            return Token(TokenKind.CHARACTERS, echo + b":", False, "")
        kind, text = self._take(TokenKind.EMPTY)
        self._line_had_colon = True
        return Token(kind, echo, False, text, b":")

    def _end_line(self, echo: bytes, delimiter: bytes) -> Token:
        kind, text = self._take(TokenKind.EMPTY if self._line_had_colon else TokenKind.EMPTY_LINE)
        self._in_comment = False
        self._line_had_colon = False
        return Token(kind, echo, True, text, delimiter)

    def _take(self, when_empty: TokenKind) -> tuple[TokenKind, str]:
        if self._too_long:
            self._too_long = False
            return TokenKind.TOO_LONG, ""
        text = self._text.decode("latin-1").strip(" \t")
        self._text.clear()
        return (TokenKind.COMMAND, text) if text else (when_empty, "")


@lru_cache(maxsize=1024)
def _tokens_of_lines(data: bytes, max_command: int) -> tuple[Token, ...]:
    """The tokens of whole lines that arrive when nothing is half-typed."""
    return tuple(LineAssembler(max_command)._scan(data))
