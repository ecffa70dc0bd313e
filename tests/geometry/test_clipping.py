"""Draws from polygons that lines cut, beside slow code: their areas, where they lie, and that they are uniform."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from qsrlang.geometry.angles import unit
from qsrlang.geometry.clipping import draw_inside

SQUARE = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
GRID = (np.stack(np.meshgrid(*[np.arange(200)] * 2), axis=-1).reshape(-1, 2) + 0.5) / 200.0 - 0.5
lines = st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6), st.floats(-math.pi, math.pi))


def cut(outline, cuts, count=1, seed=0):
    """Draws (count, 2) and areas (count,) of one polygon, cut by lines (x, y, direction of the inside)."""
    outlines = np.ascontiguousarray(np.broadcast_to(outline, (count, *outline.shape)))
    points = np.array([[[x, y]] * count for x, y, _ in cuts]).reshape(len(cuts), count, 2)
    normals = np.array([[unit(np.array(turn))] * count for *_, turn in cuts]).reshape(len(cuts), count, 2)
    return draw_inside(outlines, points, normals, np.random.default_rng(seed).random((count, 2)))


def is_inside(points, cuts):
    inside = (np.abs(points) <= 0.5 + 1e-12).all(axis=1)
    for x, y, turn in cuts:
        inside &= (points - [x, y]) @ unit(np.array(turn)) >= -1e-12
    return inside


@given(st.lists(lines, max_size=5))
@settings(max_examples=50)
def test_areas_are_those_of_a_grid_and_draws_lie_inside(cuts):
    draws, areas = cut(SQUARE, cuts, 64)
    assert abs(areas[0] - is_inside(GRID, cuts).mean()) < 0.01
    assert np.isfinite(draws).all()
    if areas[0] > 1e-9:
        assert is_inside(draws, cuts).all()


def test_draws_are_uniform():
    """Mean and second moments within 5 standard errors of those of the grid: a false-alarm rate below 1e-5."""
    cuts = [(-0.1, 0.0, 0.3), (0.2, 0.1, 2.5), (0.0, -0.3, 1.2)]
    draws, _ = cut(SQUARE, cuts, 100_000, seed=3)
    true = GRID[is_inside(GRID, cuts)]
    for power in ([1, 0], [0, 1], [2, 0], [0, 2], [1, 1]):
        drawn, expected = (np.prod(points**power, axis=1) for points in (draws, true))
        assert abs(drawn.mean() - expected.mean()) < 5.0 * drawn.std() / math.sqrt(len(drawn)) + 1e-3


def test_nothing_is_left_beyond_all_corners():
    draws, areas = cut(SQUARE, [(0.6, 0.0, 0.0), (0.0, 0.1, 1.0)], 10)
    assert (areas == 0.0).all()
    assert draws.shape == (10, 2)


def test_lines_along_sides_and_through_corners_keep_what_is_inside():
    assert cut(SQUARE, [(0.5, 0.0, math.pi), (-0.5, 0.0, 0.0)])[1][0] == 1.0
    np.testing.assert_allclose(cut(SQUARE, [(0.5, 0.5, -0.75 * math.pi)])[1], 1.0)
    np.testing.assert_allclose(cut(SQUARE, [(0.0, 0.0, 0.25 * math.pi)])[1], 0.5)


def test_each_polygon_is_cut_by_its_own_lines():
    outlines = np.stack([SQUARE, 2.0 * SQUARE])
    points, normals = np.zeros((1, 2, 2)), np.array([[[1.0, 0.0], [0.0, -1.0]]])
    draws, areas = draw_inside(outlines, points, normals, np.full((2, 2), 0.5))
    np.testing.assert_allclose(areas, [0.5, 2.0])
    assert draws[0, 0] > 0.0 > draws[1, 1]
