"""Recordings of the Python face: they replay without a difference, and a difference is found where it is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emulator import Emulator, Machine
from emulator.cli import main
from emulator.recording import RecordingError, read, replay
from emulator.recording.comparison import render
from emulator.recording.format import Done, Received, Sent, escaped
from emulator.recording.machine_text import machine_text
from tests.recording.sessions import record

QUIET = "[defaults]\nECHO = 0\n"
SLOW_LINE = "[serial]\nbaud = 9600\n"


@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(seed=st.integers(0, 2**32), machine=st.sampled_from(["", QUIET, SLOW_LINE]), units=st.sampled_from([1, 1, 2]))
def test_any_session_replays_without_a_difference(
    tmp_path_factory: pytest.TempPathFactory, seed: int, machine: str, units: int
) -> None:
    path = tmp_path_factory.mktemp("rec") / "a.rec"
    record(path, seed, machine=machine, units=units)
    outcome = replay(path)
    assert outcome.difference is None, render(outcome.difference, path="a.rec")
    assert outcome.complete
    assert not outcome.raised
    assert outcome.inputs > 3


def test_the_same_session_gives_the_same_file_but_for_the_date(tmp_path: Path) -> None:
    for name in ("a.rec", "b.rec"):
        record(tmp_path / name, 6250, units=2)
    first, second = ((tmp_path / name).read_text().splitlines() for name in ("a.rec", "b.rec"))
    dated = [line for line in first if line.startswith("date = ")]
    assert len(dated) == 1
    assert [line for line in first if line not in dated] == [line for line in second if not line.startswith("date =")]


def small(path: Path) -> None:
    with Emulator(Machine.parse(QUIET), record=path) as emulator:
        unit = emulator.unit(0)
        unit.send(b"DRIVE11:D4000:GO11\r")
        emulator.advance(0.5)
        unit.do("set_wire", name="enable", closed=False)
        emulator.advance(0.25)
        unit.send(b"TER\r", channel=1)
        emulator.advance(0.25)


def test_actions_and_times_are_in_the_file(tmp_path: Path) -> None:
    small(tmp_path / "a.rec")
    recording = read(tmp_path / "a.rec")
    assert Done(500_000_000, 0, 0, "set_wire", {"name": "enable", "closed": False}) in recording.entries
    assert Received(750_000_000, 0, 1, b"TER\r") in recording.entries
    assert recording.header.texts["machine u0"] == '[defaults]\nECHO = "0"\n'
    answers = [entry for entry in recording.entries if isinstance(entry, Sent) and entry.channel == 1]
    assert answers[0].at_ns == 750_000_000


def test_an_action_that_is_refused_leaves_no_trace(tmp_path: Path) -> None:
    with Emulator(record=tmp_path / "a.rec") as emulator:
        with pytest.raises(KeyError):
            emulator.unit(0).do("set_wire", name="no such wire", closed=True)
        with pytest.raises(TypeError):
            emulator.unit(0).do("set_wire", name="enable", closed=1)
    assert not [entry for entry in read(tmp_path / "a.rec").entries if isinstance(entry, Done)]


def test_power_and_reset_replay(tmp_path: Path) -> None:
    with Emulator(record=tmp_path / "a.rec") as emulator:
        unit = emulator.unit(0)
        unit.send(b"VAR1=5\rDRIVE11:GO11\r")
        emulator.advance(0.1)
        unit.do("cut_power")
        emulator.advance(0.1)
        unit.send(b"1TPE\r")
        unit.do("restore_power")
        emulator.advance(0.1)
        unit.send(b"VAR1\rRESET\r1TPE\r")
        emulator.advance(0.1)
    assert replay(tmp_path / "a.rec").difference is None


@pytest.mark.parametrize("cut_lines", [False, True])
def test_a_recording_cut_anywhere(tmp_path: Path, capsys: pytest.CaptureFixture[str], cut_lines: bool) -> None:
    """After each byte (each line in the default run's second pass): no traceback, one clear line, the right status."""
    small(tmp_path / "whole.rec")
    data = (tmp_path / "whole.rec").read_bytes()
    head = data.index(b"\nbegin\n") + len(b"\nbegin\n")
    ends = [match.end() for match in re.finditer(rb"\n", data)] if cut_lines else range(0, head + 120)
    for length in ends:
        file = tmp_path / "cut.rec"
        file.write_bytes(data[:length])
        status = main(["replay", str(file)])
        told = capsys.readouterr()
        if length < head:
            assert status == 2
            assert told.err.count("\n") == 1
            assert "cut.rec" in told.err
        else:
            assert status == 0, told
            assert ("cut after line" in told.err) == (length < len(data))
            assert told.err.count("\n") <= 1
        assert "Traceback" not in told.err


def test_bytes_after_the_end_of_the_disk_are_a_cut(tmp_path: Path) -> None:
    """A file system that lost power may leave a tail of zeros."""
    small(tmp_path / "a.rec")
    data = (tmp_path / "a.rec").read_bytes()
    (tmp_path / "b.rec").write_bytes(data[: len(data) - 40] + bytes(400))
    outcome = replay(tmp_path / "b.rec")
    assert outcome.difference is None
    assert not outcome.complete


def doctored(tmp_path: Path, before: str, after: str) -> tuple[int, Path]:
    """The small recording with one text replaced; the line where that is."""
    small(tmp_path / "a.rec")
    text = (tmp_path / "a.rec").read_text()
    assert text.count(before) == 1, text
    (tmp_path / "b.rec").write_text(text.replace(before, after))
    return text[: text.index(before)].count("\n") + 1, tmp_path / "b.rec"


@pytest.mark.parametrize(
    ("before", "after", "kind", "offset"),
    [
        ('c1 < "*TER', 'c1 < "*TES', "bytes", 3),
        ('0.750000000 u0 c1 < "', '0.750000001 u0 c1 < "', "time", 0),
        ('u0 c1 < "', 'u0 c* < "', "connection", 0),
        ('0.750000000 u0 c1 > "TER\\r"\n', '0.750000000 u0 c1 > "TAS\\r"\n', "bytes", 1),
    ],
)
def test_a_doctored_recording_is_caught_where_it_was_doctored(
    tmp_path: Path, before: str, after: str, kind: str, offset: int
) -> None:
    line, path = doctored(tmp_path, before, after)
    difference = replay(path).difference
    assert difference is not None
    assert (difference.kind, difference.offset) == (kind, offset)
    assert difference.expected is not None
    assert difference.expected.line in (line, line + 1)
    assert difference.cause is not None
    assert difference.cause.command in (b"TER\r", b"TAS\r")


def test_a_line_taken_out_and_a_line_put_in(tmp_path: Path) -> None:
    small(tmp_path / "a.rec")
    lines = (tmp_path / "a.rec").read_text().splitlines(keepends=True)
    place = next(number for number, line in enumerate(lines) if 'c1 < "*TER' in line)
    (tmp_path / "out.rec").write_text("".join(lines[:place] + lines[place + 1 :]))
    (tmp_path / "in.rec").write_text("".join([*lines[: place + 1], '0.760000000 u0 c0 < "boo"\n', *lines[place + 1 :]]))
    out, put_in = replay(tmp_path / "out.rec").difference, replay(tmp_path / "in.rec").difference
    assert out is not None
    assert (out.kind, out.at_ns) == ("surplus", 750_000_000)
    assert put_in is not None
    assert (put_in.kind, put_in.at_ns) == ("missing", 760_000_000)
    assert put_in.expected is not None
    assert put_in.expected.line == place + 2


def test_a_wire_left_out_shows(tmp_path: Path) -> None:
    small(tmp_path / "a.rec")
    text = (tmp_path / "a.rec").read_text()
    (tmp_path / "b.rec").write_text(re.sub(r".* ! set_wire .*\n", "", text))
    assert replay(tmp_path / "b.rec").difference is not None


def test_the_difference_is_told_with_context_and_a_caret(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line, path = doctored(tmp_path, 'c1 < "*TER', 'c1 < "*TES')
    assert main(["replay", str(path)]) == 1
    told = capsys.readouterr().out.rstrip("\n").split("\n")
    assert told[0].startswith(f'{path}:{line}: at 0.750000000 s, unit 0, connection 1: other bytes, after "TER\\r"')
    expected, actual, caret = told[-3:]
    assert expected.startswith("  expected  0.750000000 u0 c1 < ")
    assert actual.startswith("  actual    0.750000000 u0 c1 < ")
    column = caret.index("^")
    assert (expected[column], actual[column]) == ("S", "R")
    assert expected[:column].removeprefix("  expected") == actual[:column].removeprefix("  actual  ")
    assert any('> "TER\\r"' in context for context in told[1:-3])


def test_another_machine_and_a_tolerance(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    small(tmp_path / "a.rec")
    (tmp_path / "other.toml").write_text("[defaults]\nECHO = 1\n")
    assert main(["replay", str(tmp_path / "a.rec"), "--machine", str(tmp_path / "other.toml")]) == 1
    (tmp_path / "same.toml").write_text(QUIET)
    assert main(["replay", str(tmp_path / "a.rec"), "--machine", str(tmp_path / "same.toml")]) == 0
    _, late = doctored_again(tmp_path, "0.750000000 u0 c1 <", "0.752000000 u0 c1 <")
    assert main(["replay", str(late)]) == 1
    assert main(["replay", str(late), "--line-timing-tolerance", "1.9"]) == 1
    assert main(["replay", str(late), "--line-timing-tolerance", "2"]) == 0
    capsys.readouterr()


def doctored_again(tmp_path: Path, before: str, after: str) -> tuple[int, Path]:
    (tmp_path / "a.rec").unlink()
    return doctored(tmp_path, before, after)


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("! set_wire", "! set_wires", "no action 'set_wires'"),
        ('name="enable"', 'name="enabled"', "enabled"),
        ("u0 ! set_wire", "u0.1 ! set_wire", "no unit u0.1"),
        ("u0 c1 >", "u7 c1 >", "no unit u7"),
        ("0.750000000 u0 c1 >", "0.400000000 u0 c1 >", "time goes backwards"),
        ('units = "1"', 'units = "many"', "not a number"),
        ("ECHO = ", "ECHOO = ", "ECHOO"),
        ("[machine u0]", "[machine u1]", "--machine"),
    ],
)
def test_what_cannot_be_replayed_is_told_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], before: str, after: str, said: str
) -> None:
    _, path = doctored(tmp_path, before, after)
    assert main(["replay", str(path)]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert told.count("\n") == 1


def test_a_file_that_is_no_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x").write_bytes(bytes(range(256)) * 3)
    (tmp_path / "empty").touch()
    for name in ("x", "empty", "none", "."):
        assert main(["replay", str(tmp_path / name)]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    with pytest.raises(RecordingError):
        read(tmp_path / "x")


LINE = """\
oem6250 recording 1
source = "line"
begin
1700000000.100 > "ECHO0\\r"
1700000000.120 < "ECHO0\\r\\n\\r\\n> "
1700000000.500 > "1T"
1700000000.501 > "PE\\r"
1700000000.512 < "*1TP"
1700000000.517 < "E+0\\r\\r\\n> "
1700000000.600 > "1TPC\\r"
1700000000.610 < "*1TPC+0\\r"
"""


def test_a_real_units_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Times do not count, cuts do not count, the order of the bytes does; the end may be missing."""
    file = tmp_path / "line.rec"
    file.write_text(LINE)
    assert main(["replay", str(file)]) == 0
    assert capsys.readouterr().err == ""
    file.write_text(LINE.replace("E+0", "E+1"))
    assert main(["replay", str(file)]) == 1
    told = capsys.readouterr().out
    assert f"{file}:9: at 1700000000.517000000 s" in told
    assert 'after "1TPE\\r"' in told
    file.write_text(LINE)
    assert main(["replay", str(file), "--line-timing-tolerance", "10"]) == 1
    assert main(["replay", str(file), "--line-timing-tolerance", "25"]) == 0
    capsys.readouterr()


@given(st.binary(min_size=1, max_size=200), st.integers(0, 199))
def test_the_caret_stands_under_the_difference(data: bytes, place: int) -> None:
    """Whatever is in the bytes, and however long they are."""
    from emulator.recording.comparison import Difference

    place %= len(data)
    other = data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :]
    difference = Difference("bytes", 0, Sent(1, 0, 0, data), Sent(1, 0, 0, other), place, None, ())
    expected, actual, caret = render(difference, path="f").split("\n")[-3:]
    column = caret.index("^")
    assert expected[column:].startswith(escaped(data[place : place + 1]))
    assert actual[column:].startswith(escaped(other[place : place + 1]))


MACHINES = Path(__file__).parents[1] / "transcripts"


def test_every_machine_of_the_transcripts_can_be_written_as_a_file() -> None:
    from tests.transcripts.format import load

    texts = {load(path).machine for path in MACHINES.glob("*.txt")} | {"bare = true", "[io]\ninputs = 8\n"}
    assert len(texts) > 10
    for text in texts:
        machine = Machine.parse(text)
        assert Machine.parse(machine_text(machine)) == machine
    assert machine_text(Machine.default()) == ""
