"""Support and containment: a referent anywhere on the top of its relatum, or anywhere inside its box."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang import geometry
from qsrlang.arrays import FloatArray
from qsrlang.geometry.angles import TURN, few, rotation, unit
from qsrlang.mixtures.densities.conditional import Conditional, Turning
from qsrlang.mixtures.densities.standpoint import Standpoint
from qsrlang.relations.graph import Constraint, RelationGraph

MIN_SIDE = 1e-3


@dataclass(frozen=True, slots=True)
class BoxConditional:
    """U(x; the relatum's box, turned with it): `length` along its heading, `width` across [m]."""

    length: float
    width: float
    standpoint: Standpoint

    def turning(self, heading: float, is_certain: bool) -> Turning | None:
        """Return the moments in the relatum's frame."""
        if self.standpoint.relatum.heading is None:
            return None
        return Turning(np.zeros(2), np.diag(np.square(self._sides) / 12.0))

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance R diag(length^2, width^2) / 12 R^T (P, 2, 2) of x."""
        turn = rotation(self.standpoint.box_yaws(states))
        spread = turn * (np.square(self._sides) / 12.0)
        return self.standpoint.relatum.positions(states), spread @ turn.transpose(0, 2, 1)

    def sample(self, states: FloatArray, uniforms: FloatArray) -> FloatArray:
        """Return one draw (P, 2) from each state, made of uniform numbers (P, 3)."""
        offsets = (uniforms[:, :2] - 0.5) * self._sides
        turn = rotation(self.standpoint.box_yaws(states))
        return np.asarray(self.standpoint.relatum.positions(states) + np.einsum("pij,pj->pi", turn, offsets))

    def sample_inside(
        self, states: FloatArray, uniforms: FloatArray, lines: Sequence[tuple[FloatArray, FloatArray]]
    ) -> tuple[FloatArray, FloatArray]:
        """Return one draw (P, 2) from each state on the inner side of all lines, and the log (P,) of their share.

        Lines are points (P, 2) and normals to the inside (P, 2) or (1, 2); where nothing is inside, the log is -inf.
        """
        turn = rotation(few(self.standpoint.box_yaws(states)))
        corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]) * self._sides
        outline = self.standpoint.relatum.positions(states)[:, None] + corners @ turn.transpose(0, 2, 1)
        points, normals = np.empty((2, len(lines), len(states), 2))
        for row, (point, normal) in enumerate(lines):
            points[row], normals[row] = point, normal
        draws, areas = geometry.clipping.draw_inside(outline, points, normals, uniforms)
        with np.errstate(divide="ignore"):
            return draws, np.log(areas / (self.length * self.width))

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""
        turn = rotation(self.standpoint.box_yaws(states))
        offsets = np.einsum("pij,pi->pj", turn, points - self.standpoint.relatum.positions(states))
        inside = (np.abs(offsets) <= 0.5 * self._sides).all(axis=1)
        return np.where(inside, 1.0 / (self.length * self.width), 0.0)

    @property
    def _sides(self) -> FloatArray:
        return np.array([self.length, self.width])


@dataclass(frozen=True, slots=True)
class DiscConditional:
    """U(x; the disc of `radius` [m] about the relatum)."""

    radius: float
    standpoint: Standpoint

    def turning(self, heading: float, is_certain: bool) -> Turning | None:
        """Return the moments in the relatum's frame; a disc is the same in any."""
        return Turning(np.zeros(2), 0.25 * self.radius**2 * np.eye(2))

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance radius^2 / 4 I (P, 2, 2) of x."""
        positions = self.standpoint.relatum.positions(states)
        return positions, np.tile(0.25 * self.radius**2 * np.eye(2), (len(states), 1, 1))

    def sample(self, states: FloatArray, uniforms: FloatArray) -> FloatArray:
        """Return one draw (P, 2) from each state, made of uniform numbers (P, 3)."""
        r = self.radius * np.sqrt(uniforms[:, 0])
        theta = TURN * uniforms[:, 1]
        return np.asarray(self.standpoint.relatum.positions(states) + r[:, None] * unit(theta))

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""
        offsets = points - self.standpoint.relatum.positions(states)
        inside = np.hypot(*offsets.T) <= self.radius
        return np.where(inside, 1.0 / (np.pi * self.radius**2), 0.0)


def region_conditional(graph: RelationGraph, constraint: Constraint, standpoint: Standpoint) -> Conditional:
    """Return where in its relatum a referent lies, so that its own box does not stand out, as far as there is room.

    Each side is at least MIN_SIDE [m]; a relatum without a size is a disc of the graph's reach.
    """
    referent, relatum = (
        graph.classes[graph.class_of(name)] for name in (constraint.referent, constraint.relatum)
    )
    if relatum.width == 0.0 or relatum.depth == 0.0:
        return DiscConditional(graph.reach, standpoint)
    length = max(relatum.depth - referent.depth, MIN_SIDE)
    width = max(relatum.width - referent.width, MIN_SIDE)
    return BoxConditional(length, width, standpoint)
