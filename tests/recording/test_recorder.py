"""Writing: nothing is written over, a disk that fails or stands still ends the recording and nothing else."""

from __future__ import annotations

import logging
import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from emulator.recording import RecordingError, read
from emulator.recording import recorder as recorder_module
from emulator.recording.format import End, Received
from emulator.recording.header import Header
from emulator.recording.recorder import Recorder

HEAD = Header({"source": "emulator"}, {"machine u0": ""})
PATIENCE_S = 20.0


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while not condition() and time.monotonic() < deadline:
        os.sched_yield()
    assert condition()


def test_what_was_put_is_in_the_file(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "a.rec", HEAD)
    entries = [Received(number, 0, 0, b"1TPE\r") for number in range(5000)]
    for entry in entries:
        recorder.note(entry)
    recorder.close(6000)
    recording = read(tmp_path / "a.rec")
    assert recording.entries == (*entries, End(6000))
    assert recording.complete
    assert recording.header == HEAD


def test_it_is_in_the_file_soon_without_closing(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "a.rec", HEAD)
    recorder.note(Received(1, 0, 0, b"x"))
    wait_for(lambda: read(tmp_path / "a.rec").entries == (Received(1, 0, 0, b"x"),))
    assert not read(tmp_path / "a.rec").complete
    recorder.close()


def test_a_recording_is_never_written_over(tmp_path: Path) -> None:
    Recorder(tmp_path / "a.rec", HEAD).close(1)
    before = (tmp_path / "a.rec").read_bytes()
    with pytest.raises(RecordingError, match="already"):
        Recorder(tmp_path / "a.rec", HEAD)
    assert (tmp_path / "a.rec").read_bytes() == before


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="cannot be written"):
        Recorder(tmp_path / "none" / "a.rec", HEAD)


# Meant: not every system has one.
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_full_disk_is_told_at_the_start() -> None:
    with pytest.raises(RecordingError, match="No space left"):
        Recorder("/dev/full", HEAD)


def warnings_of(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.levelno == logging.WARNING]


def test_a_disk_that_fills_up_ends_the_recording_with_one_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    real_write = os.write
    room = [1000]

    def write(descriptor: int, data: bytes) -> int:
        if room[0] == 0:
            raise OSError(28, "No space left on device")
        part = data[: room[0]]
        room[0] -= len(part)
        return real_write(descriptor, part)

    monkeypatch.setattr(recorder_module.os, "write", write)
    with caplog.at_level(logging.WARNING, logger="oem6250.recording"):
        recorder = Recorder(tmp_path / "a.rec", HEAD)
        for number in range(1000):
            recorder.note(Received(number, 0, 0, b"1TPE\r"))
        wait_for(lambda: recorder.failed)
        recorder.note(Received(5000, 0, 0, b"1TPE\r"))
        recorder.close(9999)
    assert len(warnings_of(caplog)) == 1
    assert "No space left on device" in warnings_of(caplog)[0]
    recording = read(tmp_path / "a.rec")
    assert not recording.complete
    assert recording.entries == tuple(Received(number, 0, 0, b"1TPE\r") for number in range(len(recording.entries)))


# Meant: not every system has one.
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_disk_that_stands_still_never_holds_up_who_records(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """A pipe nobody reads takes 64 KB and then stands still."""
    monkeypatch.setattr(recorder_module, "MAX_BACKLOG_BYTES", 1_000_000)
    os.mkfifo(tmp_path / "pipe")
    end = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    with caplog.at_level(logging.WARNING, logger="oem6250.recording"):
        recorder = Recorder(tmp_path / "pipe", HEAD)
        for _ in range(2000):
            recorder.put(b"x" * 999 + b"\n")
        wait_for(lambda: recorder.failed)
    assert len(warnings_of(caplog)) == 1
    assert "too slow" in warnings_of(caplog)[0]
    os.close(end)
    recorder.close(1)
