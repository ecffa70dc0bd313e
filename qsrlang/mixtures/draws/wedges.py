"""What is assumed of directions, as wedges that draws are made inside of, instead of being made and thrown away."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom
from qsrlang.mixtures.densities.conditional import frame_of, hand
from qsrlang.mixtures.densities.sectors import arcs_of
from qsrlang.mixtures.draws.conditions import Condition
from qsrlang.mixtures.draws.wedge import Wedge
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.plans import Plan, Step, asked_step, seats_read
from qsrlang.mixtures.worlds.supports import in_region
from qsrlang.relations.graph import RelationGraph


def conjuncts(conditions: Sequence[Condition]) -> tuple[Condition, ...]:
    """Return conditions with each part of a conjunction that holds for sure as one of its own."""
    found: list[Condition] = []
    for one in conditions:
        parts = one.formula.parts if isinstance(one.formula, And) and one.share is None else (one.formula,)
        found += [replace(one, formula=part) for part in parts]
    return tuple(found)


def tightest_first(graph: RelationGraph, world: World, plan: Plan, conditions: Sequence[Condition]) -> Plan:
    """Return a plan in the order in which each thing has the most conditions with what is placed before it."""
    links: dict[str, set[str]] = defaultdict(set)
    for one in conditions:
        step = asked_step(graph, world, plan.seats, one.formula) if isinstance(one.formula, Atom) else None
        if step is not None:
            links[step.referent.block].add(step.relatum.block)
            links[step.relatum.block].add(step.referent.block)
    placed = {landmark.name for landmark in plan.landmarks}
    waiting, order = list(plan.steps), []
    while waiting:
        ready = [one for one in waiting if _is_ready(one, placed)]
        chosen = max(ready, key=lambda one: (not one.places, len(links[one.referent.block] & placed)))
        waiting.remove(chosen)
        order.append(chosen)
        placed.add(chosen.referent.block)
    return replace(plan, steps=tuple(order))


def _is_ready(step: Step, placed: set[str]) -> bool:
    read = {seat.block for seat in seats_read(step)}
    return read <= placed and (step.places or step.referent.block in placed)


def wedges_of(
    graph: RelationGraph, world: World, plan: Plan, conditions: Sequence[Condition], viewer: Pose2 | None
) -> tuple[Mapping[str, tuple[Wedge, ...]], tuple[Condition, ...]]:
    """Return, for each object that lies anywhere in a region, the wedges it must be in, and the conditions that remain.

    A direction between two objects bounds the one that is placed later.
    """
    placing = {step.referent.block: at for at, step in enumerate(plan.steps) if step.places}
    wedges: dict[str, list[Wedge]] = defaultdict(list)
    rest: list[Condition] = []
    for one in conditions:
        found = _wedge(graph, world, plan, one, viewer, placing)
        if found is None:
            rest.append(one)
        else:
            wedges[found[0]].append(found[1])
    return {name: tuple(found) for name, found in wedges.items()}, tuple(rest)


def _wedge(
    graph: RelationGraph,
    world: World,
    plan: Plan,
    condition: Condition,
    viewer: Pose2 | None,
    placing: Mapping[str, int],
) -> tuple[str, Wedge] | None:
    if not isinstance(condition.formula, Atom) or condition.share is not None:
        return None
    step = asked_step(graph, world, plan.seats, condition.formula)
    aimed = None if step is None else _aim(graph, plan, step, condition.formula, viewer)
    if step is None or aimed is None:
        return None
    start, width = aimed
    later, apex = step.referent, step.relatum
    if placing.get(later.block, -1) < placing.get(apex.block, -1):
        later, apex, start = apex, later, start + np.pi
    at = placing.get(later.block)
    if at is None or not in_region(plan.steps[at].constraint) or later.root.heading is None:
        return None
    return later.block, Wedge(apex, step.relatum, start, width)


def _aim(
    graph: RelationGraph, plan: Plan, step: Step, atom: Atom, viewer: Pose2 | None
) -> tuple[float, float] | None:
    """Return from which angle past the relatum's heading, over which width, an atom holds, if that is one wedge."""
    relation = graph.relations[atom.relation.text]
    if relation.angle is None or relation.distance or relation.region or step.second:
        return None
    layout, frame = plan.layout, frame_of(step.constraint, step.constraint.atoms[0])
    heading = layout.pose(step.relatum)[2]
    is_certain = layout.variance[heading] == 0.0
    axes = layout.anchor(step.relatum).turning_axes((frame,), viewer, float(layout.mean[heading]), is_certain)
    arcs = arcs_of(relation, graph.relations).arcs
    if axes is None or len(arcs) != 1 or arcs[0][1] >= np.pi:
        return None
    ((start, width),) = arcs
    return axes[0] + (start if hand(frame) > 0.0 else -start - width), width
