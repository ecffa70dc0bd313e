"""Roles: objects that scenes tell apart among the instances of one class, and what may stand for them."""

from __future__ import annotations

from collections.abc import Collection

from qsrlang.relations.graph import Landmark, RelationGraph


def is_unplaced_role(graph: RelationGraph, name: str) -> bool:
    """Return whether a name is a role that no statement places, so that only landmarks of its class can."""
    return name in graph.roles and not graph.choices_for(name)


def instances_in_roles(graph: RelationGraph, kind: str) -> tuple[str, ...]:
    """Return what any instance of a class may be: each role that statements place, and the class if they place it too.

    Empty where no role is placed.
    """
    roles = tuple([role for role in graph.roles_of(kind) if graph.choices_for(role)])
    return (*roles, kind) if roles and graph.choices_for(kind) else roles


def landmarks_of_role(
    graph: RelationGraph, role: str, taken: Collection[str], waiting: int
) -> tuple[tuple[float, Landmark | None], ...]:
    """Return the landmarks that may stand for an unplaced role, each with its share; None is one that nobody saw.

    Roles of one class are different objects: landmarks whose names are `taken` stand for others already, and
    `waiting` roles of the class, this one included, share those that are left.
    """
    kind = graph.class_of(role)
    free = [one for one in graph.instances_of(kind) if one.name not in taken and one.name not in graph.roles]
    places = max(len(free), waiting)
    seen = tuple((1.0 / places, landmark) for landmark in free)
    return seen if len(free) == places else (*seen, (1.0 - len(free) / places, None))
