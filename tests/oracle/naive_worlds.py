"""Every combination of alternatives and of landmarks, by itertools.product; nothing is cut and nothing is clever.

All that is known takes part, whatever is asked: what does not matter must cancel out by itself.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from plain_geometry import along_axes
from true_densities import is_region

from qsrlang.relations.graph import Authority

NOTHING = 1e-9


@dataclass(frozen=True)
class NaiveWorld:
    """Constraints that hold together, which landmark each name stands for, and the product of the shares."""

    share: float
    constraints: tuple
    landmarks: tuple


def naive_worlds(graph, names):
    """Every world of all that is known, with a landmark for each of the names asked about that landmarks stand for."""
    for choice in graph.choices:
        assert choice.authority is not Authority.SCENE or len(choice.alternatives) == 1, "several scenes"
    found = {}
    for picks in product(*(_options(choice) for choice in graph.choices)):
        share = float(np.prod([one for one, _, _ in picks]))
        for more, world in _bound(graph, names, picks):
            found[world] = found.get(world, 0.0) + share * more
    return [NaiveWorld(share, *world) for world, share in found.items() if share > 0.0]


def _options(choice):
    """(share, constraints, objects that are elsewhere) of each alternative, and of what the shares leave."""
    options = [(one.share, one.constraints, ()) for one in choice.alternatives]
    rest = 1.0 - sum(share for share, _, _ in options)
    absent = tuple(sorted({referent for referent, _ in choice.governs}))
    return [*options, (rest, (), absent)] if rest > NOTHING else options


def _bound(graph, names, picks):
    """Each way in which landmarks may stand for the names that are spoken of, with its share; what is seen is there."""
    absent = {name for _, _, gone in picks for name in gone if not graph.instances_of(name)}
    said = {c: None for _, constraints, _ in picks for c in constraints if c.referent not in absent}
    constraints = tuple(sorted(said, key=_order))
    spoken = {*names, *(name for c in constraints for name in (c.referent, *c.relata))}
    known = sorted(name for name in spoken if graph.instances_of(name))
    for landmarks in product(*(graph.instances_of(name) for name in known)):
        share = float(np.prod([1.0 / len(graph.instances_of(name)) for name in known]))
        yield share, (constraints, tuple(zip(known, landmarks, strict=True)))


def _order(constraint):
    return constraint.referent, constraint.relata, constraint.statement.text


@dataclass(frozen=True)
class Carrier:
    """What carries a referent and so ends its way: the name it is drawn under, its class, whether it is the relatum."""

    name: str
    kind: str
    is_relatum: bool


@dataclass(frozen=True)
class Placing:
    """A constraint as it is used: whether it places its referent or only speaks of it, and what carries that."""

    constraint: object
    places: bool
    carrier: Carrier | None


def order_of_placing(graph, world):
    """The constraints in an order in which their relata are placed before them, and the root landmark of each name."""
    roots = dict(world.landmarks)
    waiting, placings = list(world.constraints), []
    while ready := [one for one in waiting if all(name in roots for name in one.relata)]:
        constraint = min(ready, key=lambda one: (_late(one, waiting), _order(one)))
        waiting.remove(constraint)
        if _says_nothing_more(constraint, placings, roots):
            continue
        carrier = carrier_of(graph, constraint, world.constraints, roots)
        placings.append(Placing(constraint, constraint.referent not in roots, carrier))
        roots.setdefault(constraint.referent, roots[constraint.relatum])
    return placings, roots


def _late(constraint, waiting):
    """Regions wait for what else is said of their referent."""
    if not is_region(constraint):
        return 0
    return 1 + any(one.referent == constraint.referent and not is_region(one) for one in waiting)


def _says_nothing_more(constraint, placings, roots):
    """Whether a region only repeats what bounds the way of another constraint on its referent."""
    name = drawn_as(constraint.relatum, roots)
    placed = [one for one in placings if one.constraint.referent == constraint.referent and one.carrier]
    return is_region(constraint) and any(one.carrier.name == name for one in placed)


def drawn_as(name, roots):
    """A class that a landmark stands for is drawn as that landmark; everything else as itself."""
    return roots[name].name if _is_landmark(name, roots) else name


def _is_landmark(name, roots):
    return name in (roots[name].name, roots[name].kind)


def carrier_of(graph, constraint, others, roots):
    """What carries the referent: what it is said to be on or in, else the surface its class stands on; or None."""
    if constraint.towards is not None or is_region(constraint):
        return None
    stated = _stated(graph, constraint, others, roots)
    return stated or _usual(graph, constraint, roots[constraint.relatum])


def _stated(graph, constraint, others, roots):
    pairs = [(one.referent, one.relatum) for one in others if is_region(one)]
    for referent, name in pairs:
        if referent != constraint.referent or name not in roots:
            continue
        kind = graph.classes[graph.class_of(name)]
        if kind.width == 0.0 or roots[name].heading is None:
            continue
        is_relatum = name == constraint.relatum
        on_it = _is_landmark(name, roots) and _stands_on(graph, roots[name], roots[constraint.relatum])
        if is_relatum or (constraint.relatum, name) in pairs or on_it:
            return Carrier(drawn_as(name, roots), kind.name, is_relatum)
    return None


def _usual(graph, constraint, root):
    kinds = [graph.classes[graph.class_of(name)] for name in (constraint.referent, constraint.relatum)]
    wanted = kinds[0].on or kinds[1].on
    if wanted is None or graph.classes[wanted].width == 0.0:
        return None
    for landmark in graph.instances_of(wanted):
        if _stands_on(graph, landmark, root):
            is_relatum = constraint.relatum in (landmark.name, landmark.kind)
            return Carrier(landmark.name, landmark.kind, is_relatum)
    return None


def _stands_on(graph, surface, root):
    if surface.name == root.name:
        return True
    kind = graph.classes[surface.kind]
    x, y = along_axes(np.array([root.x - surface.x, root.y - surface.y]), surface.heading)
    return bool(abs(x) <= 0.5 * kind.depth and abs(y) <= 0.5 * kind.width)
