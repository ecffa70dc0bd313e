"""What is known of a place: classes, landmarks, and choices between constraints on ordered pairs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TypeAlias, TypeVar, cast

from qsrlang.language.source import Span
from qsrlang.language.syntax import Atom, Fit, Formula, Frame
from qsrlang.relations.calculus import Relation

_T = TypeVar("_T")
MAX_DERIVED, MAX_SIZE = 64, 256


@dataclass(frozen=True, slots=True)
class ObjectClass:
    """A class of objects: width (left to right), depth (front to back) and height [m], support, front."""

    name: str
    kind: str
    width: float = 0.0
    depth: float = 0.0
    height: float = 0.0
    front: bool = False
    on: str | None = None

    @property
    def is_surface(self) -> bool:
        """Whether its top supports things."""
        return self.kind == "surface"


@dataclass(frozen=True, slots=True)
class Landmark:
    """A named instance with a known pose: position [m], heading [rad] or None, deviations [m, m, rad]."""

    name: str
    kind: str
    x: float
    y: float
    z: float | None = None
    heading: float | None = None
    deviation: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Statement:
    """Where a piece of knowledge was written, and its text on one line."""

    file: str
    line: int
    text: str

    @classmethod
    def at(cls, span: Span) -> Statement:
        """Return the statement written at a place."""
        return cls(span.source.name, span.line, " ".join(span.text.split()).removesuffix("."))

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.text}"


@dataclass(frozen=True, slots=True)
class AtomicRelation:
    """A relation in a frame of reference; `atom` is where it was written."""

    relation: Relation
    frame: Frame
    atom: Atom | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Constraint:
    """What one statement says of where `referent` lies as seen from `relatum`: atoms that all hold, or a fit.

    Atoms of ternary relations have a second relatum, `towards`: their axis runs from `relatum` to it, and their
    distances are shares of the way between the two. `part` (j, k) is the j-th of k parts of equal mass, from one end
    of its directions to the other; (0, 1) is the whole.
    """

    referent: str
    relatum: str
    atoms: tuple[AtomicRelation, ...]
    statement: Statement
    fit: Fit | None = None
    towards: str | None = None
    part: tuple[int, int] = (0, 1)

    @property
    def parts(self) -> int:
        """In how many parts it is split: the least `components` of the atoms that tell a direction, else of all."""
        if self.fit is not None:
            return 1
        directed = [atom.relation.components for atom in self.atoms if atom.relation.angle is not None]
        return min(directed or [atom.relation.components for atom in self.atoms], default=1)

    def __hash__(self) -> int:
        return hash((self.referent, self.relatum, self.towards, self.statement.line, self.part))

    @property
    def relata(self) -> tuple[str, ...]:
        """The names it places its referent by."""
        return (self.relatum,) if self.towards is None else (self.relatum, self.towards)


@dataclass(frozen=True, slots=True)
class Alternative:
    """Constraints that hold together, with their share among the alternatives of a choice."""

    share: float
    constraints: tuple[Constraint, ...]


class Authority(IntEnum):
    """What wins where several statements speak of one pair: shares over counts over scenes."""

    SCENE = 1
    COUNT = 2
    SHARE = 3


Pair: TypeAlias = tuple[str, str]


def pair_of(constraint: Constraint, node_of: Callable[[str], str]) -> Pair:
    """Return (referent, relatum) by their classes; two relata make one: `between(X, A, B)` gives (X, "A and B")."""
    referent, relatum = node_of(constraint.referent), node_of(constraint.relatum)
    return referent, relatum if constraint.towards is None else f"{relatum} and {node_of(constraint.towards)}"


@dataclass(frozen=True, slots=True)
class Choice:
    """Exclusive alternatives for the pairs of classes it governs; shares below 1 leave the rest to `elsewhere`.

    An alternative may speak of further pairs, which then hold together with it (the atoms of one scene).
    """

    authority: Authority
    governs: frozenset[Pair]
    alternatives: tuple[Alternative, ...]


@dataclass(frozen=True, slots=True)
class Requirement:
    """A formula that holds: always where share is None (hard), else with this probability (soft)."""

    share: float | None
    formula: Formula
    statement: Statement


@dataclass(frozen=True, slots=True)
class RelationGraph:
    """All that is known: an edge (referent, relatum) for every pair that a choice speaks of.

    `roles` maps the objects that scenes tell apart by a role, such as `left: Cup`, to their classes; `scenes` maps the
    names of those that have one to their members. `evidence` are the referents whose places landmarks
    give.
    """

    classes: Mapping[str, ObjectClass]
    relations: Mapping[str, Relation]
    landmarks: tuple[Landmark, ...]
    choices: tuple[Choice, ...]
    reach: float
    roles: Mapping[str, str] = field(default_factory=dict)
    requirements: tuple[Requirement, ...] = ()
    scenes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    _choices_of: Mapping[str, tuple[Choice, ...]] = field(init=False, repr=False, compare=False)
    _instances_of: Mapping[str, tuple[Landmark, ...]] = field(init=False, repr=False, compare=False)
    _kinds: Mapping[str, str] = field(init=False, repr=False, compare=False)
    _nodes: Mapping[str, str] = field(init=False, repr=False, compare=False)
    _roles_of: Mapping[str, tuple[str, ...]] = field(init=False, repr=False, compare=False)
    evidence: tuple[str, ...] = field(init=False, repr=False, compare=False)
    _derived: dict[object, object] = field(default_factory=dict, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        choices: dict[str, list[Choice]] = defaultdict(list)
        for choice in self.choices:
            for referent in dict.fromkeys(pair[0] for pair in sorted(choice.governs)):
                choices[referent].append(choice)
        instances: dict[str, list[Landmark]] = defaultdict(list)
        for landmark in self.landmarks:
            for name in dict.fromkeys((landmark.name, landmark.kind)):
                instances[name].append(landmark)
        kinds = {**self.roles, **{landmark.name: landmark.kind for landmark in reversed(self.landmarks)}}
        object.__setattr__(self, "_kinds", kinds)
        object.__setattr__(self, "_nodes", {**kinds, **{role: role for role in self.roles}})
        roles: dict[str, list[str]] = defaultdict(list)
        for role, kind in self.roles.items():
            roles[kind].append(role)
        object.__setattr__(self, "_roles_of", {kind: tuple(found) for kind, found in roles.items()})
        object.__setattr__(self, "evidence", tuple(sorted(self._referents() & instances.keys())))
        object.__setattr__(self, "_choices_of", {name: tuple(found) for name, found in choices.items()})
        object.__setattr__(self, "_instances_of", {name: tuple(found) for name, found in instances.items()})

    def derived(self, key: Hashable, derive: Callable[[], _T], size: Callable[[_T], int]) -> _T:
        """Return what follows from the graph alone, derived when it is first asked for.

        Up to MAX_DERIVED things of a `size` up to MAX_SIZE are kept.
        """
        if key in self._derived:
            return cast(_T, self._derived[key])
        found = derive()
        if size(found) <= MAX_SIZE:
            if len(self._derived) >= MAX_DERIVED:
                self._derived.clear()
            self._derived[key] = found
        return found

    def _referents(self) -> set[str]:
        return {
            one.referent
            for choice in self.choices
            for alternative in choice.alternatives
            for one in alternative.constraints
        }

    def node_of(self, name: str) -> str:
        """Return what statements about a name are about: a role is its own, a landmark counts as its class."""
        return self._nodes.get(name, name)

    def pair_of(self, constraint: Constraint) -> Pair:
        """Return the ordered pair that a constraint speaks of, as choices govern it."""
        return pair_of(constraint, self.node_of)

    def choices_for(self, referent: str) -> tuple[Choice, ...]:
        """Return the choices that say where `referent` is."""
        return self._choices_of.get(referent, ())

    def class_of(self, name: str) -> str:
        """Return the class that the name of a class, a landmark or a role stands for."""
        return self._kinds.get(name, name)

    def roles_of(self, kind: str) -> tuple[str, ...]:
        """Return the objects that scenes tell apart by a role among the instances of a class."""
        return self._roles_of.get(kind, ())

    def instances_of(self, name: str) -> tuple[Landmark, ...]:
        """Return the landmarks that a class or landmark name stands for."""
        return self._instances_of.get(name, ())
