"""From rules to nodes: atoms, formulas, shares and fits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from qsrlang.language import syntax as s
from qsrlang.language.lexing import Word
from qsrlang.language.nodes.builder import Builder, Vector, nodes_of, token_of
from qsrlang.language.source import Span


class FormulaNodes(Builder):
    """Builds formulas."""

    def role(self, children: list[Any]) -> s.Role:
        """`left: Cup`"""
        return s.Role(self.span(children), self.name_of(children[0]), self.name_of(children[2]))

    def atom(self, children: list[Any]) -> s.Atom:
        """`left-of(Cup, Keyboard) wrt intrinsic`"""
        source, last = self._source, children[-1]
        framed = last.type == "FRAME"
        arguments = tuple(
            [
                s.Name(Span(source, one.start_pos, one.end_pos), one.value) if type(one) is Word else one
                for one in children[2 : -3 if framed else -1 : 2]
            ]
        )
        name = children[0]
        return s.Atom(
            Span(source, name.start_pos, last.end_pos),
            s.Name(Span(source, name.start_pos, name.end_pos), name.value),
            arguments,
            s.Frame(last.value) if framed else s.Frame.RELATIVE,
            framed,
        )

    def negation(self, children: list[Any]) -> s.Formula:
        """`¬ a`; a double negation is none."""
        part: s.Formula = children[1]
        return part.part if isinstance(part, s.Not) else s.Not(self.span(children), part)

    def conjunction(self, children: list[Any]) -> s.Formula:
        """`a ∧ b ∧ c`, n-ary."""
        return s.And(self.span(children), _flat(children, s.And))

    def disjunction(self, children: list[Any]) -> s.Formula:
        """`a ∨ b ∨ c`, n-ary."""
        return s.Or(self.span(children), _flat(children, s.Or))

    def parenthesised(self, children: list[Any]) -> s.Formula:
        """`( a )`, at the place of the parentheses."""
        formula: s.Formula = replace(children[1], span=self.span(children))
        return formula

    def share(self, children: list[Any]) -> s.Quantity:
        """`0.15` or `15 %`"""
        percent = len(children) > 1
        value = float(children[0]) / (100.0 if percent else 1.0)
        span = self.span(children)
        if value > 1.0:
            help_text = f"write '{children[0]} %'" if not percent and value <= 100.0 else ""
            self.refuse("Q303", "a share is at most 1", span, "expected 0 to 1, or 0 % to 100 %", help_text)
        return s.Quantity(span, value, s.Dimension.FRACTION if percent else s.Dimension.NUMBER)

    def fit(self, children: list[Any]) -> s.Fit:
        """`~ normal((x, y), (sd x, sd y), correlation)`"""
        span = self.span(children)
        first, second = nodes_of(children, Vector)
        mean = self.lengths(first, "the mean of a fit", (2,))
        deviation = self.lengths(second, "the deviation of a fit", (2,), positive=True)
        correlation = next((one.value for one in nodes_of(children, s.Quantity)), 0.0)
        if not abs(correlation) < 1.0:
            self.refuse("Q303", "a correlation lies strictly between -1 and 1", span)
        return s.Fit(span, (mean[0], mean[1]), (deviation[0], deviation[1]), correlation)

    def share_of(self, children: list[Any]) -> float | None:
        """Return the share among the children, or None."""
        return next((one.value for one in nodes_of(children, s.Quantity)), None)

    def formula_of(self, children: list[Any]) -> s.Formula:
        """Return the formula among the children."""
        formula: s.Formula = nodes_of(children, s.Atom | s.And | s.Or | s.Not)[0]  # type: ignore[arg-type]
        return formula

    def fit_of(self, children: list[Any]) -> s.Fit | None:
        """Return the fit among the children, or None."""
        return next(iter(nodes_of(children, s.Fit)), None)

    def count_of(self, children: list[Any]) -> float:
        """Return the count among the children; 1 where there is none."""
        token = token_of(children, "NUMBER")
        count = 1.0 if token is None else float(token)
        if token is not None and count == float("inf"):
            self.refuse("Q303", "a count is too large a number", self.place(token))
        return count


def _flat(children: list[Any], kind: type[s.And] | type[s.Or]) -> tuple[s.Formula, ...]:
    parts: list[s.Formula] = []
    for child in children[::2]:
        parts.extend(child.parts if type(child) is kind else (child,))
    return tuple(parts)
