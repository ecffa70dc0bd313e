"""What the names of a library stand for."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeVar

from qsrlang.language import syntax as s
from qsrlang.language.diagnostics import Diagnostic, Label, Severity
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import Landmark, ObjectClass

_DEFAULTS = {"reach": s.Dimension.LENGTH, "strength": s.Dimension.NUMBER}
_T = TypeVar("_T")


@dataclass(slots=True)
class Symbols:
    """The names of a library, while they are being gathered, with what was found wrong."""

    classes: dict[str, ObjectClass] = field(default_factory=dict)
    landmarks: dict[str, Landmark] = field(default_factory=dict)
    relations: dict[str, Relation] = field(default_factory=dict)
    scenes: dict[str, s.Scene] = field(default_factory=dict)
    defaults: dict[str, float] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    _places: dict[tuple[str, str], s.Node] = field(default_factory=dict)

    def gather(self, statements: Iterable[s.Statement]) -> None:
        """Take in every definition, then check what they refer to."""
        statements = tuple(statements)
        for statement in statements:
            self._define(statement)
        for statement in statements:
            self._check(statement)

    def report(self, code: str, message: str, node: s.Node, note: str = "", help_text: str = "") -> None:
        """Add an error."""
        self.diagnostics.append(Diagnostic(code, message, node.span, note, help_text))

    def resolve_class(self, name: s.Name) -> str | None:
        """Return the class a class or landmark name stands for; None, reported, where there is none."""
        if name.text in self.landmarks:
            return self.landmarks[name.text].kind
        if name.text in self.classes:
            return name.text
        self._unknown("Q201", "class", name, [*self.classes, *self.landmarks])
        return None

    def resolve_relation(self, name: s.Name) -> Relation | None:
        """Return the relation of a name; None, reported, where there is none."""
        if name.text not in self.relations:
            self._unknown("Q203", "relation", name, self.relations)
        return self.relations.get(name.text)

    def resolve_scene(self, name: s.Name) -> s.Scene | None:
        """Return the scene of a name; None, reported, where there is none."""
        if name.text not in self.scenes:
            self._unknown("Q204", "scene", name, self.scenes)
        return self.scenes.get(name.text)

    def _define(self, statement: s.Statement) -> None:
        match statement:
            case s.Declaration():
                for declared in statement.classes:
                    value = _object_class(declared, statement.kind)
                    self._add("Q205", "class", self.classes, declared.name, value)
            case s.Landmark():
                self._add("Q206", "landmark", self.landmarks, statement.name, landmark_value(statement))
            case s.Relation():
                self._add("Q207", "relation", self.relations, statement.name, _relation_value(statement))
            case s.Scene(name=s.Name() as name):
                self._add("Q208", "scene", self.scenes, name, statement)
            case s.Defaults():
                for name, quantity in statement.values:
                    self._set_default(name, quantity)

    def _add(self, code: str, kind: str, table: dict[str, _T], name: s.Name, value: _T) -> None:
        first = self._places.setdefault((kind, name.text), name)
        if first is name:
            table[name.text] = value
            return
        label = Label(first.span, "first defined here")
        message = f"{kind} '{name.text}' is defined twice"
        self.diagnostics.append(Diagnostic(code, message, name.span, "and here again", labels=(label,)))

    def _set_default(self, name: s.Name, quantity: s.Quantity) -> None:
        dimension = _DEFAULTS.get(name.text)
        if dimension is None:
            self._unknown("Q210", "default", name, _DEFAULTS)
        elif quantity.dimension is not dimension:
            self.report("Q302", f"the default '{name}' is {dimension.value}", quantity)
        elif quantity.value <= 0.0:
            self.report("Q303", f"the default '{name}' must be positive", quantity)
        else:
            self.defaults[name.text] = quantity.value

    def _check(self, statement: s.Statement) -> None:
        match statement:
            case s.Scene(classes=classes):
                self._adopt(statement, [name for name in classes if name.text not in self.classes])
            case s.Declaration(classes=declared):
                for one in declared:
                    self._check_support(one)
            case s.Landmark(kind=kind):
                self._check_landmark(statement, kind)
            case s.Relation():
                self._check_relation(statement)

    def _adopt(self, scene: s.Scene, names: list[s.Name]) -> None:
        """A scene may bring in classes that no statement declares: their sizes are then unknown."""
        fresh = [name for name in names if name.text not in self.landmarks]
        for name in fresh:
            self.classes[name.text] = ObjectClass(name.text, "dynamic")
        if fresh:
            listed = ", ".join(name.text for name in fresh)
            message = f"no statement declares {listed}"
            note = "taken as points without size or support"
            help_text = f"declare them, for instance 'dynamic {listed}.'"
            self.diagnostics.append(
                Diagnostic("Q502", message, fresh[0].span, note, help_text, severity=Severity.WARNING)
            )

    def _check_support(self, declared: s.DeclaredClass) -> None:
        if declared.on is None or self.resolve_class(declared.on) is None:
            return
        if not self.classes[declared.on.text].is_surface:
            self.report(
                "Q201",
                f"'{declared.on}' is no surface",
                declared.on,
                help_text=f"declare 'surface {declared.on}.'",
            )

    def _check_landmark(self, landmark: s.Landmark, kind: s.Name) -> None:
        if landmark.name.text in self.classes:
            self.report("Q206", f"'{landmark.name}' names a class already", landmark.name)
        known = self.classes.get(kind.text)
        if known is None:
            self._unknown("Q201", "class", kind, self.classes)
        elif known.kind == "dynamic":
            message = f"'{landmark.name}' is of the dynamic class '{kind}'"
            note = "dynamic objects move; its pose holds only as long as it was just seen"
            self.diagnostics.append(Diagnostic("Q501", message, kind.span, note, severity=Severity.WARNING))

    def _check_relation(self, relation: s.Relation) -> None:
        if len(relation.parameters) != 2:
            message = f"'{relation.name}' has {len(relation.parameters)} parameters"
            self.report("Q404", message, relation.parameters[-1], "a relation has a referent and a relatum")
        for name in (*relation.disjoint, *filter(None, [relation.converse])):
            self.resolve_relation(name)

    def _unknown(self, code: str, kind: str, name: s.Name, known: Iterable[str]) -> None:
        nearest = difflib.get_close_matches(name.text, list(known), n=1)
        hint = f"did you mean '{nearest[0]}'?" if nearest else ""
        self.report(
            code,
            f"unknown {kind} '{name}'",
            name,
            f"no {kind} of this name here or in what is imported",
            hint,
        )


def landmark_value(node: s.Landmark) -> Landmark:
    """Return the landmark that a node describes."""
    z = node.position[2] if len(node.position) > 2 else None
    deviation = (*node.deviation, 0.0, 0.0, 0.0)[:3] if node.deviation else (0.0, 0.0, 0.0)
    x, y = node.position[:2]
    return Landmark(
        node.name.text, node.kind.text, x, y, z, node.facing, (deviation[0], deviation[1], deviation[2])
    )


def _object_class(node: s.DeclaredClass, kind: str) -> ObjectClass:
    width, depth, height = (*(node.size or (0.0, 0.0)), 0.0)[:3]
    support = node.on.text if node.on else None
    return ObjectClass(node.name.text, kind, width, depth, node.height or height, node.front, support)


def _relation_value(node: s.Relation) -> Relation:
    converse = node.converse.text if node.converse else None
    disjoint = tuple(name.text for name in node.disjoint)
    return Relation(node.name.text, node.angle, node.distance, converse, disjoint, node.symmetric)
