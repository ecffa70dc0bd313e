"""The words of the language as nodes: names, quantities, densities and formulas; frozen, in SI units, with places.

Places do not take part in comparison, so two texts that mean the same are equal.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

from qsrlang.language.source import Span


class Frame(Enum):
    """The frame of reference of an atom."""

    RELATIVE = "relative"
    INTRINSIC = "intrinsic"
    ABSOLUTE = "absolute"


class Dimension(Enum):
    """What a quantity measures."""

    LENGTH = "a length"
    ANGLE = "an angle"
    DURATION = "a duration"
    FRACTION = "a percentage"
    NUMBER = "a bare number"


@dataclass(frozen=True, slots=True)
class Node:
    """Something written at a place."""

    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Name(Node):
    """A word that names a class, a landmark, a relation or a scene."""

    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class Role(Node):
    """One of several instances of a class: `left: Cup`; within its scene, `left` alone means it too."""

    role: Name
    kind: Name

    @property
    def text(self) -> str:
        """How the instance is named in answers."""
        return f"{self.role.text}: {self.kind.text}"

    def __str__(self) -> str:
        return self.text


Argument: TypeAlias = Name | Role


@dataclass(frozen=True, slots=True)
class Quantity(Node):
    """A value in metres, radians, seconds, as a fraction or as a bare number."""

    value: float
    dimension: Dimension


@dataclass(frozen=True, slots=True)
class Normal(Node):
    """A normal density; on the circle it is wrapped."""

    mean: Quantity
    deviation: Quantity


@dataclass(frozen=True, slots=True)
class Uniform(Node):
    """A uniform density from `low` to `high`; on the circle, counter-clockwise."""

    low: Quantity
    high: Quantity


@dataclass(frozen=True, slots=True)
class Mix(Node):
    """An equal mixture of densities."""

    parts: tuple[Density, ...]


@dataclass(frozen=True, slots=True)
class Anywhere(Node):
    """The density that says nothing."""


Density: TypeAlias = Normal | Uniform | Mix | Anywhere


@dataclass(frozen=True, slots=True)
class Atom(Node):
    """`relation(referent, relatum) wrt frame`; `framed` tells whether the frame was written."""

    relation: Name
    arguments: tuple[Argument, ...]
    frame: Frame = Frame.RELATIVE
    framed: bool = field(default=False, compare=False)


@dataclass(frozen=True, slots=True)
class And(Node):
    """All parts hold."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Or(Node):
    """One of the parts holds."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Not(Node):
    """The part does not hold."""

    part: Formula


Formula: TypeAlias = Atom | And | Or | Not


def atoms_of(formula: Formula) -> Iterator[Atom]:
    """Yield the atoms of a formula in the order they were written."""
    waiting: list[Formula] = [formula]
    while waiting:
        match waiting.pop():
            case Atom() as atom:
                yield atom
            case Not(part=part):
                waiting.append(part)
            case And(parts=parts) | Or(parts=parts):
                waiting.extend(reversed(parts))


@dataclass(frozen=True, slots=True)
class Fit(Node):
    """A metric fit in the atom's frame: mean (x, y) [m], deviation (x, y) [m], correlation."""

    mean: tuple[float, float]
    deviation: tuple[float, float]
    correlation: float
