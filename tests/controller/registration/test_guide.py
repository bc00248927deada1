"""docs/registration.md does what it says."""

from __future__ import annotations

import doctest
from pathlib import Path


def test_the_guide() -> None:
    result = doctest.testfile(str(Path(__file__).parents[3] / "docs" / "registration.md"), module_relative=False)
    assert result.attempted > 10
    assert result.failed == 0
