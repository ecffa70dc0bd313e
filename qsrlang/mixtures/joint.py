"""One Gaussian over everything that is placed in a world, grown and conditioned block by block."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.angles import rotation

_TINY = 1e-12

Conditional = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True, eq=False)
class JointGaussian:
    """N(mean, covariance) over stacked blocks; `blocks` maps a name to its slice. mean (n,), covariance (n, n).

    Each block starts with a position (x, y). `orientation` [rad] is a direction that turns with the scene: cubature
    states are laid out along it, so that a rigid motion of all that is known moves every result with it.
    """

    blocks: dict[str, slice]
    mean: FloatArray
    covariance: FloatArray
    orientation: float

    @classmethod
    def empty(cls, orientation: float) -> JointGaussian:
        """Return the Gaussian over nothing."""
        return cls({}, np.zeros(0), np.zeros((0, 0)), orientation)

    def with_block(self, name: str, mean: FloatArray, covariance: FloatArray) -> JointGaussian:
        """Return the joint with an independent block more."""
        return self._extended(name, mean, np.zeros((len(mean), len(self.mean))), covariance)

    def with_conditional(self, name: str, conditional: Conditional) -> JointGaussian:
        """Return the joint with a block x whose E[x | state] and Cov[x | state] `conditional` gives.

        Statistical linearisation (third-degree cubature, Arasaratnam and Haykin 2009): with states s_k and
        g_k = E[x | s_k], mean = E g, Cov(x, s) = E (g - E g)(s - E s)^T, Cov(x) = E Q + Cov(g).
        """
        states, gains, mean, covariance = self._propagate(conditional)
        cross = gains.T @ (states - self.mean) / len(states)
        return self._extended(name, mean, cross, covariance)

    def observed(self, name: str, conditional: Conditional) -> tuple[JointGaussian, float]:
        """Return the joint conditioned on a second source for the same block, and the log evidence [log 1/m^2].

        The source says x = g(state) + noise; linearised, it is a measurement 0 = x - A s - b + noise.
        """
        states, gains, mean, covariance = self._propagate(conditional)
        cross = gains.T @ (states - self.mean) / len(states)
        slope = cross @ np.linalg.pinv(self.covariance, hermitian=True)
        noise = covariance - slope @ self.covariance @ slope.T
        pick = np.zeros((2, len(self.mean)))
        pick[:, self.blocks[name]] = np.eye(2)
        design = pick - slope
        residual = mean - self.mean[self.blocks[name]]
        spread = design @ self.covariance @ design.T + noise
        gain = self.covariance @ design.T @ np.linalg.inv(spread)
        updated = self.covariance - gain @ spread @ gain.T
        evidence = -0.5 * residual @ np.linalg.solve(spread, residual)
        evidence -= 0.5 * math.log((2.0 * math.pi) ** 2 * np.linalg.det(spread))
        joint = replace(self, mean=self.mean + gain @ residual, covariance=0.5 * (updated + updated.T))
        return joint, float(evidence)

    def marginal(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Return mean and covariance of one block."""
        block = self.blocks[name]
        return self.mean[block], self.covariance[block, block]

    def _propagate(self, conditional: Conditional) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        states = self._cubature()
        means, covariances = conditional(states)
        mean = means.mean(axis=0)
        gains = means - mean
        return states, gains, mean, covariances.mean(axis=0) + gains.T @ gains / len(states)

    def _cubature(self) -> FloatArray:
        """Return 2 d equally weighted states, d the rank of the covariance; the mean alone where nothing varies."""
        turn = np.eye(len(self.mean))
        for block in self.blocks.values():
            pair = slice(block.start, block.start + 2)
            turn[pair, pair] = rotation(self.orientation)
        roots = turn @ semidefinite_root(turn.T @ self.covariance @ turn)
        if roots.shape[1] == 0:
            return self.mean[None, :]
        steps = (roots * math.sqrt(roots.shape[1])).T
        return np.concatenate([self.mean + steps, self.mean - steps])

    def _extended(
        self, name: str, mean: FloatArray, cross: FloatArray, covariance: FloatArray
    ) -> JointGaussian:
        size = len(self.mean)
        blocks = {**self.blocks, name: slice(size, size + len(mean))}
        full = np.block([[self.covariance, cross.T], [cross, covariance]])
        return JointGaussian(blocks, np.concatenate([self.mean, mean]), full, self.orientation)


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
