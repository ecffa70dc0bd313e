"""Rules about how much statements weigh, and when: shares, counts and contexts."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from qsrlang.language.diagnostics import Diagnostic, Edit, Label
from qsrlang.language.printing.printer import print_formula
from qsrlang.language.source import Span
from qsrlang.language.statements import (
    Alternative,
    Believe,
    Condition,
    Context,
    Elsewhere,
    Observe,
    ObserveScene,
    Require,
)
from qsrlang.language.syntax import Formula, Not
from qsrlang.relations.contexts import compatible
from qsrlang.relations.linting.linted import Linted, warning, whole_statement, without_comments

_SLACK = 1e-9


def missing_shares(linted: Linted) -> Iterator[Diagnostic]:
    """Beliefs whose shares leave a rest that `elsewhere` does not name."""
    for believe in linted.statements():
        if not isinstance(believe, Believe) or any(_is_elsewhere(one) for one in believe.alternatives):
            continue
        shares = [one.share for one in believe.alternatives if one.share is not None]
        rest = 1.0 - sum(shares)
        if len(shares) == len(believe.alternatives) and rest > _SLACK:
            end = Span(linted.source, believe.span.end, believe.span.end)
            yield warning(
                "Q504",
                f"the shares sum to {sum(shares):.6g}",
                believe.span,
                f"the rest, {rest:.6g}, is taken to be elsewhere",
                "write '| elsewhere' if that is meant, or add the alternative that is missing",
                edits=(Edit(end, " | elsewhere"),),
            )


def zero_weights(linted: Linted) -> Iterator[Diagnostic]:
    """Shares and counts of 0."""
    for statement in linted.statements():
        match statement:
            case Believe(alternatives=alternatives):
                yield from (
                    _weightless(one.span, "share", "leave the alternative out", _without(one, alternatives))
                    for one in alternatives
                    if one.share == 0.0
                )
            case Observe(count=0.0) | ObserveScene(count=0.0):
                edits = without_comments(Edit(whole_statement(statement.span), ""))
                yield _weightless(statement.span, "count", "leave the statement out", edits)
            case Require(share=0.0, formula=formula):
                never = f"require {print_formula(_negated(formula))}"
                edits = without_comments(Edit(statement.span, never))
                yield _weightless(statement.span, "share", f"write '{never}' if it never holds", edits)


def impossible_contexts(linted: Linted) -> Iterator[Diagnostic]:
    """Contexts whose conditions exclude each other."""
    for context in linted.document.statements:
        if isinstance(context, Context) and not compatible(context.conditions):
            first, second = _rivals(context.conditions)
            yield warning(
                "Q509",
                "this context can never match",
                second.span,
                f"never where or when '{first.span.text}' holds",
                "write a context for each",
                labels=(Label(first.span, "the other condition"),),
            )


def _weightless(span: Span, what: str, help_text: str, edits: tuple[Edit, ...]) -> Diagnostic:
    return warning("Q505", f"a {what} of 0", span, "this says nothing", help_text, edits=edits)


def _is_elsewhere(alternative: Alternative) -> bool:
    return isinstance(alternative.formula, Elsewhere)


def _without(one: Alternative, alternatives: tuple[Alternative, ...]) -> tuple[Edit, ...]:
    """Return the edit that takes an alternative out with a '|' beside it; none where it is the only one."""
    at = next(number for number, other in enumerate(alternatives) if other is one)
    if len(alternatives) == 1:
        return ()
    if at == 0:
        return without_comments(Edit(Span(one.span.source, one.span.start, alternatives[1].span.start), ""))
    return without_comments(Edit(Span(one.span.source, alternatives[at - 1].span.end, one.span.end), ""))


def _negated(formula: Formula) -> Formula:
    return formula.part if isinstance(formula, Not) else Not(formula.span, formula)


def _rivals(conditions: tuple[Condition, ...]) -> tuple[Condition, Condition]:
    """Return two conditions that exclude each other; the first and the last where only all together do."""
    pairs = combinations(conditions, 2)
    return next((pair for pair in pairs if not compatible(pair)), (conditions[0], conditions[-1]))
