"""The smallest changes that end a conflict: steps between conceptual neighbours; one atom less as the last resort."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, islice

from qsrlang.language.diagnostics import Edit
from qsrlang.language.syntax import Atom, Name
from qsrlang.relations.algebra import conceptual_neighbours
from qsrlang.relations.calculus import Relation
from qsrlang.relations.consistency.claims import Claim, Fact, Mention, Option
from qsrlang.relations.consistency.conflicts import Relaxation, is_plain, one_line
from qsrlang.relations.consistency.searching import Search, Theory, Undecided

MAX_RELAXATIONS = 3
MAX_TRIALS = 200


@dataclass(frozen=True, slots=True)
class _Change:
    """Another relation in the place of an atom's own, some steps away from it."""

    atom: Atom
    mention: Mention
    relation: Relation
    steps: int

    def __str__(self) -> str:
        arguments = ", ".join(argument.text for argument in self.atom.arguments)
        return f"'{self.relation.name}({arguments})' in place of '{self.atom.relation}'"

    @property
    def edit(self) -> Edit:
        return Edit(self.atom.relation.span, self.relation.name)


def relaxations(
    conflict: Sequence[Fact],
    claims: Sequence[Claim],
    relations: Mapping[str, Relation],
    placing: Theory | None,
) -> tuple[Relaxation, ...]:
    """Return the best changes to one conflict of claims that have no other: fewest steps, last written first."""
    single, twice = _changes(conflict, relations)
    for changes in ([(one,) for one in single], [*((one,) for one in twice), *_pairs(single)]):
        ending = (one for one in changes[:MAX_TRIALS] if _ends(one, claims, placing))
        found = tuple(_relaxation(one) for one in islice(ending, MAX_RELAXATIONS))
        if found:
            return found
    return tuple(Relaxation(None, f"leave out '{one_line(atom)}'") for atom in _atoms(conflict))


def _changes(
    conflict: Sequence[Fact], relations: Mapping[str, Relation]
) -> tuple[list[_Change], list[_Change]]:
    """Return the changes by one step, and those by two, to atoms that stand for themselves."""
    single, twice = list[_Change](), list[_Change]()
    for fact in _changeable(conflict):
        own = fact.relation
        near = [relations[name] for name in conceptual_neighbours(own) if name in relations]
        far = {name for one in near for name in conceptual_neighbours(one)} - {own.name}
        single += [_Change(fact.atom, fact.mention, one, 1) for one in near]
        twice += [_Change(fact.atom, fact.mention, relations[name], 2) for name in sorted(far)]
    return single, twice


def _changeable(conflict: Sequence[Fact]) -> Iterator[Fact]:
    senses: dict[Mention, list[Fact]] = {}
    for fact in conflict:
        senses.setdefault(fact.mention, []).append(fact)
    last_first = sorted(senses.values(), key=lambda group: group[0].mention, reverse=True)
    return (group[0] for group in last_first if len(group) == 1 and is_plain(group[0].atom))


def _pairs(single: Iterable[_Change]) -> Iterator[tuple[_Change, ...]]:
    pairs = combinations(single, 2)
    return (pair for pair in pairs if pair[0].mention != pair[1].mention)


def _ends(changes: Sequence[_Change], claims: Sequence[Claim], placing: Theory | None) -> bool:
    changed = {one.mention: one for one in changes}
    try:
        return not Search(placing).clash(_changed(claim, changed) for claim in claims)
    except Undecided:
        return False


def _changed(claim: Claim, changed: Mapping[Mention, _Change]) -> Claim:
    if not any(fact.mention in changed for fact in claim.facts):
        return claim
    return Claim(
        tuple(
            Option(one.share, tuple(_other(fact, changed.get(fact.mention)) for fact in one.facts))
            for one in claim.options
        )
    )


def _other(fact: Fact, change: _Change | None) -> Fact:
    if change is None:
        return fact
    name = Name(fact.atom.relation.span, change.relation.name)
    return replace(fact, atom=replace(fact.atom, relation=name), relation=change.relation)


def _relaxation(changes: Sequence[_Change]) -> Relaxation:
    told = [f"{one.atom.span}: {one}" for one in changes]
    short = " and ".join(str(one) for one in changes)
    return Relaxation(
        sum(one.steps for one in changes), " and ".join(told), short, tuple(c.edit for c in changes)
    )


def _atoms(conflict: Sequence[Fact]) -> Iterator[Atom]:
    atoms = {fact.mention: fact.atom for fact in conflict}
    return (atoms[mention] for mention in sorted(atoms, reverse=True))
