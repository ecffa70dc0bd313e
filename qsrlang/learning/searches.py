"""What a search saw, as observations: a robot learns from its own searches."""

from __future__ import annotations

import math
from collections.abc import Iterable

from qsrlang.learning.observations import Observations
from qsrlang.planning.outcome import SearchStep
from qsrlang.planning.world import Detection
from qsrlang.relations.graph import Landmark


def sightings_of(
    steps: Iterable[SearchStep], landmarks: Iterable[Landmark], place: str, scene: str, time: float = 0.0
) -> Observations:
    """Return what a search recognised, each object once, together with the landmarks that the robot knew.

    All of it is one scene in the map frame, at a `time` [s since 1970, local clock]; `scene` tells it from other
    searches. A camera tells no headings and sizes, so only landmarks have a heading, and an object's support is open.
    """
    known = {landmark.name: _known(landmark) for landmark in landmarks}
    detections = (one for step in steps for one in step.detections)
    seen = {one.name: _seen(one) for one in detections if one.name not in known}
    shared = {
        "place": place,
        "scene": scene,
        "time": time,
        "support": "",
        "source": "search",
        "confidence": 1.0,
    }
    sizes = {"length": 0.0, "width": 0.0, "height": 0.0}
    return Observations.of(shared | sizes | row for row in (known | seen).values())


def _known(landmark: Landmark) -> dict[str, str | float]:
    heading = math.nan if landmark.heading is None else landmark.heading
    pose = {"x": landmark.x, "y": landmark.y, "z": landmark.z or 0.0, "yaw": heading}
    return {"object": landmark.name, "kind": landmark.kind} | pose


def _seen(detection: Detection) -> dict[str, str | float]:
    x, y, z = detection.position
    return {"object": detection.name, "kind": detection.kind, "x": x, "y": y, "z": z, "yaw": math.nan}
