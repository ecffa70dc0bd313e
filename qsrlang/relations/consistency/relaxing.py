"""The smallest changes that end a conflict: steps between conceptual neighbours; one atom less as the last resort."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, islice

from qsrlang.language.diagnostics import Edit
from qsrlang.language.source import Span
from qsrlang.language.syntax import Atom, Name
from qsrlang.relations.algebra import conceptual_neighbours
from qsrlang.relations.calculus import Relation
from qsrlang.relations.consistency.claims import Claim, Fact, Mention, Option
from qsrlang.relations.consistency.conflicts import Relaxation, is_plain, one_line
from qsrlang.relations.consistency.searching import Search, Undecided, only

MAX_RELAXATIONS = 3
MAX_TRIALS = 200
_BEFORE = re.compile(r"\s*(?:∧|&|\band\b)\s*\Z")
_AFTER = re.compile(r"\s*(?:∧|&|\band\b)\s*")
_STATEMENT = re.compile(r"(?:\A|[\s.}])(?P<keyword>observe|require)\s+\Z")
_END = re.compile(r"\s*\.")


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
    search: Search,
) -> tuple[Relaxation, ...]:
    """Return the best changes to one conflict of claims that have no other: fewest steps, last written first."""
    single, twice = _changes(conflict, relations)
    for changes in ([(one,) for one in single], [*((one,) for one in twice), *_pairs(single)]):
        ending = (one for one in changes[:MAX_TRIALS] if _ends(one, claims, search))
        found = tuple(_relaxation(one) for one in islice(ending, MAX_RELAXATIONS))
        if found:
            return found
    return _omissions(conflict, claims, search)


def _omissions(conflict: Sequence[Fact], claims: Sequence[Claim], search: Search) -> tuple[Relaxation, ...]:
    """Return the atoms to leave out: those that end the conflict alone, or all, without edits, if none does."""
    mentions = frozenset(fact.mention for claim in claims for fact in claim.facts)
    omitted = {one: _omission(atom) for one, atom in _atoms(conflict)}
    ending = (told for one, told in omitted.items() if _is_free(only(mentions - {one}, claims), search))
    found = tuple(islice(ending, MAX_RELAXATIONS))
    return found or tuple(replace(one, edits=()) for one in omitted.values())[:MAX_RELAXATIONS]


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


def _ends(changes: Sequence[_Change], claims: Sequence[Claim], search: Search) -> bool:
    changed = {one.mention: one for one in changes}
    return _is_free([_changed(claim, changed) for claim in claims], search)


def _is_free(claims: Iterable[Claim], search: Search) -> bool:
    """Return whether claims surely hold together."""
    try:
        return not search.clash(claims)
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


def _atoms(conflict: Sequence[Fact]) -> list[tuple[Mention, Atom]]:
    """Return the atoms of a conflict with their places, the last written first."""
    atoms = {fact.mention: fact.atom for fact in conflict}
    return [(mention, atoms[mention]) for mention in sorted(atoms, reverse=True)]


def _omission(atom: Atom) -> Relaxation:
    told = f"leave out '{one_line(atom)}'"
    return Relaxation(None, f"{atom.span}: {told}", told, _without(atom) if is_plain(atom) else ())


def _without(atom: Atom) -> tuple[Edit, ...]:
    """Return the edit that takes an atom out with a connective beside it, or with its statement; none if unclear."""
    text, span = atom.span.source.text, atom.span
    before, after = _BEFORE.search(text[: span.start]), _AFTER.match(text, span.end)
    statement, end = _STATEMENT.search(text[: span.start]), _END.match(text, span.end)
    if before:
        cut = Span(span.source, before.start(), span.end)
    elif after:
        cut = Span(span.source, span.start, after.end())
    elif statement and end:
        cut = Span(span.source, statement.start("keyword"), end.end())
    else:
        return ()
    line = text.rfind("\n", 0, cut.start) + 1
    return () if "#" in text[line : cut.end] else (Edit(cut, ""),)
