"""The `[triggers]` tables: what they refuse, in one line that names the key."""

from __future__ import annotations

import pytest

from emulator.machine import Machine, MachineError


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ('[triggers.a]\nmarks_on = "axis3"', ("triggers.a.marks_on", "axis3", "axis2")),
        ("[triggers.a]\nat_rev = nan", ("triggers.a.at_rev",)),
        ("[triggers.b]\nwidth_rev = 0", ("triggers.b.width_rev", "0")),
        ("[triggers.b]\nevery_rev = -1.0", ("triggers.b.every_rev", "-1")),
        ("[triggers.a]\nevery_rev = 0.01", ("triggers.a.every_rev", "0.01", "0 or above width_rev, 0.01")),
        ("[triggers.c]\nat_rev = 1.0", ("triggers.c",)),
    ],
)
def test_tables_that_cannot_be(text: str, parts: tuple[str, ...]) -> None:
    with pytest.raises(MachineError) as caught:
        Machine.parse(text, name="web.toml")
    line = str(caught.value)
    assert line.startswith("web.toml")
    assert "\n" not in line
    for part in parts:
        assert part in line, line


def test_a_sensor_is_none_unless_the_file_says_so() -> None:
    assert Machine.parse("").triggers.a.marks_on == "none"
    assert Machine.parse('[triggers.b]\nmarks_on = "axis1"').triggers.b.every_rev == 0
