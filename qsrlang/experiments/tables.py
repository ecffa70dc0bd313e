"""A comparison as a table to read and as JSON."""

from __future__ import annotations

from typing import Any

from rich.markup import escape
from rich.table import Table

from qsrlang.experiments.statistics import Interval
from qsrlang.experiments.summaries import ArmSummary, Comparison

DECIMALS = 6


def comparison_table(comparison: Comparison) -> Table:
    """Return the table of a comparison: one row an arm, 95 % intervals in brackets."""
    made = comparison.experiment
    title = f"{made.scenario}, variant {made.variant}: {comparison.trials} trials an arm, seed {made.seed}"
    caption = (
        f"camera {made.camera}, robot {made.robot}, target {made.target}; 95 % intervals: Wilson, bootstrap; "
        "* mean over the trials that found it; censored: a failure counts as the time limit"
    )
    table = Table(title=title, caption=caption)
    table.add_column("arm")
    for heading in ("found", "time* [s]", "censored time [s]", "poses*", "travel [m]"):
        table.add_column(escape(heading), justify="right")
    for arm, summary in comparison.summaries.items():
        table.add_row(arm, *_cells(summary))
    return table


def comparison_json(comparison: Comparison) -> dict[str, Any]:
    """Return the comparison as plain values, numbers rounded to 1e-6; an interval is [low, high]."""
    made = comparison.experiment
    return {
        "scenario": made.scenario,
        "variant": made.variant,
        "target": made.target,
        "camera": made.camera,
        "robot": made.robot,
        "seed": made.seed,
        "trials": comparison.trials,
        "arms": {arm: _plain(summary) for arm, summary in comparison.summaries.items()},
        "paired_time": [
            {"arms": list(pair), "difference": _rounded(mean), "difference_ci": _pair(interval)}
            for pair, (mean, interval) in comparison.differences.items()
        ],
    }


def _cells(summary: ArmSummary) -> tuple[str, ...]:
    return (
        f"{summary.found:.1%} {_bracket(summary.found_ci, 100.0)}",
        _number(summary.time_found),
        f"{summary.time_censored:.1f} {_bracket(summary.time_ci)}",
        f"{_number(summary.poses)} {_bracket(summary.poses_ci)}".rstrip(),
        f"{summary.travel:.1f}",
    )


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


def _bracket(interval: Interval | None, scale: float = 1.0) -> str:
    return "" if interval is None else escape(f"[{scale * interval.low:.1f}, {scale * interval.high:.1f}]")


def _plain(summary: ArmSummary) -> dict[str, Any]:
    return {
        "found": _rounded(summary.found),
        "found_ci": _pair(summary.found_ci),
        "time_found": _rounded(summary.time_found),
        "time_censored": _rounded(summary.time_censored),
        "time_ci": _pair(summary.time_ci),
        "poses": _rounded(summary.poses),
        "poses_ci": _pair(summary.poses_ci),
        "travel": _rounded(summary.travel),
    }


def _pair(interval: Interval | None) -> list[float | None] | None:
    return None if interval is None else [_rounded(interval.low), _rounded(interval.high)]


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, DECIMALS)
