"""A recording as a transcript: what the runner plays is what was recorded."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emulator import Emulator, Machine
from emulator.cli import main
from emulator.recording import read
from emulator.recording.transcribing import transcript
from tests.recording.sessions import packets, record
from tests.transcripts.format import parse
from tests.transcripts.test_virtual import Mismatch, VirtualSession

QUIET = '# a quiet unit\n[defaults]\n  ECHO = 0\n\n[identity]\nrevision = """\nA\\\n   B"""\n'


def run(text: str) -> None:
    VirtualSession(parse(text, path=Path("recorded.txt"))).run()


@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(seed=st.integers(0, 2**32), machine=st.sampled_from(["", QUIET]))
def test_a_recorded_session_passes_as_a_transcript(
    tmp_path_factory: pytest.TempPathFactory, seed: int, machine: str
) -> None:
    path, random = tmp_path_factory.mktemp("rec") / "a.rec", Random(seed)
    with Emulator(Machine.parse(machine), record=path) as emulator:
        unit = emulator.unit(0)
        for packet in packets(random, 30):
            unit.send(packet)
            emulator.advance(random.choice((0.0, 1e-9, 0.0012345, 0.05)))
        unit.send(b"\r!K\r!HALT\r!K\r1TPE\r")
        emulator.advance(0.5)
    recording = read(path)
    run(transcript(recording.header, recording.entries, title="a random session"))


def test_the_command_writes_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with Emulator(Machine.parse("[defaults]\nECHO = 0\n"), record=tmp_path / "a.rec") as emulator:
        emulator.unit(0).send(b"DRIVE11:D4000:GO11\r")
        emulator.advance(1.5)
        emulator.unit(0).send(b'1TPE\r  WRITE" {}\\"\r')
        emulator.advance(0.5)
    out = tmp_path / "a.txt"
    assert main(["transcript", str(tmp_path / "a.rec"), "-o", str(out), "--title", "one move"]) == 0
    text = out.read_text()
    assert text.startswith("title: one move\nsource: a recording of this program")
    assert 'machine:\n    [defaults]\n    ECHO = "0"\n' in text
    assert "> DRIVE11:D4000:GO11\\r\n< {ok}{ok}\n@ 1.500000000s\n< {ok}\nat 1." in text
    run(text)
    with pytest.raises(Mismatch):
        run(text.replace("*1TPE+", "*1TPE-"))
    assert main(["transcript", str(tmp_path / "a.rec")]) == 0
    assert "title: a\n" in capsys.readouterr().out


def test_what_a_transcript_cannot_say_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with Emulator(record=tmp_path / "a.rec") as emulator:
        emulator.unit(0).do("set_wire", name="enable", closed=False)
    with Emulator(record=tmp_path / "b.rec") as emulator:
        emulator.unit(0).send(b"A", channel=0)
        emulator.unit(0).send(b"B", channel=1)
    record(tmp_path / "c.rec", 1, commands=3, units=2)
    for name, said in (("a", "no actions"), ("b", "one connection at a time"), ("c", "one unit")):
        assert main(["transcript", str(tmp_path / f"{name}.rec")]) == 2
        told = capsys.readouterr().err
        assert said in told
        assert told.count("\n") == 1


def test_one_connection_after_another_is_one_host(tmp_path: Path) -> None:
    (tmp_path / "a.rec").write_text(
        "oem6250 recording 1\n[machine u0]\n| \nbegin\n"
        '0.1 u0 c0 attached\n0.2 u0 c0 > "1TPE\\r"\n0.2 u0 c0 < "1TPE\\r\\n*1TPE+0\\r\\r\\n> "\n0.3 u0 c0 detached\n'
        '0.4 u0 c1 attached\n0.5 u0 c1 > "1TPC\\r"\n0.5 u0 c1 < "1TPC\\r\\n*1TPC+0\\r\\r\\n> "\n1.0 end\n'
    )
    recording = read(tmp_path / "a.rec")
    run(transcript(recording.header, recording.entries, title="two hosts"))
