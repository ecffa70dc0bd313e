"""The small picture in the terminal: what is where, which way up, and how large."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.cli.shell.sketch import LEAST_COLUMNS, MAX_COLUMNS, MAX_ROWS, draw_sketch, frame, letter
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.relations.graph import Landmark, ObjectClass

CLASSES = {
    "Monitor": ObjectClass("Monitor", "static"),
    "Desk": ObjectClass("Desk", "surface", 1.6, 0.8),
}
coordinates = st.floats(-50.0, 50.0)


def blob(*means, sd=0.05, weights=None):
    count = len(means)
    covariances = np.broadcast_to(sd**2 * np.eye(2), (count, 2, 2))
    return GaussianMixture(np.full(count, 1.0 / count) if weights is None else weights, means, covariances)


def sketch(mixture, landmarks=(), name="map", width=80):
    graph = SimpleNamespace(landmarks=landmarks, classes=CLASSES, class_of=lambda one: one)
    return draw_sketch(Where("Cup", name, mixture, 0.0, ()), graph, width, coloured=False).plain.split("\n")


def place_of(lines, sign):
    """Row and column of the first place of a sign within the picture."""
    return next((row, line.index(sign, 7)) for row, line in enumerate(lines) if sign in line[7:])


def marked(name, x, y, kind="Monitor", heading=None):
    return Landmark(name, kind, x, y, heading=heading)


def test_x_grows_to_the_right_and_y_upwards():
    lines = sketch(
        blob((0.0, 0.0)), [marked("east", 1.0, 0.0), marked("north", 0.0, 1.0), marked("west", -1.0, 0.0)]
    )
    east, north, west, cup = (place_of(lines, sign) for sign in "ENW█")
    assert west[1] < cup[1] < east[1]
    assert north[0] < cup[0]
    assert abs(east[0] - west[0]) == 0


def test_the_axes_carry_metres_at_the_right_places():
    lines = sketch(blob((2.0, 1.0)), [marked("a", 1.0, 1.0), marked("b", 3.0, 2.0)])
    ruler = next(row for row, line in enumerate(lines) if line.lstrip().startswith("└"))
    assert lines[ruler + 1].startswith(" [m] ")
    row, column = place_of(lines, "A")
    assert lines[ruler][column] == "┴"
    assert lines[ruler + 1][column - 2 : column + 3].strip().startswith("1")
    assert lines[row].lstrip().startswith("1")


def test_the_heavier_component_is_the_brighter():
    lines = sketch(blob((0.0, 0.0), (1.0, 0.0), weights=[0.9, 0.1]))
    middle = place_of(lines, "█")[1]
    assert middle < 7 + LEAST_COLUMNS / 2
    assert any(set("·░▒") & set(line[7 + LEAST_COLUMNS // 2 :]) for line in lines[:MAX_ROWS])


def test_a_mixture_much_narrower_than_a_pixel_is_still_seen():
    assert any("█" in line for line in sketch(blob((0.123, 0.456), sd=1e-4), [marked("far", 30.0, 20.0)]))


def test_surfaces_are_outlines_and_other_landmarks_letters():
    desk = marked("desk-1", 0.0, 0.0, "Desk", heading=0.0)
    lines = sketch(blob((0.0, 0.0)), [desk, marked("monitor-1", 0.2, 0.0, heading=-math.pi / 2)])
    edge = [
        (row, column) for row, line in enumerate(lines) for column, sign in enumerate(line) if sign == "+"
    ]
    rows, columns = {row for row, _ in edge}, {column for _, column in edge}
    assert len(edge) > 30
    assert 2 * (max(rows) - min(rows)) > 1.5 * (max(columns) - min(columns))
    assert lines[-1].split() == ["M", "monitor-1", "↓"]


def test_a_relative_answer_has_its_relatum_at_the_origin():
    lines = sketch(blob((-0.5, 0.0)), name="Monitor")
    assert place_of(lines, "█")[1] < place_of(lines, "M")[1]
    assert lines[-1].split() == ["M", "Monitor", "←"]


@given(st.lists(st.sampled_from(["monitor", "mug", "Küche", "杯", "a-1"]), max_size=80))
def test_no_two_landmarks_share_a_letter(names):
    marks = letter([marked(name, 0.0, 0.0) for name in names])
    assert len({mark.letter for mark in marks}) == len(marks) == min(len(names), 62)


@given(
    st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=5),
    st.floats(1e-3, 20.0),
    st.integers(20, 200),
)
def test_every_picture_holds_all_and_stays_small(means, sd, width):
    mixture = blob(*means, sd=sd)
    window = frame(mixture, [], [], width)
    assert window.columns <= min(MAX_COLUMNS, width)
    assert window.rows <= 2 * MAX_ROWS
    assert window.rows % 2 == 0
    low, high = window.corner, window.corner + window.pixel * np.array([window.columns, window.rows])
    assert (low <= mixture.means + 1e-9).all()
    assert (mixture.means - 1e-9 <= high).all()


def test_many_components_are_drawn_in_parts():
    angles = np.linspace(0.0, 6.0, 600)
    mixture = blob(*np.stack([np.cos(angles), np.sin(angles)], axis=-1), sd=0.02)
    lines = sketch(mixture)
    assert sum(line.count("█") + line.count("▓") for line in lines) > 20


def test_colours_show_the_density_on_a_ground_of_their_own():
    graph = SimpleNamespace(landmarks=[marked("a", 0.5, 0.0)], classes=CLASSES)
    text = draw_sketch(Where("Cup", "map", blob((0.0, 0.0)), 0.0, ()), graph, 80)
    grounds = {
        span.style.bgcolor.get_truecolor() for span in text.spans if getattr(span.style, "bgcolor", None)
    }
    assert len(grounds) > 5
    brightest = max(grounds, key=sum)
    assert sum(brightest) > 600
    assert sum(min(grounds, key=sum)) < 100
    assert text.plain.count("A") == 2


@pytest.mark.parametrize("width", [1, 12, 30])
def test_a_narrow_terminal_gets_a_narrow_picture(width):
    lines = sketch(blob((0.0, 0.0), (3.0, 0.0)), width=width)
    assert max(len(line) for line in lines) <= max(width, 20)
