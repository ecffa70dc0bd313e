"""Relations of the ternary point calculus (Moratz, Nebel and Freksa 2003) as polar densities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from qsrlang.language.syntax import And, Atom, Density, Formula, Mix, Name, Not, Or

MAX_CONJUNCTIONS = 64


@dataclass(frozen=True, slots=True)
class Relation:
    """A relation: what it says of angle, distance and region, which relations it excludes, and how many it relates.

    A `region` is the part of the relatum that the referent lies in: "top" or "inside"; `components` is how many
    Gaussians stand for the density of one atom.
    """

    name: str
    angle: Density | None
    distance: Density | None
    converse: str | None = None
    disjoint: tuple[str, ...] = ()
    symmetric: bool = False
    region: str | None = None
    arity: int = 2
    components: int = 1

    def __hash__(self) -> int:
        return hash(self.name)

    @property
    def terms(self) -> tuple[tuple[float, Relation], ...]:
        """The relation as exclusive alternatives with shares: one for each part of a `mix` of angles."""
        if not isinstance(self.angle, Mix):
            return ((1.0, self),)
        return tuple((share, replace(self, angle=angle)) for share, angle in _parts(self.angle))


def _parts(angle: Density | None) -> tuple[tuple[float, Density | None], ...]:
    if not isinstance(angle, Mix):
        return ((1.0, angle),)
    share = 1.0 / len(angle.parts)
    return tuple((share * inner, part) for one in angle.parts for inner, part in _parts(one))


class TooManyConjunctions(Exception):
    """A formula whose disjunctive form exceeds MAX_CONJUNCTIONS."""


class NoOpposite(Exception):
    """A negated atom whose relation names no relations it excludes."""

    def __init__(self, atom: Atom) -> None:
        super().__init__(atom.relation.text)
        self.atom = atom


def conjunctions(formula: Formula, relations: Mapping[str, Relation]) -> tuple[tuple[Atom, ...], ...]:
    """Return the formula in disjunctive form: alternatives, each a conjunction of atoms.

    A negated atom is the disjunction of the relations its own excludes (they are jointly exhaustive).
    Raises TooManyConjunctions and NoOpposite.
    """
    return _expand(formula, relations, negated=False)


def _expand(
    formula: Formula, relations: Mapping[str, Relation], negated: bool
) -> tuple[tuple[Atom, ...], ...]:
    match formula:
        case Atom():
            return _opposites(formula, relations) if negated else ((formula,),)
        case Not(part=part):
            return _expand(part, relations, not negated)
        case And(parts=parts) | Or(parts=parts):
            expanded = [_expand(part, relations, negated) for part in parts]
            return _product(expanded) if isinstance(formula, And) != negated else _union(expanded)


def _opposites(atom: Atom, relations: Mapping[str, Relation]) -> tuple[tuple[Atom, ...], ...]:
    opposites = [one for one in relations[atom.relation.text].disjoint if one in relations]
    if not opposites:
        raise NoOpposite(atom)
    names = [Name(atom.relation.span, opposite) for opposite in opposites]
    return tuple((Atom(atom.span, name, atom.arguments, atom.frame),) for name in names)


def _union(parts: list[tuple[tuple[Atom, ...], ...]]) -> tuple[tuple[Atom, ...], ...]:
    return _bounded(tuple(conjunction for part in parts for conjunction in part))


def _product(parts: list[tuple[tuple[Atom, ...], ...]]) -> tuple[tuple[Atom, ...], ...]:
    product: tuple[tuple[Atom, ...], ...] = ((),)
    for part in parts:
        product = _bounded(tuple(left + right for left in product for right in part))
    return product


def _bounded(alternatives: tuple[tuple[Atom, ...], ...]) -> tuple[tuple[Atom, ...], ...]:
    if len(alternatives) > MAX_CONJUNCTIONS:
        raise TooManyConjunctions
    return alternatives
