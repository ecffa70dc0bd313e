"""Rules about formulas: atoms that others imply, disjunctions where a belief was meant."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from qsrlang.language.diagnostics import Diagnostic, Edit, Label
from qsrlang.language.printing.printer import print_formula
from qsrlang.language.source import Span
from qsrlang.language.statements import Believe, Observe, Require, Statement
from qsrlang.language.syntax import And, Atom, Formula, Frame, Not, Or, atoms_of
from qsrlang.relations.algebra import derivation
from qsrlang.relations.calculus import Relation
from qsrlang.relations.linting.linted import Linted, warning, without_comments

_CONNECTIVE = re.compile(r"\s*(?:∧|&|and)\s*")


def implied_atoms(linted: Linted) -> Iterator[Diagnostic]:
    """Atoms of a conjunction that others imply: one that says the same, or directions of one frame along a chain."""
    for _, formula in linted.formulas():
        for part in _unnegated(formula):
            if isinstance(part, And):
                yield from _implied(part, linted)


def _implied(conjunction: And, linted: Linted) -> Iterator[Diagnostic]:
    said: dict[tuple[object, ...], Atom] = {}
    for number, atom in enumerate(conjunction.parts):
        if not isinstance(atom, Atom):
            continue
        ways = _ways_to_say(atom, linted.symbols.relations.get(atom.relation.text))
        first = next((said[way] for way in ways if way in said), None)
        if first is None:
            said[ways[0]] = atom
        else:
            yield _saying_nothing_new(conjunction, number, (first,))
    yield from _derived(conjunction, list(said.values()))


def _derived(conjunction: And, atoms: list[Atom]) -> Iterator[Diagnostic]:
    """Yield a finding for each direction that follows from two or more of the others; the last ones go first."""
    pairs = [atom for atom in atoms if len({one.text for one in atom.arguments}) == len(atom.arguments) == 2]
    for atom in reversed(pairs):
        others = [one for one in pairs if one is not atom]
        chain = derivation(others, atom)
        if chain and not any(derivation(others, one) for one in _turned(atom)):
            pairs = others
            number = next(n for n, part in enumerate(conjunction.parts) if part is atom)
            yield _saying_nothing_new(conjunction, number, chain)


def _turned(atom: Atom) -> Iterator[Atom]:
    """Yield the atom that says the opposite: if that follows as well, the others contradict each other."""
    yield replace(atom, arguments=atom.arguments[::-1])


def _saying_nothing_new(conjunction: And, number: int, others: tuple[Atom, ...]) -> Diagnostic:
    atom = conjunction.parts[number]
    alone = len(others) == 1
    return warning(
        "Q506",
        f"'{atom.span.text}' says nothing new",
        atom.span,
        "implied by the other atom" if alone else f"implied by the {len(others)} others",
        "leave one of the two out"
        if alone
        else "leave it out; counted beside them, it narrows the answer twice",
        labels=tuple(Label(one.span, "this says the same" if alone else "from this") for one in others),
        edits=_without(conjunction, number),
    )


def _ways_to_say(atom: Atom, relation: Relation | None) -> list[tuple[object, ...]]:
    """Return the atom itself as (relation, frame, arguments), then what is the same said in other words."""
    names = tuple(argument.text for argument in atom.arguments)
    ways: list[tuple[object, ...]] = [(atom.relation.text, atom.frame, *names)]
    if relation is None or len(names) != relation.arity:
        return ways
    if relation.symmetric:
        ways.append(
            (atom.relation.text, atom.frame, *(names[::-1] if len(names) == 2 else (names[0], *names[:0:-1])))
        )
    if relation.converse and len(names) == 2 and atom.frame is not Frame.INTRINSIC:
        ways.append((relation.converse, atom.frame, *names[::-1]))
    return ways


def _without(conjunction: And, number: int) -> tuple[Edit, ...]:
    """Return the edit that takes a later part out, where only a connective stands between it and the one before."""
    before, part = conjunction.parts[number - 1], conjunction.parts[number]
    place = Span(part.span.source, before.span.end, part.span.end)
    between = place.source.text[before.span.end : part.span.start]
    return without_comments(Edit(place, "")) if _CONNECTIVE.fullmatch(between) else ()


def disjunctions(linted: Linted) -> Iterator[Diagnostic]:
    """Disjunctions about one pair of objects, where the alternatives of a belief were meant."""
    for statement, formula in linted.formulas():
        parts = formula.parts if isinstance(formula, And) else (formula,)
        for disjunction in (part for part in parts if isinstance(part, Or)):
            if _offers_alternatives(statement, disjunction):
                yield warning(
                    "Q510",
                    "a disjunction of alternatives for one pair",
                    disjunction.span,
                    "each weighs the same",
                    "give each its share: 'believe 0.3 :: … | 0.7 :: …'",
                    edits=_as_belief(statement, disjunction),
                )


def _offers_alternatives(statement: Statement, disjunction: Or) -> bool:
    """Whether a disjunction speaks of one pair; of a requirement it says what is meant."""
    pairs = {tuple(one.text for one in atom.arguments) for atom in atoms_of(disjunction)}
    negates = any(isinstance(part, Not) for part in _unnegated(disjunction))
    return not (isinstance(statement, Believe | Require) or len(pairs) > 1 or negates)


def _as_belief(statement: Statement, disjunction: Or) -> tuple[Edit, ...]:
    """Return the edit that makes a belief with equal shares of an observation that is the disjunction alone."""
    match statement:
        case Observe(count=1.0, fit=None, formula=Or()):
            alternatives = " | ".join(print_formula(part) for part in disjunction.parts)
            return without_comments(Edit(statement.span, f"believe {alternatives}"))
    return ()


def _unnegated(formula: Formula) -> Iterator[Formula]:
    """Yield a formula and its parts, but nothing inside a negation."""
    waiting = [formula]
    while waiting:
        part = waiting.pop()
        yield part
        if isinstance(part, And | Or):
            waiting += reversed(part.parts)
