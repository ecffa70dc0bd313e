"""The nodes of a Document: frozen values in SI units, each with the place it was written at.

Places do not take part in comparison, so two texts that mean the same are equal.
"""

from __future__ import annotations

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
    """`relation(referent, relatum) wrt frame`."""

    relation: Name
    arguments: tuple[Name, ...]
    frame: Frame = Frame.RELATIVE


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


@dataclass(frozen=True, slots=True)
class Fit(Node):
    """A metric fit in the atom's frame: mean (x, y) [m], deviation (x, y) [m], correlation."""

    mean: tuple[float, float]
    deviation: tuple[float, float]
    correlation: float


@dataclass(frozen=True, slots=True)
class Language(Node):
    """The version of the language a file is written in."""

    version: int


@dataclass(frozen=True, slots=True)
class Import(Node):
    """Take over the definitions of another file."""

    target: str


@dataclass(frozen=True, slots=True)
class DeclaredClass(Node):
    """One class of a declaration: size (width, depth[, height]) [m], height of its surface [m], front, support."""

    name: Name
    size: tuple[float, ...] | None = None
    height: float | None = None
    front: bool = False
    on: Name | None = None


@dataclass(frozen=True, slots=True)
class Declaration(Node):
    """`surface`, `static` or `dynamic` classes."""

    kind: str
    classes: tuple[DeclaredClass, ...]


@dataclass(frozen=True, slots=True)
class Landmark(Node):
    """A named instance at (x, y[, z]) [m], the heading of its front [rad], and deviations (x, y[, heading])."""

    name: Name
    kind: Name
    position: tuple[float, ...]
    facing: float | None = None
    deviation: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Scene(Node):
    """Relations that hold together among the named classes."""

    name: Name | None
    classes: tuple[Name, ...]
    formula: Formula


@dataclass(frozen=True, slots=True)
class Alternative(Node):
    """One alternative of a belief; share is None where it is left out."""

    share: float | None
    formula: Formula
    fit: Fit | None = None


@dataclass(frozen=True, slots=True)
class Believe(Node):
    """Exclusive alternatives with shares."""

    alternatives: tuple[Alternative, ...]


@dataclass(frozen=True, slots=True)
class Observe(Node):
    """A formula that was seen `count` times, perhaps with a metric fit."""

    count: float
    formula: Formula
    fit: Fit | None = None


@dataclass(frozen=True, slots=True)
class ObserveScene(Node):
    """A named scene that was seen `count` times."""

    count: float
    scene: Name


@dataclass(frozen=True, slots=True)
class Relation(Node):
    """The definition of a relation."""

    name: Name
    parameters: tuple[Name, ...]
    angle: Density | None = None
    distance: Density | None = None
    converse: Name | None = None
    disjoint: tuple[Name, ...] = ()
    symmetric: bool = False


@dataclass(frozen=True, slots=True)
class Defaults(Node):
    """Named numbers that hold where nothing else is said."""

    values: tuple[tuple[Name, Quantity], ...]


Statement: TypeAlias = (
    Language
    | Import
    | Declaration
    | Landmark
    | Scene
    | Believe
    | Observe
    | ObserveScene
    | Relation
    | Defaults
)


@dataclass(frozen=True, slots=True)
class Document:
    """The statements of one text, in order."""

    statements: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class Where(Node):
    """`where target?`, or relative to a class: `where target wrt relatum?`."""

    target: Name
    relatum: Name | None = None
