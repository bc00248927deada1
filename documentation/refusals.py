"""Which error texts the transcripts show each command to draw.

The manuals list errors in one table for the whole language; which command draws which is known from the sessions that
are played to the unit in the test suite. So the reference promises no refusal that is not tested.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Final

from emulator.conformance import TRANSCRIPTS, names_in
from protocol import catalogue

_NUMBER: Final = re.compile(r"\bn$")
_SENT: Final = "> "
_ANSWERED: Final = ("< ", "~ ")


def refusals(folder: Path = TRANSCRIPTS) -> Mapping[str, Sequence[str]]:
    """Command -> the error texts it draws in the transcripts of `folder`, in the order of the unit's list."""
    found: defaultdict[str, set[str]] = defaultdict(set)
    for path in sorted(folder.glob("*.txt")):
        for command, text in _of_transcript(path.read_text(encoding="utf-8")):
            found[command].add(text)
    order = {row.text: place for place, row in enumerate(catalogue.error_rows())}
    return {command: sorted(texts, key=order.__getitem__) for command, texts in found.items()}


def _of_transcript(text: str) -> Iterator[tuple[str, str]]:
    sent = ""
    for line in text.splitlines():
        if line.startswith(_SENT):
            sent = line.removeprefix(_SENT)
        elif line.startswith(_ANSWERED) and (errors := list(_errors_in(line))) and (command := _only_command(sent)):
            yield from ((command, error) for error in errors)


def _only_command(line: str) -> str:
    """The command of a line that holds one; empty for several, since the error could be of any."""
    named = [name for name in names_in(line) if name in catalogue.commands()]
    return named[0] if len(named) == 1 else ""


def _errors_in(line: str) -> Iterator[str]:
    stems, pattern = _stems()
    for found in pattern.finditer(line.replace("\\", "")):
        yield stems[found[1]]


@cache
def _stems() -> tuple[Mapping[str, str], re.Pattern[str]]:
    """Error text without the number at its end -> the text, and what finds one; the longest first, some begin alike."""
    stems = {_NUMBER.sub("", row.text): row.text for row in catalogue.error_rows()}
    longest_first = sorted(stems, key=len, reverse=True)
    return stems, re.compile(r"\*(" + "|".join(map(re.escape, longest_first)) + ")")
