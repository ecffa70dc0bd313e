"""What a constraint says of its referent, given the stacked state of everything placed before it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import MissingFacingError
from qsrlang.geometry.angles import unit
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Fit, Frame
from qsrlang.mixtures.angles import bump
from qsrlang.mixtures.density import Boxes, PolarDensity, Stance, half_box
from qsrlang.relations.graph import Constraint, Landmark, ObjectClass, RelationGraph


class Conditional(Protocol):
    """p(x | state), for states (P, n): exact moments, draws and densities."""

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance (P, 2, 2) of x."""

    def sample(self, states: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Return one draw (P, 2) from each state."""

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""


@dataclass(frozen=True, slots=True)
class Standpoint:
    """Where axes and boxes come from: blocks of relatum, root landmark and support in the state, and the viewer."""

    relatum: slice
    root: slice
    support: slice | None
    own_heading: bool
    root_has_heading: bool
    root_name: str
    viewer: Pose2 | None

    def axes(self, states: FloatArray, frame: Frame) -> FloatArray:
        """Return the reference axis (P,) of a frame [rad]: away from the viewer; along +y where it is absolute."""
        if frame is Frame.ABSOLUTE:
            return np.full(len(states), 0.5 * np.pi)
        if frame is Frame.INTRINSIC and self.own_heading:
            return states[:, self.relatum][:, 2] + np.pi
        if frame is Frame.RELATIVE and self.viewer is not None:
            sight = states[:, self.relatum][:, :2] - self.viewer.position
            return np.asarray(np.arctan2(sight[:, 1], sight[:, 0]))
        if not self.root_has_heading:
            raise MissingFacingError(self.root_name, f"the {frame.value} frame (no viewer is given)")
        return states[:, self.root][:, 2] + np.pi

    def box_yaws(self, states: FloatArray) -> FloatArray:
        """Return the heading (P,) of the boxes: the relatum's own, else the root's, else towards the viewer."""
        if self.own_heading:
            return states[:, self.relatum][:, 2]
        if self.root_has_heading:
            return states[:, self.root][:, 2]
        return self.axes(states, Frame.RELATIVE) + np.pi


@dataclass(frozen=True, slots=True)
class PolarConditional:
    """A polar density about a relatum that the state places."""

    density: PolarDensity
    frames: tuple[Frame, ...]
    standpoint: Standpoint

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance (P, 2, 2) of x."""
        return self.density.moments(self._stance(states))

    def sample(self, states: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Return one draw (P, 2) from each state."""
        return self.density.sample(self._stance(states), rng)

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""
        return self.density.pdf(points, self._stance(states))

    def _stance(self, states: FloatArray) -> Stance:
        axes = np.stack([self.standpoint.axes(states, frame) for frame in self.frames], axis=-1)
        support = None if self.standpoint.support is None else states[:, self.standpoint.support]
        return Stance(
            states[:, self.standpoint.relatum][:, :2], self.standpoint.box_yaws(states), axes, support
        )


@dataclass(frozen=True, slots=True)
class FitConditional:
    """A metric fit: x = relatum + B m + noise B S B^T, B the axes of the atom's frame."""

    fit: Fit
    frame: Frame
    standpoint: Standpoint

    def moments(self, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (P, 2) and covariance (P, 2, 2) of x."""
        basis = self._basis(states)
        positions = states[:, self.standpoint.relatum][:, :2]
        return positions + basis @ np.array(self.fit.mean), basis @ self._covariance() @ basis.transpose(
            0, 2, 1
        )

    def sample(self, states: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Return one draw (P, 2) from each state."""
        mean, _ = self.moments(states)
        noise = rng.standard_normal((len(states), 2)) @ np.linalg.cholesky(self._covariance()).T
        return np.asarray(mean + np.einsum("pij,pj->pi", self._basis(states), noise))

    def pdf(self, points: FloatArray, states: FloatArray) -> FloatArray:
        """Return the density (P,) of one point (P, 2) per state [1/m^2]."""
        mean, covariance = self.moments(states)
        off = points - mean
        squares = np.einsum("pi,pij,pj->p", off, np.linalg.inv(covariance), off)
        return np.asarray(np.exp(-0.5 * squares) / (2.0 * np.pi * np.sqrt(np.linalg.det(covariance))))

    def _basis(self, states: FloatArray) -> FloatArray:
        axis = self.standpoint.axes(states, self.frame)
        return np.stack([unit(axis), hand(self.frame) * unit(axis + 0.5 * np.pi)], axis=-1)

    def _covariance(self) -> FloatArray:
        (sx, sy), rho = self.fit.deviation, self.fit.correlation
        return np.array([[sx * sx, rho * sx * sy], [rho * sx * sy, sy * sy]])


def hand(frame: Frame) -> float:
    """Return +1 where a frame's angles grow counter-clockwise, -1 where its left is the object's own left."""
    return -1.0 if frame is Frame.INTRINSIC else 1.0


def polar_density(
    graph: RelationGraph, constraint: Constraint, support: Landmark | None
) -> tuple[PolarDensity, tuple[Frame, ...]]:
    """Return the product of a constraint's atoms as one polar density, with the frame of each angle factor."""
    turning = [atom for atom in constraint.atoms if atom.relation.angle is not None]
    frames = tuple(atom.frame for atom in turning) or (Frame.RELATIVE,)
    angles = tuple(bump(atom.relation.angle) for atom in turning) or (bump(None),)
    distances = tuple(a.relation.distance for a in constraint.atoms if a.relation.distance is not None)
    referent, relatum = (
        graph.classes[graph.class_of(name)] for name in (constraint.referent, constraint.relatum)
    )
    on_relatum = support is not None and constraint.relatum in (support.name, support.kind)
    boxes = Boxes(
        half_box(referent.width, referent.depth), half_box(relatum.width, relatum.depth), on_relatum
    )
    outline = None if support is None else outline_of(graph.classes[support.kind])
    hands = tuple(hand(frame) for frame in frames)
    what = constraint.statement.text
    return PolarDensity(angles, hands, distances, boxes, outline, graph.reach, what), frames


def outline_of(surface: ObjectClass) -> ConvexPolygon:
    """Return the outline of a surface in its own frame."""
    return ConvexPolygon.rectangle(Pose2(0.0, 0.0), surface.depth, surface.width)


def support_of(graph: RelationGraph, constraint: Constraint, root: Landmark) -> Landmark | None:
    """Return the surface that carries the referent: of the class it stands `on`, under the root landmark."""
    classes = [graph.classes[graph.class_of(name)] for name in (constraint.referent, constraint.relatum)]
    wanted = classes[0].on or classes[1].on
    if wanted is None or graph.classes[wanted].width == 0.0:
        return None
    for landmark in graph.instances_of(wanted):
        if landmark.name == root.name or _carries(graph, landmark, root):
            return landmark
    return None


def _carries(graph: RelationGraph, surface: Landmark, root: Landmark) -> bool:
    if surface.heading is None:
        raise MissingFacingError(surface.name, "the outline of a support")
    pose = Pose2(surface.x, surface.y, surface.heading)
    inside = outline_of(graph.classes[surface.kind]).contains(pose.transform_inverse([root.x, root.y]))
    return bool(inside)
