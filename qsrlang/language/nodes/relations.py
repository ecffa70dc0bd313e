"""From rules to nodes: the definition of a relation, its densities on the circle and along the way."""

from __future__ import annotations

from typing import Any

from qsrlang.language import syntax as s
from qsrlang.language.nodes.builder import ANGLE, LENGTH, Builder, Field, nodes_of
from qsrlang.language.statements import Relation

FRACTION = s.Dimension.FRACTION
MAX_COMPONENTS = 64


class RelationNodes(Builder):
    """Builds the definitions of relations."""

    def relation(self, children: list[Any]) -> Relation:
        """`relation left-of(referent, relatum) { angle: …, distance: … }`"""
        name, *parameters = self.names_of(children)
        return Relation(self.span(children), name, tuple(parameters), **self.fields(children, "field"))

    def angle(self, children: list[Any]) -> Field:
        """`angle: normal(90 deg, 11.25 deg)`"""
        self._check_density(children[2], "an angle", ANGLE)
        return Field(self.span(children), "angle", children[2])

    def distance(self, children: list[Any]) -> Field:
        """`distance: uniform(0 %, 50 %)`"""
        density = children[2]
        if isinstance(density, s.Uniform | s.Anywhere):
            self._check_density(density, "a distance", LENGTH, FRACTION)
            self._check_bounds(density)
        else:
            help_text = "write 'distance: uniform(0 %, 50 %)', 'uniform(0 cm, 30 cm)' or 'any'"
            self.refuse("Q302", "a distance is uniform between two bounds", density.span, help_text=help_text)
        return Field(self.span(children), "distance", density)

    def region(self, children: list[Any]) -> Field:
        """`region: top`"""
        return Field(self.span(children), "region", children[2].value)

    def converse(self, children: list[Any]) -> Field:
        """`converse: right-of`"""
        return Field(self.span(children), "converse", self.name_of(children[2]))

    def disjoint(self, children: list[Any]) -> Field:
        """`disjoint: (right-of, behind-of)`"""
        return Field(self.span(children), "disjoint", self.names_of(children))

    def symmetric(self, children: list[Any]) -> Field:
        """`symmetric: yes`"""
        return Field(self.span(children), "symmetric", children[2] == "yes")

    def components(self, children: list[Any]) -> Field:
        """`components: 4`"""
        token = children[2]
        count = float(token)
        if count != int(min(count, 1e9)) or not 1 <= count <= MAX_COMPONENTS:
            self.refuse("Q303", f"expected 1 to {MAX_COMPONENTS} components", self.place(token))
        return Field(self.span(children), "components", int(min(count, MAX_COMPONENTS)))

    def normal(self, children: list[Any]) -> s.Normal:
        """`normal(mean, deviation)`"""
        _, mean, deviation = children[0], *nodes_of(children, s.Quantity)
        if deviation.value <= 0.0:
            self.refuse("Q303", "a deviation must be positive", deviation.span)
        return s.Normal(self.span(children), mean, deviation)

    def uniform(self, children: list[Any]) -> s.Uniform:
        """`uniform(from, to)`"""
        low, high = nodes_of(children, s.Quantity)
        span = self.span(children)
        if low.dimension is high.dimension and not low.value < high.value:
            self.refuse("Q303", "the bounds of 'uniform' must rise", span)
        return s.Uniform(span, low, high)

    def mix(self, children: list[Any]) -> s.Mix:
        """`mix(density, density)`, each with the same share."""
        return s.Mix(self.span(children), tuple(children[2:-1:2]))

    def any(self, children: list[Any]) -> s.Anywhere:
        """`any`"""
        return s.Anywhere(self.span(children))

    def _check_density(self, density: s.Density, what: str, *allowed: s.Dimension) -> None:
        match density:
            case s.Normal(mean=first, deviation=second) | s.Uniform(low=first, high=second):
                self.expect(first, what, *allowed)
                self.expect(second, what, *allowed)
            case s.Mix(parts=parts):
                for part in parts:
                    self._check_density(part, what, *allowed)

    def _check_bounds(self, density: s.Density) -> None:
        if not isinstance(density, s.Uniform):
            return
        low, high = density.low, density.high
        if {low.dimension, high.dimension} == {LENGTH, FRACTION}:
            self.refuse("Q302", "both bounds must be lengths, or both percentages", density.span)
        elif low.value < 0.0 or (low.dimension is FRACTION and high.value > 1.0):
            self.refuse("Q303", "a distance lies from 0 to 100 % of the way, or from 0 m", density.span)
