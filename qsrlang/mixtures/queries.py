"""Questions to what is known, and their answers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np

from qsrlang.errors import UnansweredQueryError, UnknownNameError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.language import questions
from qsrlang.language.diagnostics import Diagnostic, raise_errors
from qsrlang.language.parser import parse_landmark, parse_query
from qsrlang.language.source import Source
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.inference import Engine, where_on_map, where_relative, where_relative_to
from qsrlang.mixtures.names import check_object, check_question
from qsrlang.relations.build import ANYWHERE, Built, build_graph
from qsrlang.relations.contexts import Circumstances
from qsrlang.relations.graph import Landmark, RelationGraph
from qsrlang.relations.imports import find_knowledge, read_source
from qsrlang.relations.values import landmark_value

Poses: TypeAlias = Mapping[str, Pose2 | Sequence[Pose2]]
ENGINES = ("exact", "sampling")
DEFAULT_SAMPLES = 10_000


@dataclass(frozen=True, slots=True)
class KnowledgeBase:
    """What is known, ready to be asked; `diagnostics` holds the warnings and hints found in its text.

    It was `built` from that text, for some `circumstances`; `added` are the landmarks that the text does not name.
    """

    graph: RelationGraph
    diagnostics: tuple[Diagnostic, ...] = ()
    built: Built | None = field(default=None, repr=False, compare=False)
    circumstances: Circumstances = ANYWHERE
    added: tuple[Landmark, ...] = ()

    @property
    def landmarks(self) -> tuple[Landmark, ...]:
        """The named instances whose poses are known."""
        return self.graph.landmarks

    @property
    def classes(self) -> tuple[str, ...]:
        """The names of all classes."""
        return tuple(self.graph.classes)

    def with_landmarks(self, *landmarks: Landmark | str) -> KnowledgeBase:
        """Return the knowledge with more landmarks, as values or as text such as
        `monitor-1 : Monitor at (0 m, 0 m) facing -90 deg`; one of a known name takes its place.
        """
        values = [landmark_value(parse_landmark(one)) if isinstance(one, str) else one for one in landmarks]
        for value in values:
            if value.kind not in self.graph.classes:
                raise UnknownNameError("class", value.kind, self.graph.classes)
        known = {landmark.name: landmark for landmark in (*self.graph.landmarks, *values)}
        added = {landmark.name: landmark for landmark in (*self.added, *values)}
        graph = replace(self.graph, landmarks=tuple(known.values()))
        return replace(self, graph=graph, added=tuple(added.values()))

    def under(self, circumstances: Circumstances) -> KnowledgeBase:
        """Return the knowledge that holds in these circumstances, with the landmarks that were added to it.

        A graph that was not built from text holds in all of them.
        """
        known = replace(self, circumstances=circumstances)
        if self.built is None or circumstances == self.circumstances:
            return known
        return replace(known, graph=self.built.under(circumstances)).with_landmarks(*self.added)

    def where(
        self,
        target: str,
        landmarks: Poses | None = None,
        *,
        wrt: str | None = None,
        viewer: Pose2 | None = None,
        engine: str = "exact",
        samples: int = DEFAULT_SAMPLES,
        rng: np.random.Generator | None = None,
    ) -> Where:
        """Return where `target` is: a Gaussian mixture in the map frame, with the statements behind each component.

        `target` is a class, a landmark or a role such as `left: Cup`; of a class that scenes tell apart by roles,
        any instance. `landmarks` maps classes and roles to poses; without any landmark, or with `wrt`, the mixture is
        relative to the class the chain starts from (x away from the viewer, y to its left). `engine="sampling"`
        fits Gaussians to `samples` draws of `rng`, as the paper does. Raises UnreachedTargetError, NoRoomError and
        MissingFacingError.
        """
        for name in filter(None, (target, wrt)):
            check_object(name, self.graph)
        placing = _engine(engine, samples, rng)
        graph = self.with_landmarks(*_instances(landmarks or {}, self.graph)).graph
        if wrt is not None:
            return where_relative_to(graph, target, wrt, placing)
        if graph.landmarks:
            return where_on_map(graph, target, viewer, placing)
        return where_relative(graph, target, placing)

    def ask(
        self,
        query: str,
        *,
        viewer: Pose2 | None = None,
        engine: str = "exact",
        samples: int = DEFAULT_SAMPLES,
        seed: int = 0,
    ) -> Where:
        """Answer a query written in the language, such as `where Cup?` or `where Cup in room r133 at 09:30?`.

        What the query does not say of the circumstances is as it is for this knowledge. Raises LanguageError,
        UnknownNameError, and UnansweredQueryError for what this release does not answer.
        """
        question = parse_query(query)
        known = self.under(_refined(self.circumstances, Circumstances.of(question.circumstances)))
        check_question(question, known.graph)
        if question.given is not None:
            raise UnansweredQueryError("given")
        if not isinstance(question, questions.Where):
            raise UnansweredQueryError(type(question).__name__.lower())
        wrt = question.relatum.text if question.relatum else None
        rng = np.random.default_rng(seed) if engine == "sampling" else None
        return known.where(
            question.target.text, wrt=wrt, viewer=viewer, engine=engine, samples=samples, rng=rng
        )


def load(name: str | Path) -> KnowledgeBase:
    """Load knowledge: a shipped name such as `office/desk`, or a path that ends in .qsr.

    Raises FileError, and LanguageError with every error found in the text and in what it imports.
    """
    return _known(read_source(find_knowledge(str(name))))


def parse_knowledge(text: str, name: str = "<text>") -> KnowledgeBase:
    """Return the knowledge that a text states; raises LanguageError."""
    return _known(Source(name, text))


def _known(source: Source) -> KnowledgeBase:
    built = build_graph(source)
    raise_errors(built.diagnostics)
    return KnowledgeBase(built.graph, built.diagnostics, built)


def _refined(circumstances: Circumstances, asked: Circumstances) -> Circumstances:
    """Return circumstances with what is asked for in the place of what was."""
    said = {name: value for name, value in asdict(asked).items() if value is not None}
    return replace(circumstances, **said)


def _engine(name: str, samples: int, rng: np.random.Generator | None) -> Engine:
    if name not in ENGINES:
        raise UnknownNameError("engine", name, ENGINES)
    if name == "exact":
        return Engine()
    if rng is None or samples < 2:
        raise ValueRangeError(
            "the sampling engine's rng and samples", (rng, samples), "a generator and at least 2"
        )
    return Engine(samples, rng)


def _instances(poses: Poses, graph: RelationGraph) -> Iterator[Landmark]:
    for kind, given in poses.items():
        for number, pose in enumerate([given] if isinstance(given, Pose2) else given, start=1):
            name = kind if kind in graph.roles else f"{kind}-{number}"
            yield Landmark(name, graph.roles.get(kind, kind), pose.x, pose.y, heading=pose.yaw)
