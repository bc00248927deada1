"""Lines and heads of a recording: whatever is written is read as it was."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.recording.format import (
    Attached,
    Detached,
    Done,
    End,
    Entry,
    Received,
    RecordingError,
    Sent,
    escaped,
    format_entry,
    parse_entry,
    unescaped,
)
from emulator.recording.header import Header, HeaderReader, check_first_line, format_header

times = st.integers(0, 10**18 - 1)
units = st.integers(0, 999)
channels = st.integers(-1, 10**9 - 1)
names = st.from_regex(r"[a-z_][a-z0-9_]{0,12}", fullmatch=True)
values = st.one_of(st.booleans(), st.integers(-(2**40), 2**40), st.floats(allow_nan=False), st.text())
entries: st.SearchStrategy[Entry] = st.one_of(
    st.builds(Received, times, units, channels, st.binary()),
    st.builds(Sent, times, units, st.none() | channels, st.binary()),
    st.builds(Attached, times, units, channels),
    st.builds(Detached, times, units, channels),
    st.builds(Done, times, units, st.integers(0, 98), names, st.dictionaries(names, values, max_size=4)),
    st.builds(End, times),
)
keys = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
blocks = st.from_regex(r"[a-z]{1,8} u[0-9]", fullmatch=True)


@given(entries)
def test_a_line_is_read_as_it_was_written(entry: Entry) -> None:
    written = format_entry(entry)
    assert written.endswith(b"\n")
    assert written.count(b"\n") == 1
    read = parse_entry(written[:-1].decode("ascii"))
    assert read == entry
    if isinstance(entry, Done) and isinstance(read, Done):
        assert [type(value) for value in read.parameters.values()] == [type(v) for v in entry.parameters.values()]


@given(st.binary())
def test_bytes_survive_their_escapes(data: bytes) -> None:
    assert unescaped(escaped(data)) == data
    assert escaped(data).isprintable()


@given(st.dictionaries(keys, st.text()), st.dictionaries(blocks, st.text(st.characters(exclude_categories=["Cs"]))))
def test_a_head_is_read_as_it_was_written(fields: dict[str, str], texts: dict[str, str]) -> None:
    written = format_header(Header(fields, texts))
    first, *lines = written[:-1].split(b"\n")
    check_first_line(first.decode())
    reader = HeaderReader()
    heads = [reader.take(line.decode()) for line in lines]
    assert heads[:-1] == [None] * (len(lines) - 1)
    assert heads[-1] == Header(fields, texts)


def test_the_lines_of_the_documentation() -> None:
    assert format_entry(Received(12_345_678_901, 0, 3, b"1TPE\r")) == b'12.345678901 u0 c3 > "1TPE\\r"\n'
    assert format_entry(Sent(5, 1, None, b'"\x00\\')) == b'0.000000005 u1 c* < "\\"\\x00\\\\"\n'
    wire = Done(13_000_000_000, 0, 2, "set_wire", {"name": "enable", "closed": False})
    assert format_entry(wire) == b'13.000000000 u0.2 ! set_wire name="enable" closed=false\n'


def test_what_a_person_leaves_out() -> None:
    assert parse_entry('0 > "1TPE\\r"') == Received(0, 0, 0, b"1TPE\r")
    assert parse_entry('1.5 < "\\x2a"') == Sent(1_500_000_000, 0, 0, b"*")
    assert parse_entry("# a remark") is None
    assert parse_entry("  ") is None


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("hello", "no line of a recording"),
        ('1.0 u0 c0 > "1TPE', "not bytes in double quotes"),
        ('1.0 u0 c0 > "\\q"', "not an escape"),
        ('1.0 u0 c0 > "\u00e4"', "more than ASCII"),
        ('1.0 u0 c* > "a"', "c\\* stands before <"),
        ("1.0 u0 c0 >", "nothing after >"),
        ("1.0 end now", "too much after end"),
        ("1.0 u0 ! 7", "name of an action"),
        ("1.0 u0 ! set_wire enable", "not name=value"),
        ("1.0 u0 ! set_wire name=enable", "no number, text"),
        ('1.0 u0.1 c0 > "a"', "only an action"),
        ('1.0000000001 u0 c0 > "a"', "no line of a recording"),
    ],
)
def test_a_wrong_line_says_what_is_wrong(line: str, said: str) -> None:
    with pytest.raises(RecordingError, match=said):
        parse_entry(line)


@pytest.mark.parametrize(
    ("line", "said"),
    [("oem6250 recording 2", "version 2; this program reads version 1"), ("hello", "not a recording")],
)
def test_other_files_and_versions_are_refused(line: str, said: str) -> None:
    with pytest.raises(RecordingError, match=said):
        check_first_line(line)
