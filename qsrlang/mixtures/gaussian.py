"""Mixtures of Gaussians in the plane (equation 2 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import logsumexp

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import rotation
from qsrlang.geometry.pose import Pose2

MIN_DEVIATION = 1e-3
_QUADRATURE_ORDER = 24


@dataclass(frozen=True, slots=True, eq=False)
class GaussianMixture:
    """p(x) = sum_i w_i N(x | mu_i, Sigma_i): weights (M,) that sum to 1, means (M, 2) [m], covariances (M, 2, 2) [m^2].

    Equation 2 of Kunze et al. 2014. Raises ValueRangeError for weights that do not sum to 1 within 1e-9
    or covariances that are not symmetric and positive definite.
    """

    weights: FloatArray
    means: FloatArray
    covariances: FloatArray

    def __post_init__(self) -> None:
        weights = frozen_array("mixture weights", self.weights, (None,))
        means = frozen_array("mixture means", self.means, (len(weights), 2))
        covariances = frozen_array("mixture covariances", self.covariances, (len(weights), 2, 2))
        if len(weights) == 0 or (weights < 0.0).any() or abs(float(weights.sum()) - 1.0) > 1e-9:
            raise ValueRangeError(
                "the sum of mixture weights", float(weights.sum()), "1, of weights of at least 0"
            )
        symmetric = np.allclose(covariances, covariances.transpose(0, 2, 1), rtol=1e-9, atol=1e-15)
        if not symmetric or (np.linalg.eigvalsh(covariances) <= 0.0).any():
            raise ValueRangeError("a covariance", covariances.tolist(), "symmetric and positive definite")
        for name, value in (("weights", weights), ("means", means), ("covariances", covariances)):
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        return len(self.weights)

    def component_logpdf(self, points: npt.ArrayLike) -> FloatArray:
        """Return log N(x | mu_i, Sigma_i) of points (N, 2) for each component: (N, M)."""
        residuals = np.asarray(points, dtype=np.float64)[:, None, :] - self.means
        factors = np.linalg.cholesky(self.covariances)
        a, b, c = factors[:, 0, 0], factors[:, 1, 0], factors[:, 1, 1]
        first = residuals[..., 0] / a
        second = (residuals[..., 1] - b * first) / c
        return np.asarray(-0.5 * (first**2 + second**2) - np.log(2.0 * np.pi * a * c))

    def logpdf(self, points: npt.ArrayLike) -> FloatArray:
        """Return log p(x) of points (N, 2): (N,) [log 1/m^2]."""
        return np.asarray(logsumexp(self.component_logpdf(points), b=self.weights, axis=1))

    def pdf(self, points: npt.ArrayLike) -> FloatArray:
        """Return p(x) of points (N, 2): (N,) [1/m^2]."""
        return np.asarray(np.exp(self.component_logpdf(points)) @ self.weights)

    def sample(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Return `count` draws (count, 2) from the mixture [m]."""
        chosen = rng.choice(len(self), size=count, p=self.weights)
        noise = rng.standard_normal((count, 2))
        factors = np.linalg.cholesky(self.covariances)
        return np.asarray(self.means[chosen] + np.einsum("nij,nj->ni", factors[chosen], noise))

    def transformed(self, pose: Pose2) -> GaussianMixture:
        """Return the mixture moved by the rigid motion `pose`: R mu + t and R Sigma R^T."""
        turn = rotation(pose.yaw)
        covariances = turn @ self.covariances @ turn.T
        return GaussianMixture(self.weights, pose.transform(self.means), covariances)

    def moments(self) -> tuple[FloatArray, FloatArray]:
        """Return the mean (2,) [m] and covariance (2, 2) [m^2] of the whole mixture."""
        mean = self.weights @ self.means
        spread = self.means - mean
        within = np.einsum("m,mij->ij", self.weights, self.covariances)
        return np.asarray(mean), np.asarray(within + np.einsum("m,mi,mj->ij", self.weights, spread, spread))

    def entropy(self) -> float:
        """Return -integral p log p [nat], by Gauss-Hermite quadrature about each component (exact for one)."""
        nodes, node_weights = np.polynomial.hermite_e.hermegauss(_QUADRATURE_ORDER)
        grid = np.stack(np.meshgrid(nodes, nodes), axis=-1).reshape(-1, 2)
        grid_weights = np.outer(node_weights, node_weights).ravel() / (2.0 * np.pi)
        points = self.means[:, None] + grid @ np.linalg.cholesky(self.covariances).transpose(0, 2, 1)
        logs = self.logpdf(points.reshape(-1, 2)).reshape(len(self), -1)
        return float(-self.weights @ (logs @ grid_weights))


def fitted(points: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean (2,) and covariance (2, 2) of weighted draws (P, 2)."""
    mean = np.asarray(weights @ points / weights.sum())
    off = points - mean
    return mean, definite(off.T @ (weights[:, None] * off) / weights.sum())


def definite(covariance: FloatArray) -> FloatArray:
    """Return a covariance (2, 2) that is: a landmark known to the millimetre has no spread, a Gaussian needs some."""
    (a, b), (_, c) = covariance = 0.5 * (covariance + covariance.T)
    is_definite = a + c > 0.0 and a * c - b * b > 0.0
    return np.asarray(covariance if is_definite else covariance + MIN_DEVIATION**2 * np.eye(2))
