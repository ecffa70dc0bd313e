"""From rules to nodes: statements."""

from __future__ import annotations

import math
from typing import Any

from qsrlang.language import statements as st
from qsrlang.language import syntax as s
from qsrlang.language.nodes.builder import ANGLE, LENGTH, MINUTES_A_DAY, Builder, Field, Vector, nodes_of
from qsrlang.language.nodes.formulas import FormulaNodes
from qsrlang.language.nodes.relations import RelationNodes

_Head = tuple[st.Condition, ...]


class DeclarationNodes(Builder):
    """Builds what declares: versions, imports, defaults, classes and landmarks."""

    def language(self, children: list[Any]) -> st.Language:
        """`language 1`"""
        version = float(children[1])
        if version != int(min(version, 1e9)):
            self.refuse("Q303", "a language's version is a whole number", self.place(children[1]))
        return st.Language(self.span(children), int(min(version, 1e9)))

    def importing(self, children: list[Any]) -> st.Import:
        """`import "lab.qsr" as lab`"""
        alias = self.name_of(children[3]) if len(children) > 2 else None
        if alias is not None and "." in alias.text:
            self.refuse("Q303", "a prefix is one word", alias.span)
        return st.Import(self.span(children), children[1].value[1:-1], alias)

    def defaults(self, children: list[Any]) -> st.Defaults:
        """`defaults { reach: 75 cm }`"""
        return st.Defaults(self.span(children), tuple(field.value for field in nodes_of(children, Field)))

    def default(self, children: list[Any]) -> Field:
        """`reach: 75 cm`"""
        name = self.name_of(children[0])
        return Field(self.span(children), name.text, (name, children[2]))

    def declaration(self, children: list[Any]) -> st.Declaration:
        """`static Monitor { … }, Printer`"""
        return st.Declaration(self.span(children), children[0].value, tuple(children[1::2]))

    def declared(self, children: list[Any]) -> st.DeclaredClass:
        """One class with its properties."""
        name = self.name_of(children[0])
        return st.DeclaredClass(self.span(children), name, **self.fields(children, "property"))

    def size(self, children: list[Any]) -> Field:
        """`size: 55 cm × 20 cm × 40 cm`"""
        quantities = nodes_of(children, s.Quantity)
        sides = tuple(self.expect_positive(quantity, "a size", LENGTH) for quantity in quantities)
        return Field(self.span(children), "size", sides)

    def height(self, children: list[Any]) -> Field:
        """`height: 75 cm`"""
        return Field(self.span(children), "height", self.expect_positive(children[2], "a height", LENGTH))

    def front(self, children: list[Any]) -> Field:
        """`front: yes`"""
        return Field(self.span(children), "front", children[2] == "yes")

    def on(self, children: list[Any]) -> Field:
        """`on: Desk`"""
        return Field(self.span(children), "on", self.name_of(children[2]))

    def landmark(self, children: list[Any]) -> st.Landmark:
        """`landmark …` as a statement."""
        body: st.Landmark = children[1]
        return st.Landmark(
            self.span(children), body.name, body.kind, body.position, body.facing, body.deviation
        )

    def landmark_body(self, children: list[Any]) -> st.Landmark:
        """`monitor-1 : Monitor at (1 m, 2 m) facing -90 deg ± (2 cm, 2 cm, 3 deg)`"""
        name, kind = self.names_of(children)
        position = self.lengths(nodes_of(children, Vector)[0], "a landmark's position", (2, 3))
        options = {field.key: field.value for field in nodes_of(children, Field)}
        return st.Landmark(self.span(children), name, kind, position, **options)

    def facing(self, children: list[Any]) -> Field:
        """`facing -90 deg`"""
        return Field(self.span(children), "facing", self.expect(children[1], "a heading", ANGLE))

    def deviation(self, children: list[Any]) -> Field:
        """`± (2 cm, 2 cm, 3 deg)`"""
        vector: Vector = children[1]
        what = "a landmark's deviation"
        count = len(vector.quantities)
        if count not in (2, 3):
            self.refuse("Q304", f"{what} has {count} values", vector.span, "expected 2 or 3")
        values = [self.expect(quantity, what, LENGTH) for quantity in vector.quantities[:2]]
        values += [self.expect(one, "the deviation of a heading", ANGLE) for one in vector.quantities[2:3]]
        if min(values, default=math.nan) < 0.0:
            self.refuse("Q303", f"{what} must not be negative", vector.span)
        return Field(self.span(children), "deviation", tuple(values))


class StatementNodes(DeclarationNodes, RelationNodes, FormulaNodes):
    """Builds every statement."""

    def scene(self, children: list[Any]) -> st.Scene:
        """`scene name(A, B) ⇔ formula`; the name is optional."""
        named = children[1].type == "NAME"
        members = children[3 if named else 2 : -3 : 2]
        return st.Scene(
            self.span(children),
            self.name_of(children[1]) if named else None,
            tuple(self.argument_of(member) for member in members),
            children[-1],
        )

    def believe(self, children: list[Any]) -> st.Believe:
        """`believe 0.15 :: … | 0.85 :: …`"""
        return st.Believe(self.span(children), tuple(children[1::2]))

    def alternative(self, children: list[Any]) -> st.Alternative:
        """One alternative, its share if there is one and its fit if there is one."""
        share, formula = self.share_of(children), self.formula_of(children)
        return st.Alternative(self.span(children), share, formula, self.fit_of(children))

    def elsewhere(self, children: list[Any]) -> st.Alternative:
        """`0.1 :: elsewhere`"""
        nowhere = st.Elsewhere(self.place(children[-1]))
        return st.Alternative(self.span(children), self.share_of(children), nowhere)

    def observe(self, children: list[Any]) -> st.Observe:
        """`observe 85 × right-of(Cup, Keyboard) ~ normal(…)`"""
        count, formula = self.count_of(children), self.formula_of(children)
        return st.Observe(self.span(children), count, formula, self.fit_of(children))

    def observe_scene(self, children: list[Any]) -> st.ObserveScene:
        """`observe 12 × breakfast`"""
        return st.ObserveScene(self.span(children), self.count_of(children), self.name_of(children[-1]))

    def require(self, children: list[Any]) -> st.Require:
        """`require 0.9 :: ¬behind-of(Mug, Monitor)`"""
        return st.Require(self.span(children), self.share_of(children), children[-1])

    def room(self, children: list[Any]) -> st.Room:
        """`room r133`"""
        return st.Room(self.span(children), self.name_of(children[1]))

    def period(self, children: list[Any]) -> st.Period:
        """`from 08:00 to 12:00`"""
        start, end = self.minutes(children[1]), self.minutes(children[3], MINUTES_A_DAY)
        if start == end:
            self.refuse("Q303", "the period is empty", self.span(children), "it ends as it begins")
        return st.Period(self.span(children), start, end)

    def days(self, children: list[Any]) -> st.Days:
        """`weekday`"""
        return st.Days(self.span(children), children[0].value)

    def context_head(self, children: list[Any]) -> st.Context:
        """`in room r133, from 08:00 to 12:00 {`, without its statements."""
        conditions = nodes_of(children, st.Room | st.Period | st.Days)  # type: ignore[arg-type]
        return st.Context(self.span(children), conditions, ())

    def context(self, children: list[Any]) -> st.Context:
        """A head with its statements."""
        head: st.Context = children[0]
        return st.Context(self.span(children), head.conditions, nodes_of(children[1:], st.Statement))

    def document(self, children: list[Any]) -> st.Document:
        """A whole text."""
        return st.Document(nodes_of(children, st.Statement))
