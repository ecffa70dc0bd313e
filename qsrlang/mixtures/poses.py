"""Poses given for classes and roles, as landmarks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from qsrlang.geometry.pose import Pose2
from qsrlang.relations.graph import Landmark, RelationGraph

Poses: TypeAlias = Mapping[str, Pose2 | Sequence[Pose2]]


def landmarks_at(poses: Poses, graph: RelationGraph) -> Iterator[Landmark]:
    """Yield a landmark for each pose of a class, numbered, or of a role, which bears the role's name."""
    for kind, given in poses.items():
        for number, pose in enumerate([given] if isinstance(given, Pose2) else given, start=1):
            name = kind if kind in graph.roles else f"{kind}-{number}"
            yield Landmark(name, graph.roles.get(kind, kind), pose.x, pose.y, heading=pose.yaw)
