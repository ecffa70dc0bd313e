"""Every place of a library where a name is written, for what follows names: navigation, renaming, completion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from qsrlang.language import statements as st
from qsrlang.language.source import Span
from qsrlang.language.syntax import Argument, Formula, Name, Role, atoms_of
from qsrlang.relations.imports import Library

_PREFIXED = ("class", "landmark", "relation", "scene")
_NO_ROLES: Mapping[str, Role] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A name at the place of its own text, prefixes left out, and whether the place defines it.

    `kind` is class, landmark, relation, scene, role, default, room or prefix. A role bears its class in its name,
    `left: Cup`, for it is one object wherever both are written; a prefix bears those before it, `lab.north`.
    """

    kind: str
    name: str
    span: Span
    defines: bool = False


def occurrences(library: Library) -> tuple[Occurrence, ...]:
    """Return every occurrence of a name in the documents of a library, document by document in the order of the text.

    Classes that no statement declares are defined by the scenes that bring them in.
    """
    reading = _Reading(_defined(library, st.Landmark), _defined(library, st.DeclaredClass))
    found: list[Occurrence] = []
    for document in library.documents:
        own = [one for statement in document.statements for one in reading.of(statement)]
        found += sorted(_with_prefixes(own), key=lambda one: one.span.start)
    return tuple(found)


@dataclass(frozen=True, slots=True)
class _Reading:
    """What is needed to tell landmarks from classes, and declared classes from others."""

    landmarks: frozenset[str]
    classes: frozenset[str]

    def of(self, statement: st.Statement) -> Iterator[Occurrence]:
        """Yield the occurrences in a statement."""
        match statement:
            case st.Context(conditions=conditions, statements=inner):
                rooms = (one.name for one in conditions if isinstance(one, st.Room))
                yield from (Occurrence("room", name.text, name.span) for name in rooms)
                yield from (one for part in inner for one in self.of(part))
            case st.Scene():
                yield from self._scene(statement)
            case st.Believe(alternatives=alternatives):
                for one in alternatives:
                    if not isinstance(one.formula, st.Elsewhere):
                        yield from self._formula(one.formula)
            case st.Observe(formula=formula) | st.Require(formula=formula):
                yield from self._formula(formula)
            case st.ObserveScene(scene=name):
                yield Occurrence("scene", name.text, name.span)
            case _:
                yield from _definitions(statement)

    def _scene(self, scene: st.Scene) -> Iterator[Occurrence]:
        if scene.name is not None:
            yield Occurrence("scene", scene.name.text, scene.name.span, defines=True)
        for member in scene.members:
            yield from self._member(member)
        roles = {member.role.text: member for member in scene.members if isinstance(member, Role)}
        yield from self._formula(scene.formula, roles)

    def _member(self, member: Argument) -> Iterator[Occurrence]:
        if isinstance(member, Role):
            yield Occurrence("role", member.text, member.role.span, defines=True)
            yield from self._member(member.kind)
        else:
            (own,) = self._argument(member, _NO_ROLES)
            undeclared = own.kind == "class" and own.name not in self.classes
            yield replace(own, defines=undeclared)

    def _formula(self, formula: Formula, roles: Mapping[str, Role] = _NO_ROLES) -> Iterator[Occurrence]:
        for atom in atoms_of(formula):
            yield Occurrence("relation", atom.relation.text, atom.relation.span)
            for argument in atom.arguments:
                yield from self._argument(argument, roles)

    def _argument(self, argument: Argument, roles: Mapping[str, Role]) -> Iterator[Occurrence]:
        match argument:
            case Role(role=role, kind=kind):
                yield Occurrence("role", argument.text, role.span)
                yield Occurrence("class", kind.text, kind.span)
            case Name(text=text, span=span) if text in roles:
                yield Occurrence("role", roles[text].text, span)
            case Name(text=text, span=span):
                yield Occurrence("landmark" if text in self.landmarks else "class", text, span)


def _definitions(statement: st.Statement) -> Iterator[Occurrence]:
    """Yield the occurrences in a statement that has no formula."""
    match statement:
        case st.Declaration(classes=classes):
            for one in classes:
                yield Occurrence("class", one.name.text, one.name.span, defines=True)
                if one.on is not None:
                    yield Occurrence("class", one.on.text, one.on.span)
        case st.Landmark(name=name, kind=kind):
            yield Occurrence("landmark", name.text, name.span, defines=True)
            yield Occurrence("class", kind.text, kind.span)
        case st.Relation(name=name):
            yield Occurrence("relation", name.text, name.span, defines=True)
            for other in (*statement.disjoint, *filter(None, [statement.converse])):
                yield Occurrence("relation", other.text, other.span)
        case st.Defaults(values=values):
            yield from (Occurrence("default", name.text, name.span, defines=True) for name, _ in values)
        case st.Import(alias=Name() as alias):
            yield Occurrence("prefix", alias.text, alias.span, defines=True)


def _with_prefixes(own: list[Occurrence]) -> Iterator[Occurrence]:
    """Yield the occurrences of a document, its prefixes and what is written before a full stop among them."""
    aliases = frozenset(one.name for one in own if one.kind == "prefix")
    imported = (one.name.removesuffix(one.span.text) for one in own if one.kind in _PREFIXED)
    before = next((prefix for prefix in imported if prefix), "")
    for one in own:
        if one.kind == "prefix":
            yield replace(one, name=before + one.name)
        elif one.kind in _PREFIXED:
            yield from _parts(one, aliases)
        else:
            yield one


def _parts(one: Occurrence, aliases: frozenset[str]) -> Iterator[Occurrence]:
    """Yield the prefixes that are written before a name, then the name at the place of its own text."""
    written = one.span.text
    if "." not in written or written.partition(".")[0] not in aliases:
        yield one
        return
    start = one.span.start
    before = one.name.removesuffix(written)
    for part in written.split(".")[:-1]:
        yield Occurrence("prefix", before + part, Span(one.span.source, start, start + len(part)))
        before += f"{part}."
        start += len(part) + 1
    yield replace(one, span=Span(one.span.source, start, one.span.end))


def _defined(library: Library, kind: type[st.Landmark] | type[st.DeclaredClass]) -> frozenset[str]:
    statements = (statement for document in library.documents for statement in document.statements)
    nodes = (
        node for one in statements for node in (one.classes if isinstance(one, st.Declaration) else (one,))
    )
    return frozenset(node.name.text for node in nodes if isinstance(node, kind))
