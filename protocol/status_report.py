"""Full-text status reports (TASF, TSSF ...): one line a bit with YES or NO, as laid out for the 6000 Series.

Title line, for per-axis words a header with the axis numbers, then the labels padded to 23 columns; a bare ``*`` line
after every fourth bit but the last.  The layout is assumed (confidence low).
"""

from __future__ import annotations

from collections.abc import Sequence

from protocol.catalogue import StatusWordRow
from protocol.reply import ReplyLine

LABEL_WIDTH = 23
VALUE_WIDTH = 4
BITS_BETWEEN_BLANK_LINES = 4


def bit_labels(word: StatusWordRow, count: int) -> list[str]:
    """The label of each bit 1..count, RESERVED where the table has none."""
    labels = ["RESERVED"] * count
    for bit in word.bit:
        for number in range(bit.number, (bit.last_number or bit.number) + 1):
            labels[number - 1] = bit.label
    return labels


def status_table(
    title: str, labels: Sequence[str], columns: Sequence[str], *, axes: Sequence[int] | None
) -> list[ReplyLine]:
    """The lines of a report.

    ``columns`` holds one bit text a column (bit 1 first, ``len(labels)`` long); ``axes`` the axis numbers for the
    header, or None for a word of the whole unit.
    """
    lines = [ReplyLine("", title)]
    if axes is not None:
        lines.append(ReplyLine("", " " * LABEL_WIDTH + "AXIS #"))
        lines.append(ReplyLine("", (" " * LABEL_WIDTH + "".join(f"{axis:<{VALUE_WIDTH}}" for axis in axes)).rstrip()))
    for index, text in enumerate(labels):
        values = "".join(f"{'YES' if column[index] == '1' else 'NO':<{VALUE_WIDTH}}" for column in columns)
        lines.append(ReplyLine("", f"{text:<{LABEL_WIDTH}}{values}".rstrip()))
        last = index == len(labels) - 1
        if (index + 1) % BITS_BETWEEN_BLANK_LINES == 0 and not last:
            lines.append(ReplyLine("", ""))
    return lines
