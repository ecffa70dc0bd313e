"""All that does not hold together in what is known."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace

from qsrlang.relations.calculus import Relation
from qsrlang.relations.consistency.claims import Claim, Fact, Mention, Option
from qsrlang.relations.consistency.conflicts import Conflict, Consistency, Impossible
from qsrlang.relations.consistency.orders import entangled
from qsrlang.relations.consistency.relaxing import relaxations
from qsrlang.relations.consistency.searching import Effort, Search, Theory, Undecided, only

MAX_CONFLICTS = 20
MAX_ALTERNATIVES = 200


def no_poses(facts: Sequence[Fact]) -> tuple[str, ...]:
    """Return that a conflict rests on no landmark's pose."""
    return ()


@dataclass(frozen=True, slots=True)
class Examination:
    """Claims under examination, by a theory of places too if there is one.

    `poses_behind` tells on which landmarks' poses a conflict rests.
    """

    claims: tuple[Claim, ...]
    relations: Mapping[str, Relation]
    placing: Theory | None = None
    poses_behind: Callable[[Sequence[Fact]], tuple[str, ...]] = no_poses
    effort: Effort = field(default_factory=Effort)

    def consistency(self) -> Consistency:
        """Return every conflict, no two of which share an atom; where there is none, what holds in no world."""
        conflicts, decided = self.conflicts()
        if conflicts or not decided:
            return Consistency(conflicts, is_decided=decided)
        impossible, decided = self._impossible()
        return Consistency((), impossible, decided)

    def conflicts(self) -> tuple[tuple[Conflict, ...], bool]:
        """Return every conflict, no two of which share an atom, and whether there are surely no more."""
        cores, decided = self._cores()
        return tuple(self._conflict(core, cores) for core in cores), decided

    @property
    def mentions(self) -> frozenset[Mention]:
        """Where all facts are written."""
        return frozenset(fact.mention for claim in self.claims for fact in claim.facts)

    def _cores(self) -> tuple[list[frozenset[Mention]], bool]:
        """Return minimal clashes, each of what the ones before leave, and whether there are no more."""
        cores = list[frozenset[Mention]]()
        remaining = self.mentions
        try:
            while len(cores) < MAX_CONFLICTS:
                claims = only(remaining, self.claims)
                core = Search(self.effort, self.placing).clash(claims)
                if not core:
                    return cores, True
                cores.append(Search(self.effort, self.placing).minimal(core, claims))
                remaining -= cores[-1]
        except Undecided:
            pass
        return cores, False

    def _conflict(self, core: Set[Mention], cores: Iterable[Set[Mention]]) -> Conflict:
        others = frozenset().union(*(one for one in cores if one is not core))
        claims = only(self.mentions - others, self.claims)
        facts = self._written(core)
        found = relaxations(facts, claims, self.relations, Search(self.effort, self.placing))
        return replace(self._bare(facts), relaxations=found)

    def _bare(self, facts: Sequence[Fact]) -> Conflict:
        atoms = {fact.mention: fact.atom for fact in facts}
        ordered = tuple(atoms[mention] for mention in sorted(atoms))
        return Conflict(ordered, self._poses(atoms.keys(), facts))

    def _poses(self, mentions: Set[Mention], facts: Sequence[Fact]) -> tuple[str, ...]:
        """Return the landmarks whose poses a conflict rests on; none where directions alone contradict each other."""
        try:
            if self.placing is None or Search(self.effort).clash(only(mentions, self.claims)):
                return ()
        except Undecided:
            pass
        return self.poses_behind(facts)

    def _written(self, mentions: Set[Mention]) -> list[Fact]:
        """Return the facts written at some places, those that several claims hold once."""
        return list(
            {
                (fact.mention, fact.relation.name, fact.relation.angle): fact
                for claim in self.claims
                for fact in claim.facts
                if fact.mention in mentions
            }.values()
        )

    def _impossible(self) -> tuple[tuple[Impossible, ...], bool]:
        """Return the alternatives that hold in no world; senses of the same atoms are one alternative."""
        found = list[Impossible]()
        tried = 0
        suspect = (
            self.mentions if self.placing else entangled(f for claim in self.claims for f in claim.facts)
        )
        for number, claim in enumerate(self.claims):
            for mentions, options in _alternatives(claim).items():
                if len(options) == len(claim.options) or not mentions & suspect:
                    continue
                tried += 1
                if tried > MAX_ALTERNATIVES:
                    return tuple(found), False
                others = self.claims[:number] + self.claims[number + 1 :]
                told = self._never(Claim(tuple(options)), others)
                found += [told] if told else []
        return tuple(found), True

    def _never(self, claim: Claim, others: tuple[Claim, ...]) -> Impossible | None:
        claims = (claim, *others)
        try:
            core = Search(self.effort, self.placing).clash(claims)
            core = Search(self.effort, self.placing).minimal(core, claims) if core else core
        except Undecided:
            return None
        if not core:
            return None
        atoms = tuple({fact.mention: fact.atom for fact in claim.facts}.values())
        return Impossible(atoms, sum(one.share for one in claim.options), self._bare(self._written(core)))


def _alternatives(claim: Claim) -> dict[frozenset[Mention], list[Option]]:
    """Return the options by where their atoms are written, those without any left out."""
    grouped: dict[frozenset[Mention], list[Option]] = {}
    for option in claim.options:
        if option.facts:
            grouped.setdefault(option.mentions, []).append(option)
    return grouped
