"""The query `views Cup?` on the map of a scenario."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from qsrlang.errors import ValueRangeError
from qsrlang.experiments.briefings import supports_of
from qsrlang.experiments.goals import extent_of
from qsrlang.experiments.places import read_place
from qsrlang.experiments.scenarios import Scenario, load_scenario
from qsrlang.geometry.pose import Pose2
from qsrlang.language import questions
from qsrlang.language.parser import parse_query
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.planning.ranking import DOUBT, LATTICE, RankedViews, rank_views

ARM = "rollout"


def ask_views(
    known: KnowledgeBase,
    query: str,
    scenario: str | Path | Scenario,
    *,
    viewer: Pose2 | None = None,
    seed: int = 0,
) -> RankedViews:
    """Answer a query such as `views Cup?` on the map of a scenario, for its robot at its start, as `rollout` ranks.

    The scenario's landmarks join those that are known. Raises ValueRangeError for other queries, and what
    `KnowledgeBase.where`, `load_scenario` and `rank_views` raise.
    """
    question = parse_query(query)
    if not isinstance(question, questions.Views):
        raise ValueRangeError("a query on the map of a scenario", repr(query), "one such as 'views Cup?'")
    loaded = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    arm, place, rng = loaded.arm(ARM), read_place(loaded), np.random.default_rng(seed)
    there = known.with_landmarks(*loaded.landmarks).for_question(question)
    target, preset = question.target.text, arm.preset
    answer = there.where(target, given=question.given, viewer=viewer, rng=rng)
    extent, _ = extent_of(there, target, preset)
    return rank_views(
        answer,
        supports_of(loaded, preset, place),
        place.voxels,
        place.reachable,
        loaded.camera,
        loaded.robot,
        loaded.start,
        floor_height=loaded.floor_height,
        extent=extent,
        detector=preset.looks.detector(),
        doubt=preset.belief.doubt() if preset.belief else DOUBT,
        lattice=preset.lattice.lattice() if preset.lattice else LATTICE,
        seconds=arm.limits.seconds,
        rng=rng,
    )
