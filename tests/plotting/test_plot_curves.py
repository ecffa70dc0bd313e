import numpy as np
import pytest

from qsrlang.errors import ValueRangeError
from qsrlang.plotting.curves import draw_curves


def lines(figure):
    return [line for line in figure.axes[0].lines if line.get_gid() == "curve"]


def test_curves_are_what_was_given_and_bear_their_names():
    figure = draw_curves({"ours": ([1, 2, 3], [3, 2, 1]), "theirs": ([1, 2], [4, 5])}, "noise", "time [s]")
    np.testing.assert_array_equal(lines(figure)[0].get_ydata(), [3, 2, 1])
    names = [text.get_text() for text in figure.axes[0].texts if text.get_gid() == "name"]
    assert sorted(names) == ["ours", "theirs"]
    assert figure.axes[0].get_xlabel() == "noise"


def test_names_do_not_lie_on_each_other():
    figure = draw_curves({str(n): ([0, 1], [1, 1]) for n in range(5)}, "x", "y")
    heights = sorted(text.xy[1] for text in figure.axes[0].texts if text.get_gid() == "name")
    assert np.diff(heights).min() > 0.05


def test_both_axes_by_tens():
    axes = draw_curves({"a": ([1, 100], [1, 100])}, "x", "y", log=True).axes[0]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")


@pytest.mark.parametrize("curves", [{}, {"a": ([], [])}, {"a": ([1, 2], [1])}, {"a": ([1], [np.nan])}])
def test_senseless_curves_are_refused(curves):
    with pytest.raises(ValueRangeError):
        draw_curves(curves, "x", "y")


def test_the_bold_curve_stands_out():
    figure = draw_curves({"a": ([1, 2], [1, 2]), "mean": ([1, 2], [2, 1])}, "x", "y", bold="mean")
    one, bold = lines(figure)
    assert bold.get_linewidth() > one.get_linewidth()
    assert bold.get_color() != one.get_color()
