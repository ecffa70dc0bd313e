"""From formulas to evidence: exclusive alternatives of constraints, with what is wrong in their atoms reported."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice, product

from qsrlang.language.diagnostics import Label
from qsrlang.language.statements import Scene
from qsrlang.language.syntax import And, Atom, Fit, Formula, Frame, Name, Node, Not, Or, Role, atoms_of
from qsrlang.relations.calculus import (
    MAX_CONJUNCTIONS,
    NoOpposite,
    Relation,
    TooManyConjunctions,
    conjunctions,
)
from qsrlang.relations.consistency.claims import Claim, Option, facts_of
from qsrlang.relations.consistency.orders import contradiction
from qsrlang.relations.consistency.reporting import contradicting
from qsrlang.relations.graph import AtomicRelation, Constraint, Statement
from qsrlang.relations.symbols import Symbols

_ARGUMENTS = {2: "a referent and a relatum", 3: "a referent and two relata"}


@dataclass(frozen=True, slots=True)
class Evidence:
    """One alternative that a statement names, with its share or count, and the statement's place."""

    weight: float
    constraints: tuple[Constraint, ...]
    node: Node


_Related = tuple[Atom, AtomicRelation]


def evidence_of(
    weight: float, formula: Formula, fit: Fit | None, node: Node, symbols: Symbols
) -> list[Evidence]:
    """Return a formula's disjuncts, each with an equal part of the weight; empty, reported, where it is wrong."""
    if not check_atoms(formula, symbols):
        return []
    symbols.related += atoms_of(formula)
    try:
        disjuncts = conjunctions(formula, symbols.relations)
    except NoOpposite as error:
        _report_no_opposite(error.atom, symbols)
        return []
    except TooManyConjunctions:
        symbols.report("Q103", f"the formula has more than {MAX_CONJUNCTIONS} alternatives", node)
        return []
    _warn_of_conflict(disjuncts, symbols)
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


def check_atoms(formula: Formula, symbols: Symbols) -> bool:
    """Return whether all atoms of a formula make sense; what does not is reported."""
    sound = [_check_atom(atom, symbols) for atom in atoms_of(formula)]
    return all(sound)


def with_roles(formula: Formula, roles: Mapping[str, Role]) -> Formula:
    """Return a scene's formula with its roles in place of their bare names."""
    match formula:
        case Atom(arguments=arguments):
            full = tuple(
                replace(roles[one.text], span=one.span)
                if isinstance(one, Name) and one.text in roles
                else one
                for one in arguments
            )
            return replace(formula, arguments=full)
        case Not(part=part):
            return replace(formula, part=with_roles(part, roles))
        case And(parts=parts) | Or(parts=parts):
            return replace(formula, parts=tuple(with_roles(part, roles) for part in parts))


def _warn_of_conflict(disjuncts: tuple[tuple[Atom, ...], ...], symbols: Symbols) -> None:
    """Report a formula all of whose alternatives contradict themselves, by the first one's shortest contradiction."""
    alternatives = [facts_of(atoms, symbols.relations) for atoms in disjuncts]
    conflicts = [contradiction(facts) for facts in alternatives]
    if all(conflicts):
        claim = Claim((Option(1.0, alternatives[0]),))
        symbols.diagnostics.append(contradicting(conflicts[0], (claim,), symbols.relations))


def _report_no_opposite(atom: Atom, symbols: Symbols) -> None:
    place = symbols.places.get(("relation", atom.relation.text))
    labels = (Label(place.span, "defined here without 'disjoint'"),) if place else ()
    help_text = f"give '{atom.relation}' a 'disjoint' field, or state what does hold"
    symbols.report("Q405", f"'{atom.relation}' has no opposites", atom, "negated", help_text, labels)


def _terms(
    atoms: tuple[Atom, ...], symbols: Symbols, split: bool
) -> Iterator[tuple[float, tuple[_Related, ...]]]:
    """Yield a conjunction as exclusive alternatives: one for each combination of the parts of its relations."""
    choices = []
    for atom in atoms:
        relation = symbols.relations[atom.relation.text]
        terms = relation.terms if split else ((1.0, relation),)
        choices.append([(share, (atom, AtomicRelation(term, atom.frame, atom))) for share, term in terms])
    for combination in islice(product(*choices), MAX_CONJUNCTIONS + 1):
        yield math.prod(share for share, _ in combination), tuple(related for _, related in combination)


def _constraints(related: tuple[_Related, ...], fit: Fit | None, node: Node) -> tuple[Constraint, ...]:
    """Group what multiplies: angles and distances on one pair; a region or a second relatum stands alone."""
    grouped: dict[object, list[_Related]] = defaultdict(list)
    for number, (atom, one) in enumerate(related):
        names = tuple(argument.text for argument in atom.arguments)
        alone = len(names) > 2 or one.relation.region is not None
        grouped[names, number if alone else None].append((atom, one))
    return tuple(_constraint(members, fit, node) for members in grouped.values())


def _constraint(members: list[_Related], fit: Fit | None, node: Node) -> Constraint:
    atoms = [atom for atom, _ in members]
    referent, relatum, *towards = (argument.text for argument in atoms[0].arguments)
    relations = tuple(relation for _, relation in members)
    return Constraint(
        referent, relatum, relations, _statement(node, atoms), fit, towards[0] if towards else None
    )


def _statement(node: Node, atoms: list[Atom]) -> Statement:
    """Return what to cite: of a scene, which may be long, only the atoms that speak of the pair."""
    if not isinstance(node, Scene):
        return Statement.at(node.span)
    where = Statement.at(atoms[0].span)
    return Statement(where.file, where.line, " ∧ ".join(" ".join(atom.span.text.split()) for atom in atoms))


def _check_atom(atom: Atom, symbols: Symbols) -> bool:
    relation = symbols.resolve_relation(atom.relation)
    kinds = [symbols.resolve_class(argument) for argument in atom.arguments]
    if relation is None or None in kinds:
        return False
    return _check_count(atom, relation, symbols) and _check_front(atom, relation, str(kinds[1]), symbols)


def _check_count(atom: Atom, relation: Relation, symbols: Symbols) -> bool:
    names = [argument.text for argument in atom.arguments]
    if len(names) != relation.arity:
        given = f"{len(names)} argument" + ("s" if len(names) > 1 else "")
        symbols.report(
            "Q404", f"'{atom.relation}' takes {_ARGUMENTS.get(relation.arity, '')}, not {given}", atom
        )
        return False
    twice = next((one for one in atom.arguments if names.count(one.text) > 1), None)
    if twice is not None:
        help_text = f"where a scene has two of one class, give them roles: 'left: {twice.text}'"
        symbols.report("Q407", f"'{twice.text}' is related to itself", atom, "", help_text)
    return twice is None


def _check_front(atom: Atom, relation: Relation, kind: str, symbols: Symbols) -> bool:
    needs = atom.frame is Frame.INTRINSIC and relation.arity == 2
    if not needs or symbols.classes[kind].front:
        return True
    place = symbols.places.get(("class", kind))
    labels = (Label(place.span, f"'{kind}' is declared here without a front"),) if place else ()
    help_text = f"declare '{kind} {{ front: yes }}', or write 'wrt relative'"
    symbols.report(
        "Q406", f"'{kind}' has no front", atom.arguments[1], "an intrinsic frame needs one", help_text, labels
    )
    return False
