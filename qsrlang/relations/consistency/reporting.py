"""Conflicts as findings about a text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from qsrlang.language.diagnostics import Diagnostic, Label, Severity
from qsrlang.language.source import Span
from qsrlang.relations.calculus import Relation
from qsrlang.relations.consistency.claims import Claim, Fact, claims_of
from qsrlang.relations.consistency.conflicts import Conflict, Relaxation
from qsrlang.relations.consistency.finding import Examination
from qsrlang.relations.consistency.relaxing import relaxations
from qsrlang.relations.consistency.searching import Effort, Search, only
from qsrlang.relations.graph import RelationGraph

CODE = "Q515"
MAX_EFFORT = 20_000
"""Less than where it is asked for, since a text is checked as it is typed."""


def contradicting(
    facts: Sequence[Fact], claims: Sequence[Claim], relations: Mapping[str, Relation]
) -> Diagnostic:
    """Return the finding that facts, among claims that have no other conflict, contradict each other."""
    atoms = sorted({fact.mention: fact.atom for fact in facts}.items())
    found = relaxations(facts, claims, relations, Search(Effort(MAX_EFFORT)))
    return _finding(Conflict(tuple(atom for _, atom in atoms), (), found))


def contradictions(
    graph: RelationGraph, known: Iterable[Diagnostic], within: Span | None = None
) -> Iterator[Diagnostic]:
    """Yield a finding for each conflict of directions and exclusions in a graph that is not known yet.

    Of those, only the ones with an atom `within` a place if that is given.
    """
    told = {_mention(place) for one in known if one.code == CODE for place in _places(one)}
    claims = claims_of(graph)
    mentions = {fact.mention for claim in claims for fact in claim.facts}
    fresh = tuple(only(mentions - told, claims)) if told else claims
    for conflict in Examination(fresh, graph.relations, effort=Effort(MAX_EFFORT)).conflicts()[0]:
        if within is None or any(_lies_in(atom.span, within) for atom in conflict.atoms):
            yield _finding(conflict)


def _finding(conflict: Conflict) -> Diagnostic:
    first, *others = conflict.atoms
    labels = tuple(Label(atom.span, "nor this one, together") for atom in others)
    edits = conflict.relaxations[0].edits if conflict.relaxations else ()
    return Diagnostic(
        CODE,
        conflict.title,
        first.span,
        "this one cannot hold",
        _help(conflict.relaxations),
        labels,
        Severity.WARNING,
        edits,
        sure=False,
    )


def _help(relaxations: Sequence[Relaxation]) -> str:
    each = "each could hold without one of the others"
    if not relaxations:
        return each
    first, *others = (one.short for one in relaxations)
    also = f" (or {', or '.join(others)})" if others else ""
    return f"{each}; the least change: {first}{also}"


def _places(finding: Diagnostic) -> Iterator[Span]:
    yield finding.span
    yield from (label.span for label in finding.labels)


def _mention(span: Span) -> tuple[str, int, int]:
    return span.source.name, span.start, span.end


def _lies_in(span: Span, other: Span) -> bool:
    return span.source is other.source and other.start <= span.start and span.end <= other.end
