"""Rules about frames of reference: atoms that mean one thing to a viewer and another by the front of their relatum."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator

from qsrlang.language.diagnostics import Diagnostic, Edit, Label
from qsrlang.language.source import Span
from qsrlang.language.syntax import Atom, Normal, Uniform, atoms_of
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import Landmark
from qsrlang.relations.linting.linted import Linted, warning

TURN = 2.0 * math.pi
DISAGREEMENT = 0.25 * math.pi
_DECIMALS = 9
_SLACK = 1e-9


def ambiguous_frames(linted: Linted) -> Iterator[Diagnostic]:
    """Atoms without `wrt` that mean something else by the front of their relatum than as seen by some viewer.

    Where both the viewer and the relatum stand at known places, what they mean is known too.
    """
    for _, formula in linted.formulas():
        for atom in atoms_of(formula):
            kind = _kind_with_a_front(atom, linted)
            mirrored = kind is None or _is_mirrored(linted.symbols.relations[atom.relation.text])
            if kind is not None and not mirrored and not _seen(atom, linted):
                yield _ambiguous(atom, kind, linted)


def _kind_with_a_front(atom: Atom, linted: Linted) -> str | None:
    """Return the class of the relatum of an atom without `wrt`, if it has a front."""
    symbols = linted.symbols
    relation = symbols.relations.get(atom.relation.text)
    if atom.framed or relation is None or not len(atom.arguments) == relation.arity == 2:
        return None
    relatum = atom.arguments[1].text
    kind = symbols.classes.get(symbols.class_of(symbols.roles.get(relatum, relatum)))
    return kind.name if kind and kind.front and relation.angle is not None else None


def _ambiguous(atom: Atom, kind: str, linted: Linted) -> Diagnostic:
    declared = linted.symbols.places.get(("class", kind))
    labels = (Label(declared.span, "declared here with its front"),) if declared else ()
    return warning(
        "Q507",
        f"'{atom.relation}' is ambiguous, for '{kind}' has a front",
        atom.span,
        "without 'wrt' it is as the viewer sees it",
        f"write 'wrt relative' for that, or 'wrt intrinsic' for the {kind}'s own side",
        labels=labels,
        edits=(Edit(Span(linted.source, atom.span.end, atom.span.end), " wrt relative"),),
    )


def disagreeing_frames(linted: Linted) -> Iterator[Diagnostic]:
    """Atoms without `wrt` whose side, as the viewer sees it, is over 45 deg off that by the front of their relatum."""
    for _, formula in linted.formulas():
        for atom in atoms_of(formula):
            kind = _kind_with_a_front(atom, linted)
            if kind is None:
                continue
            relation = linted.symbols.relations[atom.relation.text]
            seen = [(_disagreement(relation, one, linted), one) for one in _seen(atom, linted)]
            off, landmark = max(seen, key=lambda one: one[0], default=(0.0, None))
            if landmark is not None and off > DISAGREEMENT + _SLACK:
                yield _disagreeing(atom, kind, landmark, off, linted)


def _seen(atom: Atom, linted: Linted) -> list[Landmark]:
    """Return the landmarks with a heading that the relatum of an atom may be, if a viewer looks at them."""
    if linted.viewer is None:
        return []
    named = atom.arguments[1].text
    return [
        one
        for one in linted.landmarks
        if named in (one.name, one.kind) and one.heading is not None and (one.x, one.y) != linted.viewer
    ]


def _disagreement(relation: Relation, landmark: Landmark, linted: Linted) -> float:
    """Return how far the two readings are apart [rad]: of several parts, the one furthest from all of the other's."""
    relative, intrinsic = _readings(relation, landmark, linted)
    return max((min(abs(_wrapped(one - other)) for other in intrinsic) for one in relative), default=0.0)


def _readings(relation: Relation, landmark: Landmark, linted: Linted) -> tuple[list[float], list[float]]:
    """Return where on the map a relation points as the viewer sees it, and by the front of a landmark [rad]."""
    assert linted.viewer is not None and landmark.heading is not None
    seen = math.atan2(landmark.y - linted.viewer[1], landmark.x - linted.viewer[0])
    own = landmark.heading + math.pi
    sides = [side for _, term in relation.terms for side in _sides(term)]
    return [seen + side for side in sides], [own - side for side in sides]


def _sides(term: Relation) -> Iterator[float]:
    match term.angle:
        case Normal(mean=mean):
            yield mean.value
        case Uniform(low=low, high=high) if high.value - low.value < TURN:
            yield 0.5 * (low.value + high.value)


def _disagreeing(atom: Atom, kind: str, landmark: Landmark, off: float, linted: Linted) -> Diagnostic:
    relation = linted.symbols.relations[atom.relation.text]
    (seen, *_), (own, *_) = _readings(relation, landmark, linted)
    place = linted.symbols.places.get(("landmark", landmark.name))
    labels = (Label(place.span, "it stands here"),) if place else ()
    return warning(
        "Q514",
        f"'{atom.relation}' of '{landmark.name}' is {math.degrees(off):.0f} deg off what it is by its own front",
        atom.span,
        f"for the viewer at {_bearing(seen)}, by its front at {_bearing(own)} on the map",
        f"write 'wrt relative' for the viewer's side, or 'wrt intrinsic' for the {kind}'s own",
        labels=labels,
        edits=(Edit(Span(linted.source, atom.span.end, atom.span.end), " wrt relative"),),
    )


def _bearing(angle: float) -> str:
    return f"{round(math.degrees(_wrapped(angle))) + 0} deg"


def _wrapped(angle: float) -> float:
    return math.remainder(angle, TURN)


def _is_mirrored(relation: Relation) -> bool:
    """Whether a relation means the same with left and right swapped."""
    shares: dict[tuple[float, float], float] = defaultdict(float)
    mirrored: dict[tuple[float, float], float] = defaultdict(float)
    for share, term in relation.terms:
        match term.angle:
            case Normal(mean=mean, deviation=deviation):
                shares[_turned(mean.value), deviation.value] += share
                mirrored[_turned(-mean.value), deviation.value] += share
            case Uniform(low=low, high=high) if high.value - low.value < TURN:
                middle, width = (low.value + high.value) / 2.0, high.value - low.value
                shares[_turned(middle), width] += share
                mirrored[_turned(-middle), width] += share
    return shares.keys() == mirrored.keys() and all(
        abs(shares[key] - mirrored[key]) < _SLACK for key in shares
    )


def _turned(angle: float) -> float:
    """Return an angle within one turn, rounded so that equal angles are equal."""
    return round(round(angle / TURN, _DECIMALS) % 1.0, _DECIMALS)
