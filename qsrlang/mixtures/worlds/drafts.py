"""Drafts of worlds: names are visited from a target on, and each opens what is still to be decided about it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from qsrlang.mixtures.worlds.chains import needed_for
from qsrlang.mixtures.worlds.evidence import constraints_on
from qsrlang.mixtures.worlds.roles import instances_in_roles, is_unplaced_role, landmarks_of_role
from qsrlang.relations.graph import Alternative, Authority, Choice, Constraint, Landmark, Pair, RelationGraph

MIN_SHARE = 1e-9

Outcome: TypeAlias = Landmark | Alternative | Choice | Constraint | str | None
Decision: TypeAlias = tuple[float, "Callable[[Draft], None]", Outcome]


@dataclass(slots=True)
class Draft:
    """A world in the making: what is decided, what it weighs, and the names that are still to be visited.

    `likeness` is the product of share / greatest share over the `depth` decisions made. `decided` are their shares and
    outcomes: a landmark, an alternative, a choice that leaves its referent elsewhere, a part of a constraint, a role.
    """

    pending: deque[str]
    telling: tuple[str, ...] = ()
    weight: float = 1.0
    likeness: float = 1.0
    depth: int = 0
    visited: set[str] = field(default_factory=set)
    covered: set[Pair] = field(default_factory=set)
    closed: set[int] = field(default_factory=set)
    decided: list[tuple[float, Outcome]] = field(default_factory=list)
    heard: set[int] = field(default_factory=set)
    constraints: list[Constraint] = field(default_factory=list)
    relata: dict[str, tuple[str, ...]] = field(default_factory=dict)
    whole: list[int] = field(default_factory=list)
    bindings: dict[str, Landmark] = field(default_factory=dict)
    aliases: dict[str, str] = field(default_factory=dict)
    absent: list[str] = field(default_factory=list)

    @classmethod
    def start(cls, targets: Iterable[str], telling: tuple[str, ...]) -> Draft:
        """Return the draft in which nothing is decided; `telling` things are visited after the targets."""
        return cls(deque(targets), telling)

    def branches(self, graph: RelationGraph, in_parts: bool) -> list[Draft] | None:
        """Return the drafts that the next open decision leads to, or None where all is decided."""
        while True:
            decisions = self._next_decisions(graph, in_parts)
            if decisions is None:
                return None
            if len(decisions) != 1:
                return [self._after(decision, decisions) for decision in decisions]
            self._decide(decisions[0])

    def _next_decisions(self, graph: RelationGraph, in_parts: bool) -> Sequence[Decision] | None:
        while in_parts and self.whole:
            return _parts(self.whole.pop(), self.constraints)
        while self.pending:
            name = self.pending[0]
            if name in self.visited:
                self.pending.popleft()
                continue
            decisions = self._decisions_on(graph, name)
            if decisions is not None:
                return decisions
            self.pending.popleft()
            self.visited.add(name)
            self.pending += dict.fromkeys(self.relata.get(name, ()))
        return self._told(graph)

    def _decisions_on(self, graph: RelationGraph, name: str) -> Sequence[Decision] | None:
        instances = graph.instances_of(name)
        if instances:
            return _bindings(name, [(1.0 / len(instances), landmark) for landmark in instances])
        if is_unplaced_role(graph, name):
            return _bindings(name, self._landmarks_of_role(graph, name))
        candidates = self._candidates(graph, name)
        if candidates:
            return [(1.0 / len(candidates), _stand_in(name, one), one) for one in candidates]
        choice = self._open_choice(graph, name)
        return None if choice is None else self._alternatives(graph, choice)

    def _told(self, graph: RelationGraph) -> Sequence[Decision] | None:
        """Return what is to be decided about the next thing that tells of the targets, or None."""
        for name in self.telling:
            if name not in self.visited:
                return [(1.0, _visit((name,)), None)]
            for choice in graph.choices_for(graph.node_of(name)) if name in self.bindings else ():
                if id(choice) in self.heard or not any(constraints_on(graph, choice, name)):
                    continue
                self.heard.add(id(choice))
                if any(graph.pair_of(one) not in self.covered for one in constraints_on(graph, choice, name)):
                    return self._alternatives(graph, choice)
                return [(1.0, _visit(self.relata.get(name, ())), None)]
        return None

    def _landmarks_of_role(
        self, graph: RelationGraph, role: str
    ) -> tuple[tuple[float, Landmark | None], ...]:
        kind = graph.roles[role]
        named = {role, *(one for c in self.constraints for one in (c.referent, *c.relata))}
        alike = {one for one in named if graph.roles.get(one) == kind and is_unplaced_role(graph, one)}
        taken = {landmark.name for name, landmark in self.bindings.items() if name in alike}
        return landmarks_of_role(graph, role, taken, len(alike - self.visited))

    def _candidates(self, graph: RelationGraph, name: str) -> tuple[str, ...]:
        """Return what a class may be, if that is open: one of its roles, or itself."""
        if not graph.roles or name in self.aliases or name in self.relata:
            return ()
        candidates = instances_in_roles(graph, name)
        return tuple(one for one in candidates if one == name or not self._differ(one, name))

    def _differ(self, role: str, name: str) -> bool:
        """Return whether a role is not what a name stands for: one constraint names both, or the role depends on it."""
        if any({role, name} <= {one.referent, *one.relata} for one in self.constraints):
            return True
        return name in needed_for((role,), self.constraints)

    def _open_choice(self, graph: RelationGraph, name: str) -> Choice | None:
        for choice in graph.choices_for(name):
            if id(choice) in self.closed:
                continue
            for pair in choice.governs:
                if pair[0] == name and pair not in self.covered:
                    return choice
        return None

    def _alternatives(self, graph: RelationGraph, choice: Choice) -> list[Decision]:
        alternatives = self._compatible(graph, choice)
        rest = 1.0 - sum([alternative.share for alternative in alternatives])
        decisions: list[Decision] = [(rest, _elsewhere(choice), choice)] if rest > MIN_SHARE else []
        return [*decisions, *[(one.share, _take(graph, choice, one), one) for one in alternatives]]

    def _compatible(self, graph: RelationGraph, choice: Choice) -> tuple[Alternative, ...]:
        """Return the alternatives; scenes that were already passed over for another are left out if any remain."""
        if choice.authority is not Authority.SCENE:
            return tuple([one for one in choice.alternatives if one.share > 0.0])
        free = [
            one
            for one in choice.alternatives
            if not any(graph.pair_of(c) in self.covered for c in one.constraints)
        ]
        kept = free or list(choice.alternatives)
        total = sum(alternative.share for alternative in kept)
        return tuple(Alternative(alternative.share / total, alternative.constraints) for alternative in kept)

    def add(self, constraint: Constraint) -> None:
        """Take in a constraint; where its referent is visited already, its relata are to be."""
        if constraint.parts > 1:
            self.whole.append(len(self.constraints))
        self.constraints.append(constraint)
        referent = constraint.referent
        self.relata[referent] = (*self.relata.get(referent, ()), *constraint.relata)
        if referent in self.visited:
            self.pending += constraint.relata

    def _decide(self, decision: Decision) -> None:
        share, act, outcome = decision
        self.weight *= share
        if outcome is not None:
            self.decided.append((share, outcome))
        act(self)

    def _after(self, decision: Decision, among: Sequence[Decision]) -> Draft:
        draft = Draft(
            self.pending.copy(),
            self.telling,
            self.weight,
            self.likeness * decision[0] / max(share for share, *_ in among),
            self.depth + 1,
            self.visited.copy(),
            self.covered.copy(),
            self.closed.copy(),
            self.decided.copy(),
            self.heard.copy(),
            self.constraints.copy(),
            self.relata.copy(),
            self.whole.copy(),
            self.bindings.copy(),
            self.aliases.copy(),
            self.absent.copy(),
        )
        draft._decide(decision)
        return draft


def _visit(names: Sequence[str]) -> Callable[[Draft], None]:
    return lambda draft: draft.pending.extend(names)


def _bindings(name: str, instances: Iterable[tuple[float, Landmark | None]]) -> list[Decision]:
    def bind(landmark: Landmark | None) -> Callable[[Draft], None]:
        def act(draft: Draft) -> None:
            draft.pending.popleft()
            draft.visited.add(name)
            if landmark is not None:
                draft.bindings[name] = landmark

        return act

    return [(share, bind(landmark), landmark) for share, landmark in instances]


def _stand_in(name: str, candidate: str) -> Callable[[Draft], None]:
    def act(draft: Draft) -> None:
        draft.aliases[name] = candidate
        draft.pending[0] = candidate
        if candidate != name:
            draft.visited.add(name)

    return act


def _take(graph: RelationGraph, choice: Choice, alternative: Alternative) -> Callable[[Draft], None]:
    def act(draft: Draft) -> None:
        spoken = [(graph.pair_of(constraint), constraint) for constraint in alternative.constraints]
        for pair, constraint in spoken:
            if pair not in draft.covered:
                draft.add(constraint)
        draft.covered.update([pair for pair, _ in spoken])
        draft.closed.add(id(choice))

    return act


def _elsewhere(choice: Choice) -> Callable[[Draft], None]:
    """What a choice speaks of is somewhere that no statement names; what is seen is where it is seen."""

    def act(draft: Draft) -> None:
        draft.absent += sorted({referent for referent, _ in choice.governs} - draft.bindings.keys())
        draft.covered |= choice.governs
        draft.closed.add(id(choice))

    return act


def _parts(at: int, constraints: Sequence[Constraint]) -> list[Decision]:
    """Return the parts of equal mass that a constraint is split into."""
    count = constraints[at].parts

    def take(number: int) -> Callable[[Draft], None]:
        def act(draft: Draft) -> None:
            draft.constraints[at] = replace(draft.constraints[at], part=(number, count))

        return act

    return [
        (1.0 / count, take(number), replace(constraints[at], part=(number, count))) for number in range(count)
    ]
