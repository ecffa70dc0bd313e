"""A search in words: what the robot believes, where it looks and why, what it saw."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from qsrlang.cli.answers import print_answer
from qsrlang.experiments.stories import Opening, SearchStory
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.outcome import SearchStep
from qsrlang.planning.ranking import RankedView, ranked
from qsrlang.planning.world import Detection


def narrate_opening(console: Console, opening: Opening, seed: int) -> None:
    """Print what is sought, where, with what, and what the robot believes before it starts."""
    scenario, briefing = opening.scenario, opening.briefing
    console.print(f"[bold]{escape(scenario.title)}[/bold]", highlight=False)
    console.print(
        f"Sought: {', '.join(briefing.targets)}; arm {briefing.arm}, variant {opening.variant}, "
        f"camera {scenario.camera_name}, robot {scenario.robot_name}, seed {seed}.",
        highlight=False,
        markup=False,
    )
    supports, limits = briefing.supports, briefing.limits
    console.print(
        f"{len(supports.centres)} voxels on {len(supports.names)} supporting planes; at most {limits.seconds:g} s "
        f"and {limits.poses} looks.",
        highlight=False,
    )
    if not briefing.beliefs:
        console.print("It uses no relations.", highlight=False)
    for target, belief in zip(briefing.targets, briefing.beliefs, strict=False):
        print_answer(belief, console, f"It believes: where {target} is")


def narrate_step(
    console: Console, opening: Opening, step: SearchStep, picture: Path | None, explain: bool = False
) -> None:
    """Print one step: where it looks, why, what it saw, and the clock; `explain` adds what the best views cost."""
    console.print(f"\n[bold]Step {step.number + 1}[/bold]", highlight=False)
    lines = [
        f"looks from {_pose(step.pose)}: {step.travel:.1f} m to drive, {math.degrees(step.turn):.0f} deg to turn",
        f"because {_reason(opening, step)}",
        *(_weighed(step) if explain else ()),
        _seen(step),
        f"clock {step.clock:.1f} s",
    ]
    if picture is not None:
        lines.append(f"picture {picture}")
    for line in lines:
        console.print(f"  {line}", highlight=False, soft_wrap=True, markup=False)


def value_text(value: float) -> str:
    """Return a value with as many digits as tell small ones apart."""
    return f"{value:.1f}" if abs(value) >= 1.0 else f"{value:.3g}"


def _pose(pose: Pose2) -> str:
    return f"({pose.x:.2f} m, {pose.y:.2f} m) facing {math.degrees(pose.yaw):.0f} deg"


def _reason(opening: Opening, step: SearchStep) -> str:
    count, value = len(step.candidates), step.value
    unit = f" {step.unit}" if step.unit else ""
    if opening.scenario.arm(opening.briefing.arm).planner == "random":
        return f"it picked one of {count} poses at random"
    runner_up = max(
        (float(other) for index, other in enumerate(step.values) if index != step.chosen), default=0.0
    )
    rank = step.ranking.index(step.chosen) + 1
    return (
        f"its view is worth {value_text(value)}{unit}, rank {rank} of {count} poses; "
        f"the runner-up is worth {value_text(runner_up)}"
    )


def _weighed(step: SearchStep) -> list[str]:
    """Return what the best view and the runner-up were worth and cost."""
    if step.terms is None:
        return ["it does not weigh what views cost"]
    order = [step.chosen, *([step.runner_up] if step.runner_up is not None else [])]
    views = ranked(step.candidates, step.values, step.terms, order)
    return [f"{name}: {_terms(view)}" for name, view in zip(("best view", "runner-up"), views, strict=False)]


def _terms(view: RankedView) -> str:
    plan = "" if view.expected is None else f", plan from there {view.expected:.1f} s"
    return (
        f"{_pose(view.pose)}, chance {view.gain:.3f}, cost {view.seconds:.1f} s ({view.travel:.1f} m, "
        f"{math.degrees(view.turn):.0f} deg), chance per second {view.index:.4f}{plan}"
    )


def _seen(step: SearchStep) -> str:
    if not step.looked:
        return "the time ran out before the look was over"
    kinds = {seen.kind for seen in step.detections}
    missed = " and ".join(f"no {target}" for target in step.wanted if target not in kinds)
    if not step.detections:
        return f"saw nothing it knows, {missed}"
    things = ", ".join(_thing(seen) for seen in step.detections)
    return f"saw {things}" + (f"; {missed}" if missed else "")


def _thing(seen: Detection) -> str:
    x, y, z = seen.position
    return f"{seen.name} ({seen.kind}) at ({x:.2f} m, {y:.2f} m, {z:.2f} m)"


def narrate_end(console: Console, story: SearchStory) -> None:
    """Print how the search ended, as a table."""
    console.print(outcome_table(story))


def outcome_table(story: SearchStory) -> Table:
    """Return how the search ended: outcome, objects found, time [s], looks and travel [m]."""
    table = Table(title=f"\nSearch for {story.target}", title_justify="left")
    for heading in ("outcome", "object", "time [s]", "looks", "travel [m]"):
        table.add_column(escape(heading), justify="right")
    name = ", ".join(one.name for one in story.finds) or "-"
    outcome = story.result.verdict
    table.add_row(outcome, name, f"{story.seconds:.1f}", str(story.poses), f"{story.travel:.1f}")
    return table


def steps_table(story: SearchStory) -> Table:
    """Return a search step by step: where it looked from, path [m], clock [s], and what it saw."""
    table = Table()
    for heading in ("step", "looked from", "travel [m]", "clock [s]", "because", ""):
        said = heading in ("because", "")
        table.add_column(escape(heading), justify="left" if said else "right", no_wrap=not said)
    for step in story.steps:
        numbers = (str(step.number + 1), _pose(step.pose), f"{step.travel:.1f}", f"{step.clock:.1f}")
        table.add_row(*numbers, escape(_reason(story.opening, step)), escape(_seen(step)))
    return table


def story_json(story: SearchStory, pictures: Sequence[Path]) -> dict[str, Any]:
    """Return the story as plain data: metres, radians, seconds, map frame."""
    opening = story.opening
    return {
        "scenario": opening.scenario.name,
        "variant": opening.variant,
        "arm": opening.briefing.arm,
        "camera": opening.scenario.camera_name,
        "robot": opening.scenario.robot_name,
        "seed": story.seed,
        "trial": story.trial,
        "targets": list(opening.briefing.targets),
        "found": story.found,
        "seconds": story.seconds,
        "verdict": story.result.verdict,
        "absence": story.result.absence,
        "poses": story.poses,
        "travel": story.travel,
        "finds": [_detection(seen) for seen in story.finds],
        "beliefs": [belief.to_json() for belief in opening.briefing.beliefs],
        "steps": [_step(step) for step in story.steps],
        "pictures": [str(path) for path in pictures],
    }


def _step(step: SearchStep) -> dict[str, Any]:
    return {
        "from": [step.origin.x, step.origin.y, step.origin.yaw],
        "pose": [step.pose.x, step.pose.y, step.pose.yaw],
        "value": step.value,
        "values": step.values.tolist(),
        "unit": step.unit,
        "terms": _weights_of(step),
        "absence": step.absence,
        "travel": step.travel,
        "turn": step.turn,
        "seconds": step.seconds,
        "clock": step.clock,
        "looked": step.looked,
        "wanted": list(step.wanted),
        "detections": [_detection(seen) for seen in step.detections],
    }


def _weights_of(step: SearchStep) -> dict[str, Any] | None:
    if step.terms is None:
        return None
    (view,) = ranked(step.candidates, step.values, step.terms, [step.chosen])
    return {name: value for name, value in asdict(view).items() if name not in ("pose", "equation_3")}


def _detection(seen: Detection) -> dict[str, Any]:
    return {"name": seen.name, "kind": seen.kind, "position": list(seen.position)}
