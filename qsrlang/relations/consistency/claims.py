"""What knowledge claims: facts, and exclusive alternatives of facts of which one holds."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, replace
from typing import TypeAlias

from qsrlang.language.syntax import And, Atom, Formula, Frame
from qsrlang.relations.calculus import NoOpposite, Relation, TooManyConjunctions, conjunctions
from qsrlang.relations.consistency.frames import NO_FRAME, Axes, Axis
from qsrlang.relations.graph import Alternative, Authority, Choice, RelationGraph

Mention: TypeAlias = tuple[str, int, int]
_SLACK = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Fact:
    """An atom in one of its senses: one part of its relation's `mix`, what stands for its arguments, and its axis."""

    atom: Atom
    relation: Relation
    names: tuple[str, ...]
    axis: Axis

    @property
    def mention(self) -> Mention:
        """Where the atom is written: facts of one mention are senses of one atom."""
        span = self.atom.span
        return span.source.name, span.start, span.end


@dataclass(frozen=True, slots=True)
class Option:
    """Facts that hold together, and the share of this among the alternatives of its claim."""

    share: float
    facts: tuple[Fact, ...]

    @property
    def mentions(self) -> frozenset[Mention]:
        """Where its atoms are written."""
        return frozenset(fact.mention for fact in self.facts)


@dataclass(frozen=True, slots=True)
class Claim:
    """One of the options holds; shares below 1 leave the rest to `elsewhere`, which is an option without facts."""

    options: tuple[Option, ...]

    def keeping(self, mentions: Set[Mention]) -> Claim:
        """Return the claim without the facts that are written elsewhere."""
        return Claim(
            tuple(
                replace(one, facts=tuple(fact for fact in one.facts if fact.mention in mentions))
                for one in self.options
            )
        )

    @property
    def facts(self) -> Iterator[Fact]:
        """The facts of all options."""
        return (fact for option in self.options for fact in option.facts)


def claims_of(graph: RelationGraph) -> tuple[Claim, ...]:
    """Return what a graph claims: its choices, and its requirements that always hold.

    Soft requirements, and negations of relations without opposites, claim nothing that must hold.
    """
    reading = _Reading(graph, Axes.of(graph))
    required = (one.formula for one in graph.requirements if one.share is None)
    return (*reading.choices(), *(claim for formula in required for claim in reading.formula(formula)))


def facts_of(atoms: Iterable[Atom], relations: Mapping[str, Relation]) -> tuple[Fact, ...]:
    """Return the atoms of one formula as facts, of which nothing else is known."""
    found = []
    for atom in atoms:
        names = tuple(argument.text for argument in atom.arguments)
        relation = relations[atom.relation.text]
        own = names[1] if atom.frame is Frame.INTRINSIC else None
        axis = Axis((atom.frame, own), hand=1 if own is None else -1) if _turns(relation) else NO_FRAME
        found.append(Fact(atom, relation, names, axis))
    return tuple(found)


@dataclass(frozen=True, slots=True)
class _Reading:
    graph: RelationGraph
    axes: Axes

    def fact(self, atom: Atom, relation: Relation) -> Fact:
        names = tuple(self.axes.named(argument.text) for argument in atom.arguments)
        axis = self.axes.axis(names[1], atom.frame) if _turns(relation) else NO_FRAME
        return Fact(atom, relation, names, axis)

    def choices(self) -> Iterator[Claim]:
        """Yield a claim for each choice; those between the same scenes or observations are one."""
        alike: dict[object, list[Choice]] = {}
        for choice in self.graph.choices:
            key = tuple(tuple(map(id, one.constraints)) for one in choice.alternatives)
            alike.setdefault(key, []).append(choice)
        for choices in alike.values():
            governed = frozenset().union(*(choice.governs for choice in choices))
            yield self._claim(choices[0], governed)

    def formula(self, formula: Formula) -> Iterator[Claim]:
        """Yield what a formula claims, one claim for each part that must hold."""
        if isinstance(formula, And):
            for part in formula.parts:
                yield from self.formula(part)
            return
        try:
            disjuncts = conjunctions(formula, self.graph.relations)
        except (NoOpposite, TooManyConjunctions):
            return
        facts = (
            tuple(self.fact(atom, self.graph.relations[atom.relation.text]) for atom in disjunct)
            for disjunct in disjuncts
        )
        yield Claim(tuple(Option(1.0 / len(disjuncts), one) for one in facts))

    def _claim(self, choice: Choice, governed: Set[tuple[str, str]]) -> Claim:
        whole = choice.authority is Authority.SHARE
        options = [
            Option(one.share, tuple(self._facts(one, None if whole else governed)))
            for one in choice.alternatives
        ]
        rest = 1.0 - sum(option.share for option in options)
        return Claim((*options, Option(rest, ())) if rest > _SLACK else tuple(options))

    def _facts(self, alternative: Alternative, governed: Set[tuple[str, str]] | None) -> Iterator[Fact]:
        for constraint in alternative.constraints:
            if governed is None or self.graph.pair_of(constraint) in governed:
                for one in constraint.atoms:
                    if one.atom is not None:
                        fitted = constraint.fit is not None
                        relation = replace(one.relation, distance=None) if fitted else one.relation
                        yield self.fact(one.atom, relation)


def _turns(relation: Relation) -> bool:
    """Return whether a relation says nothing without a frame."""
    return relation.arity == 2 and relation.angle is not None
