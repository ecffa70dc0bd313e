import numpy as np
import pytest
from matplotlib.collections import Collection
from matplotlib.colors import to_rgb
from matplotlib.patches import Ellipse, Polygon
from matplotlib.text import Text

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.plotting.canvas import save_figure
from qsrlang.plotting.mixtures import SHOWN_SHARE_OF_PEAK, draw_mixture
from qsrlang.relations.graph import Landmark

COVARIANCES = np.array(
    [[[0.010, 0.004], [0.004, 0.003]], [[0.02, 0.0], [0.0, 0.005]], [[0.006, -0.002], [-0.002, 0.006]]]
)
MIXTURE = GaussianMixture(
    np.array([0.15, 0.55, 0.3]), np.array([[-0.45, -0.25], [0.42, -0.28], [0.05, -0.42]]), COVARIANCES
)
LANDMARKS = (
    Landmark("monitor-1", "Monitor", 0.0, 0.0, heading=-np.pi / 2.0),
    Landmark("keyboard $1_a^2$", "Keyboard", 0.02, -0.3),
)
DESK = ConvexPolygon.rectangle(Pose2(0.0, -0.15, 0.1), 1.5, 0.8)


@pytest.fixture(scope="module")
def picture():
    figure = draw_mixture(
        MIXTURE, landmarks=LANDMARKS, supports=[DESK], frame="monitor-1", title="where Cup?"
    )
    figure.canvas.draw()
    return figure


def _texts(axes):
    return [text for text in axes.texts if text.get_text() and text.get_gid() != "caption"]


def test_ellipses_have_the_axes_of_their_gaussians(picture):
    ellipses = [patch for patch in picture.axes[0].patches if isinstance(patch, Ellipse)]
    assert len(ellipses) == 6
    for number, ellipse in enumerate(ellipses):
        index, sigmas = divmod(number, 2)
        values, vectors = np.linalg.eigh(MIXTURE.covariances[index])
        expected = 2.0 * (sigmas + 1) * np.sqrt(values[::-1])
        assert np.abs(np.array([ellipse.width, ellipse.height]) - expected).max() < 1e-9
        assert np.abs(np.array(ellipse.center) - MIXTURE.means[index]).max() == 0.0
        heading = np.deg2rad(ellipse.angle)
        assert abs(np.array([np.cos(heading), np.sin(heading)]) @ vectors[:, 1]) == pytest.approx(
            1.0, abs=1e-9
        )


def test_the_picture_holds_the_density(picture):
    (image,) = (image for image in picture.axes[0].images if image.get_gid() == "density")
    shown = image.get_array()
    height, width = shown.shape
    x0, x1, y0, y1 = image.get_extent()
    peak = MIXTURE.pdf(MIXTURE.means).max()
    rows, columns = np.random.default_rng(1).integers([height, width], size=(300, 2)).T
    points = np.stack(
        [x0 + (columns + 0.5) * (x1 - x0) / width, y0 + (rows + 0.5) * (y1 - y0) / height], axis=1
    )
    density = MIXTURE.pdf(points)
    assert np.array_equal(
        np.ma.getmaskarray(shown)[rows, columns], density < SHOWN_SHARE_OF_PEAK * image.get_clim()[1]
    )
    assert np.allclose(shown.data[rows, columns], density) and image.get_clim()[0] == 0.0
    assert image.get_clim()[1] == pytest.approx(peak, rel=0.02)


def test_background_is_white_and_the_peak_is_dark(picture):
    axes = picture.axes[0]
    assert _pixel(picture, axes, (-0.6, 0.2)) == (255, 255, 255)
    peak = MIXTURE.means[np.argmax(MIXTURE.pdf(MIXTURE.means))]
    assert sum(_pixel(picture, axes, peak)) < 350


def _pixel(figure, axes, place):
    x, y = axes.transData.transform(place)
    pixels = np.asarray(figure.canvas.buffer_rgba())
    return tuple(int(part) for part in pixels[int(pixels.shape[0] - y), int(x), :3])


def test_landmarks_stand_where_they_are_with_a_tick_only_for_a_known_heading(picture):
    axes = picture.axes[0]
    discs = [line.get_xydata()[0].tolist() for line in axes.lines if line.get_gid() == "landmark"]
    assert discs == [[0.0, 0.0], [0.02, -0.3]]
    (tick,) = (text for text in axes.texts if text.get_gid() == "heading")
    assert tick.xy == (0.0, 0.0) and tick.xyann[1] < 0.0 and abs(tick.xyann[0]) < 1e-9


def test_names_are_plain_text(picture):
    (name,) = (text for text in picture.axes[0].texts if text.get_text().startswith("keyboard"))
    assert name.get_text() == "keyboard $1_a^2$" and not name.get_parse_math()


def test_supports_keep_their_corners(picture):
    (outline,) = (patch for patch in picture.axes[0].patches if isinstance(patch, Polygon))
    assert np.array_equal(outline.get_xy()[:-1], DESK.corners)


def test_weights_are_written_and_no_label_overlaps_another(picture):
    texts = _texts(picture.axes[0])
    assert {"w = 0.15", "w = 0.55", "w = 0.30", "monitor-1"} <= {text.get_text() for text in texts}
    assert not _overlaps(texts)
    inside = picture.axes[0].get_window_extent()
    boxes = [Text.get_window_extent(text) for text in texts]
    assert all(inside.x0 <= box.x0 and box.x1 <= inside.x1 for box in boxes)


def _overlaps(texts):
    boxes = [Text.get_window_extent(text) for text in texts]
    return any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_axes_and_colour_bar_bear_units(picture):
    main, bar = picture.axes
    assert main.get_xlabel() == "x in the monitor-1 frame [m]" and main.get_ylabel().endswith("[m]")
    assert "[1/m²]" in bar.get_title(loc="left")
    assert bar.get_ylim()[1] == pytest.approx(MIXTURE.pdf(MIXTURE.means).max(), rel=0.02)


def test_crowded_mixtures_never_overlap_their_weights():
    rng = np.random.default_rng(3)
    count = 30
    means = rng.normal(scale=0.4, size=(count, 2))
    weights = rng.dirichlet(np.ones(count))
    mixture = GaussianMixture(weights, means, np.tile(0.003 * np.eye(2), (count, 1, 1)))
    figure = draw_mixture(mixture)
    figure.canvas.draw()
    texts = [text for text in _texts(figure.axes[0]) if text.get_text().startswith("w")]
    assert texts and not _overlaps(texts)


def test_points_are_drawn_as_given():
    points = MIXTURE.sample(50, np.random.default_rng(2))
    axes = draw_mixture(MIXTURE, points=points).axes[0]
    (drawn,) = (line for line in axes.lines if line.get_gid() == "points")
    assert np.array_equal(drawn.get_xydata(), points)
    assert not [child for child in axes.collections if isinstance(child, Collection)]
    with pytest.raises(ValueRangeError, match="the points of a picture"):
        draw_mixture(MIXTURE, points=np.zeros((3, 3)))


def test_a_narrow_peak_far_off_still_sets_the_scale():
    mixture = GaussianMixture([0.5, 0.5], [[0.0, 0.0], [30.0, 0.0]], [1e-6 * np.eye(2), np.eye(2)])
    image = next(image for image in draw_mixture(mixture).axes[0].images if image.get_gid() == "density")
    assert image.get_clim()[1] == pytest.approx(0.5 / (2.0 * np.pi * 1e-6), rel=1e-6)


def test_a_mixture_without_bounds_is_refused():
    with pytest.raises(ValueRangeError, match="a side of the ground"):
        draw_mixture(GaussianMixture([1.0], [[0.0, 0.0]], [1e12 * np.eye(2)]))


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_it_is_written_in_every_format(picture, tmp_path, suffix):
    assert save_figure(picture, tmp_path / f"mixture{suffix}").stat().st_size > 5_000
    assert to_rgb(picture.get_facecolor()) == (1.0, 1.0, 1.0)
