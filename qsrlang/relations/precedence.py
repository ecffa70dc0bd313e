"""What wins where several statements speak of one pair: shares over counts, and counts over scenes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace

from qsrlang.language.diagnostics import Diagnostic, Label, Severity
from qsrlang.language.statements import Believe, Observe
from qsrlang.language.syntax import Node
from qsrlang.relations.evidence import Evidence
from qsrlang.relations.graph import Alternative, Authority, Choice, Constraint, Pair, pair_of
from qsrlang.relations.symbols import Symbols


def settle(
    beliefs: list[tuple[Believe, list[Evidence]]],
    counts: list[Evidence],
    scenes: list[Evidence],
    symbols: Symbols,
) -> tuple[Choice, ...]:
    """Return the choices that hold, with what each pair is governed by; what is overridden is reported."""
    by_pair = _by_pair(counts, symbols)
    governed: dict[Pair, Node] = {}
    choices = []
    for believe, alternatives in beliefs:
        pairs = _pairs(alternatives, symbols)
        _refuse_second(believe, pairs, governed, symbols)
        updates = by_pair.get(next(iter(pairs)), []) if len(pairs) == 1 else []
        choices.append(Choice(Authority.SHARE, frozenset(pairs), _updated(alternatives, updates, symbols)))
    choices += _ungoverned(Authority.COUNT, by_pair, governed, symbols)
    governed |= {pair: evidence[0].node for pair, evidence in by_pair.items() if pair not in governed}
    choices += _ungoverned(Authority.SCENE, _by_pair(scenes, symbols), governed, symbols)
    return tuple(choices)


def _ungoverned(
    authority: Authority, by_pair: dict[Pair, list[Evidence]], governed: dict[Pair, Node], symbols: Symbols
) -> list[Choice]:
    """Return a choice for each pair that nothing of more authority governs, and tell of the others."""
    choices = []
    for pair, evidence in by_pair.items():
        if pair in governed:
            _tell_override(pair, evidence, governed[pair], symbols)
        else:
            free = [_without(one, governed, symbols) for one in evidence]
            choices.append(Choice(authority, frozenset([pair]), _shares(free)))
    return choices


def _pairs(evidence: Iterable[Evidence], symbols: Symbols) -> set[Pair]:
    return {_class_pair(constraint, symbols) for one in evidence for constraint in one.constraints}


def _by_pair(evidence: Iterable[Evidence], symbols: Symbols) -> dict[Pair, list[Evidence]]:
    grouped: dict[Pair, list[Evidence]] = defaultdict(list)
    for one in evidence:
        for pair in dict.fromkeys(_class_pair(constraint, symbols) for constraint in one.constraints):
            grouped[pair].append(one)
    return grouped


def _class_pair(constraint: Constraint, symbols: Symbols) -> Pair:
    return pair_of(constraint, symbols.class_of)


def _shares(evidence: list[Evidence]) -> tuple[Alternative, ...]:
    weighty = [one for one in _pooled(evidence) if one.weight > 0.0]
    total = sum(one.weight for one in weighty)
    return tuple(Alternative(one.weight / total, one.constraints) for one in weighty)


def _pooled(evidence: Iterable[Evidence]) -> list[Evidence]:
    """Return the evidence with what says the same counted together, under the first statement that says it."""
    groups: dict[object, list[Evidence]] = defaultdict(list)
    for one in evidence:
        groups[_key(one), tuple(constraint.fit for constraint in one.constraints)].append(one)
    return [_together(group) for group in groups.values()]


def _together(group: list[Evidence]) -> Evidence:
    first, *others = group
    if not others:
        return first
    constraints = tuple(
        replace(one, statement=replace(one.statement, text=f"{one.statement.text} (and {len(others)} more)"))
        for one in first.constraints
    )
    return Evidence(sum(one.weight for one in group), constraints, first.node)


def _updated(beliefs: list[Evidence], counts: list[Evidence], symbols: Symbols) -> tuple[Alternative, ...]:
    """Dirichlet update: share = (strength x share + count) / (strength + all counts); fits refine their atoms."""
    strength = symbols.defaults["strength"]
    total = strength + sum(one.weight for one in counts)
    keyed: dict[object, list[Evidence]] = defaultdict(list)
    for one in _pooled(counts):
        keyed[_key(one)].append(one)
    found = []
    for belief in beliefs:
        matching = keyed.pop(_key(belief), [])
        share = (strength * belief.weight + sum(one.weight for one in matching)) / total
        found += _refined(belief, share, [one for one in matching if one.constraints[0].fit])
    found += [Alternative(one.weight / total, one.constraints) for group in keyed.values() for one in group]
    return tuple(alternative for alternative in found if alternative.share > 0.0)


def _refined(belief: Evidence, share: float, fitted: list[Evidence]) -> list[Alternative]:
    count = sum(one.weight for one in fitted)
    if count == 0.0:
        return [Alternative(share, belief.constraints)]
    return [Alternative(share * one.weight / count, one.constraints) for one in fitted]


def _key(evidence: Evidence) -> object:
    return frozenset(
        (c.referent, c.relatum, c.towards, frozenset((a.relation, a.frame) for a in c.atoms))
        for c in evidence.constraints
    )


def _without(one: Evidence, governed: dict[Pair, Node], symbols: Symbols) -> Evidence:
    kept = tuple(c for c in one.constraints if _class_pair(c, symbols) not in governed)
    return Evidence(one.weight, kept, one.node)


def _refuse_second(believe: Believe, pairs: set[Pair], governed: dict[Pair, Node], symbols: Symbols) -> None:
    for pair in sorted(pairs):
        if pair in governed:
            label = Label(governed[pair].span, "first believed here")
            message = f"two beliefs speak of {pair[0]} and {pair[1]}"
            symbols.diagnostics.append(Diagnostic("Q403", message, believe.span, labels=(label,)))
        governed.setdefault(pair, believe)


def _tell_override(pair: Pair, evidence: list[Evidence], winner: Node, symbols: Symbols) -> None:
    if isinstance(winner, Believe) and isinstance(evidence[0].node, Observe):
        return
    for node in {id(one.node): one.node for one in evidence}.values():
        label = Label(winner.span, "this wins")
        message = f"what is said of {pair[0]} and {pair[1]} is overridden"
        symbols.diagnostics.append(
            Diagnostic("Q601", message, node.span, labels=(label,), severity=Severity.INFO)
        )
