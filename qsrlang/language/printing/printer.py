"""From nodes to text: what is printed reads back as the same nodes."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from qsrlang.language import questions as q
from qsrlang.language import statements as st
from qsrlang.language import syntax as s
from qsrlang.language.printing.amounts import amount_text, number_text, quantity_text, signed_text
from qsrlang.language.printing.formatter import format_source
from qsrlang.language.printing.spelling import SIGNS, Spelling
from qsrlang.language.source import Source

LENGTH, ANGLE = s.Dimension.LENGTH, s.Dimension.ANGLE


def print_document(document: st.Document, spelling: Spelling = "unicode") -> str:
    """Return the canonical text of a document: `parse(print_document(d)).document == d`."""
    return _formatted(_Printer(spelling).statements(document.statements), spelling)


def print_statement(statement: st.Statement, spelling: Spelling = "unicode") -> str:
    """Return the canonical text of a statement with its doc comment and its full stop, without a last line end."""
    return _formatted(_Printer(spelling).statements([statement]), spelling).removesuffix("\n")


def print_formula(formula: s.Formula, spelling: Spelling = "unicode") -> str:
    """Return a formula on one line."""
    return _Printer(spelling).formula(formula)


def print_query(query: q.Query, spelling: Spelling = "unicode") -> str:
    """Return a query with its question mark, on one line: `parse_query(print_query(q)) == q`."""
    return _Printer(spelling).query(query)


def _formatted(text: str, spelling: Spelling) -> str:
    return format_source(Source("<printed>", text), spelling)


class _Printer:
    """Writes nodes in one spelling, each statement on one line; the formatter finds the line ends."""

    def __init__(self, spelling: Spelling) -> None:
        signs = SIGNS[spelling]
        self._and, self._or, self._iff = f" {signs['AND']} ", f" {signs['OR']} ", signs["IFF"]
        self._not = "¬" if spelling == "unicode" else f"{signs['NOT']} "
        self._times, self._plus_minus = signs["TIMES"], signs["PLUSMINUS"]

    def statements(self, statements: Iterable[st.Statement]) -> str:
        """Return statements with their doc comments, in groups of one kind."""
        listed = [*statements]
        texts = [f"{_doc(one.doc)}{self.statement(one)}" for one in listed]
        gaps = ["\n" if _are_apart(one, other) else "" for one, other in pairwise(listed)]
        return "\n".join(f"{gap}{text}" for gap, text in zip(["", *gaps], texts, strict=False))

    def statement(self, statement: st.Statement) -> str:
        """Return a statement without its doc comment."""
        match statement:
            case st.Context(conditions=conditions, statements=inner):
                listed = ", ".join(_condition(one) for one in conditions)
                return f"in {listed} {{\n{self.statements(inner)}\n}}"
            case _:
                return f"{self._statement(statement)}."

    def _statement(self, statement: st.Statement) -> str:
        match statement:
            case st.Language(version=version):
                return f"language {version}"
            case st.Import(target=target, alias=alias):
                return f'import "{target}"' + (f" as {alias}" if alias else "")
            case st.Defaults(values=values):
                return f"defaults {_braced(f'{name}: {quantity_text(value)}' for name, value in values)}"
            case st.Declaration(kind=kind, classes=classes):
                return f"{kind} {', '.join(self._declared(one) for one in classes)}"
            case st.Landmark():
                return self._landmark(statement)
            case st.Relation():
                return self._relation(statement)
            case _:
                return self._claim(statement)

    def _claim(self, statement: st.Statement) -> str:
        match statement:
            case st.Scene(name=name, members=members, formula=formula):
                head = f"scene {name}" if name else "scene"
                return f"{head}({_listed(members)}) {self._iff} {self.formula(formula)}"
            case st.Believe(alternatives=alternatives):
                return f"believe {' | '.join(self._alternative(one) for one in alternatives)}"
            case st.Observe(count=count, formula=formula, fit=fit):
                return f"observe {self._count(count)}{self.formula(formula)}{_fit(fit)}"
            case st.ObserveScene(count=count, scene=scene):
                return f"observe {self._count(count)}{scene}"
            case st.Require(share=share, formula=formula):
                return f"require {_share(share)}{self.formula(formula)}"
        raise TypeError(f"{type(statement).__name__} is no statement of the language")

    def formula(self, formula: s.Formula) -> str:
        """Return a formula with no more parentheses than it needs."""
        match formula:
            case s.Atom():
                return f"({_atom(formula)})" if _is_misread(formula) else _atom(formula)
            case s.Not(part=part):
                return f"{self._not}{self._literal(part)}"
            case s.And(parts=parts):
                return self._and.join(self._literal(part) for part in parts)
            case s.Or(parts=parts):
                return self._or.join(self.formula(part) for part in parts)

    def _literal(self, formula: s.Formula) -> str:
        text = self.formula(formula)
        return f"({text})" if isinstance(formula, s.And | s.Or) else text

    def _count(self, count: float) -> str:
        return "" if count == 1.0 else f"{number_text(count)} {self._times} "

    def _alternative(self, alternative: st.Alternative) -> str:
        share = _share(alternative.share)
        if isinstance(alternative.formula, st.Elsewhere):
            return f"{share}elsewhere"
        return f"{share}{self.formula(alternative.formula)}{_fit(alternative.fit)}"

    def _declared(self, declared: st.DeclaredClass) -> str:
        fields = []
        if declared.size is not None:
            fields.append(
                "size: " + f" {self._times} ".join(amount_text(side, LENGTH) for side in declared.size)
            )
        if declared.height is not None:
            fields.append(f"height: {amount_text(declared.height, LENGTH)}")
        if declared.front:
            fields.append("front: yes")
        if declared.on is not None:
            fields.append(f"on: {declared.on}")
        return f"{declared.name} {_braced(fields)}" if fields else declared.name.text

    def _landmark(self, landmark: st.Landmark) -> str:
        text = f"landmark {landmark.name} : {landmark.kind} at {_lengths(landmark.position)}"
        if landmark.facing is not None:
            text += f" facing {amount_text(landmark.facing, ANGLE)}"
        if landmark.deviation:
            sides = [amount_text(one, LENGTH) for one in landmark.deviation[:2]]
            turns = [amount_text(one, ANGLE) for one in landmark.deviation[2:]]
            text += f" {self._plus_minus} ({', '.join([*sides, *turns])})"
        return text

    def _relation(self, relation: st.Relation) -> str:
        fields = []
        if relation.angle is not None:
            fields.append(f"angle: {_density(relation.angle)}")
        if relation.distance is not None:
            fields.append(f"distance: {_density(relation.distance)}")
        if relation.region is not None:
            fields.append(f"region: {relation.region}")
        if relation.converse is not None:
            fields.append(f"converse: {relation.converse}")
        if relation.disjoint:
            names = _listed(relation.disjoint)
            fields.append(f"disjoint: {names}" if len(relation.disjoint) == 1 else f"disjoint: ({names})")
        if relation.symmetric or not fields:
            fields.append(f"symmetric: {'yes' if relation.symmetric else 'no'}")
        if relation.components > 1:
            fields.append(f"components: {relation.components}")
        return f"relation {relation.name}({_listed(relation.parameters)}) {_braced(fields)}"

    def query(self, query: q.Query) -> str:
        """Return a query with its question mark."""
        given = f" given {self.formula(query.given)}" if query.given else ""
        return f"{self._question(query)}{given}{_circumstances(query.circumstances)}?"

    def _question(self, query: q.Query) -> str:
        match query:
            case q.Where(target=target, relatum=relatum):
                return f"where {target}" + (f" wrt {relatum}" if relatum else "")
            case q.Prob(formula=formula):
                return f"prob {self.formula(formula)}"
            case q.Explain(subject=s.Atom() as atom):
                return f"explain {_atom(atom)}"
            case q.Explain(subject=subject, relatum=relatum):
                return f"explain {subject}" + (f" wrt {relatum}" if relatum else "")
            case q.Views(target=target):
                return f"views {target}"
            case q.Landmarks(target=target):
                return f"landmarks {target}"
            case q.Sample(subject=named, count=count):
                return " ".join(
                    ["sample", *([str(named)] if named else []), *([str(count)] if count != 1 else [])]
                )
            case q.Check():
                return "check"


def _are_apart(one: st.Statement, other: st.Statement) -> bool:
    return type(one) is not type(other) or bool(other.doc) or isinstance(other, st.Context)


def _doc(doc: str) -> str:
    return "".join(f"## {line}".rstrip() + "\n" for line in doc.split("\n")) if doc else ""


def _is_misread(atom: s.Atom) -> bool:
    """Whether an alternative cannot begin with this atom, because `elsewhere` begins it."""
    return atom.relation.text.split(".")[0] == "elsewhere"


def _atom(atom: s.Atom) -> str:
    frame = "" if atom.frame is s.Frame.RELATIVE else f" wrt {atom.frame.value}"
    return f"{atom.relation}({_listed(atom.arguments)}){frame}"


def _listed(names: Iterable[s.Argument]) -> str:
    return ", ".join(map(str, names))


def _braced(fields: Iterable[str]) -> str:
    return f"{{ {', '.join(fields)} }}"


def _share(share: float | None) -> str:
    return "" if share is None else f"{number_text(share)} :: "


def _lengths(values: Iterable[float]) -> str:
    return f"({', '.join(amount_text(one, LENGTH) for one in values)})"


def _fit(fit: s.Fit | None) -> str:
    if fit is None:
        return ""
    correlation = f", {signed_text(fit.correlation)}" if fit.correlation else ""
    return f" ~ normal({_lengths(fit.mean)}, {_lengths(fit.deviation)}{correlation})"


def _density(density: s.Density) -> str:
    match density:
        case s.Normal(mean=first, deviation=second):
            return f"normal({quantity_text(first)}, {quantity_text(second)})"
        case s.Uniform(low=first, high=second):
            return f"uniform({quantity_text(first)}, {quantity_text(second)})"
        case s.Mix(parts=parts):
            return f"mix({', '.join(map(_density, parts))})"
        case s.Anywhere():
            return "any"


def _condition(condition: st.Condition) -> str:
    match condition:
        case st.Room(name=name):
            return f"room {name}"
        case st.Period(start=start, end=end):
            return f"from {_time(start)} to {_time(end)}"
        case st.Days(days=days):
            return days


def _circumstances(circumstances: q.Circumstances | None) -> str:
    if circumstances is None:
        return ""
    room = [f"room {circumstances.room}"] if circumstances.room else []
    said = [*room, *([circumstances.days] if circumstances.days else [])]
    at = "" if circumstances.time is None else f" at {_time(circumstances.time)}"
    return (f" in {', '.join(said)}" if said else "") + at


def _time(minutes: int) -> str:
    return f"{minutes // 60:02}:{minutes % 60:02}"
