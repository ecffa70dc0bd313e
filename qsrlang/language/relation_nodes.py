"""From parse trees to nodes: the definition of a relation, its densities on the circle and along the way."""

from __future__ import annotations

from typing import Any

from lark import Token
from lark.visitors import Transformer_NonRecursive, v_args

from qsrlang.language import syntax as s
from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.quantities import Refused, expect
from qsrlang.language.source import Source, Span

LENGTH, ANGLE, FRACTION = s.Dimension.LENGTH, s.Dimension.ANGLE, s.Dimension.FRACTION


@v_args(meta=True)
class RelationNodes(Transformer_NonRecursive[Token, Any]):
    """Builds the nodes of relation definitions of one source; raises Refused for values that make no sense."""

    def __init__(self, source: Source) -> None:
        super().__init__()
        self._source = source

    def _span(self, meta: Any) -> Span:
        return Span(self._source, meta.start_pos, meta.end_pos)

    def relation(self, meta: Any, children: list[Any]) -> s.Relation:
        """`relation left-of(referent, relatum) { angle: …, distance: … }`"""
        names = [child for child in children if isinstance(child, s.Name)]
        fields = [child for child in children if isinstance(child, tuple)]
        return s.Relation(self._span(meta), names[0], tuple(names[1:]), **self._once(fields, "field"))

    def angle(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`angle: normal(90 deg, 11.25 deg)`"""
        _check_density(children[1], "an angle", (ANGLE,))
        return "angle", self._span(meta), children[1]

    def distance(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`distance: uniform(0 %, 50 %)`"""
        density = children[1]
        if not isinstance(density, s.Uniform | s.Anywhere):
            help_text = "write 'distance: uniform(0 %, 50 %)', 'uniform(0 cm, 30 cm)' or 'any'"
            raise Refused(
                Diagnostic("Q302", "a distance is uniform between two bounds", density.span, help=help_text)
            )
        _check_density(density, "a distance", (LENGTH, FRACTION))
        _check_distance(density)
        return "distance", self._span(meta), density

    def converse(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`converse: right-of`"""
        return "converse", self._span(meta), children[1]

    def disjoint(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`disjoint: (right-of, behind-of)`"""
        return "disjoint", self._span(meta), tuple(children[1:])

    def symmetric(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`symmetric: yes`"""
        return "symmetric", self._span(meta), children[1] == "yes"

    def normal(self, meta: Any, children: list[Any]) -> s.Normal:
        """`normal(mean, deviation)`"""
        if children[2].value <= 0.0:
            raise Refused(Diagnostic("Q303", "a deviation must be positive", children[2].span))
        return s.Normal(self._span(meta), children[1], children[2])

    def uniform(self, meta: Any, children: list[Any]) -> s.Uniform:
        """`uniform(from, to)`"""
        if not children[1].value < children[2].value:
            raise Refused(Diagnostic("Q303", "the bounds of 'uniform' must rise", self._span(meta)))
        return s.Uniform(self._span(meta), children[1], children[2])

    def mix(self, meta: Any, children: list[Any]) -> s.Mix:
        """`mix(density, density)`, each with the same share."""
        return s.Mix(self._span(meta), tuple(children[1:]))

    def any(self, meta: Any, children: list[Any]) -> s.Anywhere:
        """`any`"""
        return s.Anywhere(self._span(meta))

    def _once(self, fields: list[tuple[str, Span, object]], what: str) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, span, value in fields:
            if key in found:
                raise Refused(Diagnostic("Q303", f"the {what} '{key}' is given twice", span))
            found[key] = value
        return found


def _check_density(density: s.Density, what: str, allowed: tuple[s.Dimension, ...]) -> None:
    match density:
        case s.Normal(mean=first, deviation=second) | s.Uniform(low=first, high=second):
            expect(first, what, *allowed)
            expect(second, what, *allowed)
        case s.Mix(parts=parts):
            for part in parts:
                _check_density(part, what, allowed)


def _check_distance(density: s.Density) -> None:
    if not isinstance(density, s.Uniform):
        return
    low, high = density.low, density.high
    if low.dimension is not high.dimension:
        raise Refused(Diagnostic("Q302", "both bounds must be lengths, or both percentages", density.span))
    top = 1.0 if low.dimension is FRACTION else float("inf")
    if low.value < 0.0 or high.value > top:
        raise Refused(
            Diagnostic("Q303", "a distance lies from 0 to 100 % of the way, or from 0 m", density.span)
        )
