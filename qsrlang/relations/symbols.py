"""What the names of a library stand for."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import TypeVar

from qsrlang.language.diagnostics import Diagnostic, Edit, Label, Severity
from qsrlang.language.quantities import likely_unit
from qsrlang.language.source import Source
from qsrlang.language.statements import (
    Context,
    Declaration,
    DeclaredClass,
    Defaults,
    Scene,
    Statement,
)
from qsrlang.language.statements import Landmark as LandmarkNode
from qsrlang.language.statements import (
    Relation as RelationNode,
)
from qsrlang.language.syntax import Atom, Dimension, Name, Node, Quantity, Role
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import Landmark, ObjectClass
from qsrlang.relations.values import class_value, landmark_value, relation_value

_DEFAULTS = {"reach": Dimension.LENGTH, "strength": Dimension.NUMBER}
_SURELY_MEANT = 0.8
_IMPORTS = {0: "", 1: " or in the import"}
_T = TypeVar("_T")


@dataclass(slots=True)
class Symbols:
    """The names of a library, while they are being gathered, with what was found wrong.

    `places` tells where each (kind, name) is defined, kind one of class, landmark, relation and scene; `lost` are
    names whose definition could not be read, so that no further error follows from that; `imports` is how many
    files are imported, and `source` the file that imports them; `related` are the atoms that say where something is.
    """

    lost: frozenset[str] = frozenset()
    imports: int = 0
    source: Source | None = None
    classes: dict[str, ObjectClass] = field(default_factory=dict)
    landmarks: dict[str, Landmark] = field(default_factory=dict)
    relations: dict[str, Relation] = field(default_factory=dict)
    scenes: dict[str, Scene] = field(default_factory=dict)
    roles: dict[str, str] = field(default_factory=dict)
    defaults: dict[str, float] = field(default_factory=dict)
    places: dict[tuple[str, str], Name] = field(default_factory=dict)
    related: list[Atom] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def gather(self, statements: Iterable[Statement]) -> None:
        """Take in every definition, then check what they refer to."""
        everything = tuple(flat(statements))
        for statement in everything:
            self._define(statement)
        for statement in everything:
            self._check(statement)

    def report(
        self,
        code: str,
        message: str,
        node: Node,
        note: str = "",
        help_text: str = "",
        labels: tuple[Label, ...] = (),
        severity: Severity = Severity.ERROR,
    ) -> None:
        """Add a finding."""
        self.diagnostics.append(Diagnostic(code, message, node.span, note, help_text, labels, severity))

    def resolve_class(self, argument: Name | Role) -> str | None:
        """Return the class that an argument stands for; None, reported, where there is none."""
        if isinstance(argument, Role):
            kind = self.resolve_class(argument.kind)
            if kind is not None:
                self.roles[argument.text] = kind
            return kind
        if argument.text in self.landmarks:
            kind = self.landmarks[argument.text].kind
            return kind if kind in self.classes else None
        if argument.text in self.classes:
            return argument.text
        self._unknown("Q201", "class", argument, [*self.classes, *self.landmarks])
        return None

    def resolve_relation(self, name: Name) -> Relation | None:
        """Return the relation of a name; None, reported, where there is none."""
        if name.text not in self.relations:
            self._unknown("Q203", "relation", name, self.relations)
        return self.relations.get(name.text)

    def resolve_scene(self, name: Name) -> Scene | None:
        """Return the scene of a name; None, reported, where there is none."""
        if name.text not in self.scenes:
            self._unknown("Q204", "scene", name, self.scenes)
        return self.scenes.get(name.text)

    def class_of(self, name: str) -> str:
        """Return the class of a landmark; other names stand for themselves."""
        return self.landmarks[name].kind if name in self.landmarks else name

    def _define(self, statement: Statement) -> None:
        match statement:
            case Declaration():
                for declared in statement.classes:
                    value = class_value(declared, statement.kind)
                    self._add("Q205", "class", self.classes, declared.name, value)
            case LandmarkNode():
                self._add("Q206", "landmark", self.landmarks, statement.name, landmark_value(statement))
            case RelationNode():
                self._add("Q207", "relation", self.relations, statement.name, relation_value(statement))
            case Scene(name=Name() as name):
                self._add("Q208", "scene", self.scenes, name, statement)
            case Defaults():
                for name, quantity in statement.values:
                    self._set_default(name, quantity)

    def _add(self, code: str, kind: str, table: dict[str, _T], name: Name, value: _T) -> None:
        first = self.places.setdefault((kind, name.text), name)
        if first is name:
            table[name.text] = value
            return
        message = f"{kind} '{name.text}' is defined twice"
        if first.span.source is self.source and name.span.source is not self.source:
            labels = (Label(name.span, "defined here too"),)
            self.report(code, message, first, "an import defines it", labels=labels)
        else:
            labels = (Label(first.span, "first defined here"),)
            self.report(code, message, name, "and here again", labels=labels)

    def _set_default(self, name: Name, quantity: Quantity) -> None:
        expected = _DEFAULTS.get(name.text)
        if expected is None:
            self._unknown("Q210", "default", name, _DEFAULTS)
        elif quantity.dimension is Dimension.NUMBER and expected is Dimension.LENGTH:
            unit = likely_unit(quantity.value, expected)
            end = replace(quantity.span, start=quantity.span.end)
            message, help_text = f"the default '{name}' needs a unit", f"write '{quantity.span.text} {unit}'"
            edits = (Edit(end, f" {unit}"),)
            self.diagnostics.append(
                Diagnostic("Q301", message, quantity.span, "", help_text, edits=edits, sure=False)
            )
        elif quantity.dimension is not expected:
            self.report("Q302", f"the default '{name}' is {expected.value}", quantity)
        elif quantity.value <= 0.0:
            self.report("Q303", f"the default '{name}' must be positive", quantity)
        else:
            self.defaults[name.text] = quantity.value

    def _check(self, statement: Statement) -> None:
        match statement:
            case Scene(members=members):
                self._adopt([member.kind if isinstance(member, Role) else member for member in members])
            case Declaration(classes=declared):
                for one in declared:
                    self._check_support(one)
            case LandmarkNode(kind=kind):
                self._check_landmark(statement, kind)
            case RelationNode():
                self._check_relation(statement)

    def _adopt(self, names: list[Name]) -> None:
        """A scene may bring in classes that no statement declares: their sizes are then unknown."""
        known = {*self.classes, *self.landmarks, *self.lost}
        fresh = [name for name in names if name.text not in known]
        for name in fresh:
            self.classes[name.text] = ObjectClass(name.text, "dynamic")
        if fresh:
            listed = ", ".join(dict.fromkeys(name.text for name in fresh))
            help_text = f"declare them, for instance 'dynamic {listed}.'"
            message, note = f"no statement declares {listed}", "taken as points without size or support"
            self.report("Q502", message, fresh[0], note, help_text, severity=Severity.WARNING)

    def _check_support(self, declared: DeclaredClass) -> None:
        if declared.on is None or self.resolve_class(declared.on) is None:
            return
        support = self.classes.get(declared.on.text)
        if support is None or not support.is_surface:
            place = self.places.get(("class", declared.on.text))
            labels = (Label(place.span, "declared here"),) if place else ()
            help_text = f"declare 'surface {declared.on}.'"
            self.report("Q201", f"'{declared.on}' is no surface", declared.on, "", help_text, labels)

    def _check_landmark(self, landmark: LandmarkNode, kind: Name) -> None:
        if landmark.name.text in self.classes:
            place = self.places.get(("class", landmark.name.text))
            labels = (Label(place.span, "the class is declared here"),) if place else ()
            self.report("Q206", f"'{landmark.name}' names a class already", landmark.name, labels=labels)
        known = self.classes.get(kind.text)
        if known is None:
            self._unknown("Q201", "class", kind, self.classes)
        elif known.kind == "dynamic":
            place = self.places.get(("class", kind.text))
            labels = (Label(place.span, "declared dynamic here"),) if place else ()
            message = f"'{landmark.name}' is of the dynamic class '{kind}'"
            note = "dynamic objects move; its pose holds only as long as it was just seen"
            self.report("Q501", message, kind, note, labels=labels, severity=Severity.WARNING)

    def _check_relation(self, relation: RelationNode) -> None:
        if len(relation.parameters) not in (2, 3):
            count = len(relation.parameters)
            message = f"'{relation.name}' has {count} parameter{'s' if count > 1 else ''}"
            note = "a relation has a referent and one or two relata"
            self.report("Q404", message, relation.parameters[-1], note)
        if relation.angle is None and relation.distance is None and relation.region is None:
            help_text = "give it an angle, a distance or a region"
            self.report("Q411", f"'{relation.name}' says nothing of a place", relation.name, "", help_text)
        if relation.region is not None and (relation.angle, relation.distance) != (None, None):
            note = "the region says where the referent is"
            self.report(
                "Q412", f"'{relation.name}' has a region beside an angle or a distance", relation.name, note
            )
        if relation.region is not None and relation.components > 1:
            note = "a region is one component"
            self.report("Q412", f"'{relation.name}' has a region beside components", relation.name, note)
        for name in (*relation.disjoint, *filter(None, [relation.converse])):
            self.resolve_relation(name)

    def _unknown(self, code: str, kind: str, name: Name, known: Iterable[str]) -> None:
        if name.text in self.lost:
            return
        known = list(known)
        qualified = [one for one in known if one.endswith(f".{name.text}")]
        nearest = qualified if len(qualified) == 1 else difflib.get_close_matches(name.text, known, n=1)
        note = (
            f"no {kind} of this name here{_IMPORTS.get(self.imports, f' or in the {self.imports} imports')}"
        )
        if not nearest:
            self.report(code, f"unknown {kind} '{name}'", name, note)
            return
        sure = difflib.SequenceMatcher(a=name.text, b=nearest[0]).ratio() >= _SURELY_MEANT
        help_text = f"did you mean '{nearest[0]}'{self._place_of(kind, nearest[0])}?"
        edits = (Edit(name.span, nearest[0].removeprefix(_prefix(name))),)
        self.diagnostics.append(
            Diagnostic(code, f"unknown {kind} '{name}'", name.span, note, help_text, edits=edits, sure=sure)
        )

    def _place_of(self, kind: str, name: str) -> str:
        place = self.places.get((kind, name)) or self.places.get(("landmark", name))
        return f" ({place.span.source.name}:{place.span.line})" if place else ""


def flat(statements: Iterable[Statement]) -> Iterable[Statement]:
    """Yield statements, those inside contexts too."""
    for statement in statements:
        yield statement
        if isinstance(statement, Context):
            yield from statement.statements


def _prefix(name: Name) -> str:
    """Return what an import put before a name that was written without it."""
    return name.text.removesuffix(name.span.text)
