r"""Quoted text of VARS, WRITE and DWRITE: ``\nn`` stands for the character with that decimal code.

The quote, the colon, the semicolon and the backslash itself can only be written that way, and so can CR and LF, because
they would end the command (GemCR p.334)."""

from __future__ import annotations

import re

from protocol.errors import INCORRECT_DATA, CommandError

_QUOTED = re.compile(r'"([^"]*)"')
_CODE = re.compile(r"\\(\d{1,3})", re.ASCII)
_LARGEST_CODE = 255
_WRITTEN_AS_CODES = frozenset('":;\\')
_FIRST_PRINTABLE, _LAST_PRINTABLE = 32, 126


def unquoted(text: str) -> str:
    r"""The characters a quoted text stands for: ``"HI MOM\13"`` ends in CR.

    Raises:
        CommandError: INCORRECT DATA, no quotes or a backslash without a character code behind it.
    """
    match = _QUOTED.fullmatch(text)
    if match is None:
        raise CommandError(INCORRECT_DATA)
    inside = match[1]
    if "\\" not in inside:
        return inside
    if "\\" in _CODE.sub("", inside):
        raise CommandError(INCORRECT_DATA)
    return _CODE.sub(lambda code: _character(int(code[1])), inside)


def quoted(text: str) -> str:
    r"""Text as it would have to be entered, quotes included: what ``unquoted`` reads back."""
    return '"' + "".join(_written(character) for character in text) + '"'


def _character(code: int) -> str:
    if code > _LARGEST_CODE:
        raise CommandError(INCORRECT_DATA)
    return chr(code)


def _written(character: str) -> str:
    code = ord(character)
    if character in _WRITTEN_AS_CODES or not _FIRST_PRINTABLE <= code <= _LAST_PRINTABLE:
        # Three digits always: a digit that follows in the text must not become part of the code.
        return f"\\{code:03d}"
    return character
