"""The probability of one atom on one pair without a draw: its share of the stated density, or of a Gaussian."""

from __future__ import annotations

from functools import lru_cache, partial

import numpy as np

from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom
from qsrlang.mixtures.conditional import PolarConditional, frame_of, hand
from qsrlang.mixtures.conditionals import make_conditional
from qsrlang.mixtures.cones import turning_cone_probability
from qsrlang.mixtures.events import share_inside
from qsrlang.mixtures.layout import compact_anchor
from qsrlang.mixtures.linear import cubature
from qsrlang.mixtures.plans import Step, asked_step, seats_read
from qsrlang.mixtures.sectors import Arcs, arcs_of
from qsrlang.mixtures.solving import Solved
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import RelationGraph

EXACT, GAUSSIAN, DRAWS = "exact", "Gaussian", "draws"


def atom_probability(
    graph: RelationGraph, solved: Solved, atom: Atom, viewer: Pose2 | None
) -> tuple[float, str] | None:
    """Return P(atom) in a world and how it was found; None where only draws tell.

    Where the one step that places the referent is about the same relatum, and nothing is fused, the share of its own
    density is exact; else that of the Gaussian of the pair, for relations of direction alone.
    """
    step = asked_step(graph, solved.world, solved.plan.seats, atom)
    if step is None:
        return 0.0, EXACT
    stated = None if solved.plan.fused else _stated(solved, step)
    if stated is not None:
        share = _share_of_density(graph, solved, stated, step, atom, viewer)
        if share is not None:
            return share, EXACT
    share = _share_of_gaussian(graph, solved, step, atom, viewer)
    return None if share is None else (share, GAUSSIAN)


def _stated(solved: Solved, asked: Step) -> Step | None:
    """Return the step that places what is asked about by the same relatum."""
    placing = [one for one in solved.plan.steps if one.referent == asked.referent]
    if len(placing) != 1 or placing[0].relatum != asked.relatum or placing[0].second or asked.second:
        return None
    return placing[0]


def _share_of_density(
    graph: RelationGraph, solved: Solved, stated: Step, asked: Step, atom: Atom, viewer: Pose2 | None
) -> float | None:
    seats = seats_read(stated, asked)
    anchor = partial(compact_anchor, seats)
    density = make_conditional(graph, stated, anchor, viewer)
    window = make_conditional(graph, asked, anchor, viewer)
    if not isinstance(density, PolarConditional) or not isinstance(window, PolarConditional):
        return None
    posterior, relation = solved.posterior, graph.relations[atom.relation.text]
    columns = np.array([column for seat in seats for column in posterior.layout.pose(seat)])
    mean, covariance = posterior.mean[columns], posterior.covariance(columns)
    arcs = arcs_of(relation, graph.relations)
    return _share(density, window, relation, arcs, mean.tobytes(), covariance.tobytes())


@lru_cache(maxsize=8192)
def _share(
    density: PolarConditional,
    window: PolarConditional,
    relation: Relation,
    arcs: Arcs,
    mean_bytes: bytes,
    covariance_bytes: bytes,
) -> float:
    """Return the share of a density that a relation holds in, over a cubature of what both depend on."""
    mean = np.frombuffer(mean_bytes)
    covariance = np.frombuffer(covariance_bytes).reshape(len(mean), -1)
    states = cubature(mean, covariance, float(mean[2]))
    rays = density.density.rays(density.stance(states), strict=False).part(*density.part)
    return float(share_inside(window, relation, arcs, rays, states).mean())


def _share_of_gaussian(
    graph: RelationGraph, solved: Solved, asked: Step, atom: Atom, viewer: Pose2 | None
) -> float | None:
    relation, constraint = graph.relations[atom.relation.text], asked.constraint
    if relation.distance or relation.region or asked.second or relation.angle is None:
        return None
    layout, frame = solved.posterior.layout, frame_of(constraint, constraint.atoms[0])
    heading = layout.pose(asked.relatum)[2]
    anchor = layout.anchor(asked.relatum)
    is_certain = layout.variance[heading] == 0.0
    axes = anchor.turning_axes((frame,), viewer, float(layout.mean[heading]), is_certain)
    if axes is None:
        return None
    columns = np.array([*layout.place(asked.referent), *layout.place(asked.relatum), heading])
    difference = np.array([[1.0, 0.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0]])
    mean = difference @ solved.posterior.mean[columns]
    covariance = difference @ solved.posterior.covariance(columns) @ difference.T
    arcs = arcs_of(relation, graph.relations)
    return turning_cone_probability(arcs, axes[0], hand(frame), mean, covariance)
