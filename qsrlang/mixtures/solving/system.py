"""A world as one Gaussian over all its objects: linear equations, solved together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.mixtures.solving.linear import Factor, Linear
from qsrlang.mixtures.worlds.layout import Layout

DENSE = 96


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """The posterior N(mean, H^-1) of a system, mean (n,), and the log of its evidence [log of densities]."""

    mean: FloatArray
    log_evidence: float
    index: IntArray
    inverse: FloatArray | None
    factorised: Any

    def covariance(self, columns: IntArray) -> FloatArray:
        """Return the joint covariance (K, K) of some columns."""
        at = self.index[columns]
        if self.inverse is not None:
            return self.inverse[np.ix_(at, at)]
        size = int(self.index.max(initial=0))
        wanted, where = np.unique(at, return_inverse=True)
        units = np.zeros((size, len(wanted)))
        units[wanted[wanted < size], np.flatnonzero(wanted < size)] = 1.0
        solved = np.vstack([self.factorised.solve(units), np.zeros(len(wanted))])
        full = solved[wanted][:, where][where]
        return np.asarray(0.5 * (full + full.T))


def solve(
    prior: Layout, factors: Sequence[Factor], equations: Sequence[Linear], start: FloatArray
) -> Solution:
    """Return the posterior of x_f = A_f s_f + b_f + N(0, Q_f) for all f, and of the prior, from a `start` (n,).

    H = diag(1 / prior variance) + sum J^T Q^-1 J with J = [I, -A]; the evidence is the integral over all columns of
    the product of the prior and of all N(x_f; A_f s_f + b_f, Q_f). Dense up to DENSE free columns, else sparse.
    """
    free = np.flatnonzero(prior.free)
    index = np.full(len(prior.mean), len(free))
    index[free] = np.arange(len(free))
    columns, jacobians, offsets, noises = _stacked(factors, equations)
    weights = np.linalg.inv(noises)
    loads = np.swapaxes(jacobians, 1, 2) @ weights
    at = index[columns]
    known = prior.variance[free] > 0.0
    precision = np.where(known, 1.0 / np.where(known, prior.variance[free], 1.0), 0.0)
    residuals = (jacobians @ start[columns][..., None])[..., 0] - offsets
    gradient = np.append(precision * (start - prior.mean)[free], 0.0)
    np.add.at(gradient, at, (loads @ residuals[..., None])[..., 0])
    inverse, factorised, log_determinant = _factorised(at, loads @ jacobians, precision)
    step = np.zeros(len(prior.mean))
    if inverse is not None:
        step[free] = -inverse[:-1, :-1] @ gradient[:-1]
    else:
        step[free] = -factorised.solve(gradient[:-1])
    residuals = residuals + (jacobians @ step[columns][..., None])[..., 0]
    mean = start + step
    log = -0.5 * float(np.einsum("fi,fij,fj->", residuals, weights, residuals))
    log -= 0.5 * float(precision @ np.square(mean - prior.mean)[free])
    log -= 0.5 * float(np.linalg.slogdet(noises)[1].sum()) - 0.5 * float(np.log(precision[known]).sum())
    log += 0.5 * math.log(2.0 * math.pi) * (int((~known).sum()) - 2 * len(equations)) - 0.5 * log_determinant
    return Solution(mean, log, index, inverse, factorised)


def _stacked(
    factors: Sequence[Factor], equations: Sequence[Linear]
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Return columns (F, 2 + K), J = [I, -A] (F, 2, 2 + K), offsets (F, 2) and noises (F, 2, 2), padded with zeros."""
    width = 2 + max((len(factor.columns) for factor in factors), default=0)
    columns = np.zeros((len(factors), width), dtype=np.int64)
    jacobians = np.zeros((len(factors), 2, width))
    jacobians[:, :, :2] = np.eye(2)
    for row, (factor, equation) in enumerate(zip(factors, equations, strict=True)):
        end = 2 + len(factor.columns)
        columns[row, :2], columns[row, 2:end] = factor.referent, factor.columns
        jacobians[row, :, 2:end] = -equation.slope
    offsets = np.array([equation.offset for equation in equations]).reshape(-1, 2)
    noises = np.array([equation.covariance for equation in equations]).reshape(-1, 2, 2)
    return columns, jacobians, offsets, noises


def _factorised(
    at: IntArray, blocks: FloatArray, precision: FloatArray
) -> tuple[FloatArray | None, Any, float]:
    """Return H^-1 with a row and a column of zeros more, or else a sparse factorisation, and log |H|."""
    size = len(precision)
    rows = np.broadcast_to(at[:, :, None], blocks.shape)
    columns = np.broadcast_to(at[:, None, :], blocks.shape)
    if size <= DENSE:
        information = np.zeros((size + 1, size + 1))
        np.add.at(information, (rows, columns), blocks)
        information[range(size), range(size)] += precision
        inverse = np.zeros((size + 1, size + 1))
        inverse[:-1, :-1] = np.linalg.inv(information[:-1, :-1])
        inverse = 0.5 * (inverse + inverse.T)
        return inverse, None, float(np.linalg.slogdet(information[:-1, :-1])[1])
    inside = (rows < size) & (columns < size)
    entries = (blocks[inside], (rows[inside], columns[inside]))
    matrix = scipy.sparse.coo_matrix(entries, shape=(size, size)) + scipy.sparse.diags(precision)
    factorised = scipy.sparse.linalg.splu(
        matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    return None, factorised, float(np.log(np.abs(factorised.U.diagonal())).sum())
