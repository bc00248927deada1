"""Contents for tests: made up by hypothesis, and one of everything by hand."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from typing import Any

from hypothesis import strategies as st

from emulator.state.contents import UNSET_BITS, Contents, GainValue, Number, ProgramText

FULL = Contents(
    settings=(("ADDR", "3"), ("DPASS", "77"), ("DRPCHK@2", "1"), ("MEMORY", "20000,20000"), ("STARTP", "MAIN")),
    numbers=(Decimal("0"), Decimal("3.50000000"), Decimal("-123456789.87654321")),
    bits=("X" * 31 + "1",),
    texts=("", 'it\'s "quoted"\\13'),
    programs=(
        ProgramText("MAIN", ("V2,3", "$L", "VAR1=VAR1+1", "GOTO L"), ((0, ((0, (Decimal("2.0"), 25000)),)),)),
        ProgramText("EMPTY", ()),
        ProgramText("DATP1", ("DATA=+1,+2.5",)),
    ),
    gains=(
        GainValue(1, 1, 1, "SGP", (Decimal("0.5"), 1)),
        GainValue(1, 2, 1, "SMPER", (Decimal("4000"), 25000)),
    ),
    profiles=(("PATH", "some compiled form"),),
)

any_text = st.text(st.characters(max_codepoint=255), max_size=12)
finite = st.decimals(allow_nan=False, allow_infinity=False, places=8)
odd = st.sampled_from([Decimal("-0"), Decimal("1E+3"), Decimal("0.00"), Decimal("1e-20"), Decimal("5")])
names = st.from_regex("[A-Z][A-Z0-9]{0,5}", fullmatch=True)
patterns = st.text("01X", min_size=32, max_size=32)
numbers: st.SearchStrategy[Number] = st.tuples(finite | odd, st.sampled_from([0, 1, 4000, 25000]))


@st.composite
def programs(draw: st.DrawFn) -> ProgramText:
    """A program of any lines at all, some with scaled values."""
    lines = draw(st.lists(any_text, max_size=8))
    places = draw(st.sets(st.integers(0, len(lines) - 1), max_size=4)) if lines else set()
    fields = st.dictionaries(st.integers(0, 3), numbers, min_size=1, max_size=3)
    scaled = tuple((place, tuple(draw(fields).items())) for place in sorted(places))
    return ProgramText(draw(names), tuple(lines), scaled)


gains = st.builds(GainValue, st.integers(1, 5), st.integers(1, 2), st.integers(1, 2), names, numbers)


@st.composite
def contents(draw: st.DrawFn) -> Contents:
    """Anything a unit could keep, and more."""
    return Contents(
        settings=tuple(sorted(draw(st.dictionaries(names, any_text, max_size=5)).items())),
        numbers=_trimmed(draw(st.lists(finite | odd, max_size=8)), lambda value: str(value) == "0"),
        bits=_trimmed(draw(st.lists(patterns, max_size=5)), lambda value: value == UNSET_BITS),
        texts=_trimmed(draw(st.lists(any_text, max_size=5)), lambda value: value == ""),
        programs=tuple(draw(st.lists(programs(), max_size=3, unique_by=lambda program: program.name))),
        gains=tuple(sorted(draw(st.lists(gains, max_size=4, unique_by=lambda gain: gain[:4])), key=_gain_name)),
        profiles=tuple(sorted(draw(st.dictionaries(names, any_text, max_size=3)).items())),
    )


def _gain_name(gain: GainValue) -> str:
    return f"SGSET{gain.set_number} axis{gain.axis} SFB{gain.feedback} {gain.command}"


def _trimmed(values: list[Any], cleared: Callable[[Any], bool]) -> tuple[Any, ...]:
    while values and cleared(values[-1]):
        values.pop()
    return tuple(values)
