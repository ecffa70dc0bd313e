"""Uniform numbers that draws are made of: independent ones, or the points of a lattice that fill space evenly."""

from __future__ import annotations

import math

import numpy as np

from qsrlang.arrays import FloatArray

REPLICATES = 16
_MARGIN = 1e-12


def independent(count: int, width: int, rng: np.random.Generator) -> FloatArray:
    """Return independent uniform numbers (count, width) inside (0, 1)."""
    return np.asarray(rng.random((count, width)).clip(_MARGIN, 1.0 - _MARGIN))


def lattices(count: int, width: int, rng: np.random.Generator) -> FloatArray:
    """Return REPLICATES runs of a lattice, count / REPLICATES points each, one after the other: (count', width).

    Richtmyer's lattice frac(n sqrt(p_j) + shift_j) with the j-th prime p_j; each run has random shifts of its own, so
    that a mean over one is unbiased, and those over all of them tell its error (Cranley and Patterson 1976).
    """
    length = max(1, math.ceil(count / REPLICATES))
    steps = np.sqrt(_primes(width)) % 1.0
    shifts = rng.random((REPLICATES, 1, width))
    points = np.arange(1, length + 1)[:, None] * steps
    return np.asarray(
        ((points + shifts) % 1.0).reshape(REPLICATES * length, width).clip(_MARGIN, 1.0 - _MARGIN)
    )


def _primes(count: int) -> FloatArray:
    """Return the first primes, by trial division."""
    found: list[int] = []
    candidate = 2
    while len(found) < count:
        if all(candidate % prime for prime in found if prime * prime <= candidate):
            found.append(candidate)
        candidate += 1
    return np.array(found, dtype=np.float64)
