"""From parse trees to nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from lark import Token, Transformer, Tree
from lark.visitors import v_args

from qsrlang.language import syntax as s
from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.quantities import Refused, convert, expect, expect_positive
from qsrlang.language.relation_nodes import RelationNodes
from qsrlang.language.source import Source, Span

LENGTH, ANGLE = s.Dimension.LENGTH, s.Dimension.ANGLE


@v_args(meta=True)
class NodeBuilder(RelationNodes):
    """Builds the nodes of one source; raises Refused for values that make no sense."""

    def document(self, meta: Any, children: list[Any]) -> s.Document:
        """A whole text."""
        return s.Document(tuple(children))

    def name(self, meta: Any, children: list[Any]) -> s.Name:
        """A word."""
        return s.Name(self._span(meta), str(children[0]))

    def signed(self, meta: Any, children: list[Any]) -> float:
        """A number with its sign."""
        return float("".join(children))

    def quantity(self, meta: Any, children: list[Any]) -> s.Quantity:
        """A number with its unit, in SI."""
        return convert(self._span(meta), children[0], str(children[1]) if len(children) > 1 else None)

    def vector(self, meta: Any, children: list[Any]) -> tuple[Span, tuple[s.Quantity, ...]]:
        """Quantities in parentheses."""
        return self._span(meta), tuple(children)

    def dimensions(self, meta: Any, children: list[Any]) -> tuple[float, ...]:
        """A size: width, depth and perhaps height."""
        quantities = [child for child in children if isinstance(child, s.Quantity)]
        return tuple(expect_positive(quantity, "a size", LENGTH) for quantity in quantities)

    def language(self, meta: Any, children: list[Any]) -> s.Language:
        """`language 1.`"""
        return s.Language(self._span(meta), int(children[1]))

    def importing(self, meta: Any, children: list[Any]) -> s.Import:
        """`import "office/desk".`"""
        return s.Import(self._span(meta), str(children[1])[1:-1])

    def declaration(self, meta: Any, children: list[Any]) -> s.Declaration:
        """`static Monitor { … }, Printer.`"""
        return s.Declaration(self._span(meta), str(children[0]), tuple(children[1:]))

    def declared(self, meta: Any, children: list[Any]) -> s.DeclaredClass:
        """One class with its properties."""
        return s.DeclaredClass(self._span(meta), children[0], **self._once(children[1:], "property"))

    def size(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`size: 55 cm × 20 cm × 40 cm`"""
        return "size", self._span(meta), children[1]

    def height(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`height: 75 cm`"""
        return "height", self._span(meta), expect_positive(children[1], "a height", LENGTH)

    def front(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`front: yes`"""
        return "front", self._span(meta), children[1] == "yes"

    def on(self, meta: Any, children: list[Any]) -> tuple[str, Span, object]:
        """`on: Desk`"""
        return "on", self._span(meta), children[1]

    def landmark(self, meta: Any, children: list[Any]) -> s.Landmark:
        """`landmark …` as a statement."""
        body: s.Landmark = children[1]
        return s.Landmark(self._span(meta), body.name, body.kind, body.position, body.facing, body.deviation)

    def landmark_body(self, meta: Any, children: list[Any]) -> s.Landmark:
        """`monitor-1 : Monitor at (1 m, 2 m) facing -90 deg ± (2 cm, 2 cm, 3 deg)`"""
        name, kind, _, at, *rest = children
        position = self._lengths(at, "a landmark's position", (2, 3))
        options = {str(token.type): value for token, value in zip(rest[::2], rest[1::2], strict=True)}
        facing = options.get("FACING")
        heading = None if facing is None else expect(facing, "a heading", ANGLE)
        deviation = self._deviation(options.get("PLUSMINUS"))
        return s.Landmark(self._span(meta), name, kind, position, heading, deviation)

    def scene(self, meta: Any, children: list[Any]) -> s.Scene:
        """`scene name(A, B) ⇔ formula`; the name is optional."""
        head = self._source.text[children[0].end_pos : children[1].span.start]
        names = [child for child in children if isinstance(child, s.Name)]
        title = None if "(" in head else names.pop(0)
        return s.Scene(self._span(meta), title, tuple(names), children[-1])

    def believe(self, meta: Any, children: list[Any]) -> s.Believe:
        """`believe 0.15 :: … | 0.85 :: …`"""
        return s.Believe(self._span(meta), tuple(children[1:]))

    def alternative(self, meta: Any, children: list[Any]) -> s.Alternative:
        """One alternative, its share if there is one and its fit if there is one."""
        parts = [child for child in children if not isinstance(child, Token)]
        share = parts.pop(0) if isinstance(parts[0], float) else None
        return s.Alternative(self._span(meta), share, parts[0], parts[1] if len(parts) > 1 else None)

    def share(self, meta: Any, children: list[Any]) -> float:
        """`0.15` or `15 %`"""
        return float(children[0]) / (100.0 if len(children) > 1 else 1.0)

    def count(self, meta: Any, children: list[Any]) -> float:
        """`85`"""
        value = float(children[0])
        if value == float("inf"):
            raise Refused(Diagnostic("Q303", "a count is too large a number", self._span(meta)))
        return value

    def observe(self, meta: Any, children: list[Any]) -> s.Observe:
        """`observe 85 × right-of(Cup, Keyboard) ~ normal(…)`"""
        count, (formula, *fit) = self._counted(children)
        return s.Observe(self._span(meta), count, formula, fit[0] if fit else None)

    def observe_scene(self, meta: Any, children: list[Any]) -> s.ObserveScene:
        """`observe 12 × breakfast`"""
        count, (scene,) = self._counted(children)
        return s.ObserveScene(self._span(meta), count, scene)

    def fit(self, meta: Any, children: list[Any]) -> s.Fit:
        """`~ normal((x, y), (sd x, sd y), correlation)`"""
        mean = self._lengths(children[1], "the mean of a fit", (2,))
        deviation = self._lengths(children[2], "the deviation of a fit", (2,), positive=True)
        correlation = children[3] if len(children) > 3 else 0.0
        if not abs(correlation) < 1.0:
            raise Refused(
                Diagnostic("Q303", "a correlation lies strictly between -1 and 1", self._span(meta))
            )
        return s.Fit(self._span(meta), (mean[0], mean[1]), (deviation[0], deviation[1]), correlation)

    def conjunction(self, meta: Any, children: list[Any]) -> s.Formula:
        """`a ∧ b ∧ c`, n-ary."""
        return s.And(self._span(meta), _flat(children, s.And))

    def disjunction(self, meta: Any, children: list[Any]) -> s.Formula:
        """`a ∨ b ∨ c`, n-ary."""
        parts = _flat(children, s.Or)
        return parts[0] if len(parts) == 1 else s.Or(self._span(meta), parts)

    def negation(self, meta: Any, children: list[Any]) -> s.Formula:
        """`¬ a`; a double negation is none."""
        part = children[1]
        return part.part if isinstance(part, s.Not) else s.Not(self._span(meta), part)

    def atom(self, meta: Any, children: list[Any]) -> s.Atom:
        """`left-of(Cup, Keyboard) wrt intrinsic`"""
        names = tuple(child for child in children if isinstance(child, s.Name))
        framed = isinstance(children[-1], Token) and children[-1].type == "FRAME"
        frame = s.Frame(str(children[-1])) if framed else s.Frame.RELATIVE
        return s.Atom(self._span(meta), names[0], names[1:], frame)

    def defaults(self, meta: Any, children: list[Any]) -> s.Defaults:
        """`defaults { reach: 75 cm }`"""
        return s.Defaults(self._span(meta), tuple(children[1:]))

    def default(self, meta: Any, children: list[Any]) -> tuple[s.Name, s.Quantity]:
        """`reach: 75 cm`"""
        return children[0], children[1]

    def query(self, meta: Any, children: list[Any]) -> s.Where:
        """`where Cup wrt Keyboard?`"""
        return s.Where(self._span(meta), children[1], children[3] if len(children) > 2 else None)

    def _counted(self, children: list[Any]) -> tuple[float, list[Any]]:
        parts = [child for child in children if not isinstance(child, Token)]
        return (parts[0], parts[1:]) if isinstance(parts[0], float) else (1.0, parts)

    def _lengths(
        self,
        vector: tuple[Span, tuple[s.Quantity, ...]],
        what: str,
        sizes: tuple[int, ...],
        positive: bool = False,
    ) -> tuple[float, ...]:
        span, quantities = vector
        if len(quantities) not in sizes:
            expected = " or ".join(map(str, sizes))
            raise Refused(
                Diagnostic("Q304", f"{what} has {len(quantities)} values", span, f"expected {expected}")
            )
        take: Callable[..., float] = expect_positive if positive else expect
        return tuple(take(quantity, what, LENGTH) for quantity in quantities)

    def _deviation(self, vector: tuple[Span, tuple[s.Quantity, ...]] | None) -> tuple[float, ...]:
        if vector is None:
            return ()
        span, quantities = vector
        what = "a landmark's deviation"
        if len(quantities) not in (2, 3):
            raise Refused(Diagnostic("Q304", f"{what} has {len(quantities)} values", span, "expected 2 or 3"))
        values = [expect(quantity, what, LENGTH) for quantity in quantities[:2]]
        values += [expect(quantity, "the deviation of a heading", ANGLE) for quantity in quantities[2:]]
        if min(values) < 0.0:
            raise Refused(Diagnostic("Q303", f"{what} must not be negative", span))
        return tuple(values)


def build(tree: Tree[Token], source: Source) -> Any:
    """Return the node that a parse tree stands for."""
    builder: Transformer[Token, Any] = NodeBuilder(source)
    return builder.transform(tree)


def _flat(children: list[Any], kind: type[s.And] | type[s.Or]) -> tuple[s.Formula, ...]:
    parts: list[s.Formula] = []
    for child in children:
        if isinstance(child, Token):
            continue
        parts.extend(child.parts if isinstance(child, kind) else (child,))
    return tuple(parts)
