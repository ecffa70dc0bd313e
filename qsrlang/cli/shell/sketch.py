"""An answer as a small picture in the terminal: its mixture from above, the way `qsr plot` draws it."""

from __future__ import annotations

import math
import string
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from rich.color import Color
from rich.style import Style
from rich.text import Text

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.geometry.angles import rotation
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.relations.graph import Landmark, RelationGraph

LEAST_COLUMNS, MAX_COLUMNS, MAX_ROWS = 40, 60, 14
SHOWN_SHARE_OF_PEAK = 0.02
"""Below this share of the highest density the ground stays dark, as it stays white in `qsr plot`."""

_RAMP = np.array(
    [(22, 22, 30), (84, 34, 10), (170, 76, 12), (238, 155, 47), (253, 217, 160), (255, 248, 236)]
)
_EDGE = np.array([(88, 88, 102)])
_LANDMARK, _LANDMARK_ON_BRIGHT = Color.parse("#7fd4ff"), Color.parse("#0b3c6f")
_BRIGHT = 330.0
_AXES = "#8b8b98"
_SHADES = " ·░▒▓█"
_ARROWS = "→↗↑↖←↙↓↘"
_LETTERS = string.ascii_uppercase + string.ascii_lowercase + string.digits
_REACH_SIGMAS = 2.6
_LEAST_ASPECT = 0.2
_BLUR = 0.5
_CHUNK = 256
_NAMED = 12
_GUTTER = 7
_PIXELS_TO_A_TICK = 8
_UNIT = " [m]"


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """The pixels of a picture, two to a cell: where its lower left corner is, their side [m], columns and rows."""

    corner: FloatArray
    pixel: float
    columns: int
    rows: int

    def centres(self) -> FloatArray:
        """Return the middles of the pixels (rows, columns, 2), the first row at the top [m]."""
        x = self.corner[0] + self.pixel * (np.arange(self.columns) + 0.5)
        y = self.corner[1] + self.pixel * (np.arange(self.rows)[::-1] + 0.5)
        return np.stack(np.meshgrid(x, y), axis=-1)

    def cells_of(self, points: FloatArray) -> IntArray:
        """Return row and column (N, 2) of the pixels that hold points (N, 2)."""
        steps = np.floor((points - self.corner) / self.pixel).astype(np.int64)
        limits = np.array([self.columns, self.rows]) - 1
        column, row = np.clip(steps, 0, limits).T
        return np.stack([self.rows - 1 - row, column], axis=-1)


@dataclass(frozen=True, slots=True)
class Mark:
    """A landmark in the picture: its letter, its name, and where its front faces."""

    letter: str
    landmark: Landmark

    @property
    def legend(self) -> str:
        """The letter explained."""
        heading = self.landmark.heading
        if heading is None:
            return f"{self.letter} {self.landmark.name}"
        arrow = _ARROWS[round(heading / (math.pi / 4.0)) % len(_ARROWS)]
        return f"{self.letter} {self.landmark.name} {arrow}"


def draw_sketch(answer: Where, graph: RelationGraph, width: int, *, coloured: bool = True) -> Text:
    """Return the picture of an answer, at most `width` columns wide: density, outlines of surfaces, landmarks."""
    shown = _landmarks_of(answer, graph)
    outlines = list(_outlines(shown, graph))
    marks = letter([one for one in shown if not graph.classes[one.kind].is_surface])
    window = frame(answer.mixture, [mark.landmark for mark in marks], outlines, width - _GUTTER)
    values = _densities(answer.mixture, window)
    edges = np.zeros(values.shape, dtype=np.bool_)
    for outline in outlines:
        edges[tuple(window.cells_of(outline).T)] = True
    letters = {}
    for mark in reversed(marks):
        row, column = window.cells_of(np.array([[mark.landmark.x, mark.landmark.y]]))[0]
        letters[int(row) // 2, int(column)] = mark.letter
    paint = _colours if coloured else _shades
    body = paint(values, edges, letters)
    return Text("\n").join([*_with_axes(body, window), *_legend(marks, width)])


def letter(landmarks: Sequence[Landmark]) -> list[Mark]:
    """Give each landmark a letter, its initial where that is free; as many as there are letters."""
    free = dict.fromkeys(_LETTERS)
    marks = []
    for landmark in landmarks[: len(_LETTERS)]:
        wanted = [sign for sign in landmark.name.upper() if sign in free]
        chosen = wanted[0] if wanted else next(iter(free))
        del free[chosen]
        marks.append(Mark(chosen, landmark))
    return marks


def frame(
    mixture: GaussianMixture, landmarks: Iterable[Landmark], outlines: Iterable[FloatArray], width: int
) -> Window:
    """Return the window that shows all of a mixture, landmarks and outlines in at most `width` columns."""
    reach = _REACH_SIGMAS * np.sqrt(np.einsum("mii->mi", mixture.covariances))
    places = [mixture.means - reach, mixture.means + reach, *outlines]
    points = np.concatenate([*places, *(np.array([[one.x, one.y]]) for one in landmarks)])
    low, high = points.min(axis=0), points.max(axis=0)
    side = 1.1 * np.maximum(high - low, _LEAST_ASPECT * (high - low).max())
    most = max(8, min(width, MAX_COLUMNS))
    pixel = float(max(side[0] / most, side[1] / (2 * MAX_ROWS)))
    columns = min(most, max(LEAST_COLUMNS, math.ceil(side[0] / pixel)))
    shape = (columns, 2 * min(MAX_ROWS, math.ceil(0.5 * side[1] / pixel)))
    return Window(0.5 * (low + high - pixel * np.array(shape)), pixel, *shape)


def _landmarks_of(answer: Where, graph: RelationGraph) -> list[Landmark]:
    if answer.frame == "map":
        return list(graph.landmarks)
    return [Landmark(answer.frame, graph.class_of(answer.frame), 0.0, 0.0, heading=math.pi)]


def _outlines(landmarks: Iterable[Landmark], graph: RelationGraph) -> Iterator[FloatArray]:
    """Yield points (N, 2) along the edges of the surfaces whose size and pose are known."""
    for one in landmarks:
        kind = graph.classes[one.kind]
        if kind.is_surface and kind.width > 0.0 and one.heading is not None:
            half = 0.5 * np.array([kind.depth, kind.width])
            corners = half * np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])
            shares = np.linspace(0.0, 1.0, 4 * MAX_COLUMNS)[:, None]
            edges = [a + shares * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
            yield np.concatenate(edges) @ rotation(one.heading).T + np.array([one.x, one.y])


def _densities(mixture: GaussianMixture, window: Window) -> FloatArray:
    """Return the density of each pixel as a share of the greatest, blurred so that no peak falls between pixels."""
    blur = (_BLUR * window.pixel) ** 2 * np.eye(2)
    points = window.centres().reshape(-1, 2)
    density = np.zeros(len(points))
    for start in range(0, len(mixture), _CHUNK):
        chunk = slice(start, start + _CHUNK)
        share = float(mixture.weights[chunk].sum())
        if share > 0.0:
            weights = mixture.weights[chunk] / share
            part = GaussianMixture(weights, mixture.means[chunk], mixture.covariances[chunk] + blur)
            density += share * part.pdf(points)
    return np.asarray(density / density.max()).reshape(window.rows, window.columns)


def _colours(values: FloatArray, edges: BoolArray, letters: dict[tuple[int, int], str]) -> list[Text]:
    position = np.sqrt(np.where(values < SHOWN_SHARE_OF_PEAK, 0.0, values)) * (len(_RAMP) - 1)
    pixels = np.stack([np.interp(position, range(len(_RAMP)), channel) for channel in _RAMP.T], axis=-1)
    pixels = np.where((edges & (values < 0.5))[..., None], _EDGE, pixels)
    lines = []
    for row in range(len(pixels) // 2):
        cells = enumerate(zip(pixels[2 * row], pixels[2 * row + 1], strict=True))
        lines.append(Text.assemble(*(_cell(*pair, letters.get((row, column))) for column, pair in cells)))
    return lines


def _cell(top: FloatArray, bottom: FloatArray, sign: str | None) -> tuple[str, Style]:
    lower = Color.from_rgb(*bottom)
    if sign is None:
        return "▀", Style(color=Color.from_rgb(*top), bgcolor=lower)
    ink = _LANDMARK_ON_BRIGHT if bottom.sum() > _BRIGHT else _LANDMARK
    return sign, Style(color=ink, bgcolor=lower, bold=True)


def _shades(values: FloatArray, edges: BoolArray, letters: dict[tuple[int, int], str]) -> list[Text]:
    shown = np.where(values < SHOWN_SHARE_OF_PEAK, 0.0, np.sqrt(values))
    levels = np.ceil(shown * (len(_SHADES) - 1)).astype(np.int64)
    levels = np.maximum(levels[::2], levels[1::2])
    edged = edges[::2] | edges[1::2]
    lines = []
    for row, (line, on_edge) in enumerate(zip(levels, edged, strict=True)):
        signs = [
            "+" if edge and level < 2 else _SHADES[level] for level, edge in zip(line, on_edge, strict=True)
        ]
        lines.append(Text("".join(letters.get((row, column), sign) for column, sign in enumerate(signs))))
    return lines


def _with_axes(body: list[Text], window: Window) -> Iterator[Text]:
    step = _tick_step(_PIXELS_TO_A_TICK * window.pixel)
    decimals = max(0, -math.floor(math.log10(step)))
    heights = {
        window.cells_of(np.array([[window.corner[0], y]]))[0][0] // 2: y for y in _ticks(window, 1, step)
    }
    for row, line in enumerate(body):
        label = f"{heights[row]:.{decimals}f} ┤" if row in heights else "│"
        yield Text.assemble((label.rjust(_GUTTER), _AXES), line)
    rule, labels = ["─"] * window.columns, [*_UNIT.ljust(window.columns + 2 * _GUTTER)]
    for x in _ticks(window, 0, step):
        column = int(window.cells_of(np.array([[x, window.corner[1]]]))[0][1])
        rule[column] = "┴"
        text = f"{x:.{decimals}f}"
        start = max(len(_UNIT) + 1, _GUTTER + column - len(text) // 2)
        labels[start : start + len(text)] = text
    yield Text(f"{'└':>{_GUTTER}}{''.join(rule)}", _AXES)
    yield Text("".join(labels).rstrip(), _AXES)


def _ticks(window: Window, axis: int, step: float) -> list[float]:
    low = window.corner[axis]
    high = low + window.pixel * (window.columns, window.rows)[axis]
    return [float(step * n) + 0.0 for n in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _tick_step(about: float) -> float:
    """Return 1, 2 or 5 times a power of ten [m], at least `about`."""
    power = 10.0 ** math.floor(math.log10(about))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= about)


def _legend(marks: Sequence[Mark], width: int) -> list[Text]:
    if not marks:
        return []
    named = [mark.legend for mark in marks[:_NAMED]]
    if len(marks) > _NAMED:
        named.append(f"and {len(marks) - _NAMED} more")
    return [Text(" " * _GUTTER + "   ".join(named), str(_LANDMARK.name))]
