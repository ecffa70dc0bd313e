"""What the builders of all nodes share: places, quantities with their units checked once, and what was found wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from qsrlang.language.diagnostics import Diagnostic, Edit, Label
from qsrlang.language.lexing import Word
from qsrlang.language.quantities import EXAMPLES, likely_unit, to_si
from qsrlang.language.source import Source, Span
from qsrlang.language.syntax import Dimension, Name, Node, Quantity, Role

LENGTH, ANGLE = Dimension.LENGTH, Dimension.ANGLE
MINUTES_A_DAY = 24 * 60


@dataclass(frozen=True, slots=True)
class Vector(Node):
    """Quantities in parentheses."""

    quantities: tuple[Quantity, ...]


@dataclass(frozen=True, slots=True)
class Field(Node):
    """A named field of a declaration or a relation."""

    key: str
    value: Any


class Builder:
    """Builds the nodes of one source as the parser reduces its rules; each method is named by its rule.

    `children` holds every token and node of the rule in order. What makes no sense goes to `findings`, and a value
    that can be computed with takes its place, so that one mistake hides no other.
    """

    def __init__(self) -> None:
        self._source = Source("", "")
        self.findings: list[Diagnostic] = []

    def start(self, source: Source) -> None:
        """Begin a source."""
        self._source, self.findings = source, []

    def span(self, children: list[Any]) -> Span:
        """Return the place from the first child to the last."""
        first, last = children[0], children[-1]
        start: int = first.start_pos if type(first) is Word else first.span.start
        end: int = last.end_pos if type(last) is Word else last.span.end
        return Span(self._source, start, end)

    def place(self, token: Word) -> Span:
        """Return the place of a token."""
        start = token.start_pos or 0
        return Span(self._source, start, start + len(token))

    def name_of(self, token: Word) -> Name:
        """Return the name that a token is."""
        return Name(self.place(token), token.value)

    def names_of(self, children: list[Any]) -> tuple[Name, ...]:
        """Return the names among the children."""
        return tuple(
            self.name_of(child) for child in children if type(child) is Word and child.type == "NAME"
        )

    def argument_of(self, child: Any) -> Name | Role:
        """Return the argument that a child is."""
        return self.name_of(child) if type(child) is Word else child

    def refuse(
        self,
        code: str,
        message: str,
        span: Span,
        note: str = "",
        help_text: str = "",
        edits: tuple[Edit, ...] = (),
        sure: bool = True,
    ) -> None:
        """Report an error; its statement will be left out."""
        self.findings.append(Diagnostic(code, message, span, note, help_text, edits=edits, sure=sure))

    def quantity(self, children: list[Any]) -> Quantity:
        """A number with its sign and unit, in SI."""
        span = self.span(children)
        last = children[-1]
        unit = last.value if last.type in ("UNIT", "PERCENT") else None
        value, dimension = to_si(_number(children[:-1] if unit else children), unit)
        if not math.isfinite(value):
            self.refuse("Q303", f"{span.text} is too large a number", span)
        return Quantity(span, value, dimension)

    def signed(self, children: list[Any]) -> Quantity:
        """A number with its sign."""
        return Quantity(self.span(children), _number(children), Dimension.NUMBER)

    def vector(self, children: list[Any]) -> Vector:
        """Quantities in parentheses."""
        return Vector(self.span(children), nodes_of(children, Quantity))

    def expect(self, quantity: Quantity, what: str, *allowed: Dimension) -> float:
        """Return the value of a quantity of one of the allowed dimensions; of any other it is refused."""
        if quantity.dimension in allowed:
            return quantity.value
        note = "expected " + " or ".join(EXAMPLES[dimension] for dimension in allowed)
        unit = likely_unit(quantity.value, allowed[0])
        if quantity.dimension is Dimension.NUMBER and unit:
            end = Span(quantity.span.source, quantity.span.end, quantity.span.end)
            remedy = f"write '{quantity.span.text} {unit}'"
            self.refuse(
                "Q301",
                f"{what} needs a unit",
                quantity.span,
                note,
                remedy,
                (Edit(end, f" {unit}"),),
                sure=False,
            )
        else:
            message = f"{what} has the unit of {quantity.dimension.value}"
            self.refuse("Q302", message, quantity.span, note)
        return math.nan

    def expect_positive(self, quantity: Quantity, what: str, *allowed: Dimension) -> float:
        """Return the value of a positive quantity; others are refused."""
        value = self.expect(quantity, what, *allowed)
        if value <= 0.0:
            self.refuse("Q303", f"{what} must be positive", quantity.span)
        return value

    def lengths(
        self, vector: Vector, what: str, sizes: tuple[int, ...], positive: bool = False
    ) -> tuple[float, ...]:
        """Return the lengths of a vector of one of the allowed sizes."""
        if len(vector.quantities) not in sizes:
            expected = " or ".join(map(str, sizes))
            self.refuse(
                "Q304", f"{what} has {len(vector.quantities)} values", vector.span, f"expected {expected}"
            )
            return (math.nan,) * sizes[0]
        take = self.expect_positive if positive else self.expect
        return tuple(take(quantity, what, LENGTH) for quantity in vector.quantities)

    def fields(self, children: list[Any], what: str) -> dict[str, Any]:
        """Return the fields among the children by their names, each given once."""
        found: dict[str, Field] = {}
        for field in nodes_of(children, Field):
            first = found.setdefault(field.key, field)
            if first is not field:
                self.refuse_again(f"the {what} '{field.key}'", field.span, first.span)
        return {key: field.value for key, field in found.items()}

    def refuse_again(self, what: str, span: Span, first: Span) -> None:
        """Report what is given twice, with both places."""
        labels = (Label(first, "first given here"),)
        self.findings.append(Diagnostic("Q305", f"{what} is given twice", span, labels=labels))

    def minutes(self, token: Word, latest: int = MINUTES_A_DAY - 1) -> int:
        """Return a time of day in minutes after midnight."""
        hours, minutes = (int(part) for part in token.split(":"))
        if minutes > 59 or 60 * hours + minutes > latest:
            self.refuse("Q303", f"'{token}' is no time of day", self.place(token), "expected 00:00 to 23:59")
        return 60 * hours + minutes


def nodes_of(children: list[Any], kind: type[Any]) -> tuple[Any, ...]:
    """Return the children of a kind."""
    return tuple(child for child in children if isinstance(child, kind))


def token_of(children: list[Any], *kinds: str) -> Word | None:
    """Return the first token of one of the kinds, or None."""
    return next((child for child in children if type(child) is Word and child.type in kinds), None)


def _number(children: list[Any]) -> float:
    value = float(children[-1])
    return -value if children[0] == "-" else value
