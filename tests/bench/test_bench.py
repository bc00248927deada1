"""The benchmark runs and its arithmetic holds. No measured figure is asserted here: those belong to a machine."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from tests.bench.__main__ import main
from tests.bench.figures import Figure, Reach, Reference, percentile
from tests.bench.session import Exchange, Lateness, Session
from tests.bench.staleness import staleness

KEYS = {"schema", "quick", "began", "took_s", "host", "figures", "failures"}
FIGURE_KEYS = {
    "group", "name", "unit", "measured", "low", "high", "samples", "reference", "reference_measured",
    "reference_samples", "ratio", "reach", "met", "note", "load_average",
}  # fmt: skip


def test_a_quick_run_prints_a_table_and_writes_the_promised_json(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bench.json"
    assert main(["--quick", "--json", str(path), "--only", "help", "kernel"]) == 0
    written = json.loads(path.read_text())
    assert set(written) == KEYS
    assert written["quick"] is True
    assert written["failures"] == {}
    assert {figure["group"] for figure in written["figures"]} == {"help", "kernel"}
    table = capsys.readouterr().out
    for figure in written["figures"]:
        assert set(figure) == FIGURE_KEYS
        assert figure["low"] <= figure["measured"] <= figure["high"]
        assert figure["name"] in table


def test_a_group_that_fails_is_told_and_the_others_still_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(effort: object) -> list[Figure]:
        raise RuntimeError("no such machine")

    monkeypatch.setattr("tests.bench.kernel.measure", broken)
    path = tmp_path / "bench.json"
    assert main(["--quick", "--json", str(path), "--only", "kernel", "help"]) == 1
    written = json.loads(path.read_text())
    assert written["failures"] == {"kernel": "RuntimeError: no such machine"}
    assert {figure["group"] for figure in written["figures"]} == {"help"}
    assert "NOT MEASURED" in capsys.readouterr().out


def test_a_ratio_is_the_median_of_neighbours() -> None:
    """A machine that runs at half speed for the last pair changes the medians but not the ratio."""
    figure = Figure(
        name="x", unit="s", samples=[2.0, 2.0, 4.0, 4.0], reference=Reference(name="y", samples=[1.0, 1.0, 2.0, 2.0])
    )
    assert figure.measured == 3.0
    assert figure.ratio == 2.0


@pytest.mark.parametrize(
    ("reach", "met"),
    [
        (Reach(bound=10), True),
        (Reach(bound=9), False),
        (Reach(bound=10, at_least=True), True),
        (Reach(bound=11, at_least=True), False),
        (Reach(bound=2, of="ratio"), True),
        (Reach(bound=1.9, of="ratio"), False),
        (None, None),
    ],
)
def test_reach(reach: Reach | None, met: bool | None) -> None:
    figure = Figure(name="x", unit="s", samples=[10.0], reference=Reference(name="y", samples=[5.0]), reach=reach)
    assert figure.met is met


def test_a_reach_on_a_ratio_without_reference_is_neither_met_nor_missed() -> None:
    assert Figure(name="x", unit="s", samples=[1.0], reach=Reach(bound=1, of="ratio")).met is None


def test_every_sample_needs_a_reference_sample() -> None:
    with pytest.raises(ValueError, match="reference sample"):
        Figure(name="x", unit="s", samples=[1.0, 2.0], reference=Reference(name="y", samples=[1.0]))


def test_percentiles() -> None:
    values = [float(value) for value in range(100, 0, -1)]
    assert percentile(values, 0) == 1.0
    assert percentile(values, 50) == 51.0
    assert percentile(values, 99) == 100.0
    assert percentile([7.0], 99) == 7.0


def test_staleness_of_a_unit_whose_answers_are_known() -> None:
    """20,000 counts/s from 0 at 1 s: read 0.4 ms and 0.8 ms too low at the middle of requests of 2 ms."""
    ahead_ns = -500_000_000
    exchanges = []
    for middle_ms, late_ms in ((1100.0, 0.4), (1200.0, 0.8)):
        counts = round((middle_ms - late_ms - 1000.0) * 20)
        middle_ns = int(middle_ms * 1e6) - ahead_ns
        left_at_ns = int((middle_ms - 0.2) * 1e6)
        exchanges.append(Exchange(middle_ns - 1_000_000, middle_ns + 1_000_000, left_at_ns, f"*1TPC+{counts}\r\r\n> "))
    session = Session(
        exchanges,
        Lateness(0.0, 0.0, 0.0),
        {
            "virtual_ahead_ns": ahead_ns,
            "line": (1_000_000_000, 0.0, 20_000.0),
            "trajectory_ns": 1_120_000,
            "outputs": [],
        },
    )
    found = staleness(session)
    assert found.mean_ms == pytest.approx(0.6)
    assert found.rms_ms == pytest.approx(math.sqrt((0.4**2 + 0.8**2) / 2))
    assert found.own_rms_ms == pytest.approx(math.sqrt((0.2**2 + 0.6**2) / 2))
    assert found.half_round_trip_rms_ms == pytest.approx(1.0)
