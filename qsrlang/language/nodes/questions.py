"""From rules to nodes: queries."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from qsrlang.language import questions as q
from qsrlang.language import syntax as s
from qsrlang.language.nodes.builder import nodes_of, token_of
from qsrlang.language.nodes.statements import StatementNodes
from qsrlang.language.statements import Days, Room

DEFAULT_SCENES = 1
MAX_SCENES = 1_000_000


@dataclass(frozen=True, slots=True)
class _Given(s.Node):
    """What is assumed, until its query takes it."""

    formula: s.Formula


class NodeBuilder(StatementNodes):
    """Builds every node of the language."""

    def query(self, children: list[Any]) -> q.Query:
        """A question with what it assumes and where and when it is asked."""
        question: q.Query = children[0]
        given = next((one.formula for one in nodes_of(children, _Given)), None)
        circumstances = next(iter(nodes_of(children, q.Circumstances)), None)
        return replace(question, given=given, circumstances=circumstances)

    def where(self, children: list[Any]) -> q.Where:
        """`where Cup wrt Keyboard`"""
        return q.Where(self.span(children), self.argument_of(children[1]), self._relatum(children))

    def prob(self, children: list[Any]) -> q.Prob:
        """`prob right-of(Cup, Keyboard)`"""
        return q.Prob(self.span(children), children[1])

    def explain(self, children: list[Any]) -> q.Explain:
        """`explain Cup`"""
        return q.Explain(self.span(children), self.argument_of(children[1]), self._relatum(children))

    def explain_formula(self, children: list[Any]) -> q.Explain:
        """`explain right-of(Cup, Keyboard)`"""
        return q.Explain(self.span(children), children[1])

    def views(self, children: list[Any]) -> q.Views:
        """`views Cup`"""
        return q.Views(self.span(children), self.argument_of(children[1]))

    def landmarks(self, children: list[Any]) -> q.Landmarks:
        """`landmarks Cup`"""
        return q.Landmarks(self.span(children), self.argument_of(children[1]))

    def sample(self, children: list[Any]) -> q.Sample:
        """`sample desk 100`"""
        subject, token = token_of(children, "NAME"), token_of(children, "NUMBER")
        count = DEFAULT_SCENES if token is None else float(token)
        if token is not None and (count != int(min(count, 1e9)) or not 1 <= count <= MAX_SCENES):
            self.refuse("Q303", f"expected 1 to {MAX_SCENES} scenes", self.place(token))
        named = None if subject is None else self.name_of(subject)
        return q.Sample(self.span(children), named, int(min(count, MAX_SCENES)))

    def check(self, children: list[Any]) -> q.Check:
        """`check`"""
        return q.Check(self.span(children))

    def given(self, children: list[Any]) -> _Given:
        """`given left-of(Cup, Keyboard)`"""
        return _Given(self.span(children), children[1])

    def circumstances(self, children: list[Any]) -> q.Circumstances:
        """`in room r133, weekend at 09:30`"""
        rooms, days = nodes_of(children, Room), nodes_of(children, Days)
        for given, what in ((rooms, "room"), (days, "day")):
            for again in given[1:]:
                self.refuse_again(f"the {what}", again.span, given[0].span)
        time = token_of(children, "TIME")
        return q.Circumstances(
            self.span(children),
            rooms[0].name if rooms else None,
            days[0].days if days else None,
            None if time is None else self.minutes(time),
        )

    def _relatum(self, children: list[Any]) -> s.Name | None:
        return self.name_of(children[3]) if len(children) > 2 else None
