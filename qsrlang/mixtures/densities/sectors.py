"""Directions in which a relation holds, as arcs of the circle about its axis: sharp where its density is not.

A relation holds where no relation that it excludes is nearer, in deviations of its angle (the four directions are
quarters); one that excludes none, within the central 95 % of its angle.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.geometry.angles import TURN, wrap, wrap_positive
from qsrlang.language.syntax import Density, Normal, Uniform
from qsrlang.relations.calculus import Relation

Part: TypeAlias = tuple[FloatArray, FloatArray]
CENTRAL_95 = 1.959963984540054
_GRID = 1440
_HALVINGS = 48


@dataclass(frozen=True, slots=True)
class Arcs:
    """Arcs of the circle, each from an angle [rad] counter-clockwise over a width of up to a full turn."""

    arcs: tuple[tuple[float, float], ...]

    def contain(self, angles: FloatArray) -> BoolArray:
        """Return which angles (...) lie in one of the arcs: (...,)."""
        inside = [wrap_positive(angles - start) <= width for start, width in self.arcs]
        return np.asarray(np.logical_or.reduce(inside or [np.zeros(np.shape(angles), dtype=bool)]))

    def parts(self, angles: FloatArray, cell: float) -> tuple[Part, ...]:
        """Return, of each arc, from where to where it covers a cell about each of the angles (...): past the angle."""
        half = np.full(np.shape(angles), 0.5 * cell)
        return tuple(
            (-half, half) if width >= TURN else _part(wrap(angles - start - 0.5 * width), half, 0.5 * width)
            for start, width in self.arcs
        )


def covered(parts: Iterable[Part], cell: float, shape: tuple[int, ...]) -> FloatArray:
    """Return which share (...) of cells lies in parts of them that do not overlap."""
    shares = np.zeros(shape)
    for low, high in parts:
        shares += np.maximum(high - low, 0.0) / cell
    return np.minimum(shares, 1.0)


def _part(off: FloatArray, half: FloatArray, reach: float) -> Part:
    return np.maximum(-half, -reach - off), np.minimum(half, reach - off)


def arcs_of(relation: Relation, relations: Mapping[str, Relation]) -> Arcs:
    """Return where a relation holds by its angle: one arc or several, all of the circle where it has none."""
    return _arcs_among(relation, tuple([relations[name] for name in relation.disjoint]))


@lru_cache(maxsize=1024)
def _arcs_among(relation: Relation, rivals: tuple[Relation, ...]) -> Arcs:
    own = tuple(term.angle for _, term in relation.terms)
    excluded = [term.angle for rival in rivals for _, term in rival.terms]
    return _arcs(own, tuple(angle for angle in excluded if angle is not None))


def _arcs(own: tuple[Density | None, ...], rivals: tuple[Density, ...]) -> Arcs:
    if None in own:
        return Arcs(((0.0, TURN),))
    grid = np.arange(_GRID) * TURN / _GRID + 1e-6
    held = _holds(grid, own, rivals)
    changes = np.flatnonzero(held != np.roll(held, -1))
    if len(changes) == 0:
        return Arcs(((0.0, TURN),) if held[0] else ())
    edges = _bisected(grid[changes], held[changes], own, rivals)
    rising = np.flatnonzero(~held[changes])
    ends = np.roll(edges, -1)
    return Arcs(tuple((float(edges[at]), float((ends[at] - edges[at]) % TURN)) for at in rising))


def _bisected(
    low: FloatArray, held: BoolArray, own: tuple[Density | None, ...], rivals: tuple[Density, ...]
) -> FloatArray:
    """Return the edges (K,) of arcs between grid points `low` (K,), at which they hold or not, and the next ones."""
    low, high = low, low + TURN / _GRID
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        same = _holds(middle, own, rivals) == held
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray(0.5 * (low + high))


def _holds(angles: FloatArray, own: tuple[Density | None, ...], rivals: tuple[Density, ...]) -> BoolArray:
    nearest = np.minimum.reduce([_deviations(one, angles) for one in own])
    limits = [_deviations(one, angles) for one in rivals] or [np.full_like(angles, CENTRAL_95)]
    return np.asarray((nearest <= np.minimum.reduce(limits)) & np.isfinite(nearest))


def _deviations(angle: Density | None, angles: FloatArray) -> FloatArray:
    """Return how far angles (P,) are from a density's middle, in its deviations; 0 inside an arc, infinite outside."""
    match angle:
        case Normal(mean=mean, deviation=deviation):
            return np.asarray(np.abs(wrap(angles - mean.value)) / deviation.value)
        case Uniform(low=low, high=high):
            middle, half = 0.5 * (low.value + high.value), 0.5 * (high.value - low.value)
            return np.where(np.abs(wrap(angles - middle)) <= half, 0.0, np.inf)
        case _:
            return np.zeros_like(angles)
