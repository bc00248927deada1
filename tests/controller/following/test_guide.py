"""docs/following.md does what it says."""

from __future__ import annotations

import doctest
from pathlib import Path


def test_the_guide() -> None:
    result = doctest.testfile(str(Path(__file__).parents[3] / "docs" / "following.md"), module_relative=False)
    assert result.attempted > 15
    assert result.failed == 0
