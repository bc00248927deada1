"""Sweeps: the same table from any executor and batch size, the margin to chatter, ranges, tables, interruption."""

from __future__ import annotations

import csv
import json
import math
import pickle
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

from emulator.machine import Machine
from emulator.tuning.experiment import StepExperiment
from emulator.tuning.sampling import make_plan, parse_span
from emulator.tuning.sweep import MARGIN, MARGIN_FACTORS, SweepPlan, SweepResult, chatter_margin, split, sweep
from emulator.tuning.sweep_table import best_sets, render_sets, write_table

MACHINE = Machine.default()


def plan_of(**spans: str) -> SweepPlan:
    experiment = replace(StepExperiment.of_machine(MACHINE, 0), duration_s=0.2)
    names = {name.replace("__", "."): parse_span(text) for name, text in spans.items()}
    return make_plan(MACHINE, 0, experiment, names)


PLAN = plan_of(SGP="2,15,60,105", SGV="0,2,25", plant__loop_time_constant_s="0.8:1.2:2")


@contextmanager
def dask() -> Iterator[Executor]:
    distributed = pytest.importorskip("distributed", reason="Dask is not installed")
    options = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        yield client.get_executor(pure=False)


@contextmanager
def processes() -> Iterator[Executor]:
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        yield pool


@pytest.fixture(scope="module")
def serial() -> SweepResult:
    return sweep(PLAN, samples_per_job=len(PLAN))


def same(one: SweepResult, other: SweepResult) -> bool:
    return list(one.columns) == list(other.columns) and all(
        np.array_equal(one.columns[name], other.columns[name]) for name in one.columns
    )


@pytest.mark.parametrize("samples_per_job", [1, 5])
def test_batch_size_changes_nothing(serial: SweepResult, samples_per_job: int) -> None:
    assert same(sweep(PLAN, samples_per_job=samples_per_job), serial)


def test_threads_change_nothing(serial: SweepResult) -> None:
    with ThreadPoolExecutor(3) as pool:
        assert same(sweep(PLAN, pool, samples_per_job=2), serial)


def test_processes_change_nothing(serial: SweepResult) -> None:
    with processes() as pool:
        assert same(sweep(PLAN, pool, samples_per_job=6), serial)


@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster_changes_nothing(serial: SweepResult) -> None:
    with dask() as executor:
        assert same(sweep(PLAN, executor, samples_per_job=6), serial)


def test_order_of_the_samples_changes_nothing_but_the_order(serial: SweepResult) -> None:
    order = np.random.default_rng(1).permutation(len(PLAN))
    assert PLAN.plant_of is not None
    inputs = tuple((name, values[order]) for name, values in PLAN.inputs)
    shuffled = SweepPlan(PLAN.experiment, PLAN.gains[order], PLAN.plants, PLAN.plant_of[order], inputs)
    found = sweep(shuffled)
    for name, values in serial.columns.items():
        np.testing.assert_array_equal(found.columns[name], values[order])


def test_jobs_and_results_are_small_plain_data() -> None:
    jobs = split(PLAN, 4)
    assert sum(len(job.gains) for job in jobs) == len(PLAN)
    assert all(len(pickle.dumps(job)) < 5000 for job in jobs)


def test_margin_is_the_largest_factor_up_to_which_all_are_quiet() -> None:
    factors = np.array([1.0, *MARGIN_FACTORS])
    ripple = np.array([[0, 0, 0, 0, 0], [0, 0, 0, 0.5, 0], [0.5, 0, 0, 0, 0], [0, math.inf, 0, 0, 0]])
    assert chatter_margin(ripple, factors).tolist() == [2.0, 1.25, 0.0, 1.0]


def test_the_margin_of_a_set_agrees_with_a_sweep_over_the_multiplied_gains() -> None:
    """A set has margin m when it is quiet at m times its gains and not at the next factor."""
    found = sweep(plan_of(SGP="20:80:13", SGV="2")).columns
    assert len(np.unique(found[MARGIN])) > 2
    for sgp, margin in zip(found["SGP"], found[MARGIN], strict=True):
        for factor in (1.0, *MARGIN_FACTORS):
            ripple = sweep(plan_of(SGP=repr(float(sgp) * factor), SGV=repr(2.0 * factor))).columns["ripple_v"][0]
            if factor <= margin:
                assert ripple <= 0.1
            else:
                assert ripple > 0.1
                break


def test_interruption_keeps_what_has_been_done(serial: SweepResult) -> None:
    def interrupt(done: int, wanted: int) -> None:
        if done >= 8:
            raise KeyboardInterrupt

    found = sweep(PLAN, samples_per_job=4, progress=interrupt)
    assert (len(found), found.wanted, found.complete) == (8, len(PLAN), False)
    for name, values in found.columns.items():
        np.testing.assert_array_equal(values, serial.columns[name][:8])
    with ThreadPoolExecutor(2) as pool:
        assert 8 <= len(sweep(PLAN, pool, samples_per_job=4, progress=interrupt)) < len(PLAN)


def test_nothing_done_is_an_empty_table(tmp_path: Path) -> None:
    def interrupt(done: int, wanted: int) -> None:
        raise KeyboardInterrupt

    found = sweep(PLAN, progress=interrupt)
    assert len(found) == 0
    write_table(tmp_path / "none.json", found)
    assert best_sets(found)["SGP"].tolist() == []


def test_best_sets_are_the_worst_over_plants_with_the_quiet_ones_first(serial: SweepResult) -> None:
    best = best_sets(serial, sort="overshoot", count=100)
    assert len(best["SGP"]) == 12
    restless = best[MARGIN] == 0.0
    assert restless.any()
    assert not restless[: len(restless) - restless.sum()].any()
    quiet = best["overshoot_percent"][~restless]
    assert (np.diff(quiet) >= 0).all()
    for row in range(12):
        own = (serial.columns["SGP"] == best["SGP"][row]) & (serial.columns["SGV"] == best["SGV"][row])
        assert best["overshoot_percent"][row] == serial.columns["overshoot_percent"][own].max()
        assert best[MARGIN][row] == serial.columns[MARGIN][own].min()
    assert "never" in render_sets(best)


def test_random_samples_repeat_with_their_seed_and_stay_in_range() -> None:
    spans = {"SGP": parse_span("5:100"), "SGV": parse_span("0,2"), "plant.command_lag_s": parse_span("0.9:1.1")}
    experiment = StepExperiment.of_machine(MACHINE, 0)
    one, same_again, other = (
        make_plan(MACHINE, 0, experiment, spans, random_samples=50, seed=seed) for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one.gains, same_again.gains)
    assert not np.array_equal(one.gains, other.gains)
    assert 5.0 <= one.gains[:, 0].min() < one.gains[:, 0].max() <= 100.0
    assert set(one.gains[:, 2]) == {0.0, 2.0}
    assert len(one.plants) == 50


def test_a_grid_has_every_combination() -> None:
    plan = plan_of(SGP="1:3:3", SGI="0,0.5", plant__speed_per_volt_rev_s="0.5,1,2")
    combinations = {(row[0], row[1], factor) for row, factor in zip(plan.gains, plan.inputs[0][1], strict=True)}
    assert len(combinations) == len(plan) == 18
    assert len(plan.plants) == 3


@pytest.mark.parametrize(
    "text", ["", "a", "1:", "5:1:3", "1:2:0", "1:2:x", "1:2:3:4", "1,,2", "nan", "inf", "1:2:1", "1:2:9999999"]
)
def test_what_is_no_range_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(ValueError) as caught:
        parse_span(text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("spans", "message"),
    [
        ({}, "nothing to sweep"),
        ({"SGP": "1:5"}, "does not say how many"),
        ({"SGP": "-1,2"}, "out of range"),
        ({"SGILIM": "201"}, "out of range"),
        ({"SGX": "1"}, "cannot be varied"),
        ({"plant__mass": "1"}, "no quantity"),
        ({"SGP": "1:2:2000", "SGV": "1:2:2000"}, "samples; 1 to"),
    ],
)
def test_a_sweep_that_cannot_be_is_refused(spans: dict[str, str], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        plan_of(**spans)


@pytest.mark.parametrize("ending", [".csv", ".npz", ".json"])
def test_tables_hold_every_sample_in_every_form(serial: SweepResult, tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"table{ending}"
    write_table(path, serial)
    if ending == ".csv":
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        columns = {name: [float(row[name]) for row in rows] for name in rows[0]}
    elif ending == ".npz":
        columns = {name: values.tolist() for name, values in np.load(path).items()}
    else:
        stored = json.loads(path.read_text())["columns"]
        columns = {name: [math.inf if x is None else x for x in values] for name, values in stored.items()}
    assert columns == {name: values.tolist() for name, values in serial.columns.items()}
    assert "nan" not in str(columns)
