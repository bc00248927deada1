"""The 6000 Series command language, both ways and without I/O: framing, reading, catalogue, replies, status words.

The emulator and the client library share this package; it imports nothing of either, keeps no time and opens nothing.
"""

from protocol.catalogue import CommandRow, commands, lookup, operands, rows, status_words
from protocol.command import Command, Direction, VariableReference, parse_command
from protocol.errors import CommandError, ProtocolError, ReplyError
from protocol.line import LineAssembler, Token, TokenKind
from protocol.reply import Framing, ReplyLine
from protocol.reply_shapes import ParsedReply, parse_reply_line
from protocol.status import AxisStatus, ErrorStatus, ExtendedAxisStatus, FollowingStatus, OtherInputs, SystemStatus

__all__ = [
    "AxisStatus",
    "Command",
    "CommandError",
    "CommandRow",
    "Direction",
    "ErrorStatus",
    "ExtendedAxisStatus",
    "FollowingStatus",
    "Framing",
    "LineAssembler",
    "OtherInputs",
    "ParsedReply",
    "ProtocolError",
    "ReplyError",
    "ReplyLine",
    "SystemStatus",
    "Token",
    "TokenKind",
    "VariableReference",
    "commands",
    "lookup",
    "operands",
    "parse_command",
    "parse_reply_line",
    "rows",
    "status_words",
]
