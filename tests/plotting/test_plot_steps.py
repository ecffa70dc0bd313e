import math

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.text import Text

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import Sector, Triangle
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.supports import Supports
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.outcome import SearchStep
from qsrlang.planning.world import Detection
from qsrlang.plotting import style
from qsrlang.plotting.outlines import cone_outline, cone_outlines
from qsrlang.plotting.steps import draw_search_step
from qsrlang.plotting.views import MAX_VIEWS
from qsrlang.relations.graph import Landmark

CONE = Triangle(3.0, 1.0)
GRID = OccupancyGrid(np.full((80, 60), Cell.FREE, dtype=np.uint8), 0.1, Pose2(-3.0, -4.0), "a test")
MIXTURE = GaussianMixture([0.5, 0.5], [[1.0, 2.0], [-1.0, -2.0]], [0.1 * np.eye(2), np.diag([0.3, 0.05])])
SUPPORTS = Supports(
    np.array([[0.05 + 0.1 * i, 2.05, 0.8] for i in range(10)]), np.zeros(10, dtype=int), ("support-1",)
)
WEIGHTS = np.linspace(1.0, 4.0, 10)
CUP = Detection("cup-2", "Cup", (0.4, 2.0, 0.9))
FIVE = tuple(Detection(f"cup-{i}", "Cup", (0.0, 0.0, 0.0)) for i in range(5))
BOTTLE = Detection("bottle-1", "Bottle", (0.45, 2.05, 0.9))


def _step(number=0, count=20, *, same=False, looked=True, detections=(), seed=0):
    rng, origin = np.random.default_rng(seed), Pose2(0.0, 0.0, 0.3)
    candidates = np.column_stack([rng.uniform(-2.5, 2.5, (count, 2)), rng.uniform(-math.pi, math.pi, count)])
    values = np.ones(count) if same else rng.uniform(0.0, 500.0, count)
    chosen = int(np.argmax(values))
    path = np.array([[origin.x, origin.y], [0.5, 0.5], candidates[chosen, :2]])
    return SearchStep(
        number=number, origin=origin, candidates=candidates, values=values, chosen=chosen, path=path, travel=3.0,
        turn=1.0, seconds=12.0, clock=12.0 * (number + 1) + 0.25, looked=looked, detections=detections, reached=origin,
        wanted=("Cup",),
    )  # fmt: skip


def _draw(*steps, cone=CONE, **named):
    return draw_search_step(GRID, steps, cone=cone, **named)


def _lines(figure, gid):
    return [line for line in figure.axes[0].lines if line.get_gid() == gid]


def _caption(figure):
    return [text.get_text() for text in figure.axes[0].texts if text.get_gid() == "caption"]


def _chosen(figure):
    (patch,) = (patch for patch in figure.axes[0].patches if patch.get_gid() == "chosen-view")
    return patch


def test_the_chosen_view_is_its_cone_and_the_boldest_line():
    step = _step()
    figure = _draw(step)
    assert np.array_equal(_chosen(figure).get_xy()[:-1], cone_outlines(CONE, step.candidates)[step.chosen])
    assert np.allclose(_chosen(figure).get_xy()[:-1], cone_outline(CONE, step.pose), atol=1e-12)
    assert _chosen(figure).get_linewidth() > max(figure.axes[0].collections[0].get_linewidths())


def test_every_other_view_is_outlined_in_the_colour_of_its_value():
    step = _step()
    lines = _draw(step).axes[0].collections[0]
    order = [index for index in step.ranking[::-1] if index != step.chosen]
    drawn = np.array([path.vertices for path in lines.get_paths()])
    assert np.allclose(drawn[:, :3], cone_outlines(CONE, step.candidates)[order], atol=1e-12)
    assert np.array_equal(drawn[:, 0], drawn[:, 3])
    shades = style.VALUE_COLOURS(step.values[order] / step.values.max())
    assert np.allclose(lines.get_colors(), shades)
    luminance = np.asarray(lines.get_colors())[:, :3] @ [0.299, 0.587, 0.114]
    assert (np.diff(luminance) <= 1e-9).all()


def test_the_way_is_this_drive_and_the_earlier_ones():
    first, second, third = (_step(number, seed=number) for number in range(3))
    figure = _draw(first, second, third)
    (drive,) = _lines(figure, "drive")
    assert np.array_equal(drive.get_xydata(), third.path)
    assert [line.get_xydata().tolist() for line in _lines(figure, "earlier-drive")] == [
        first.path.tolist(),
        second.path.tolist(),
    ]
    stands = [line.get_xydata()[0].tolist() for line in _lines(figure, "robot")]
    assert stands == [[0.0, 0.0], *([step.pose.x, step.pose.y] for step in (first, second, third))]


def test_the_robot_looks_along_its_yaw():
    step = _step()
    head = _lines(_draw(step), "robot")[-1].get_marker().vertices
    tip = head[np.argmax(np.linalg.norm(head, axis=1))]
    sides = head[:5] @ [math.cos(step.pose.yaw), math.sin(step.pose.yaw)]
    assert sides.max() == pytest.approx(1.0) and np.linalg.norm(tip) <= 1.1


def test_what_was_seen_is_a_star_with_its_name():
    figure = _draw(_step(detections=(CUP, BOTTLE)))
    (stars,) = _lines(figure, "detections")
    assert stars.get_xydata().tolist() == [[0.4, 2.0], [0.45, 2.05]]
    assert {"cup-2", "bottle-1"} <= {text.get_text() for text in figure.axes[0].texts}


def test_labels_stay_apart():
    marks = [Landmark("sink-1", "Sink", 0.5, 2.2, heading=1.0), Landmark("hob-1", "Hob", 0.3, 1.9)]
    figure = _draw(_step(detections=(CUP, BOTTLE)), landmarks=marks, weights=WEIGHTS, supports=SUPPORTS)
    figure.canvas.draw()
    texts = [text for text in figure.axes[0].texts if text.get_text() and text.get_gid() is None]
    names = {
        text.get_text(): text for text in texts if text.get_text() in {"sink-1", "hob-1", "cup-2", "bottle-1"}
    }
    boxes = [Text.get_window_extent(text) for text in names.values()]
    assert len(boxes) == 4
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_the_caption_tells_step_clock_outcome_and_values():
    step = _step(1, detections=(BOTTLE,))
    first, second = _caption(_draw(_step(), step))
    runner_up = sorted(step.values)[-2]
    assert first == "Step 2: Cup not seen"
    assert second == f"clock 24.2 s · view worth {step.value:.0f}, runner-up {runner_up:.0f}, of 20 views"


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (_step(detections=(BOTTLE, CUP)), "Step 1: Cup seen (cup-2)"),
        (_step(detections=FIVE), "Step 1: Cup seen (cup-0, cup-1, cup-2 and 2 more)"),
        (_step(looked=False), "Step 1: time ran out before the look"),
    ],
)  # fmt: skip
def test_the_caption_tells_what_came_of_it(step, words):
    assert _caption(_draw(step))[0] == words


def test_views_of_equal_worth_get_one_colour_and_no_bar():
    figure = _draw(_step(same=True), supports=SUPPORTS)
    assert len(figure.axes) == 1 and _caption(figure)[1].endswith("20 views, all worth the same")
    assert len(np.unique(figure.axes[0].collections[0].get_colors(), axis=0)) == 1


def test_one_candidate_is_the_only_view():
    assert _caption(_draw(_step(count=1)))[1].endswith("the only view")


def test_of_many_views_the_best_are_drawn_and_the_caption_says_so():
    step = _step(count=400)
    figure = _draw(step)
    drawn = figure.axes[0].collections[0]
    assert len(drawn.get_paths()) == MAX_VIEWS - 1
    least = step.values[list(step.ranking[:MAX_VIEWS])].min()
    assert np.allclose(drawn.get_colors()[0], style.VALUE_COLOURS(least / step.values.max()))
    assert _caption(figure)[1].endswith(f"of 400 views ({MAX_VIEWS} best shown)")


def test_a_sector_is_tied_to_the_robot():
    step = _step()
    sector = Sector(0.8, 2.5, 1.0)
    figure = _draw(step, cone=sector)
    blind = figure.axes[0].collections[-1].get_paths()
    assert np.allclose([path.vertices[0] for path in blind], [step.pose.x, step.pose.y])
    assert np.allclose(_chosen(figure).get_xy()[:-1], cone_outline(sector, step.pose), atol=1e-12)


def test_weights_and_belief_are_drawn_with_a_bar_for_each_scale():
    figure = _draw(_step(), supports=SUPPORTS, weights=WEIGHTS, mixtures=[MIXTURE])
    titles = [axes.get_title(loc="left") for axes in figure.axes[1:]]
    assert sorted(titles) == ["value of\nthe view", "voxel\nweight"]
    sigma = [patch.width for patch in figure.axes[0].patches if patch.get_gid() == "sigma-1"]
    assert np.allclose(sigma, [2.0 * math.sqrt(0.1), 2.0 * math.sqrt(0.3)], atol=1e-9)
    boxes = [axes.get_tightbbox() for axes in figure.axes]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes[1:]) for b in boxes[1 : i + 1])
    picture = np.asarray((figure.canvas.draw(), figure.canvas.buffer_rgba())[1])[::-1, :, :3] / 255.0
    x, y = figure.axes[0].transData.transform(SUPPORTS.centres[-1, :2]).astype(int)
    assert np.abs(picture[y, x] - to_rgb(style.WEIGHT_COLOURS(1.0))).max() < 0.35


def test_bad_input_is_refused():
    with pytest.raises(ValueRangeError, match="the number of steps"):
        _draw()
    with pytest.raises(ValueRangeError, match="the weights of the support voxels"):
        _draw(_step(), supports=SUPPORTS, weights=np.ones(3))
