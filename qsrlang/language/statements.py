"""The statements of a Document: frozen values in SI units, each with its place and its doc comment."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from qsrlang.language.syntax import Argument, Density, Fit, Formula, Name, Node, Quantity


@dataclass(frozen=True, slots=True)
class Statement(Node):
    """Something a file states; `doc` is the doc comment (`## ...`) before it, its lines joined by line ends."""

    doc: str = field(default="", kw_only=True)


@dataclass(frozen=True, slots=True)
class Language(Statement):
    """The version of the language a file is written in."""

    version: int


@dataclass(frozen=True, slots=True)
class Import(Statement):
    """Take over the definitions of another file, perhaps each under a prefix: `import "lab.qsr" as lab`."""

    target: str
    alias: Name | None = None


@dataclass(frozen=True, slots=True)
class DeclaredClass(Node):
    """One class of a declaration: size (width, depth[, height]) [m], height of its surface [m], front, support."""

    name: Name
    size: tuple[float, ...] | None = None
    height: float | None = None
    front: bool = False
    on: Name | None = None


@dataclass(frozen=True, slots=True)
class Declaration(Statement):
    """`surface`, `static` or `dynamic` classes."""

    kind: str
    classes: tuple[DeclaredClass, ...]


@dataclass(frozen=True, slots=True)
class Landmark(Statement):
    """A named instance at (x, y[, z]) [m], the heading of its front [rad], and deviations (x, y[, heading])."""

    name: Name
    kind: Name
    position: tuple[float, ...]
    facing: float | None = None
    deviation: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Scene(Statement):
    """Relations that hold together among the members: classes, landmarks and roles."""

    name: Name | None
    members: tuple[Argument, ...]
    formula: Formula


@dataclass(frozen=True, slots=True)
class Elsewhere(Node):
    """The alternative that none of the others names: somewhere no statement speaks of."""


@dataclass(frozen=True, slots=True)
class Alternative(Node):
    """One alternative of a belief; share is None where it is left out."""

    share: float | None
    formula: Formula | Elsewhere
    fit: Fit | None = None


@dataclass(frozen=True, slots=True)
class Believe(Statement):
    """Exclusive alternatives with shares."""

    alternatives: tuple[Alternative, ...]


@dataclass(frozen=True, slots=True)
class Observe(Statement):
    """A formula that was seen `count` times, perhaps with a metric fit."""

    count: float
    formula: Formula
    fit: Fit | None = None


@dataclass(frozen=True, slots=True)
class ObserveScene(Statement):
    """A named scene that was seen `count` times."""

    count: float
    scene: Name


@dataclass(frozen=True, slots=True)
class Require(Statement):
    """A formula that holds: always where share is None (hard), else with this probability (soft)."""

    share: float | None
    formula: Formula


@dataclass(frozen=True, slots=True)
class Relation(Statement):
    """The definition of a relation; `region` is the part of the relatum the referent lies in, "top" or "inside"."""

    name: Name
    parameters: tuple[Name, ...]
    angle: Density | None = None
    distance: Density | None = None
    region: str | None = None
    converse: Name | None = None
    disjoint: tuple[Name, ...] = ()
    symmetric: bool = False
    components: int = 1


@dataclass(frozen=True, slots=True)
class Defaults(Statement):
    """Named numbers that hold where nothing else is said."""

    values: tuple[tuple[Name, Quantity], ...]


@dataclass(frozen=True, slots=True)
class Room(Node):
    """In the room of this name."""

    name: Name


@dataclass(frozen=True, slots=True)
class Period(Node):
    """From `start` up to but not including `end`, in minutes after midnight; it may wrap midnight."""

    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Days(Node):
    """On a "weekday" (Monday to Friday) or on the "weekend"."""

    days: str


Condition: TypeAlias = Room | Period | Days


@dataclass(frozen=True, slots=True)
class Context(Statement):
    """Statements that hold where and when all conditions do."""

    conditions: tuple[Condition, ...]
    statements: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class Document:
    """The statements of one text, in order."""

    statements: tuple[Statement, ...]
