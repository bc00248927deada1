"""What a unit sends, cut into lines to show and prompts, without the echo of what was typed.

Nothing here waits for an answer to anything: at every error level, with any framing, in the middle of whatever, bytes
become lines. A prompt counts as one at the beginning of a line, so text that a program writes may lose a leading `> `.
"""

from __future__ import annotations

from collections import deque
from typing import Literal, NamedTuple

from protocol.line import LineAssembler
from protocol.reply import Framing

PromptKind = Literal["good", "bad", "defining"]

MOST_ECHOES = 64
"""So many commands may be typed ahead of their echoes (ours)."""

LONGEST_LINE = 4096
"""More than that without an end of line is shown in pieces (ours)."""

_IGNORED = bytes((0, 8, 17, 19))
"""NUL, the echo of backspaces, XON and XOFF: nothing to show."""

_FIRST_PRINTABLE = 32


class Piece(NamedTuple):
    """A line to show, or a prompt."""

    text: str
    prompt: PromptKind | None = None


class Incoming:
    """The bytes of one connection."""

    def __init__(self) -> None:
        self._rest = b""
        self._echoes: deque[bytes] = deque(maxlen=MOST_ECHOES)
        self._prompts: dict[bytes, PromptKind] = {}
        self._ends = bytearray(b"\r\n")
        self.use(Framing())

    def use(self, framing: Framing) -> None:
        """Know this framing, too; those known before stay known, because answers under them may be on their way."""
        kinds: tuple[tuple[bytes, PromptKind], ...] = (
            (framing.good_prompt, "good"),
            (framing.bad_prompt, "bad"),
            (framing.defining_prompt, "defining"),
        )
        for text, kind in kinds:
            if shown := _printable(text):
                self._prompts[shown] = kind
        for byte in framing.eot + framing.eol + framing.bot:
            if byte < _FIRST_PRINTABLE and byte not in self._ends and byte not in _IGNORED:
                self._ends.append(byte)

    def sent(self, line: str) -> None:
        """This line was sent: its echo, command by command, is not to be shown."""
        for token in LineAssembler().feed(line.encode("latin-1", "replace") + b"\r"):
            if echo := (token.echo + (b"" if token.ends_line else token.delimiter)).strip():
                self._echoes.append(echo)

    def feed(self, data: bytes) -> list[Piece]:
        """What is complete with these bytes."""
        ends = self._ends
        text = (self._rest + data.translate(bytes.maketrans(ends, b"\n" * len(ends)), _IGNORED)).split(b"\n")
        self._rest = text.pop()
        pieces = [piece for line in text for piece in self._line(line)]
        if self._rest in self._prompts or len(self._rest) > LONGEST_LINE:
            pieces += self.quiet()
        return pieces

    def quiet(self) -> list[Piece]:
        """Nothing more has come for a while: half a line is shown as it is."""
        rest, self._rest = self._rest, b""
        return self._line(rest)

    def _line(self, line: bytes) -> list[Piece]:
        """The prompts before a line, and what remains of it after the echoes."""
        pieces: list[Piece] = []
        while line:
            prompt = max((text for text in self._prompts if line.startswith(text)), key=len, default=b"")
            if prompt:
                pieces.append(Piece("", self._prompts[prompt]))
            cut = len(prompt) or self._echo(line)
            if not cut:
                break
            line = line[cut:]
        if line.strip():
            pieces.append(Piece(visible(line)))
        return pieces

    def _echo(self, line: bytes) -> int:
        """The length of the echo a line begins with; echoes that were expected before it will not come any more."""
        typed = line.upper()
        for index, echo in enumerate(self._echoes):
            upper = echo.upper()
            if typed.rstrip() == upper or (upper.endswith(b":") and typed.startswith(upper)):
                for _ in range(index + 1):
                    self._echoes.popleft()
                return len(line) if typed.rstrip() == upper else len(echo)
        return 0


def _printable(text: bytes) -> bytes:
    return bytes(byte for byte in text if byte >= _FIRST_PRINTABLE)


def visible(data: bytes) -> str:
    """Bytes as they can be put on a screen: what is no printable ASCII is spelled out."""
    return "".join(chr(byte) if 32 <= byte < 127 else f"\\x{byte:02x}" for byte in data)
