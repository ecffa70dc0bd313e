"""An answer as a picture: its mixture among the landmarks and surfaces it was drawn from."""

from __future__ import annotations

import math

from matplotlib.figure import Figure

from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.plotting.mixtures import draw_mixture
from qsrlang.relations.graph import Landmark


def draw_answer(answer: Where, known: KnowledgeBase) -> Figure:
    """Return the answer's mixture from above, with the landmarks of its frame."""
    if answer.frame != "map":
        centre = Landmark(answer.frame, answer.frame, 0.0, 0.0, heading=math.pi)
        title = f"{answer.target} with respect to {answer.frame}"
        return draw_mixture(answer.mixture, landmarks=[centre], frame=answer.frame, title=title)
    return draw_mixture(
        answer.mixture,
        landmarks=[one for one in known.landmarks if not known.graph.classes[one.kind].is_surface],
        supports=surface_outlines(known),
        title=f"where {answer.target}",
    )


def surface_outlines(known: KnowledgeBase) -> list[ConvexPolygon]:
    """Return the outlines, in the map frame, of all surfaces whose size and pose are known."""
    outlines = []
    for landmark in known.landmarks:
        kind = known.graph.classes[landmark.kind]
        if kind.is_surface and kind.width > 0.0 and landmark.heading is not None:
            pose = Pose2(landmark.x, landmark.y, landmark.heading)
            outlines.append(ConvexPolygon.rectangle(pose, kind.depth, kind.width))
    return outlines
