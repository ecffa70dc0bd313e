"""The law that every answer keeps: it moves with all that it was drawn from."""

from __future__ import annotations

import numpy as np

import qsrlang as qsr
from qsrlang.geometry.angles import rotation


def moved(landmark: qsr.Landmark, pose: qsr.Pose2) -> qsr.Landmark:
    """Return a landmark, given in the frame of a pose, in the frame the pose is given in."""
    new = pose @ qsr.Pose2(landmark.x, landmark.y, landmark.heading or 0.0)
    heading = None if landmark.heading is None else new.yaw
    return qsr.Landmark(landmark.name, landmark.kind, new.x, new.y, None, heading, landmark.deviation)


def assert_moves_with_its_landmarks(
    known: qsr.KnowledgeBase, target: str, pose: qsr.Pose2, viewer: qsr.Pose2 | None = None
) -> None:
    """Check that moving all landmarks and the viewer moves every component, to 1e-9."""
    before = known.where(target, viewer=viewer)
    there = known.with_landmarks(*(moved(landmark, pose) for landmark in known.landmarks))
    after = there.where(target, viewer=pose @ viewer if viewer else None)
    turn = rotation(pose.yaw)
    means = pose.transform(before.means)
    order = [np.linalg.norm(means - mean, axis=1).argmin() for mean in after.means]
    np.testing.assert_allclose(after.weights, before.weights[order], atol=1e-9)
    np.testing.assert_allclose(after.means, means[order], atol=1e-9)
    np.testing.assert_allclose(after.covariances, turn @ before.covariances[order] @ turn.T, atol=1e-9)
