"""Questions to what is known, and their answers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TypeAlias, TypeVar, overload

import numpy as np

from qsrlang.errors import UnansweredQueryError, UnknownNameError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.language import questions
from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.nodes.questions import MAX_SCENES
from qsrlang.language.parser import parse_formula, parse_landmark, parse_query
from qsrlang.language.syntax import Atom, Formula, atoms_of
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.draws.conditions import conditions_on, objects_of
from qsrlang.mixtures.explanation import Explanation, explain_probability, explain_where
from qsrlang.mixtures.inference import Bounds, Placed, in_frame, place_assuming, rooted
from qsrlang.mixtures.information import LandmarkRanking, rank_landmarks
from qsrlang.mixtures.manner import Manner
from qsrlang.mixtures.names import check_atom, check_object, check_question, drawn_names
from qsrlang.mixtures.poses import Poses, landmarks_at
from qsrlang.mixtures.probability import Probability, probabilities, probability, prove
from qsrlang.mixtures.reduction import MAX_COMPONENTS
from qsrlang.mixtures.scenes import SceneSamples, sample_scenes
from qsrlang.mixtures.worlds.enumeration import MAX_WORLDS
from qsrlang.relations.build import ANYWHERE, Built
from qsrlang.relations.consistency.conflicts import Consistency
from qsrlang.relations.consistency.deciding import find_conflicts
from qsrlang.relations.contexts import Circumstances
from qsrlang.relations.graph import Landmark, RelationGraph
from qsrlang.relations.values import landmark_value

Answer: TypeAlias = Where | Probability | Explanation | LandmarkRanking | SceneSamples | Consistency
DEFAULT_SAMPLES = 10_000

_T = TypeVar("_T")


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

    def for_question(self, question: questions.Query) -> KnowledgeBase:
        """Return the knowledge that holds in the circumstances of a question; raises UnknownNameError for its names."""
        known = self.under(self.circumstances.refined(question.circumstances))
        check_question(question, known.graph)
        return known

    def where(
        self,
        target: str,
        landmarks: Poses | None = None,
        *,
        wrt: str | None = None,
        given: str | Formula | None = None,
        viewer: Pose2 | None = None,
        engine: str = "exact",
        samples: int = DEFAULT_SAMPLES,
        rng: np.random.Generator | None = None,
        max_components: int = MAX_COMPONENTS,
        max_worlds: int = MAX_WORLDS,
    ) -> Where:
        """Return where `target` is: a Gaussian mixture in the map frame, with the statements behind each component.

        `target` is a class, a landmark or a role such as `left: Cup`; of a class that scenes tell apart by roles,
        any instance. `landmarks` maps classes and roles to poses; without any landmark, or with `wrt`, the mixture is
        relative to the class the chain starts from (x away from the viewer, y to its left). `engine="sampling"`
        fits Gaussians to `samples` draws of `rng`, as the paper does. What is `given`, such as
        `left-of(Cup, Keyboard)`, and what the knowledge requires of what the target depends on, is met by weighing
        `samples` draws (of `rng`, or of a generator with seed 0). The `max_worlds` likeliest combinations of
        alternatives are weighed, and reduced to `max_components`. Raises UnreachedTargetError, NoRoomError,
        MissingFacingError and ImpossibleConditionError.
        """
        how = Manner(engine, samples, rng, viewer, Bounds(max_worlds, max_components))
        known = self.with_landmarks(*landmarks_at(landmarks, self.graph)) if landmarks else self
        return self._placed(known.graph, target, wrt, given, how).answer

    def prob(
        self,
        formula: str | Formula,
        given: str | Formula | None = None,
        *,
        viewer: Pose2 | None = None,
        samples: int = DEFAULT_SAMPLES,
        rng: np.random.Generator | None = None,
    ) -> Probability:
        """Return how probable a formula such as `right-of(Cup, Keyboard)` is.

        By the first way that tells: the stated densities, the Gaussians of the worlds, else `samples` weighted draws
        (of `rng`, or of a generator with seed 0) among those in which what is `given` and required holds. Raises
        UnreachedTargetError where no landmark is known and the objects hang on different classes, NoRoomError,
        MissingFacingError, ImpossibleConditionError.
        """
        how = Manner("exact", samples, rng, viewer, Bounds())
        return self._told(probability, self._formula(formula), given, how)

    def prob_each(
        self,
        formulas: Iterable[str | Formula],
        given: str | Formula | None = None,
        *,
        viewer: Pose2 | None = None,
        samples: int = DEFAULT_SAMPLES,
        rng: np.random.Generator | None = None,
    ) -> tuple[Probability, ...]:
        """Return how probable each of several formulas is, as `prob` does; what they share is worked out once."""
        how = Manner("exact", samples, rng, viewer, Bounds())
        nodes, assumed = [self._formula(one) for one in formulas], self._formula(given)
        if all(self._rooted(one, assumed) is self.graph for one in nodes):
            return probabilities(self.graph, nodes, assumed, how)
        return tuple(self._told(probability, one, assumed, how) for one in nodes)

    def explain(
        self,
        subject: str | Formula,
        *,
        wrt: str | None = None,
        given: str | Formula | None = None,
        viewer: Pose2 | None = None,
        samples: int = DEFAULT_SAMPLES,
        rng: np.random.Generator | None = None,
    ) -> Explanation:
        """Return why a target such as `Cup` is where it is, or why a formula is as probable as it is.

        Its numbers, world by world, are those of `where` and `prob`, and it raises what those raise.
        """
        how = Manner("exact", samples, rng, viewer, Bounds())
        if isinstance(subject, str) and "(" not in subject:
            return explain_where(self._placed(self.graph, subject, wrt, given, how), subject)
        return explain_probability(self._told(prove, self._formula(subject), given, how))

    def rank_landmarks(
        self, target: str, *, viewer: Pose2 | None = None, rng: np.random.Generator | None = None
    ) -> LandmarkRanking:
        """Return what a target is placed by, ranked by how much knowing the place of each narrows the search for it.

        By mutual information, from draws of `rng` (or of a generator with seed 0). Raises what `where` raises.
        """
        check_object(target, self.graph)
        return rank_landmarks(self.graph, target, viewer, rng or np.random.default_rng(0))

    def check(self) -> Consistency:
        """Return whether all that is known can hold together, and which few atoms contradict each other if not."""
        return find_conflicts(self.graph)

    def sample(
        self,
        subject: str | None = None,
        count: int = 1,
        *,
        given: str | Formula | None = None,
        viewer: Pose2 | None = None,
        rng: np.random.Generator | None = None,
    ) -> SceneSamples:
        """Return `count` joint scenes, drawn by `rng` (or a generator with seed 0), without boxes that overlap.

        `subject` is a named scene, whose members are drawn, or a class, drawn with all that it is placed by; without
        one all that is related. What is `given` and required holds in every scene. Raises what `prob` raises.
        """
        if not 1 <= count <= MAX_SCENES:
            raise ValueRangeError("the number of scenes", count, f"1 to {MAX_SCENES}")
        names = drawn_names(self.graph, subject)
        graph = rooted(self.graph, names)
        conditions = conditions_on(graph, names, self._formula(given))
        scenes = sample_scenes(graph, names, count, conditions, viewer, rng or np.random.default_rng(0))
        return scenes if self.graph.landmarks else replace(scenes, frame=graph.landmarks[0].kind)

    def ask(
        self,
        query: str,
        *,
        viewer: Pose2 | None = None,
        engine: str = "exact",
        samples: int = DEFAULT_SAMPLES,
        seed: int = 0,
    ) -> Answer:
        """Answer a query written in the language, such as `where Cup?` or `prob left-of(Cup, Keyboard)?`.

        What the query does not say of the circumstances is as it is for this knowledge. Raises LanguageError,
        UnknownNameError, and UnansweredQueryError for `views`, which needs a map.
        """
        question = parse_query(query)
        known = self.for_question(question)
        given, rng = question.given, np.random.default_rng(seed)
        match question:
            case questions.Where(target=target, relatum=relatum):
                wrt = relatum.text if relatum else None
                return known.where(
                    target.text, wrt=wrt, given=given, viewer=viewer, engine=engine, samples=samples, rng=rng
                )
            case questions.Prob(formula=formula):
                return known.prob(formula, given, viewer=viewer, samples=samples, rng=rng)
            case questions.Explain(subject=subject, relatum=relatum):
                wrt = relatum.text if relatum else None
                about = subject if isinstance(subject, Atom) else subject.text
                return known.explain(about, wrt=wrt, given=given, viewer=viewer, samples=samples, rng=rng)
            case questions.Landmarks(target=target):
                return known.rank_landmarks(target.text, viewer=viewer, rng=rng)
            case questions.Check():
                return known.check()
            case questions.Sample(subject=subject, count=count):
                name = subject.text if subject else None
                return known.sample(name, count, given=given, viewer=viewer, rng=rng)
            case _:
                raise UnansweredQueryError(type(question).__name__.lower())

    def _placed(
        self, graph: RelationGraph, target: str, wrt: str | None, given: str | Formula | None, how: Manner
    ) -> Placed:
        for name in (target,) if wrt is None else (target, wrt):
            check_object(name, self.graph)
        assumed = self._formula(given)

        def place(known: RelationGraph) -> Placed:
            conditions = conditions_on(known, (target,), assumed)
            if conditions:
                return place_assuming(known, target, conditions, how.drawing(), how.bounds)
            return how.place(known, target)

        return in_frame(graph, target, wrt, place)

    def _told(
        self,
        tell: Callable[[RelationGraph, Formula, Formula | None, Manner], _T],
        formula: Formula,
        given: str | Formula | None,
        how: Manner,
    ) -> _T:
        assumed = self._formula(given)
        graph = self._rooted(formula, assumed)
        return tell(graph, formula, assumed, how)

    def _rooted(self, formula: Formula, given: Formula | None) -> RelationGraph:
        return rooted(self.graph, objects_of(formula, *([given] if given else [])))

    @overload
    def _formula(self, formula: str | Formula) -> Formula: ...
    @overload
    def _formula(self, formula: str | Formula | None) -> Formula | None: ...
    def _formula(self, formula: str | Formula | None) -> Formula | None:
        """Return a formula as a node, its names checked."""
        if formula is None:
            return None
        node = _parsed(formula) if isinstance(formula, str) else formula
        for atom in atoms_of(node):
            check_atom(atom, self.graph)
        return node


@lru_cache(maxsize=256)
def _parsed(formula: str) -> Formula:
    return parse_formula(formula)
