"""From nodes to the values that names stand for."""

from __future__ import annotations

from functools import lru_cache

from qsrlang.language import statements as st
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import Landmark, ObjectClass


def class_value(node: st.DeclaredClass, kind: str) -> ObjectClass:
    """Return the class that a node declares."""
    width, depth, height = (*(node.size or (0.0, 0.0)), 0.0)[:3]
    support = node.on.text if node.on else None
    return ObjectClass(node.name.text, kind, width, depth, node.height or height, node.front, support)


def landmark_value(node: st.Landmark) -> Landmark:
    """Return the landmark that a node describes."""
    z = node.position[2] if len(node.position) > 2 else None
    deviation = (*node.deviation, 0.0, 0.0, 0.0)[:3] if node.deviation else (0.0, 0.0, 0.0)
    x, y = node.position[:2]
    return Landmark(
        node.name.text, node.kind.text, x, y, z, node.facing, (deviation[0], deviation[1], deviation[2])
    )


def relation_value(node: st.Relation) -> Relation:
    """Return the relation that a node defines."""
    converse = node.converse.text if node.converse else None
    disjoint = tuple(name.text for name in node.disjoint)
    arity = len(node.parameters)
    return _only_one(
        Relation(
            node.name.text,
            node.angle,
            node.distance,
            converse,
            disjoint,
            node.symmetric,
            node.region,
            arity,
            node.components,
        )
    )


@lru_cache(maxsize=4096)
def _only_one(relation: Relation) -> Relation:
    """Return the first relation that is equal to one, so that they are told to be equal at a glance."""
    return relation
