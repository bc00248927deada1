"""A session compared with one that was kept: a transcript in a file beside the test."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import unified_diff
from pathlib import Path

PASSING = ("title: ", "source: ")
"""Lines of a transcript that say when and by what it was made, and may differ."""


def assert_same_transcript(said: str, path: Path, *, update: bool) -> None:
    """Compare a transcript with the file; with ``update`` write the file instead.

    AssertionError, with the difference, if they are not the same or there is no file.
    """
    if update:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(said, encoding="utf-8")
        return
    if not path.exists():
        raise AssertionError(f"there is no transcript {path} yet; run once with --oem6250-update (or update=True)")
    kept = path.read_text(encoding="utf-8")
    difference = list(unified_diff(_lasting(kept), _lasting(said), f"{path}", "this session", lineterm=""))
    if difference:
        raise AssertionError("the session is not the one that was kept:\n" + "\n".join(difference))


def _lasting(text: str) -> list[str]:
    lines: Iterable[str] = text.splitlines()
    return [line for line in lines if not line.startswith(PASSING)]
