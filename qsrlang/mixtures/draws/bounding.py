"""What is assumed, as bounds that draws are made inside of, instead of being made and thrown away."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom, Dimension, Uniform
from qsrlang.mixtures.densities.conditional import frame_of, hand
from qsrlang.mixtures.densities.sectors import arcs_of
from qsrlang.mixtures.densities.stance import half_box
from qsrlang.mixtures.draws.bounds import Bound, Near, Wedge
from qsrlang.mixtures.draws.conditions import Condition
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.plans import Plan, Step, asked_step, seats_read
from qsrlang.mixtures.worlds.supports import Seat, in_region
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


def bounds_of(
    graph: RelationGraph, world: World, plan: Plan, conditions: Sequence[Condition], viewer: Pose2 | None
) -> tuple[Mapping[str, tuple[Bound, ...]], tuple[Condition, ...]]:
    """Return, for each object that lies anywhere in a region, what bounds it, and the conditions that remain.

    A direction between two objects bounds the one that is placed later, and needs no more to be looked at. A distance
    bounds its referent, if that is placed later, roughly.
    """
    placing = {step.referent.block: step for step in plan.steps if step.places}
    order = {block: at for at, block in enumerate(placing)}
    bounds: dict[str, list[Bound]] = defaultdict(list)
    rest: list[Condition] = []
    for one in conditions:
        atom = one.formula if isinstance(one.formula, Atom) and one.share is None else None
        step = None if atom is None else asked_step(graph, world, plan.seats, atom)
        wedge = None if atom is None or step is None else _wedge(graph, plan, step, atom, viewer, order)
        if wedge is not None and _lies_anywhere(placing.get(wedge[0].block)):
            bounds[wedge[0].block].append(wedge[1])
            continue
        rest.append(one)
        if step is not None and order.get(step.referent.block, -1) > order.get(step.relatum.block, -1):
            bounds[step.referent.block] += _near(graph, step, placing[step.referent.block])
    return {name: tuple(found) for name, found in bounds.items() if found}, tuple(rest)


def _lies_anywhere(step: Step | None) -> bool:
    return step is not None and in_region(step.constraint) and step.relatum.root.heading is not None


def _wedge(
    graph: RelationGraph,
    plan: Plan,
    step: Step,
    atom: Atom,
    viewer: Pose2 | None,
    order: Mapping[str, int],
) -> tuple[Seat, Wedge] | None:
    aimed = _aim(graph, plan, step, atom, viewer)
    if aimed is None:
        return None
    start, width = aimed
    if order.get(step.referent.block, -1) < order.get(step.relatum.block, -1):
        return step.relatum, Wedge(step.referent, step.relatum, start + np.pi, width)
    return step.referent, Wedge(step.relatum, step.relatum, start, width)


def _near(graph: RelationGraph, step: Step, placing: Step) -> list[Near]:
    """Return the bound of a distance up to a share of the way to the edge of what its referent lies anywhere on."""
    (atom,) = step.constraint.atoms
    distance, support = atom.relation.distance, step.support
    if not isinstance(distance, Uniform) or support is None or support.seat != placing.relatum:
        return []
    if distance.high.dimension is not Dimension.FRACTION or not _lies_anywhere(placing):
        return []
    kinds = [
        graph.classes[graph.class_of(name)] for name in (step.constraint.referent, step.constraint.relatum)
    ]
    touching = sum(math.hypot(*half_box(kind.width, kind.depth)) for kind in kinds)
    share = distance.high.value
    half = half_box(support.kind.width, support.kind.depth)
    return [Near(step.relatum, support.seat, half, share, (1.0 - share) * touching)]


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
