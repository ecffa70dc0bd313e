"""Names under a prefix: what `import "lab.qsr" as lab` does to the names of a document."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import fields, replace
from typing import Any, TypeVar

from qsrlang.language.statements import Defaults, Document, Import, Language, Relation, Room, Scene
from qsrlang.language.syntax import Name, Node, Role

_N = TypeVar("_N", bound=Node)


def under_prefix(document: Document, prefix: str, spared: Set[str]) -> Document:
    """Return a document whose classes, landmarks, relations and scenes bear a prefix, but for the spared names.

    The places stay those of the names as they were written.
    """
    return Document(tuple(_renamed(statement, prefix, spared) for statement in document.statements))


def _renamed(value: Any, prefix: str, spared: Set[str]) -> Any:
    match value:
        case Name():
            return value if value.text in spared else replace(value, text=f"{prefix}.{value.text}")
        case Role():
            return replace(value, kind=_renamed(value.kind, prefix, spared))
        case Import() | Language() | Defaults() | Room():
            return value
        case Relation(parameters=parameters):
            return replace(_each(value, prefix, spared), parameters=parameters)
        case Scene(members=members):
            roles = {member.role.text for member in members if isinstance(member, Role)}
            return _each(value, prefix, spared | roles)
        case Node():
            return _each(value, prefix, spared)
        case tuple():
            return type(value)(_renamed(one, prefix, spared) for one in value)
        case _:
            return value


def _each(node: _N, prefix: str, spared: Set[str]) -> _N:
    named = (field.name for field in fields(node) if field.name not in ("span", "doc"))
    return replace(node, **{name: _renamed(getattr(node, name), prefix, spared) for name in named})
