"""Whether all that is known can be true at once, by every theory there is."""

from __future__ import annotations

from qsrlang.relations.consistency.claims import claims_of
from qsrlang.relations.consistency.conflicts import Consistency
from qsrlang.relations.consistency.finding import Examination
from qsrlang.relations.consistency.placing import Placing
from qsrlang.relations.graph import RelationGraph


def find_conflicts(graph: RelationGraph) -> Consistency:
    """Return whether what a graph knows can be true at once, and if not, minimal conflicts with their smallest changes.

    Choices and hard requirements hold together across statements; alternatives are tried in turn. Directions of one
    frame are judged exactly by two strict orders, places on the map by linear programming: known poses, distances as
    discs, outlines of landmarks. There is no viewer. Nothing is claimed that the knowledge does not imply; what
    overlapping boxes, or a viewer near the objects, would rule out besides is not looked for.
    """
    placing = Placing.of(graph)
    return Examination(claims_of(graph), graph.relations, placing, placing.poses_behind).consistency()
