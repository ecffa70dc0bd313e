"""A search as pictures, like Figs. 6 to 8 of the paper."""

from __future__ import annotations

from collections.abc import Sequence

from qsrlang.experiments.stories import Opening, SearchStory
from qsrlang.planning.outcome import SearchStep
from qsrlang.plotting.canvas import Figure
from qsrlang.plotting.steps import draw_search_step


def draw_steps(opening: Opening, steps: Sequence[SearchStep]) -> Figure:
    """Return the last of the steps of a search: what it weighed, where it went, what it saw."""
    briefing = opening.briefing
    return draw_search_step(
        opening.place.occupancy,
        steps,
        cone=briefing.cone,
        supports=briefing.supports,
        weights=briefing.weights,
        mixtures=[belief.mixture for belief in briefing.beliefs],
        landmarks=briefing.landmarks,
    )


def draw_story(story: SearchStory) -> Figure:
    """Return the last step of a finished search."""
    return draw_steps(story.opening, story.steps)
