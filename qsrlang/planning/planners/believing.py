"""The planner that keeps a belief: it sees in three dimensions, remembers, and chooses by a strategy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.goals import Goal
from qsrlang.planning.options import Options, atlas_options, drawn_options, problem_of
from qsrlang.planning.planners.planner import Choice, Situation, Terms
from qsrlang.planning.sensing import Robot
from qsrlang.planning.strategies.strategy import Strategy
from qsrlang.planning.world import Detection


@dataclass(frozen=True, slots=True, eq=False)
class BeliefPlanner:
    """Takes the view that its `strategy` ranks first, by what the `goals` believe and what `robot` pays for it.

    Views are those of the goals' atlas where they have one, else the candidates drawn at random.
    """

    goals: tuple[Goal, ...]
    robot: Robot
    strategy: Strategy

    def __post_init__(self) -> None:
        if not self.goals:
            raise ValueRangeError("the number of goals of a search", 0, "at least 1")
        if len({goal.atlas is None for goal in self.goals}) > 1:
            raise ValueRangeError("the atlases of the goals", "some", "one for each goal, or none at all")

    def choose(self, situation: Situation, rng: np.random.Generator) -> Choice:
        """Choose the view that the strategy ranks first, the first of equals."""
        options = self.options(situation, rng)
        problem = problem_of(options, self.goals, self.robot, situation.seconds)
        ranking = self.strategy.rank(problem, rng)
        index = int(np.argmax(ranking.values))
        terms = Terms(problem.gains(), options.travel, options.turn, options.seconds, ranking.expected)
        tilt = float(options.views.tilts[index])
        return Choice(options.views.poses, index, ranking.values, ranking.unit, terms, tilt)

    def options(self, situation: Situation, rng: np.random.Generator) -> Options:
        """Return the views to choose from; where the atlas shows nothing more, the candidates that were drawn."""
        if self.goals[0].atlas is not None:
            options = atlas_options(self.goals, self.robot, situation, rng, self.strategy.most)
            if len(options.views):
                return options
        return drawn_options(
            self.goals, self.robot, situation, self.strategy.is_farsighted, self.strategy.most
        )

    def after_look(
        self, pose: Pose2, detections: Sequence[Detection], tilt: float | None = None
    ) -> BeliefPlanner:
        """Return the planner with the beliefs after a look."""
        return replace(self, goals=tuple(goal.after_look(pose, detections, tilt) for goal in self.goals))

    def after_find(self, target: str) -> BeliefPlanner:
        """Return the planner for the goals that are left."""
        left = tuple(goal for goal in self.goals if goal.target != target)
        return replace(self, goals=left) if left else self

    def settles(self, detection: Detection) -> bool:
        """Return whether the goal of the class that was reported takes the report for true."""
        return all(goal.settles(detection) for goal in self.goals if goal.target == detection.kind)

    @property
    def absence(self) -> float:
        """The least of the probabilities, over the goals, that the target is not here."""
        return min(goal.belief.absence for goal in self.goals)
