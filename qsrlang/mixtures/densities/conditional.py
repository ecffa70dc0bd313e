"""What a constraint says of its referent, given the stacked state of everything placed before it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from scipy.special import ndtri

from qsrlang.arrays import FloatArray
from qsrlang.geometry.angles import unit
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.language.syntax import Fit, Frame
from qsrlang.mixtures.densities.angles import bump
from qsrlang.mixtures.densities.density import PolarDensity
from qsrlang.mixtures.densities.stance import Boxes, Stance, half_box
from qsrlang.mixtures.densities.standpoint import Standpoint
from qsrlang.mixtures.worlds.supports import Support
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import AtomicRelation, Constraint, RelationGraph


class Turning(NamedTuple):
    """Mean (2,) and covariance (2, 2) of x - relatum in a frame that turns with the relatum's heading, the same
    wherever it stands; where it is `fixed`, in the map frame, whatever that heading is.
    """

    mean: FloatArray
    covariance: FloatArray
    fixed: bool = False


class Conditional(Protocol):
    """p(x | state), for states (P, n): exact moments, draws and densities."""

    def turning(self, heading: float, is_certain: bool) -> Turning | None:
        """Return the moments in the relatum's frame; None where they depend on more than its heading.

        Where the heading [rad] is certain, axes that do not turn with it are still the same for every state.
        """

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance (P, 2, 2) of x."""

    def sample(self, states: FloatArray, uniforms: FloatArray) -> FloatArray:
        """Return one draw (P, 2) from each state, made of uniform numbers (P, 3)."""

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""


@dataclass(frozen=True, slots=True)
class PolarConditional:
    """A polar density about a relatum that the state places."""

    density: PolarDensity
    frames: tuple[Frame, ...]
    standpoint: Standpoint
    part: tuple[int, int] = (0, 1)

    def turning(self, heading: float, is_certain: bool) -> Turning | None:
        """Return the moments in the relatum's frame, unless they depend on a place: of a support, viewer or relatum."""
        if self._is_fixed:
            return _turning(self.density, (0.5 * np.pi,) * len(self.frames), self.part)._replace(fixed=True)
        axes = self._turning_axes(heading, is_certain)
        return None if axes is None else _turning(self.density, axes, self.part)

    @property
    def _is_fixed(self) -> bool:
        """Whether all axes are the map's, and no box turns with the relatum."""
        is_alone = self.standpoint.second is None and self.density.support is None
        return is_alone and self.density.boxes.are_points and set(self.frames) == {Frame.ABSOLUTE}

    def turns(self, heading: float, is_certain: bool) -> bool:
        """Return whether it is the same in the relatum's frame, wherever that is, as far as its heading is certain."""
        is_fixed = is_certain and self._is_fixed
        return is_fixed or self._turning_axes(heading, is_certain) is not None

    def _turning_axes(self, heading: float, is_certain: bool) -> tuple[float, ...] | None:
        if self.standpoint.second or self.density.support:
            return None
        stand = self.standpoint
        return stand.relatum.turning_axes(self.frames, stand.viewer, heading, is_certain)

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance (P, 2, 2) of x."""
        return self.density.moments(self.stance(states), self.part)

    def sample(self, states: FloatArray, uniforms: FloatArray) -> FloatArray:
        """Return one draw (P, 2) from each state, made of uniform numbers (P, 3)."""
        return self.density.sample(self.stance(states), uniforms)

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""
        return self.density.pdf(points, self.stance(states))

    def stance(self, states: FloatArray) -> Stance:
        """Return where the relatum stands in each state."""
        stand = self.standpoint
        axes = np.stack([stand.axes(states, frame) for frame in self.frames], axis=-1)
        support = None if stand.support is None else stand.support.poses(states)
        yaws = np.zeros(len(states)) if self.density.boxes.are_points else stand.box_yaws(states)
        return Stance(stand.relatum.positions(states), yaws, axes, support, stand.ends(states))


@dataclass(frozen=True, slots=True)
class FitConditional:
    """A metric fit: x = relatum + B m + noise B S B^T, B the axes of the atom's frame."""

    fit: Fit
    frame: Frame
    standpoint: Standpoint

    def turning(self, heading: float, is_certain: bool) -> Turning | None:
        """Return the moments in the relatum's frame, unless the axis depends on where the relatum is."""
        stand, fixed = self.standpoint, self.frame is Frame.ABSOLUTE
        axes = stand.relatum.turning_axes((self.frame,), stand.viewer, heading, is_certain)
        axes = (0.5 * np.pi,) if fixed else axes
        if axes is None or stand.second:
            return None
        basis = _bases(np.array(axes), self.frame)[0]
        return Turning(basis @ np.array(self.fit.mean), basis @ self._covariance() @ basis.T, fixed)

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance (P, 2, 2) of x."""
        basis = self._basis(states)
        positions = self.standpoint.relatum.positions(states)
        return positions + basis @ np.array(self.fit.mean), basis @ self._covariance() @ basis.transpose(
            0, 2, 1
        )

    def sample(self, states: FloatArray, uniforms: FloatArray) -> FloatArray:
        """Return one draw (P, 2) from each state, made of uniform numbers (P, 3)."""
        mean, _ = self.moments(states)
        noise = ndtri(uniforms[:, :2]) @ np.linalg.cholesky(self._covariance()).T
        return np.asarray(mean + np.einsum("pij,pj->pi", self._basis(states), noise))

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""
        mean, covariance = self.moments(states)
        off = points - mean
        squares = np.einsum("pi,pij,pj->p", off, np.linalg.inv(covariance), off)
        return np.asarray(np.exp(-0.5 * squares) / (2.0 * np.pi * np.sqrt(np.linalg.det(covariance))))

    def _basis(self, states: FloatArray) -> FloatArray:
        return _bases(self.standpoint.axes(states, self.frame), self.frame)

    def _covariance(self) -> FloatArray:
        (sx, sy), rho = self.fit.deviation, self.fit.correlation
        return np.array([[sx * sx, rho * sx * sy], [rho * sx * sy, sy * sy]])


@dataclass(frozen=True, slots=True)
class EitherConditional:
    """p(x | state) = (p_1(x | state) + p_2(x | state)) / 2; its moments are those of the whole, as one Gaussian."""

    first: Conditional
    second: Conditional

    def turning(self, heading: float, is_certain: bool) -> Turning | None:
        """Return None, for the way between two relata turns with both."""
        return None

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance (P, 2, 2) of x: E Q + Cov m (law of total variance)."""
        (m1, q1), (m2, q2) = self.first.moments(states), self.second.moments(states)
        half = 0.5 * (m1 - m2)
        return 0.5 * (m1 + m2), 0.5 * (q1 + q2) + half[:, :, None] * half[:, None, :]

    def sample(self, states: FloatArray, uniforms: FloatArray) -> FloatArray:
        """Return one draw (P, 2) from each state, made of uniform numbers (P, 3)."""
        draws = np.empty((len(states), 2))
        heads = uniforms[:, 0] < 0.5
        again = np.column_stack([2.0 * uniforms[:, 0] - ~heads, uniforms[:, 1:]])
        draws[heads] = self.first.sample(states[heads], again[heads])
        draws[~heads] = self.second.sample(states[~heads], again[~heads])
        return draws

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""
        return 0.5 * (self.first.pdf(points, states) + self.second.pdf(points, states))


@lru_cache(maxsize=1024)
def _turning(density: PolarDensity, axes: tuple[float, ...], part: tuple[int, int]) -> Turning:
    stance = Stance(np.zeros((1, 2)), np.zeros(1), np.array([axes]))
    (mean,), (covariance,) = density.moments(stance, part)
    for array in (mean, covariance):
        array.setflags(write=False)
    return Turning(mean, covariance)


def _bases(axes: FloatArray, frame: Frame) -> FloatArray:
    """Return the axes (P,) of a frame and their left as columns (P, 2, 2)."""
    return np.stack([unit(axes), hand(frame) * unit(axes + 0.5 * np.pi)], axis=-1)


def frame_of(constraint: Constraint, atom: AtomicRelation) -> Frame:
    """Return the frame of an atom; between two relata there is only the one that runs from relatum to relatum."""
    return atom.frame if constraint.towards is None else Frame.RELATIVE


def hand(frame: Frame) -> float:
    """Return +1 where a frame's angles grow counter-clockwise, -1 where its left is the object's own left."""
    return -1.0 if frame is Frame.INTRINSIC else 1.0


def polar_conditional(
    graph: RelationGraph, constraint: Constraint, standpoint: Standpoint, support: Support | None
) -> Conditional:
    """Return the product of a constraint's atoms as one polar density.

    A symmetric relation to two relata is the equal mixture of how it is seen from the one and from the other.
    """
    seen = PolarConditional(*polar_density(graph, constraint, support), standpoint, constraint.part)
    if constraint.towards is None or not constraint.atoms[0].relation.symmetric:
        return seen
    turned = replace(constraint, relatum=constraint.towards, towards=constraint.relatum)
    back = PolarConditional(*polar_density(graph, turned, support), standpoint.turned(), constraint.part)
    return EitherConditional(seen, back)


def polar_density(
    graph: RelationGraph, constraint: Constraint, support: Support | None
) -> tuple[PolarDensity, tuple[Frame, ...]]:
    """Return the product of a constraint's atoms as one polar density, with the frame of each angle factor."""
    relations = tuple([atom.relation for atom in constraint.atoms])
    frames = tuple([frame_of(constraint, atom) for atom in constraint.atoms])
    outline = None if support is None else support.outline
    boxes = _boxes(graph, constraint, support)
    return product_of(relations, frames, boxes, outline, graph.reach, constraint.statement.text)


def product_of(
    relations: tuple[Relation, ...],
    frames: tuple[Frame, ...],
    boxes: Boxes,
    outline: ConvexPolygon | None,
    reach: float,
    what: str,
) -> tuple[PolarDensity, tuple[Frame, ...]]:
    """Return the product of relations, each in its frame, as one polar density, with the frame of each angle factor.

    `what` names it in errors.
    """
    said = zip(relations, frames, strict=True)
    turning = [(relation.angle, frame) for relation, frame in said if relation.angle is not None]
    angles = tuple([bump(angle) for angle, _ in turning]) or (bump(None),)
    axes = tuple([frame for _, frame in turning]) or (Frame.RELATIVE,)
    distances = tuple([relation.distance for relation in relations if relation.distance is not None])
    hands = tuple([hand(frame) for frame in axes])
    return PolarDensity(angles, hands, distances, boxes, outline, reach, what), axes


def _boxes(graph: RelationGraph, constraint: Constraint, support: Support | None) -> Boxes:
    names = (constraint.referent, constraint.relatum, constraint.towards or constraint.relatum)
    referent, relatum, second = (half_box_of(graph, name) for name in names)
    return Boxes(referent, relatum, support is not None and support.is_relatum, second)


def half_box_of(graph: RelationGraph, name: str) -> tuple[float, float]:
    """Return (half length, half width) [m] of what a name stands for."""
    kind = graph.classes[graph.class_of(name)]
    return half_box(kind.width, kind.depth)
