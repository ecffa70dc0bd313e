"""Whether some choice of options is free of contradiction, and the fewest atoms that keep it from being so."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence, Set
from dataclasses import dataclass
from typing import TypeAlias

from qsrlang.relations.consistency.claims import Claim, Fact, Mention
from qsrlang.relations.consistency.orders import contradiction, entangled, some_contradiction

MAX_EFFORT = 150_000
PLACEMENT = 200
MAX_UNSETTLED = 200

Theory: TypeAlias = Callable[[Sequence[Fact]], Sequence[Fact]]
"""Returns facts of a conjunction that contradict each other, or nothing."""


class Undecided(Exception):
    """More effort, or more than MAX_UNSETTLED claims with alternatives, would have to be tried."""


@dataclass(slots=True)
class Effort:
    """How many facts may still be judged, each as often as it is; a placement counts as many."""

    left: int = MAX_EFFORT

    def spend(self, facts: int) -> None:
        """Judge some facts; raises Undecided where that is too many."""
        self.left -= facts
        if self.left < 0:
            raise Undecided


@dataclass(frozen=True, slots=True)
class Search:
    """A search by the orders of directions, and then, if it finds nothing, by a theory of places too."""

    effort: Effort
    placing: Theory | None = None

    def clash(self, claims: Iterable[Claim]) -> frozenset[Mention]:
        """Return atoms that keep the claims from holding together, or nothing; raises Undecided."""
        claims = tuple(claims)
        self.effort.spend(sum(len(option.facts) for claim in claims for option in claim.options))
        found = self._branch(relevant(claims), some_contradiction)
        if found or self.placing is None:
            return found
        return self._branch(claims, self.placing)

    def minimal(self, core: Set[Mention], claims: Sequence[Claim]) -> frozenset[Mention]:
        """Return a part of a clash each of whose atoms is needed for it (deletion filtering).

        Where what is certain contradicts itself without numbers, that is the shortest of its circles.
        """
        kept = frozenset(fact.mention for fact in contradiction(_certain(claims))) or frozenset(core)
        for mention in sorted(kept, reverse=True):
            if mention in kept:
                smaller = self.clash(only(kept - {mention}, claims))
                kept = smaller or kept
        return kept

    def _branch(self, claims: Sequence[Claim], last: Theory) -> frozenset[Mention]:
        bound = [claim for claim in claims if all(option.facts for option in claim.options)]
        certain = _certain(bound)
        unsettled = sorted((one for one in bound if len(one.options) > 1), key=lambda one: len(one.options))
        if len(unsettled) > MAX_UNSETTLED:
            raise Undecided
        return self._clash(certain, unsettled, last)

    def _clash(self, facts: list[Fact], unsettled: Sequence[Claim], last: Theory) -> frozenset[Mention]:
        """Judge the facts, then each option of the first claim; a clash that spares an option ends the matter."""
        found = self._judge(facts, some_contradiction)
        if found:
            return found
        if not unsettled:
            return self._judge(facts, last) if last is not some_contradiction else found
        first, *others = unsettled
        together: frozenset[Mention] = frozenset()
        for option in first.options:
            found = self._clash([*facts, *option.facts], others, last)
            if not found & option.mentions:
                return found
            together |= found
        return together

    def _judge(self, facts: list[Fact], theory: Theory) -> frozenset[Mention]:
        self.effort.spend(len(facts) if theory is some_contradiction else PLACEMENT + len(facts))
        return frozenset(fact.mention for fact in theory(facts))


def relevant(claims: Iterable[Claim]) -> tuple[Claim, ...]:
    """Return claims with those facts alone that could take part in a contradiction of directions or exclusion."""
    claims = tuple(claims)
    mentions = entangled(fact for claim in claims for fact in claim.facts)
    return tuple(only(mentions, claims)) if mentions else ()


def _certain(claims: Iterable[Claim]) -> list[Fact]:
    return [fact for claim in claims if len(claim.options) == 1 for fact in claim.facts]


def only(mentions: Set[Mention], claims: Iterable[Claim]) -> list[Claim]:
    """Return the claims with the facts written at some places alone."""
    return [claim.keeping(mentions) for claim in claims]
