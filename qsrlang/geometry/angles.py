"""Angles on the circle, and equation 1 of the paper."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray

TURN = 2.0 * np.pi


def wrap(angle: npt.ArrayLike) -> FloatArray:
    """Return the angle in (-pi, pi], elementwise [rad]."""
    return np.asarray(np.pi - np.mod(np.pi - np.asarray(angle, dtype=np.float64), TURN))


def wrap_positive(angle: npt.ArrayLike) -> FloatArray:
    """Return the angle in [0, 2 pi), elementwise [rad]; -1e-16 gives 0, never 2 pi."""
    wrapped = np.mod(np.asarray(angle, dtype=np.float64), TURN)
    return np.asarray(np.where(wrapped >= TURN, 0.0, wrapped))


def relative_angle(origin: npt.ArrayLike, relatum: npt.ArrayLike, referent: npt.ArrayLike) -> FloatArray:
    """Return phi_rel = atan2(referent - relatum) - atan2(relatum - origin), in [0, 2 pi).

    Equation 1 of Kunze et al. 2014, with atan2 so that it holds in all quadrants: 0 is behind the relatum
    as seen from the origin, pi/2 left, pi in front, 3 pi/2 right. Arguments broadcast over (..., 2) [m].
    """
    seen = np.asarray(referent, dtype=np.float64) - np.asarray(relatum, dtype=np.float64)
    axis = np.asarray(relatum, dtype=np.float64) - np.asarray(origin, dtype=np.float64)
    return wrap_positive(np.arctan2(seen[..., 1], seen[..., 0]) - np.arctan2(axis[..., 1], axis[..., 0]))


def few(angles: FloatArray) -> FloatArray:
    """Return angles (P,), or the first alone (1,) where all are the same, to be broadcast."""
    return angles[:1] if len(angles) and (angles == angles[0]).all() else angles


def unit(angle: npt.ArrayLike) -> FloatArray:
    """Return the unit vectors (..., 2) that point along the angles (...)."""
    angle = np.asarray(angle, dtype=np.float64)
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def rotation(angle: npt.ArrayLike) -> FloatArray:
    """Return the rotation matrices (..., 2, 2) by the angles (...): R(angle) @ x turns x counter-clockwise."""
    angle = np.asarray(angle, dtype=np.float64)
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([cos, -sin], axis=-1), np.stack([sin, cos], axis=-1)], axis=-2)
