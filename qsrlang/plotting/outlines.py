"""Outlines in the plane: view cones and the ellipses of Gaussians."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import TURN, rotation, unit
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import Sector, Triangle, ViewCone

_ARC_STEP = np.deg2rad(2.0)


@dataclass(frozen=True, slots=True)
class Axes2:
    """The half axes of an ellipse [m] and the heading of the longer one [rad]."""

    major: float
    minor: float
    heading: float


def ellipse_axes(covariance: npt.ArrayLike) -> Axes2:
    """Return the 1-sigma ellipse of a covariance (2, 2) [m^2]: roots of eigenvalues along eigenvectors."""
    values, vectors = np.linalg.eigh(np.asarray(covariance, dtype=np.float64))
    minor, major = np.sqrt(np.maximum(values, 0.0))
    return Axes2(float(major), float(minor), float(np.arctan2(vectors[1, 1], vectors[0, 1])))


def ellipse_outline(mean: npt.ArrayLike, covariance: npt.ArrayLike, sigmas: float, count: int) -> FloatArray:
    """Return `count` points (count, 2) on the `sigmas`-sigma ellipse of a Gaussian [m]."""
    half = ellipse_axes(covariance)
    circle = unit(np.arange(count) * TURN / count)
    turned = (circle * [half.major, half.minor]) @ rotation(half.heading).T
    return np.asarray(np.asarray(mean, dtype=np.float64) + sigmas * turned)


def cone_outline(cone: ViewCone, pose: Pose2) -> FloatArray:
    """Return the outline (K, 2) of a view cone at a pose, counter-clockwise, in the frame the pose is in [m].

    A Triangle gives its 3 corners, apex first; the arcs of a Sector have a corner every 2 degrees at most.
    """
    return pose.transform(_outline_robot(cone))


def cone_outlines(cone: ViewCone, poses: npt.ArrayLike) -> FloatArray:
    """Return the outlines (N, K, 2) of the same view cone at the poses (N, 3) of x, y [m] and yaw [rad]."""
    poses = np.asarray(poses, dtype=np.float64)
    turned = np.einsum("nij,kj->nki", rotation(poses[:, 2]), _outline_robot(cone))
    return np.asarray(turned + poses[:, None, :2])


def along_edges(corners: FloatArray, count: int) -> FloatArray:
    """Return `count` points on each edge of a closed polygon with corners (K, 2) [m]."""
    shares = np.arange(count)[:, None, None] / count
    return np.asarray((corners + shares * (np.roll(corners, -1, axis=0) - corners)).reshape(-1, 2))


def blind_edges(cone: ViewCone, pose: Pose2) -> FloatArray:
    """Return the lines (L, 2, 2) from a pose to the near corners of its cone [m]; none where they are one."""
    if not isinstance(cone, Sector) or cone.near == 0.0:
        return np.zeros((0, 2, 2))
    corners = cone.near * unit(np.array([-0.5, 0.5]) * cone.field_of_view)
    return pose.transform(np.stack([np.zeros((2, 2)), corners], axis=1))


def _outline_robot(cone: ViewCone) -> FloatArray:
    match cone:
        case Triangle(length, half_width):
            return np.array([[0.0, 0.0], [length, -half_width], [length, half_width]])
        case Sector():
            return _sector_outline(cone)
        case _:
            raise ValueRangeError("the kind of a view cone", type(cone).__name__, "Triangle or Sector")


def _sector_outline(sector: Sector) -> FloatArray:
    half = 0.5 * sector.field_of_view
    arc = unit(np.linspace(-half, half, 1 + max(1, int(np.ceil(sector.field_of_view / _ARC_STEP)))))
    if sector.field_of_view >= TURN and sector.near == 0.0:
        return np.asarray(sector.far * arc[:-1])
    back = sector.near * arc[::-1] if sector.near > 0.0 else np.zeros((1, 2))
    return np.concatenate([sector.far * arc, back])
