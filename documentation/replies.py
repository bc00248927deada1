"""The reference pages of status words and their bits, error texts, and the letters of input and output functions."""

from __future__ import annotations

from typing import Final

from documentation.markdown import code, page, plain, table
from protocol.catalogue import (
    BitRow,
    IoFunctionRow,
    StatusWordRow,
    error_rows,
    io_functions,
    other_product_names,
    status_words,
)

BITS_IN_A_GROUP: Final = 4


def status_page() -> str:
    """Every status word with its bits."""
    head = (
        "A report prints bit 1 first, at the left, in groups of four: `*1TAS0000_0000_...`. An expression reads a word "
        "by the name of the operand, with or without a bit: `IF(1AS.1=b0)`, `VARB1=1AS`."
    )
    return page("Status words", head, *map(_word, status_words().values()))


def _word(word: StatusWordRow) -> str:
    facts = [plain(text) for text in (word.scope, word.format, word.polarity, word.note) if text]
    known = f"Known from: {plain(word.source)}" + (f" (confidence {word.confidence})" if word.confidence else "")
    bits = table(("bit", "meaning", "in the full-text report", "confidence"), map(_bit, word.bit))
    report = f", reported by {code(word.report)}" if word.report else ""
    parts = [f"## {word.name}{report}", "; ".join(facts) + "." if facts else "", f"{known}.", bits if word.bit else ""]
    return "\n\n".join(part.strip("\n") for part in parts if part)


def _bit(bit: BitRow) -> tuple[str, str, str, str]:
    number = str(bit.number) if bit.last_number is None else f"{bit.number} to {bit.last_number}"
    meaning = "; ".join(plain(text) for text in (bit.meaning, bit.branch, bit.notes) if text)
    return number, meaning, code(bit.label), bit.confidence


def errors_page() -> str:
    """Every error text, and what is answered to names of other products."""
    head = (
        "An error is sent as the BOT characters, a line end, `*`, the text and the EOT characters; then the ERRBAD "
        "prompt follows. How much of this is sent depends on [ERRLVL](#command-errlvl). *n* stands for the number of a "
        "field or an axis."
    )
    rows = [(code(row.text), plain(row.trigger), row.confidence) for row in error_rows()]
    return page(
        "Error texts",
        head,
        table(("text", "when", "confidence"), rows),
        "## Names of other products",
        "Host programs written for relatives of the unit may send these; what it answers:",
        table(("answer", "names"), _foreign_names()),
    )


def _foreign_names() -> list[tuple[str, str]]:
    names = other_product_names()
    return [
        (code(answer), ", ".join(code(name) for name in names if names[name] == answer))
        for answer in dict.fromkeys(names.values())
    ]


def io_page() -> str:
    """The letters of INFNC and OUTFNC."""
    return page(
        "Input and output functions",
        "`INFNC3-D` gives input 3 the function D; an axis number stands before the letter where it needs one: "
        "`INFNC5-1R`. They act with `INFEN1` and `OUTFEN1`.",
        "## INFNC",
        _letters(list(io_functions("infnc").values())),
        "## OUTFNC",
        _letters(list(io_functions("outfnc").values())),
    )


def _letters(rows: list[IoFunctionRow]) -> str:
    head = ("letter", "function", "notes", "on", "confidence")
    cells = [
        (code(row.letter), plain(row.meaning), plain(row.notes), plain(row.applies), row.confidence) for row in rows
    ]
    return table(head, cells)
