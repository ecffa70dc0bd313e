"""From scenes, beliefs and observations to choices between constraints."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from qsrlang.language import syntax as s
from qsrlang.language.diagnostics import Diagnostic, Label, Severity
from qsrlang.relations.calculus import MAX_CONJUNCTIONS, NoOpposite, TooManyConjunctions, conjunctions
from qsrlang.relations.graph import (
    Alternative,
    AtomicRelation,
    Authority,
    Choice,
    Constraint,
    Pair,
    Statement,
)
from qsrlang.relations.symbols import Symbols

_SHARE_SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Evidence:
    """One alternative that a statement names, with its share or count, and the statement's place."""

    weight: float
    constraints: tuple[Constraint, ...]
    node: s.Node


def build_choices(statements: Iterable[s.Statement], symbols: Symbols) -> tuple[Choice, ...]:
    """Return the choices of a library: on one pair, shares win over counts, and counts over scenes."""
    beliefs: list[tuple[s.Believe, list[Evidence]]] = []
    counts: list[Evidence] = []
    scenes: list[Evidence] = []
    seen = _scene_counts(statements := tuple(statements), symbols)
    for statement in statements:
        match statement:
            case s.Believe():
                beliefs.append((statement, _belief(statement, symbols)))
            case s.Observe():
                counts.extend(
                    _evidence(statement.count, statement.formula, statement.fit, statement, symbols)
                )
            case s.Scene():
                _check_members(statement, symbols)
                count = seen.get(statement.name.text, 1.0) if statement.name else 1.0
                scenes.extend(_evidence(count, statement.formula, None, statement, symbols))
    return _settle(beliefs, counts, scenes, symbols)


def _settle(
    beliefs: list[tuple[s.Believe, list[Evidence]]],
    counts: list[Evidence],
    scenes: list[Evidence],
    symbols: Symbols,
) -> tuple[Choice, ...]:
    by_pair = _by_pair(counts, symbols)
    governed: dict[Pair, s.Node] = {}
    choices = []
    for believe, alternatives in beliefs:
        pairs = _pairs(alternatives, symbols)
        _refuse_second(believe, pairs, governed, symbols)
        updates = by_pair.get(next(iter(pairs)), []) if len(pairs) == 1 else []
        choices.append(Choice(Authority.SHARE, frozenset(pairs), _updated(alternatives, updates, symbols)))
    for pair, evidence in by_pair.items():
        if pair in governed:
            _tell_override(pair, evidence, governed[pair], symbols)
        else:
            choices.append(Choice(Authority.COUNT, frozenset([pair]), _shares(evidence)))
            governed[pair] = evidence[0].node
    for pair, evidence in _by_pair(scenes, symbols).items():
        if pair in governed:
            _tell_override(pair, evidence, governed[pair], symbols)
        else:
            free = [_without(one, governed, symbols) for one in evidence]
            choices.append(Choice(Authority.SCENE, frozenset([pair]), _shares(free)))
    return tuple(choices)


def _belief(believe: s.Believe, symbols: Symbols) -> list[Evidence]:
    given = [alternative.share for alternative in believe.alternatives]
    if None in given and any(share is not None for share in given):
        missing = believe.alternatives[given.index(None)]
        symbols.report(
            "Q402", "some alternatives have a share and some have none", missing, "this one has none"
        )
    total = sum(share or 0.0 for share in given)
    if total > 1.0 + _SHARE_SLACK:
        help_text = "shares of exclusive alternatives sum to at most 1; the rest is elsewhere"
        symbols.report("Q401", f"the shares sum to {total:g}", believe, help_text=help_text)
    equal = 1.0 / len(given)
    found: list[Evidence] = []
    for alternative in believe.alternatives:
        share = equal if alternative.share is None else alternative.share
        found += _evidence(share, alternative.formula, alternative.fit, alternative, symbols)
    return found


def _evidence(
    weight: float, formula: s.Formula, fit: s.Fit | None, node: s.Node, symbols: Symbols
) -> list[Evidence]:
    """Return a formula's disjuncts, each with an equal part of the weight; empty, reported, where it is wrong."""
    atoms = list(_atoms(formula))
    sound = [_check_atom(atom, symbols) for atom in atoms]
    if not all(sound):
        return []
    try:
        disjuncts = conjunctions(formula, symbols.relations)
    except NoOpposite as error:
        help_text = f"give '{error.atom.relation}' a 'disjoint' field, or state what does hold"
        symbols.report("Q405", f"'{error.atom.relation}' has no opposites", error.atom, "negated", help_text)
        return []
    except TooManyConjunctions:
        symbols.report("Q103", f"the formula has more than {MAX_CONJUNCTIONS} alternatives", node)
        return []
    part = weight / len(disjuncts)
    found = [Evidence(part, _constraints(disjunct, fit, node, symbols), node) for disjunct in disjuncts]
    if fit and (len(found) > 1 or len(found[0].constraints) > 1):
        symbols.report("Q408", "a metric fit belongs to one pair", fit, "the formula speaks of several")
    return found


def _constraints(
    atoms: tuple[s.Atom, ...], fit: s.Fit | None, node: s.Node, symbols: Symbols
) -> tuple[Constraint, ...]:
    grouped: dict[Pair, list[s.Atom]] = defaultdict(list)
    for atom in atoms:
        grouped[atom.arguments[0].text, atom.arguments[1].text].append(atom)
    return tuple(
        Constraint(referent, relatum, _relations(pair_atoms, symbols), _statement(node, pair_atoms), fit)
        for (referent, relatum), pair_atoms in grouped.items()
    )


def _relations(atoms: list[s.Atom], symbols: Symbols) -> tuple[AtomicRelation, ...]:
    return tuple(AtomicRelation(symbols.relations[atom.relation.text], atom.frame) for atom in atoms)


def _statement(node: s.Node, atoms: list[s.Atom]) -> Statement:
    """Return what to cite: of a scene, which may be long, only the atoms that speak of the pair."""
    if not isinstance(node, s.Scene):
        return Statement.at(node.span)
    where = Statement.at(atoms[0].span)
    return Statement(where.file, where.line, " ∧ ".join(" ".join(atom.span.text.split()) for atom in atoms))


def _check_atom(atom: s.Atom, symbols: Symbols) -> bool:
    relation = symbols.resolve_relation(atom.relation)
    kinds = [symbols.resolve_class(name) for name in atom.arguments]
    if relation is None or None in kinds:
        return False
    if len(kinds) != 2:
        message = f"'{atom.relation}' takes a referent and a relatum, not {len(kinds)} arguments"
        symbols.report("Q404", message, atom)
        return False
    if atom.arguments[0].text == atom.arguments[1].text:
        symbols.report("Q407", f"'{atom.arguments[0]}' is related to itself", atom)
        return False
    return _check_front(atom, str(kinds[1]), symbols)


def _check_front(atom: s.Atom, kind: str, symbols: Symbols) -> bool:
    if atom.frame is not s.Frame.INTRINSIC or symbols.classes[kind].front:
        return True
    help_text = f"declare '{kind} {{ front: yes }}', or write 'wrt relative'"
    symbols.report(
        "Q406", f"'{kind}' has no front", atom.arguments[1], "an intrinsic frame needs one", help_text
    )
    return False


def _check_members(scene: s.Scene, symbols: Symbols) -> None:
    members = {name.text for name in scene.classes}
    for atom in _atoms(scene.formula):
        for name in atom.arguments:
            if name.text not in members and name.text in symbols.classes:
                help_text = f"add '{name}' to the scene's arguments"
                symbols.report(
                    "Q211", f"'{name}' is not among the scene's arguments", name, help_text=help_text
                )


def _scene_counts(statements: tuple[s.Statement, ...], symbols: Symbols) -> dict[str, float]:
    counts: dict[str, float] = defaultdict(float)
    for statement in statements:
        if isinstance(statement, s.ObserveScene) and symbols.resolve_scene(statement.scene):
            counts[statement.scene.text] += statement.count
    return counts


def _atoms(formula: s.Formula) -> Iterable[s.Atom]:
    match formula:
        case s.Atom():
            yield formula
        case s.Not(part=part):
            yield from _atoms(part)
        case s.And(parts=parts) | s.Or(parts=parts):
            for part in parts:
                yield from _atoms(part)


def _class_pair(constraint: Constraint, symbols: Symbols) -> Pair:
    names = (constraint.referent, constraint.relatum)
    first, second = (symbols.landmarks[n].kind if n in symbols.landmarks else n for n in names)
    return first, second


def _pairs(evidence: Iterable[Evidence], symbols: Symbols) -> set[Pair]:
    return {_class_pair(constraint, symbols) for one in evidence for constraint in one.constraints}


def _by_pair(evidence: Iterable[Evidence], symbols: Symbols) -> dict[Pair, list[Evidence]]:
    grouped: dict[Pair, list[Evidence]] = defaultdict(list)
    for one in evidence:
        for pair in dict.fromkeys(_class_pair(constraint, symbols) for constraint in one.constraints):
            grouped[pair].append(one)
    return grouped


def _without(one: Evidence, governed: dict[Pair, s.Node], symbols: Symbols) -> Evidence:
    kept = tuple(c for c in one.constraints if _class_pair(c, symbols) not in governed)
    return Evidence(one.weight, kept, one.node)


def _shares(evidence: list[Evidence]) -> tuple[Alternative, ...]:
    total = sum(one.weight for one in evidence)
    return tuple(Alternative(one.weight / total, one.constraints) for one in evidence if one.weight > 0.0)


def _updated(beliefs: list[Evidence], counts: list[Evidence], symbols: Symbols) -> tuple[Alternative, ...]:
    """Dirichlet update: share = (strength x share + count) / (strength + all counts); fits refine their atoms."""
    strength = symbols.defaults["strength"]
    total = strength + sum(one.weight for one in counts)
    keyed: dict[object, list[Evidence]] = defaultdict(list)
    for one in counts:
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
        (c.referent, c.relatum, frozenset((a.relation.name, a.frame) for a in c.atoms))
        for c in evidence.constraints
    )


def _refuse_second(
    believe: s.Believe, pairs: set[Pair], governed: dict[Pair, s.Node], symbols: Symbols
) -> None:
    for pair in sorted(pairs):
        if pair in governed:
            label = Label(governed[pair].span, "first believed here")
            message = f"two beliefs speak of {pair[0]} and {pair[1]}"
            symbols.diagnostics.append(Diagnostic("Q403", message, believe.span, labels=(label,)))
        governed.setdefault(pair, believe)


def _tell_override(pair: Pair, evidence: list[Evidence], winner: s.Node, symbols: Symbols) -> None:
    if isinstance(winner, s.Believe) and isinstance(evidence[0].node, s.Observe):
        return
    for node in {id(one.node): one.node for one in evidence}.values():
        label = Label(winner.span, "this wins")
        message = f"what is said of {pair[0]} and {pair[1]} is overridden"
        symbols.diagnostics.append(
            Diagnostic("Q601", message, node.span, labels=(label,), severity=Severity.INFO)
        )
