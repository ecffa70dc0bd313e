import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from qsrlang.errors import ValueRangeError
from qsrlang.plotting.statistics import draw_found_by_time, spread

TIMES = {
    "random": [90.0, np.inf, 30.0, np.inf],
    "qsr": [10.0, 12.0, 12.0, 50.0],
    "late": [130.0, 5.0, np.inf, 120.0],
}


def _value_at(line, t):
    x, y = line.get_data()
    return y[np.searchsorted(x, t, side="right") - 1]


def test_curves_are_the_shares_found_by_each_time():
    figure = draw_found_by_time(TIMES, 120.0)
    lines = figure.axes[0].lines
    assert len(lines) == 3 and all(line.get_drawstyle() == "steps-post" for line in lines)
    for line, times in zip(lines, TIMES.values(), strict=True):
        for t in np.linspace(0.0, 120.0, 241):
            assert _value_at(line, t) == sum(time <= t for time in times) / len(times)
        assert line.get_xdata()[0] == 0.0 and line.get_xdata()[-1] == 120.0


def test_bands_have_the_half_width_of_massart():
    (line,), (band,) = (
        getattr(draw_found_by_time({"arm": np.full(200, 60.0)}, 120.0).axes[0], what)
        for what in ("lines", "collections")
    )
    heights = band.get_paths()[0].vertices[:, 1]
    assert heights.max() == 1.0 and line.get_ydata()[-1] == 1.0
    assert np.isclose(heights, np.sqrt(np.log(40.0) / 400.0)).any()


def test_labels_name_the_arm_its_share_and_its_trials_in_its_colour():
    axes = draw_found_by_time(TIMES, 120.0).axes[0]
    labels = {text.get_text(): text for text in axes.texts}
    assert set(labels) == {"random  50 % of 4", "qsr  100 % of 4", "late  50 % of 4"}
    for line, arm in zip(axes.lines, ("random", "qsr", "late"), strict=True):
        (label,) = (text for words, text in labels.items() if words.startswith(arm))
        assert label.get_color() == line.get_color()


def test_labels_stay_apart_and_on_the_picture():
    figure = draw_found_by_time({f"arm-{i}": [5.0, 6.0] for i in range(7)}, 120.0)
    figure.canvas.draw()
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    width, height = figure.get_size_inches() * figure.dpi
    assert all(box.x1 <= width and box.y1 <= height and box.y0 >= 0.0 for box in boxes)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=8))
def test_spreading_keeps_order_distance_and_top(heights):
    heights = np.sort(heights)
    moved = spread(heights, 0.05)
    assert (np.diff(moved) >= 0.05 - 1e-12).all() and moved[-1] <= 1.0 + 1e-12
    if (np.diff(heights) >= 0.05).all():
        assert np.allclose(moved, heights)


def test_spreading_moves_least():
    heights = np.array([0.30, 0.31, 0.33, 0.80, 0.97, 0.99, 1.0])
    gaps = [{"type": "ineq", "fun": lambda x, i=i: x[i + 1] - x[i] - 0.05} for i in range(6)]
    best = minimize(
        lambda x: ((x - heights) ** 2).sum(),
        np.linspace(0.1, 0.9, 7),
        bounds=[(None, 1.0)] * 7,
        constraints=gaps,
        tol=1e-14,
    ).x
    assert np.allclose(spread(heights, 0.05), best, atol=1e-4)


@pytest.mark.parametrize("times", [{}, {"arm": []}, {"arm": [np.nan]}, {"arm": [-1.0]}, {"arm": [[1.0]]}])
def test_bad_times_are_refused(times):
    with pytest.raises(ValueRangeError):
        draw_found_by_time(times, 120.0)


@pytest.mark.parametrize("limit", [0.0, -1.0, np.inf, np.nan])
def test_bad_limits_are_refused(limit):
    with pytest.raises(ValueRangeError, match="the time limit of a picture"):
        draw_found_by_time({"arm": [1.0]}, limit)
