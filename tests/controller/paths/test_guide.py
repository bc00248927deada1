"""The guide to paths says what is so."""

from __future__ import annotations

import doctest
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[3] / "docs"


def test_the_guide_to_paths_is_true(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(DOCS.parent)
    result = doctest.testfile(str(DOCS / "paths.md"), module_relative=False)
    assert result.attempted >= 25
    assert result.failed == 0
