"""A host and a unit joined by a fake wire: every exchange is looked at from both ends.

What the host sends is assembled twice, in one piece and byte by byte, and must amount to the same; what the unit
answers is framed into bytes, cut into lines as a host does it and read back with the row it was made from.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from protocol.catalogue import CommandRow
from protocol.line import DEFAULT_MAX_COMMAND, LineAssembler, Token, TokenKind
from protocol.reply import Framing, ReplyLine
from protocol.reply_shapes import ParsedReply, parse_reply_line


def joined(tokens: Iterable[Token]) -> list[Token]:
    """Tokens with the echo of bare characters moved into the token that follows, so cuts no longer show."""
    result: list[Token] = []
    echo = b""
    for token in tokens:
        echo += token.echo
        if token.kind is not TokenKind.CHARACTERS:
            result.append(token._replace(echo=echo))
            echo = b""
    if echo:
        result.append(Token(TokenKind.CHARACTERS, echo, False, ""))
    return result


def assembled(chunks: Iterable[bytes], max_command: int = DEFAULT_MAX_COMMAND) -> list[Token]:
    """What a fresh assembler makes of ``chunks``, joined."""
    assembler = LineAssembler(max_command)
    return joined(token for chunk in chunks for token in assembler.feed(chunk))


class ConnectionPair:
    """The two ends of one serial line, with the framing the unit has in force."""

    def __init__(self, framing: Framing | None = None, max_command: int = DEFAULT_MAX_COMMAND) -> None:
        self.framing = framing or Framing()
        self.max_command = max_command

    def host_sends(self, data: bytes) -> list[Token]:
        """The joined tokens the unit sees; the cut into packets must not matter."""
        whole = assembled([data], self.max_command)
        single = assembled((bytes([byte]) for byte in data), self.max_command)
        assert single == whole
        return whole

    def unit_answers(self, row: CommandRow, lines: Sequence[ReplyLine]) -> list[ParsedReply]:
        """What the host reads from a reply of the unit."""
        data = self.framing.reply(lines)
        assert data.startswith(self.framing.bot) and data.endswith(self.framing.eot)
        text = data[len(self.framing.bot) : len(data) - len(self.framing.eot)].decode("latin-1")
        parts = text.split(self.framing.eol.decode("latin-1"))
        assert len(parts) == len(lines)
        return [parse_reply_line(part, row) for part in parts]
