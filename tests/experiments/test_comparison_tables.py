import io
import json

import pytest
from rich.console import Console

from qsrlang.experiments.recording import Experiment
from qsrlang.experiments.statistics import bootstrap_interval, wilson_interval
from qsrlang.experiments.summaries import Comparison
from qsrlang.experiments.tables import comparison_json, comparison_table
from qsrlang.experiments.trials import Trial

MADE = Experiment("kitchen", "A", "Cup", "narrow", "steady", 7, "0123456789ab")
RANDOM = [
    Trial("random", n, n < 2, 40.0 + n if n < 2 else 120.0, 3 + n, 10.0, "cup" if n < 2 else "")
    for n in range(4)
]
NEVER = [Trial("never", n, False, 120.0, 9, 30.0, "") for n in range(4)]
COMPARISON = Comparison(MADE, ("random", "never"), 4, (*RANDOM, *NEVER))


def test_json_has_the_promised_fields():
    data = json.loads(json.dumps(comparison_json(COMPARISON)))
    assert {key: data[key] for key in ("scenario", "seed", "trials")} == {
        "scenario": "kitchen",
        "seed": 7,
        "trials": 4,
    }
    arm = data["arms"]["random"]
    wilson, boot = wilson_interval(2, 4), bootstrap_interval([40.0, 41.0, 120.0, 120.0], 7)
    assert arm["found"] == 0.5
    assert arm["found_ci"] == pytest.approx([wilson.low, wilson.high], abs=1e-6)
    assert (arm["time_found"], arm["time_censored"], arm["poses"], arm["travel"]) == (40.5, 80.25, 3.5, 10.0)
    assert arm["time_ci"] == pytest.approx([boot.low, boot.high], abs=1e-6)
    assert arm["time_ci"][0] < arm["time_censored"] < arm["time_ci"][1]
    assert set(arm) == {
        "found", "found_ci", "time_found", "time_censored", "time_ci", "poses", "poses_ci", "travel"
    }  # fmt: skip


def test_an_arm_that_never_finds_has_no_time_of_finding():
    arm = comparison_json(COMPARISON)["arms"]["never"]
    assert (arm["found"], arm["time_found"], arm["poses"], arm["poses_ci"]) == (0.0, None, None, None)
    assert (arm["time_censored"], arm["time_ci"]) == (120.0, [120.0, 120.0])


def test_differences_are_paired():
    (pair,) = comparison_json(COMPARISON)["paired_time"]
    assert pair["arms"] == ["random", "never"]
    assert pair["difference"] == pytest.approx(-39.75)
    assert pair["difference_ci"][0] < -39.75 < pair["difference_ci"][1]


def test_the_table_shows_units_and_intervals():
    console = Console(width=120, record=True, file=io.StringIO())
    console.print(comparison_table(COMPARISON))
    text = console.export_text()
    for part in (
        "random",
        "50.0% [15.0, 85.0]",
        "40.5",
        "travel [m]",
        "censored time [s]",
        "seed 7",
        "narrow",
        "steady",
    ):
        assert part in text
