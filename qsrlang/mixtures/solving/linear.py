"""What a step says of its referent as a linear equation with Gaussian noise, about where its relata are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.angles import rotation
from qsrlang.mixtures.densities.conditional import Conditional, Turning

_TINY = 1e-12


class Linear(NamedTuple):
    """x = slope s + offset + noise, noise ~ N(0, covariance): (2, K), (2,), (2, 2); or many, along a first axis."""

    slope: FloatArray
    offset: FloatArray
    covariance: FloatArray

    def difference(self, other: Linear, mean: FloatArray) -> float:
        """Return by how much two equations differ at a mean (K,), in x [m] or in their noise [m^2]."""
        off = (self.slope - other.slope) @ mean + self.offset - other.offset
        return max(float(np.abs(off).max()), float(np.abs(self.covariance - other.covariance).max()))


@dataclass(frozen=True, slots=True, eq=False)
class Factor:
    """What a step says, with the columns of its referent (2,) and those (K,) that its `conditional` reads.

    Columns come in threes, the place and the heading of each thing that is read. It is `turning` where it says the same
    in the relatum's frame wherever that is, and then `bends`, depends on how its columns are distributed, only if the
    heading is not certain. `orientation` [rad] is a direction that turns with the scene.
    """

    referent: IntArray
    columns: IntArray
    conditional: Conditional
    turning: Turning | None
    bends: bool
    orientation: float

    def linearised(self, mean: FloatArray, covariance: FloatArray) -> Linear:
        """Return the equation for its columns distributed as N(mean, covariance): (K,), (K, K)."""
        if self.turning is not None:
            heading, variance = (
                (0.0, 0.0) if self.turning.fixed else (float(mean[2]), float(covariance[2, 2]))
            )
            return _turned(self.turning, heading, variance, len(mean))
        return _statistically(self.conditional, mean.tobytes(), covariance.tobytes(), self.orientation)  # type: ignore[arg-type]

    def linearised_each(self, means: FloatArray, covariances: FloatArray) -> Linear:
        """Return the equations for many distributions of its columns, (W, K) and (W, K, K), of one heading's."""
        if self.turning is not None:
            return Linear(*(part[None] for part in self.linearised(means[0], covariances[0])))
        each = [
            self.linearised(mean, covariance) for mean, covariance in zip(means, covariances, strict=True)
        ]
        return Linear(*(np.array(parts) for parts in zip(*each, strict=True)))


def _turned(turning: Turning, heading: float, variance: float, size: int) -> Linear:
    """Return x = relatum + R(h) m + noise, h ~ N(heading, v): all moments of cos h and sin h are known.

    E R(h) = e^{-v/2} R(heading), Cov(R(h) m, h) = v e^{-v/2} R'(heading) m (Stein), and twice the angle gives second
    moments: E R M R^T = tr M / 2 I + e^{-2v} R (M - tr M / 2 I) R^T for a symmetric M.
    """
    (mx, my), ((xx, xy), (_, yy)) = turning.mean.tolist(), turning.covariance.tolist()
    shrink = math.exp(-0.5 * variance)
    cos, sin = shrink * math.cos(heading), shrink * math.sin(heading)
    x, y = cos * mx - sin * my, sin * mx + cos * my
    twice = math.exp(-2.0 * variance)
    cos2, sin2 = twice * math.cos(2.0 * heading), twice * math.sin(2.0 * heading)
    trace, spread, skew = (
        0.5 * (xx + mx * mx + yy + my * my),
        0.5 * (xx + mx * mx - yy - my * my),
        xy + mx * my,
    )
    spread, skew = cos2 * spread - sin2 * skew, sin2 * spread + cos2 * skew
    across = skew - x * y + variance * x * y
    slope = np.zeros((2, size))
    slope[0, 0] = slope[1, 1] = 1.0
    slope[0, 2], slope[1, 2] = (-y, x) if variance > 0.0 else (0.0, 0.0)
    offset = np.array([x - slope[0, 2] * heading, y - slope[1, 2] * heading])
    noise = [
        [trace + spread - x * x - variance * y * y, across],
        [across, trace - spread - y * y - variance * x * x],
    ]
    return Linear(slope, offset, np.array(noise))


@lru_cache(maxsize=8192)
def _statistically(
    conditional: Conditional, mean_bytes: bytes, covariance_bytes: bytes, orientation: float
) -> Linear:
    """Statistical linearisation over a third-degree cubature (Arasaratnam and Haykin 2009).

    With states s_k and g_k = E[x | s_k]: slope = Cov(g, s) Cov(s)^-1, noise = E Cov[x | s] + Cov(g) - slope Cov(s, g).
    Worlds share most of their steps, so results are kept, by the bytes of what they depend on.
    """
    mean = np.frombuffer(mean_bytes)
    covariance = np.frombuffer(covariance_bytes).reshape(len(mean), -1)
    states = cubature(mean, covariance, orientation)
    means, covariances = conditional.moments(states)
    centre = means.mean(axis=0)
    off = means - centre
    cross = off.T @ (states - mean) / len(states)
    slope = cross @ np.linalg.pinv(covariance, hermitian=True) if len(states) > 1 else np.zeros_like(cross)
    noise = covariances.mean(axis=0) + off.T @ off / len(states) - slope @ cross.T
    return Linear(slope, centre - slope @ mean, 0.5 * (noise + noise.T))


def cubature(mean: FloatArray, covariance: FloatArray, orientation: float) -> FloatArray:
    """Return 2 d equally weighted states, d the rank of the covariance; the mean alone where nothing varies.

    Columns come in threes, the first two of them a place; places are laid out along `orientation`, so that a rigid
    motion of all that is known moves the states with it.
    """
    if not covariance.any():
        return mean[None, :]
    turn = np.eye(len(mean))
    for start in range(0, len(mean), 3):
        turn[start : start + 2, start : start + 2] = rotation(orientation)
    roots = turn @ semidefinite_root(turn.T @ covariance @ turn)
    steps = (roots * math.sqrt(roots.shape[1])).T
    return np.concatenate([mean + steps, mean - steps])


def semidefinite_root(matrix: FloatArray) -> FloatArray:
    """Return L (n, rank) with L L^T = matrix, lower triangular where the rank is full (Cholesky, zero pivots skipped).

    Unlike eigenvectors, L changes little where the matrix changes little, also when eigenvalues coincide.
    """
    rest = np.array(matrix)
    floor = _TINY * max(float(np.diag(matrix).max(initial=0.0)), _TINY)
    columns = []
    for pivot in range(len(rest)):
        if rest[pivot, pivot] > floor:
            column = rest[:, pivot] / math.sqrt(rest[pivot, pivot])
            columns.append(column)
            rest -= np.outer(column, column)
    return np.array(columns).reshape(len(columns), len(rest)).T
