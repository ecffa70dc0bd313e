"""From scenes, beliefs and observations to choices between constraints."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import islice, product

from qsrlang.language import syntax as s
from qsrlang.relations.calculus import MAX_CONJUNCTIONS, NoOpposite, TooManyConjunctions, conjunctions
from qsrlang.relations.graph import AtomicRelation, Choice, Constraint, Pair, Statement
from qsrlang.relations.precedence import Evidence, settle
from qsrlang.relations.symbols import Symbols

_SHARE_SLACK = 1e-9


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
    return settle(beliefs, counts, scenes, symbols)


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
    found = [
        Evidence(part * share, _constraints(relations, fit, node), node)
        for disjunct in disjuncts
        for share, relations in _terms(disjunct, symbols, split=fit is None)
    ]
    if len(found) > MAX_CONJUNCTIONS:
        symbols.report("Q103", f"the formula has more than {MAX_CONJUNCTIONS} alternatives", node)
        return []
    if fit and (len(found) > 1 or len(found[0].constraints) > 1):
        symbols.report("Q408", "a metric fit belongs to one pair", fit, "the formula speaks of several")
    return found


_Related = tuple[s.Atom, AtomicRelation]


def _terms(
    atoms: tuple[s.Atom, ...], symbols: Symbols, split: bool
) -> Iterator[tuple[float, tuple[_Related, ...]]]:
    """Yield a conjunction as exclusive alternatives: one for each combination of the parts of its relations."""
    choices = []
    for atom in atoms:
        relation = symbols.relations[atom.relation.text]
        terms = relation.terms if split else ((1.0, relation),)
        choices.append([(share, (atom, AtomicRelation(term, atom.frame))) for share, term in terms])
    for combination in islice(product(*choices), MAX_CONJUNCTIONS + 1):
        yield math.prod(share for share, _ in combination), tuple(related for _, related in combination)


def _constraints(related: tuple[_Related, ...], fit: s.Fit | None, node: s.Node) -> tuple[Constraint, ...]:
    grouped: dict[Pair, list[_Related]] = defaultdict(list)
    for atom, relation in related:
        grouped[atom.arguments[0].text, atom.arguments[1].text].append((atom, relation))
    return tuple(
        Constraint(
            referent,
            relatum,
            tuple(relation for _, relation in members),
            _statement(node, [atom for atom, _ in members]),
            fit,
        )
        for (referent, relatum), members in grouped.items()
    )


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
