"""Joint scenes beside the oracle's, thrown away where boxes overlap or a requirement is broken.

The energy distance of the same scenes in two halves is 0 on average; over draws of N scenes its standard deviation is
about 1 / N, so that a limit of 6 / N has a false-alarm rate far below 1e-3. Seeds are fixed.
"""

from itertools import combinations

import numpy as np
import pytest
from comparing_engines import energy_distance
from drawn_worlds import draw_world
from naive_worlds import naive_worlds
from plain_geometry import overlapping
from sharp_events import holds

import qsrlang as qsr

HEAD = """
static M { size: 30 cm × 20 cm, front: yes }.
dynamic A { size: 20 cm × 15 cm }, B { size: 10 cm × 12 cm }, C { size: 12 cm × 8 cm }.
landmark m : M at (1 m, 2 m) facing 30 deg ± (2 cm, 2 cm, 4 deg).
"""
FIT = "~ normal((30 cm, 5 cm), (15 cm, 10 cm), 0.3)"
WIDE_FIT = "~ normal((30 cm, 40 cm), (20 cm, 25 cm), 0)"
SCENES = {
    "a chain": "observe left-of(A, M). observe right-of(B, A). observe behind-of(C, B) ∧ close-to(C, B).",
    "alternatives": """believe 0.4 :: left-of(A, M) | 0.6 :: right-of(A, M).
        observe left-of(B, M). observe left-of(C, M).""",
    "fits of one pair": f"observe left-of(A, M) {FIT}. observe left-of(B, M) {FIT}. observe left-of(C, M).",
    "a loop": f"""observe behind-of(A, M) {FIT}. observe behind-of(B, M) {WIDE_FIT}.
        observe left-of(B, A). observe left-of(C, B).""",
    "a direction required": """observe left-of(A, M). observe left-of(B, M). observe left-of(C, M).
        require behind-of(A, B).""",
    "required of distances": """observe left-of(A, M). observe left-of(B, A). observe left-of(C, M).
        require close-to(A, M). require 0.8 :: ¬close-to(B, A).""",
}
NAMES = ("A", "B", "C")
COUNT = 800


def oracle_scenes(graph, count, rng):
    """Positions (count, N, 2) of all objects, by weight; they are in every world here."""
    points, weights = [], []
    for world in naive_worlds(graph, NAMES):
        scenes, evidence = draw_world(graph, world, None, 30_000, rng)
        for one in graph.requirements:
            share = 1.0 if one.share is None else one.share
            evidence = evidence * np.where(holds(one.formula, scenes), share, 1.0 - share)
        for one, other in combinations((*NAMES, "m"), 2):
            evidence = evidence * ~_overlap(scenes, one, other)
        points.append(np.stack([scenes.points[name] for name in NAMES], axis=1))
        weights.append(world.share * evidence)
    weights = np.concatenate(weights)
    assert weights.sum() ** 2 / np.square(weights).sum() > 2 * count
    return np.concatenate(points)[rng.choice(len(weights), count, p=weights / weights.sum())]


def _overlap(scenes, one, other):
    offsets = scenes.points[other] - scenes.points[one]
    halves = (np.array(scenes.half(name)) for name in (one, other))
    return overlapping(offsets, scenes.headings[one], scenes.headings[other], *halves)


@pytest.mark.parametrize("name", SCENES)
def test_scenes_are_drawn_as_the_oracle_draws_them(name):
    known = qsr.parse_knowledge(HEAD + SCENES[name])
    rng = np.random.default_rng(8)
    true = oracle_scenes(known.graph, COUNT, rng)
    found = known.sample(count=COUNT, rng=rng)
    at = [found.names.index(one) for one in NAMES]
    positions = found.positions[:, at]
    assert energy_distance(positions.reshape(COUNT, -1), true.reshape(COUNT, -1)) < 6.0 / COUNT
    for one, truth in zip(positions.transpose(1, 0, 2), true.transpose(1, 0, 2), strict=True):
        error = np.sqrt((one.var(axis=0) + truth.var(axis=0)) / COUNT)
        assert (np.abs(one.mean(axis=0) - truth.mean(axis=0)) < 5.0 * error).all()


def test_no_boxes_overlap_in_scenes_that_are_drawn():
    known = qsr.parse_knowledge(HEAD + SCENES["fits of one pair"])
    found = known.sample(count=500, rng=np.random.default_rng(1))
    halves = {"M": (0.1, 0.15), "A": (0.075, 0.1), "B": (0.06, 0.05), "C": (0.04, 0.06)}
    for one, other in combinations(halves, 2):
        i, j = found.names.index(one), found.names.index(other)
        offsets = found.positions[:, j] - found.positions[:, i]
        boxes = (np.array(halves[name]) for name in (one, other))
        assert not overlapping(offsets, found.headings[:, i], found.headings[:, j], *boxes).any()
