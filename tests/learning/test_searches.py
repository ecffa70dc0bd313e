import numpy as np
import pytest

import qsrlang as qsr
from qsrlang.learning.placements import placements_of
from qsrlang.learning.searches import sightings_of


def test_what_a_search_saw_becomes_placements_about_the_landmarks_it_knew():
    """The cup of variant B stands 0.38 m before the keyboard that the robot knew, whose front looks along -y."""
    story = qsr.search("kitchen", planner="qsr", seed=7, variant="B")
    desk = qsr.Landmark("known", "Keyboard", 2.05, 11.8, heading=-np.pi / 2)
    seen = sightings_of(story.steps, [desk], "kitchen", "monday", 9 * 3600.0)
    assert story.found and set(seen.text("place")) == {"kitchen"} and set(seen.hours) == {9.0}
    assert len(set(seen.text("object"))) == len(seen)
    placed = placements_of(seen)
    cup = seen.text("kind").index("Cup")
    (own,) = np.flatnonzero((placed.referents == cup) & (placed.relata == 0))
    assert placed.points[own] == pytest.approx((-0.38, 0.0), abs=0.05)
