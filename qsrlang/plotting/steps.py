"""One step of a search: the views weighed, the one taken, what it showed (Figs. 7 and 8 of the paper)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.maps.occupancy import OccupancyGrid
from qsrlang.maps.supports import Supports
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.outcome import SearchStep
from qsrlang.plotting import layers, style
from qsrlang.plotting.canvas import bar_box, plane_figure
from qsrlang.plotting.labels import Labels
from qsrlang.plotting.maps import WEIGHT_LABEL, add_weighted_voxels, is_graded, known_ground, voxel_shares
from qsrlang.plotting.views import MAX_VIEWS, Views, add_views, value_text, write_value
from qsrlang.relations.graph import Landmark

VALUE_LABEL = "value of\nthe view"

_STAR = 11.0
_NAMED = 3


def draw_search_step(
    occupancy: OccupancyGrid,
    steps: Sequence[SearchStep],
    *,
    cone: ViewCone,
    supports: Supports | None = None,
    weights: npt.ArrayLike | None = None,
    mixtures: Iterable[GaussianMixture] = (),
    landmarks: Iterable[Landmark] = (),
) -> Figure:
    """Return a picture of the last of `steps`, the search so far from its first step on.

    The map in greys; support voxels coloured by `weights` (K,); the view cones of the candidates coloured by
    value, the chosen one bold; this drive as a line, earlier ones dotted; every pose looked from; what was
    detected as a star with its name; the ellipses of `mixtures`; in the caption the step, the clock, whether
    what is still sought was seen, and the value of the view and of the runner-up.
    Raises ValueRangeError where there is no step or the weights do not fit the supports.
    """
    if not steps:
        raise ValueRangeError("the number of steps in a picture of a search", 0, "at least 1")
    step = steps[-1]
    rated = bool(np.ptp(step.values) > 0.0)
    shares = _shares(supports, weights)
    graded = shares is not None and is_graded(shares)
    bars = int(rated) + int(graded)
    figure, axes = plane_figure(known_ground(occupancy, supports), frame="map", caption_lines=2, bars=bars)
    layers.add_grid(axes, occupancy)
    if supports is not None and shares is not None:
        scale = add_weighted_voxels(axes, supports, shares, occupancy.resolution)
        if graded:
            box = bar_box(figure, axes, int(rated))
            style.add_colour_bar(figure, box, style.WEIGHT_COLOURS, scale, WEIGHT_LABEL)
    views = Views.of(step, cone)
    add_views(axes, views)
    if rated:
        style.add_colour_bar(figure, bar_box(figure, axes, 0), style.VALUE_COLOURS, views.scale, VALUE_LABEL)
    for mixture in mixtures:
        layers.add_ellipses(axes, mixture.means, mixture.covariances, width=0.8)
    _add_way(axes, steps)
    _add_names(axes, step, views, tuple(landmarks), rated)
    style.write_caption(axes, _caption(step, rated))
    return figure


def _shares(supports: Supports | None, weights: npt.ArrayLike | None) -> FloatArray | None:
    if weights is not None:
        return voxel_shares(supports, weights)
    return None if supports is None else np.ones(len(supports.centres))


def _add_way(axes: Axes, steps: Sequence[SearchStep]) -> None:
    for step in steps[:-1]:
        axes.plot(
            *step.path.T, color=style.INK, lw=0.9, ls=(0.0, (1.0, 1.5)), zorder=5.5, gid="earlier-drive"
        )
    axes.plot(*steps[-1].path.T, color=style.INK, lw=1.6, solid_capstyle="round", zorder=5.5, gid="drive")
    start = steps[0].origin
    layers.add_robot(axes, (start.x, start.y, start.yaw), size=9.0, filled=False)
    for step in steps[:-1]:
        layers.add_robot(axes, step.candidates[step.chosen], size=9.0)
    layers.add_robot(axes, steps[-1].candidates[steps[-1].chosen], size=14.0)


def _add_names(
    axes: Axes, step: SearchStep, views: Views, landmarks: Sequence[Landmark], rated: bool
) -> None:
    labels = Labels(axes)
    places = np.array([seen.position[:2] for seen in step.detections]).reshape(-1, 2)
    layers.add_stars(axes, places, _STAR)
    labels.keep_clear(places, 0.6 * _STAR)
    labels.keep_clear(step.candidates[step.chosen, :2], 5.0)
    layers.add_landmarks(axes, labels, landmarks)
    for seen, place in zip(step.detections, places, strict=True):
        labels.place(seen.name, place, gap=0.6 * _STAR, colour=style.SEEN, bold=True, must=True)
    layers.name_landmarks(labels, landmarks)
    if rated:
        write_value(labels, views, step.chosen, bold=True)
        write_value(labels, views, _runner_up(step), bold=False)


def _runner_up(step: SearchStep) -> int:
    return next(index for index in step.ranking if index != step.chosen)


def _caption(step: SearchStep, rated: bool) -> list[str]:
    return [
        f"Step {step.number + 1}: {_outcome(step)}",
        f"clock {step.clock:.1f} s · {_views(step, rated)}",
    ]


def _outcome(step: SearchStep) -> str:
    if not step.looked:
        return "time ran out before the look"
    return ", ".join(_sighting(step, target) for target in step.wanted)


def _sighting(step: SearchStep, target: str) -> str:
    seen = [detection.name for detection in step.detections if detection.kind == target]
    if not seen:
        return f"{target} not seen"
    more = f" and {len(seen) - _NAMED} more" if len(seen) > _NAMED else ""
    return f"{target} seen ({', '.join(seen[:_NAMED])}{more})"


def _views(step: SearchStep, rated: bool) -> str:
    count = len(step.candidates)
    if count == 1:
        return "the only view"
    drawn = f" ({MAX_VIEWS} best shown)" if count > MAX_VIEWS else ""
    if not rated:
        return f"{count} views{drawn}, all worth the same"
    runner_up = value_text(float(step.values[_runner_up(step)]))
    return f"view worth {value_text(step.value)}, runner-up {runner_up}, of {count} views{drawn}"
