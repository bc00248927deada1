"""The language reference: a page for each group of the catalogue, an entry for each command, operator and operand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Final

from documentation.markdown import anchor, code, page, plain, table
from documentation.refusals import refusals
from emulator.conformance import SHOWN, Conformance
from emulator.conformance import table as conformance_table
from protocol.catalogue import CommandRow, Fields
from protocol.command import parse_command
from protocol.errors import CommandError

GROUPS: Final[Mapping[str, str]] = {
    "motion": "Motion",
    "drive": "Drive",
    "servo": "Servo",
    "scaling": "Scaling",
    "limits": "Limits",
    "homing": "Homing",
    "jog_joystick": "Jogging and joystick",
    "registration": "Registration and position capture",
    "following": "Following",
    "compiled": "Compiled profiles",
    "contouring": "Contouring",
    "status": "Reports",
    "error": "Error handling",
    "io": "Inputs and outputs",
    "analog": "Analog inputs",
    "display_rp240": "Operator panel RP240",
    "communications": "Communication",
    "program": "Programs",
    "program_flow": "Program flow",
    "variables": "Variables",
    "data": "Data programs",
    "memory": "Memory",
    "timer": "Timer",
    "operators": "Prefixes, operators and operands",
}
"""Groups of the catalogue in the order of the reference, with their headings."""

WHEN: Final = {
    "either": "in its turn; at once with `!`",
    "buffered": "in its turn; `!` is refused",
    "immediate": "at once",
}
KINDS: Final = {
    "setting": "setting: with a value it sets, without one it reports",
    "report": "report",
    "action": "action",
    "flow": "program flow",
    "operator": "operator or delimiter",
    "operand": "operand of expressions",
}
FIELD_TYPES: Final = {
    "real": "number",
    "int": "whole number",
    "binary": "0, 1 or X",
    "bit-pattern": "bits (0, 1, X)",
    "name": "name",
    "string": "text",
    "mixed": "see parts",
}


def pages() -> dict[str, str]:
    """File name -> text of the pages of all groups."""
    drawn = refusals()
    shown = _rows()
    return {
        f"commands-{group.replace('_', '-')}.md": _group_page(
            heading, [each for each in shown if _group_of(each.row) == group], drawn
        )
        for group, heading in _headings(shown).items()
    }


def index(names: Sequence[str]) -> str:
    """The page before the groups: how an entry reads, and every name with what it is."""
    listed = sorted((each for each in _rows() if each.row.name.isalpha()), key=lambda each: each.row.name)
    rows = [(f"[{each.row.name}](#{label(each.row)})", plain(each.row.title), each.state) for each in listed]
    toctree = "\n".join(name.removesuffix(".md") for name in names)
    return page("Commands", _INTRODUCTION, f"```{{toctree}}\n:maxdepth: 1\n\n{toctree}\n```", "## By name",
        table(("name", "what", "this emulator"), rows))  # fmt: skip


@cache
def _rows() -> Sequence[Conformance]:
    return conformance_table()


_INTRODUCTION: Final = """\
Made from the command catalogue of the program, `protocol/catalogue_data`. In the syntax `<!>`, `<@>` and `<a>` are the
prefixes that may stand before the name, `<i>` is a whole number, `<r>` a number, `<b>` one of 0, 1 and X. *Known from*
says where an entry comes from and how sure we are: a page of a manual, a host program that relies on it, an assumption.
*Refused with* lists the errors that the transcripts of the test suite show; the [list of errors](errors.md) has all of
them. *This emulator* says what of the command is there:

- **implemented**: it does what the entry says;
- **stored**: it is set and reported, without the effect;
- **absent**: it is answered as a command that the unit has not."""


def label(row: CommandRow) -> str:
    """The anchor of an entry. Signs have no letters, so their codes stand for them."""
    name = row.name if row.name.isalnum() else "-".join(f"{ord(character):x}" for character in row.name)
    return f"{'operand' if row.kind == 'operand' else 'command'}-{name.lower()}"


def _headings(shown: Sequence[Conformance]) -> dict[str, str]:
    """Groups that exist, those the list above does not know at the end under their own names."""
    there = {_group_of(each.row): _group_of(each.row).replace("_", " ").capitalize() for each in shown}
    known = {group: heading for group, heading in GROUPS.items() if group in there}
    return known | {group: heading for group, heading in there.items() if group not in known}


def _group_of(row: CommandRow) -> str:
    return row.group or "operators"


def _group_page(heading: str, entries: Sequence[Conformance], drawn: Mapping[str, Sequence[str]]) -> str:
    return page(heading, *(_entry(each, drawn.get(each.row.name, ())) for each in entries))


def _entry(each: Conformance, errors: Sequence[str]) -> str:
    row = each.row
    name = row.name if row.name.isalnum() else code(row.name)
    facts = [(what, text) for what, text in _facts(each, errors) if text]
    parts = [anchor(label(row)) + f"## {name}: {plain(row.title)}", table(("", ""), facts), plain(row.notes)]
    return "\n\n".join(part.strip("\n") for part in parts if part)


def _facts(each: Conformance, errors: Sequence[str]) -> Iterator[tuple[str, str]]:
    row = each.row
    yield "syntax", code(row.syntax)
    yield "also called", ", ".join(map(code, row.aliases))
    yield "kind", KINDS[row.kind]
    if row.kind not in ("operator", "operand"):
        yield "carried out", WHEN["buffered" if _refuses_prefix(row) else row.immediate]
    yield from _fields(row.fields)
    yield "reply", code(row.query_response)
    yield "needs", plain(row.needs) + (" (axes at rest)" if row.at_rest else "")
    yield "refused with", ", ".join(f"[{plain(text)}](errors.md)" for text in errors)
    yield "this emulator", each.state + (f": {plain(each.reason)}" if each.reason else "")
    yield "transcripts", _transcripts(each.transcripts)
    yield "known from", f"{plain(row.source)} (confidence {row.confidence})"


def _transcripts(names: Sequence[str]) -> str:
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(map(code, names[:SHOWN])) + more


def _refuses_prefix(row: CommandRow) -> bool:
    """Whether the unit's reader refuses `!` before it, whatever the catalogue's column says."""
    try:
        parse_command("!" + row.name)
    except CommandError:
        return row.immediate == "buffered"
    return False


def _fields(fields: Fields) -> Iterator[tuple[str, str]]:
    if fields.count:
        count = f"{fields.count}{', one an axis' if fields.per_axis else ''}"
        yield (
            "fields",
            "; ".join(part for part in (count, FIELD_TYPES.get(fields.type, ""), plain(fields.units)) if part),
        )
    yield "values", plain(fields.values)
    yield "parts", plain(fields.parts)
    yield "index", plain(fields.index)
    yield "operators", code(fields.operators)
    yield "range", _range(fields)
    yield "decimals", "" if fields.decimals is None else str(fields.decimals)
    yield "scaled by", _SCALES.get(fields.scale or "", "")
    yield "longest", f"{fields.max_length} characters" if fields.max_length else ""
    yield "default", "" if fields.default is None else code(str(fields.default))


_SCALES: Final = {
    "acceleration": "`SCLA`",
    "velocity": "`SCLV`",
    "distance": "`SCLD`",
    "master": "`SCLMAS`",
    "path_acceleration": "`PSCLA`",
    "path_velocity": "`PSCLV`",
}


def _range(fields: Fields) -> str:
    if fields.min is None and fields.max is None:
        return ""
    if fields.min is None or fields.max is None:
        return f"at least {plain(str(fields.min))}" if fields.max is None else f"at most {plain(str(fields.max))}"
    return f"{plain(str(fields.min))} to {plain(str(fields.max))}"
