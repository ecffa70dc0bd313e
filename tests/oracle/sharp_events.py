"""In which draws a formula holds: relations as sharp regions, in the plainest words."""

from dataclasses import replace

import numpy as np
from drawn_worlds import table_of
from naive_worlds import carrier_of
from plain_geometry import along_axes, turned_back
from true_densities import axis, box_yaw, frame_of, region_room, sense, way

from qsrlang.language.syntax import And, Atom, Dimension, Normal, Not, Or, Uniform
from qsrlang.relations.graph import AtomicRelation, Constraint, Statement

CENTRAL_95 = 1.959963984540054


def holds(formula, scenes):
    match formula:
        case Not(part=part):
            return ~holds(part, scenes)
        case And(parts=parts):
            return np.all([holds(part, scenes) for part in parts], axis=0)
        case Or(parts=parts):
            return np.any([holds(part, scenes) for part in parts], axis=0)
        case Atom():
            return _atom_holds(formula, scenes)


def _atom_holds(atom, scenes):
    names = [argument.text for argument in atom.arguments]
    if any(name not in scenes.points for name in names):
        return np.zeros(scenes.count, dtype=bool)
    referent, relatum, *rest = names
    towards = rest[0] if rest else None
    relation = scenes.graph.relations[atom.relation.text]
    held = np.zeros(scenes.count, dtype=bool)
    for _, term in relation.terms:
        said = Constraint(
            referent, relatum, (AtomicRelation(term, atom.frame),), Statement.at(atom.span), None, towards
        )
        held |= _relation_holds(said, scenes)
        if towards is not None and relation.symmetric:
            held |= _relation_holds(replace(said, relatum=towards, towards=relatum), scenes)
    return held


def _relation_holds(said, scenes):
    relation = said.atoms[0].relation
    offsets = scenes.points[said.referent] - scenes.points[said.relatum]
    if relation.region is not None:
        return _inside(said, scenes, offsets)
    theta = np.arctan2(offsets[:, 1], offsets[:, 0])
    held = np.ones(scenes.count, dtype=bool)
    if relation.angle is not None:
        frame = frame_of(said, said.atoms[0])
        angles = turned_back(sense(frame) * (theta - axis(scenes, said, frame)))
        held &= _direction_holds(relation, angles, scenes.graph.relations)
    if isinstance(relation.distance, Uniform):
        held &= _distance_holds(said, scenes, theta, np.hypot(*offsets.T))
    return held


def _inside(said, scenes, offsets):
    """The relatum's outline holds that of the referent."""
    room = region_room(scenes, said)
    if room is None:
        return np.hypot(*offsets.T) <= scenes.graph.reach
    a, b = along_axes(offsets, box_yaw(scenes, said, said.relatum))
    return (np.abs(a) <= room[0]) & (np.abs(b) <= room[1])


def _direction_holds(relation, angles, relations):
    """No relation that it excludes is nearer, in deviations; without such ones, the central 95 %."""
    own = _deviations(relation.angle, angles)
    rivals = [term.angle for name in relation.disjoint for _, term in relations[name].terms if term.angle]
    if not rivals:
        return own <= CENTRAL_95
    nearest = np.min([_deviations(angle, angles) for angle in rivals], axis=0)
    return np.isfinite(own) & (own <= nearest)


def _deviations(angle, angles):
    if isinstance(angle, Normal):
        return np.abs(turned_back(angles - angle.mean.value)) / angle.deviation.value
    if isinstance(angle, Uniform):
        middle, half = 0.5 * (angle.low.value + angle.high.value), 0.5 * (angle.high.value - angle.low.value)
        return np.where(np.abs(turned_back(angles - middle)) <= half, 0.0, np.inf)
    return np.zeros_like(angles)


def _distance_holds(said, scenes, theta, lengths):
    """Between its bounds; below where it begins at contact; beyond where it ends at the edge of a support."""
    carrier = carrier_of(scenes.graph, said, (), scenes.roots)
    near, far = (bound[:, 0] for bound in way(scenes, said, table_of(scenes, carrier), theta[:, None]))
    distance = said.atoms[0].relation.distance
    from_contact = distance.low.value == 0.0
    share = distance.high.dimension is Dimension.FRACTION and said.towards is None
    to_edge = share and distance.high.value == 1.0
    return ((lengths >= near) | from_contact) & ((lengths <= far) | to_edge)
