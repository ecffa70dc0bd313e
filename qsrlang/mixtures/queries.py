"""Questions to what is known, and their answers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnknownNameError, UnreachedTargetError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.diagnostics import Diagnostic, raise_errors
from qsrlang.language.parser import parse_landmark, parse_query
from qsrlang.language.source import Source
from qsrlang.language.syntax import Where as WhereQuery
from qsrlang.mixtures.answers import Component, Where
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.mixtures.resolve import Placement, Plan, place_by_sampling, place_exactly, plan_world
from qsrlang.mixtures.worlds import World, enumerate_worlds
from qsrlang.relations.build import build_graph
from qsrlang.relations.graph import Landmark, RelationGraph
from qsrlang.relations.imports import find_knowledge, read_source
from qsrlang.relations.symbols import landmark_value

Poses: TypeAlias = Mapping[str, Pose2 | Sequence[Pose2]]
ENGINES = ("exact", "sampling")
DEFAULT_SAMPLES = 10_000


@dataclass(frozen=True, slots=True)
class KnowledgeBase:
    """What is known, ready to be asked; `diagnostics` holds the warnings and hints found in its text."""

    graph: RelationGraph
    diagnostics: tuple[Diagnostic, ...] = ()

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
            self._check_class(value.kind)
        kept = {landmark.name: landmark for landmark in (*self.graph.landmarks, *values)}
        return replace(self, graph=replace(self.graph, landmarks=tuple(kept.values())))

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

        `landmarks` maps class names to poses; without any landmark, or with `wrt`, the mixture is relative to
        the class the chain starts from (x away from the viewer, y to its left). `engine="sampling"` fits
        Gaussians to `samples` draws of `rng`, as the paper does. Raises UnreachedTargetError, NoRoomError and
        MissingFacingError.
        """
        for name in filter(None, (target, wrt)):
            self._check_class(name)
        if engine not in ENGINES:
            raise UnknownNameError("engine", engine, ENGINES)
        if engine == "sampling" and (rng is None or samples < 2):
            raise ValueRangeError(
                "the sampling engine's rng and samples", (rng, samples), "a generator and at least 2"
            )
        known = self.with_landmarks(*_instances(landmarks or {}))
        relata = [wrt] if wrt else ([] if known.graph.landmarks else _starts(known.graph, target))
        if not relata:
            return _answer(known.graph, target, viewer, samples, rng)
        answers = [_relative(known.graph, target, name, samples, rng) for name in relata]
        return max(answers, key=lambda answer: 1.0 - answer.elsewhere)

    def ask(
        self,
        query: str,
        *,
        viewer: Pose2 | None = None,
        engine: str = "exact",
        samples: int = DEFAULT_SAMPLES,
        seed: int = 0,
    ) -> Where:
        """Answer a query written in the language, such as `where Cup?` or `where Cup wrt Keyboard?`."""
        parsed: WhereQuery = parse_query(query)
        wrt = parsed.relatum.text if parsed.relatum else None
        rng = np.random.default_rng(seed) if engine == "sampling" else None
        return self.where(parsed.target.text, wrt=wrt, viewer=viewer, engine=engine, samples=samples, rng=rng)

    def _check_class(self, name: str) -> None:
        names = [*self.graph.classes, *(landmark.name for landmark in self.graph.landmarks)]
        if name not in names:
            raise UnknownNameError("class", name, names)


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
    return KnowledgeBase(built.graph, built.diagnostics)


def _instances(poses: Poses) -> list[Landmark]:
    found = []
    for kind, given in poses.items():
        for number, pose in enumerate([given] if isinstance(given, Pose2) else given, start=1):
            found.append(Landmark(f"{kind}-{number}", kind, pose.x, pose.y, heading=pose.yaw))
    return found


def _starts(graph: RelationGraph, target: str) -> list[str]:
    """Return the classes at which the target's chains start: those no statement places."""
    starts, waiting, seen = [], [target], {target}
    while waiting:
        name = waiting.pop(0)
        relata = sorted(
            {pair[1] for choice in graph.choices_for(name) for pair in choice.governs if pair[0] == name}
        )
        if not relata and name != target:
            starts.append(name)
        waiting += [relatum for relatum in relata if relatum not in seen]
        seen.update(relata)
    return starts


def _relative(
    graph: RelationGraph, target: str, relatum: str, samples: int, rng: np.random.Generator | None
) -> Where:
    """Answer with the relatum at the origin and the viewer's axis along +x."""
    virtual = Landmark(relatum, graph.class_of(relatum), 0.0, 0.0, heading=math.pi)
    answer = _answer(replace(graph, landmarks=(virtual,)), target, None, samples, rng)
    return replace(answer, frame=relatum)


def _answer(
    graph: RelationGraph, target: str, viewer: Pose2 | None, samples: int, rng: np.random.Generator | None
) -> Where:
    plans = _plans(graph, target)
    placed = [(world, _place(graph, plan, viewer, samples, rng)) for world, plan in plans]
    claimed = sum(world.weight for world, _ in placed)
    if claimed <= 0.0:
        raise UnreachedTargetError(target, _chains(graph, target))
    weights = _posterior(placed) * min(claimed, 1.0)
    components = [
        Component(float(weight), placement.mean, placement.covariance, _statements(placement))
        for weight, (_, placement) in zip(weights, placed, strict=True)
    ]
    components.sort(key=lambda component: (-component.weight, *component.mean))
    means = np.array([component.mean for component in components])
    covariances = np.array([component.covariance for component in components])
    shares = np.array([component.weight for component in components])
    mixture = GaussianMixture(shares / shares.sum(), means, covariances)
    return Where(target, "map", mixture, max(0.0, 1.0 - claimed), tuple(components))


def _plans(graph: RelationGraph, target: str) -> list[tuple[World, Plan]]:
    plans = ((world, plan_world(graph, world, target)) for world in enumerate_worlds(graph, target))
    return [(world, plan) for world, plan in plans if plan is not None and world.weight > 0.0]


def _place(
    graph: RelationGraph, plan: Plan, viewer: Pose2 | None, samples: int, rng: np.random.Generator | None
) -> Placement:
    if rng is None:
        return place_exactly(graph, plan, viewer)
    return place_by_sampling(graph, plan, viewer, samples, rng)


def _posterior(placed: Sequence[tuple[World, Placement]]) -> FloatArray:
    """Return the worlds' weights, prior times evidence, normalised."""
    logs = np.array([math.log(world.weight) + placement.log_evidence for world, placement in placed])
    weights = np.exp(logs - logs.max())
    return np.asarray(weights / weights.sum())


def _statements(placement: Placement) -> tuple[str, ...]:
    return tuple(dict.fromkeys(str(constraint.statement) for constraint in placement.constraints))


def _chains(graph: RelationGraph, target: str) -> list[str]:
    chains = []
    for choice in graph.choices_for(target):
        for pair in sorted(choice.governs):
            ends = ", ".join(_starts(graph, pair[1])) or pair[1]
            chains.append(f"{pair[0]} - {pair[1]} ends at {ends}, which has no landmark")
    return list(dict.fromkeys(chains))
