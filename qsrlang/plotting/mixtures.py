"""A mixture from above: where the object may be, about the landmarks that say so (Fig. 4 of the paper)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from qsrlang.arrays import frozen_array
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.plotting import layers, style
from qsrlang.plotting.canvas import Ground, bar_box, plane_figure
from qsrlang.plotting.labels import Labels
from qsrlang.plotting.outlines import along_edges, ellipse_outline
from qsrlang.relations.graph import Landmark

SHOWN_SHARE_OF_PEAK = 0.02
"""Below this share of the highest density the ground stays white."""

_LONG_SIDE = 320
_REACH_SIGMAS = 2.6
_LABELLED = 12
_ANCHORS, _RING, _EDGE = 12, 48, 60


def draw_mixture(
    mixture: GaussianMixture,
    *,
    landmarks: Iterable[Landmark] = (),
    supports: Iterable[ConvexPolygon] = (),
    frame: str = "map",
    title: str | None = None,
    points: npt.ArrayLike | None = None,
) -> Figure:
    """Return a mixture seen from above: density [1/m^2], 1- and 2-sigma ellipses with weights, landmarks.

    `supports` are outlines, `points` (N, 2) draws to show [m]; all is in the frame `frame`, the mixture's
    own. Weights are written beside their ellipses, the greatest first, as long as there is room. Raises
    ValueRangeError where the picture would be too large or the points do not fit.
    """
    known, outlines = tuple(landmarks), tuple(supports)
    ground = _ground(mixture, known, outlines)
    figure, axes = plane_figure(ground, frame=frame, caption_lines=1 if title else 0, bars=1)
    peak = _add_density(axes, mixture, ground)
    draws = frozen_array("the points of a picture", np.zeros((0, 2)) if points is None else points, (None, 2))
    axes.plot(*draws.T, ".", color=style.INK, ms=1.6, alpha=0.5, zorder=2.5, gid="points")
    layers.add_supports(axes, outlines)
    layers.add_ellipses(axes, mixture.means, mixture.covariances)
    labels = Labels(axes)
    labels.keep_clear(draws, 0.8)
    for outline in outlines:
        labels.keep_clear(along_edges(outline.corners, _EDGE), 1.5)
    for index in range(len(mixture.weights)):
        _keep_clear_of(labels, mixture, index, (1.0, 2.0))
    layers.add_landmarks(axes, labels, known)
    layers.name_landmarks(labels, known)
    _label_weights(labels, mixture)
    style.add_colour_bar(
        figure, bar_box(figure, axes, 0), style.DENSITY_COLOURS, Normalize(0.0, peak), "density\n[1/m²]"
    )
    if title:
        style.write_caption(axes, [title])
    return figure


def _ground(
    mixture: GaussianMixture, landmarks: Sequence[Landmark], supports: Sequence[ConvexPolygon]
) -> Ground:
    reach = _REACH_SIGMAS * np.sqrt(np.einsum("mii->mi", mixture.covariances))
    places = [mixture.means - reach, mixture.means + reach, *(support.corners for support in supports)]
    places += [np.array([[mark.x, mark.y]]) for mark in landmarks]
    points = np.concatenate(places)
    return Ground.around(points, 0.05 * float(np.ptp(points, axis=0).max()))


def _add_density(axes: Axes, mixture: GaussianMixture, ground: Ground) -> float:
    wide, high = ground.x_max - ground.x_min, ground.y_max - ground.y_min
    step = max(wide, high) / _LONG_SIDE
    x = layers.cell_centres(ground.x_min, ground.x_max, max(2, round(wide / step)))
    y = layers.cell_centres(ground.y_min, ground.y_max, max(2, round(high / step)))
    density = mixture.pdf(np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)).reshape(len(y), len(x))
    peak = float(max(density.max(), mixture.pdf(mixture.means).max()))
    shown = np.ma.masked_less(density, SHOWN_SHARE_OF_PEAK * peak)
    extent = (ground.x_min, ground.x_max, ground.y_min, ground.y_max)
    image = axes.imshow(shown, cmap=style.DENSITY_COLOURS, vmin=0.0, vmax=peak, extent=extent, origin="lower")
    image.set(interpolation="bilinear", zorder=1.0, gid="density")
    return peak


def _label_weights(labels: Labels, mixture: GaussianMixture) -> None:
    order = np.argsort(-mixture.weights, kind="stable")
    for index in order:
        _keep_clear_of(labels, mixture, index, np.linspace(0.0, 1.8, 7))
    for index in order[:_LABELLED]:
        places = ellipse_outline(mixture.means[index], mixture.covariances[index], 2.0, _ANCHORS)
        labels.place(_weight_text(float(mixture.weights[index])), places, gap=2.5, colour=style.BELIEF)


def _keep_clear_of(labels: Labels, mixture: GaussianMixture, index: int, sigmas: Iterable[float]) -> None:
    for count in sigmas:
        ring = ellipse_outline(mixture.means[index], mixture.covariances[index], float(count), _RING)
        labels.keep_clear(ring, 1.5)


def _weight_text(weight: float) -> str:
    return f"w = {weight:.2f}" if weight >= 0.005 else "w < 0.01"
