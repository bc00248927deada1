"""Help for one command or a list of them, from the catalogue: what it is called, takes, answers, and who says so."""

from __future__ import annotations

import textwrap

from protocol.catalogue import CommandRow, commands, lookup

WIDTH = 100


def describe(name: str) -> str | None:
    """A few lines of help for a command or operand (any case), or None when the language has no such word."""
    row = lookup(name)
    return None if row is None else "\n".join(_lines(row))


def _lines(row: CommandRow) -> list[str]:
    lines = [f"{row.name}  {row.title}", f"  syntax   {row.syntax}"]
    fields = row.fields
    if fields.count:
        kept = [f"{fields.count} field{'s' if fields.count > 1 else ''}{', one an axis' if fields.per_axis else ''}"]
        kept += [text for text in (fields.units, fields.values, fields.parts) if text]
        lines += _wrapped("fields", "; ".join(kept))
    if fields.min is not None or fields.max is not None:
        lines.append(f"  range    {fields.min} to {fields.max}")
    if fields.default is not None:
        lines.append(f"  default  {fields.default}")
    if row.query_response:
        lines += _wrapped("reply", row.query_response)
    if row.needs:
        lines += _wrapped("needs", row.needs)
    if row.notes:
        lines += _wrapped("notes", row.notes)
    lines += _wrapped("source", f"{row.source} (confidence {row.confidence})")
    if not row.applies_to_oem6250:
        lines.append("  not on the OEM6250: answers COMMAND NOT IMPLEMENTED")
    return lines


def _wrapped(head: str, text: str) -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=f"  {head:<9}", subsequent_indent=" " * 11)


def matching(prefix: str) -> list[CommandRow]:
    """The commands whose name starts with ``prefix`` (any case), by name: what completion offers."""
    upper = prefix.upper()
    unique = {row.name: row for name, row in commands().items() if name.startswith(upper)}
    return [unique[name] for name in sorted(unique)]
