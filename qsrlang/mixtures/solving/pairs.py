"""The probability of a direction between two things from the Gaussian of both: a bivariate normal over a cone."""

from __future__ import annotations

import numpy as np

from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom
from qsrlang.mixtures.densities.conditional import frame_of, hand
from qsrlang.mixtures.densities.sectors import arcs_of
from qsrlang.mixtures.solving.cones import turning_cone_probability
from qsrlang.mixtures.solving.weighing import Solved
from qsrlang.mixtures.worlds.plans import asked_step
from qsrlang.relations.graph import RelationGraph

_DIFFERENCE = np.array([[1.0, 0.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0]])


def direction_probability(
    graph: RelationGraph, solved: Solved, atom: Atom, viewer: Pose2 | None
) -> float | None:
    """Return P(atom) under the Gaussian of a world; None for what is more than a direction, or has an axis that moves.

    0 where the world does not place both things.
    """
    asked = asked_step(graph, solved.world, solved.plan.seats, atom)
    if asked is None:
        return 0.0
    relation, constraint = graph.relations[atom.relation.text], asked.constraint
    if relation.distance or relation.region or asked.second or relation.angle is None:
        return None
    layout, frame = solved.plan.layout, frame_of(constraint, constraint.atoms[0])
    heading = layout.pose(asked.relatum)[2]
    is_certain = layout.variance[heading] == 0.0
    relatum = layout.anchor(asked.relatum)
    axes = relatum.turning_axes((frame,), viewer, float(layout.mean[heading]), is_certain)
    if axes is None:
        return None
    columns = np.array([*layout.place(asked.referent), *layout.place(asked.relatum), heading])
    mean = _DIFFERENCE @ solved.posterior.mean[columns]
    covariance = _DIFFERENCE @ solved.posterior.covariance(columns) @ _DIFFERENCE.T
    return turning_cone_probability(
        arcs_of(relation, graph.relations), axes[0], hand(frame), mean, covariance
    )
