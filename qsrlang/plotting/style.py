"""The look of every picture: colours, sizes, axes, scale bar and colour bar.

What is believed of the object is warm, what the robot does is blue, what was seen is green; the colours
are those of Okabe and Ito (2008), which colour-blind readers tell apart.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypedDict

from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.ticker import MaxNLocator

from qsrlang.maps.occupancy import Cell

FONT = "DejaVu Sans"
TEXT_SIZE = 8.0
SMALL_SIZE = 7.0
_CAPTION_STEP = 11.5
FIGURE_WIDTH = 6.4
DOTS_PER_INCH = 150

INK = "#222222"
MUTED = "#6b6b6b"
CELL_GREYS = {Cell.UNKNOWN: "#e9e9e9", Cell.FREE: "#ffffff", Cell.OCCUPIED: "#8c8c8c"}
BELIEF = "#7f2704"
ROBOT = "#0b3c6f"
SEEN = "#009e73"
SUPPORT = "#8a8a8a"
PARTS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#b8a900")
OTHER_PART = "#b5aea2"

DENSITY_COLOURS = LinearSegmentedColormap.from_list(
    "density", ["#ffffff", "#fdebd0", "#f9c98a", "#ee9b2f", "#c45a0c", "#7f2704"]
)
WEIGHT_COLOURS = LinearSegmentedColormap.from_list("weight", ["#eadfc8", "#f4c06a", "#e08214", "#a63603"])
VALUE_COLOURS = LinearSegmentedColormap.from_list("value", ["#b3d3ea", "#5aa5d6", "#0072b2", "#08306b"])
HEIGHT_COLOURS = LinearSegmentedColormap.from_list(
    "height", ["#2d3f6b", "#3f7390", "#5fa48f", "#a9c77a", "#f2e08a"]
)

POINTS_PER_INCH = 72.0
_TICK_LENGTH = 2.5
_LINE = 0.6
_BAR_DROP = 21.0
_CAPTION_GAP = 5.0


class TextSetting(TypedDict):
    """How text is set."""

    fontfamily: str
    fontsize: float
    fontweight: str
    parse_math: bool


def text(size: float = TEXT_SIZE, *, bold: bool = False) -> TextSetting:
    """Return how text is set: font, size, and plain, never as mathematics, whatever signs a name holds."""
    return TextSetting(
        fontfamily=FONT, fontsize=size, fontweight="bold" if bold else "normal", parse_math=False
    )


def write_caption(axes: Axes, lines: Sequence[str]) -> None:
    """Write lines above the axes, flush left, the first one bold; plain text, whatever signs a name holds."""
    for number, line in enumerate(lines):
        height = _CAPTION_GAP + _CAPTION_STEP * (len(lines) - 1 - number)
        label = axes.annotate(
            line,
            (0.0, 1.0),
            xycoords="axes fraction",
            xytext=(0.0, height),
            textcoords="offset points",
            color=INK,
            **text(bold=number == 0),
        )
        label.set_gid("caption")


def halo(width: float = 2.0) -> list[AbstractPathEffect]:
    """Return a white rim that keeps a label readable on any ground."""
    return [withStroke(linewidth=width, foreground="white", alpha=0.85)]


def dress(axes: Axes) -> None:
    """Give the axes thin lines, small ticks and the font of the house."""
    axes.tick_params(
        labelsize=SMALL_SIZE, labelfontfamily=FONT, length=_TICK_LENGTH, width=_LINE, pad=2, colors=INK
    )
    for spine in axes.spines.values():
        spine.set_linewidth(_LINE)
        spine.set_edgecolor(MUTED)


def label_axes(axes: Axes, x_label: str, y_label: str) -> None:
    """Name the axes, units included."""
    axes.set_xlabel(x_label, color=INK, labelpad=2, **text())
    axes.set_ylabel(y_label, color=INK, labelpad=2, **text())


def round_length(extent: float) -> float:
    """Return the longest of 1, 2 and 5 times a power of ten that is at most a quarter of `extent`."""
    power = 10.0 ** math.floor(math.log10(extent / 4.0))
    return max(power * step for step in (1.0, 2.0, 5.0) if power * step <= extent / 4.0 * (1.0 + 1e-9))


def length_text(metres: float) -> str:
    """Return a round length with the unit a reader expects: '50 cm', '2 m'."""
    return f"{metres:g} m" if metres >= 1.0 else f"{100.0 * metres:g} cm"


def add_scale_bar(axes: Axes) -> None:
    """Draw a scale bar below the lower right corner, exact in the axes' metres."""
    x0, x1 = axes.get_xlim()
    length = round_length(x1 - x0)
    down = -_BAR_DROP / (POINTS_PER_INCH * axes.bbox.height / axes.figure.dpi)
    axes.plot(
        [x1 - length, x1],
        [down, down],
        transform=axes.get_xaxis_transform(),
        color=INK,
        linewidth=2.0,
        solid_capstyle="butt",
        clip_on=False,
        gid="scale-bar",
    )
    axes.text(
        x1 - length - 0.01 * (x1 - x0),
        down,
        length_text(length),
        transform=axes.get_xaxis_transform(),
        ha="right",
        va="center",
        color=INK,
        **text(SMALL_SIZE),
    )


def add_colour_bar(
    figure: Figure, box: tuple[float, float, float, float], colours: Colormap, scale: Normalize, label: str
) -> None:
    """Draw a vertical colour bar in `box` (left, bottom, width, height; figure shares), labelled on top."""
    axes = figure.add_axes(box, label="colour-bar")
    steps = [[(i + 0.5) / 256.0] for i in range(256)]
    extent = (0.0, 1.0, float(scale.vmin or 0.0), float(scale.vmax or 0.0))
    axes.imshow(steps, cmap=colours, vmin=0.0, vmax=1.0, aspect="auto", origin="lower", extent=extent)
    axes.set_xticks([])
    axes.yaxis.tick_right()
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4))
    dress(axes)
    axes.set_title(label, color=INK, loc="left", pad=4, **text(SMALL_SIZE))
