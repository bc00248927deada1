"""Recordings of sessions: written while units run, read, replayed, compared, turned into transcripts.

recording = read("session.rec")
outcome = replay("session.rec")
assert outcome.difference is None
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from emulator.recording.format import RecordingError
    from emulator.recording.reading import Recording, read
    from emulator.recording.replaying import Outcome, replay
    from emulator.recording.transcribing import transcript

__all__ = ["Outcome", "Recording", "RecordingError", "read", "replay", "transcript"]

_HOME_OF = {
    "Outcome": "emulator.recording.replaying",
    "RecordingError": "emulator.recording.format",
    "Recording": "emulator.recording.reading",
    "read": "emulator.recording.reading",
    "replay": "emulator.recording.replaying",
    "transcript": "emulator.recording.transcribing",
}


def __getattr__(name: str) -> Any:
    """Import the module that holds a name the first time it is asked for: the command line must start at once."""
    if name not in _HOME_OF:
        raise AttributeError(f"module 'emulator.recording' has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(_HOME_OF[name]), name)
