import pytest

from qsrlang.errors import ValueRangeError
from qsrlang.plotting.growth import draw_learning_curves


def test_every_curve_is_drawn_through_its_points_and_named_apart():
    figure = draw_learning_curves([1, 2, 5], {"a": [0.0, 0.5, 1.0], "b": [0.1, 0.6, 1.0]}, "scans", "gain")
    axes = figure.axes[0]
    lines = {line.get_gid(): line.get_ydata().tolist() for line in axes.lines if line.get_gid()}
    assert lines["a"] == [0.0, 0.5, 1.0] and lines["b"] == [0.1, 0.6, 1.0]
    heights = sorted(text.get_position()[1] for text in axes.texts)
    assert heights[1] - heights[0] > 0.05


@pytest.mark.parametrize("curves", [{}, {"a": [1.0]}, {"a": [0.0, float("nan")]}])
def test_curves_that_do_not_fit_are_refused(curves):
    with pytest.raises(ValueRangeError):
        draw_learning_curves([1, 2], curves, "scans", "gain")
