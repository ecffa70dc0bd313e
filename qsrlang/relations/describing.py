"""Places to text: the built-in relations that hold between objects, as atoms of the language."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import unit
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.relations.qualify import DIRECTIONS, direction_of, qualify

DEFAULT_REACH = 0.75
_HALF_WAY = 0.5
_NORTH = np.array([0.0, 1.0])


def relations_between(
    names: Sequence[str],
    points: npt.ArrayLike,
    viewer: npt.ArrayLike | None = None,
    *,
    sizes: npt.ArrayLike | None = None,
    headings: npt.ArrayLike | None = None,
    support: ConvexPolygon | None = None,
    reach: float = DEFAULT_REACH,
    pairs: Sequence[tuple[int, int]] | None = None,
) -> tuple[str, ...]:
    """Return the atoms that hold of objects at points (N, 2) [m]: `left-of(Cup, Keyboard)`, `close-to(Cup, Keyboard)`.

    Directions are as seen by a viewer at (2,), by `qualify`; without one, `wrt absolute`, along +y of the map. Close-to
    is the first half of the way from where the boxes touch to where the referent's box meets the edge of the support,
    or `reach` [m] further, distant-from all beyond. Boxes have sizes (N, 2), width and depth [m], and are turned by the
    relatum's heading (N,) [rad]. `pairs` are (referent, relatum) by number; by default each object is related to all
    before it. Points in one place have no direction. Raises ValueRangeError where shapes or numbers do not fit.
    """
    count = len(names)
    places = frozen_array("points", points, (count, 2))
    turns = frozen_array("headings", np.zeros(count) if headings is None else headings, (count,))
    boxes = frozen_array("sizes", np.zeros((count, 2)) if sizes is None else sizes, (count, 2))
    chosen = _chosen(pairs, count)
    referents, relata = chosen.T
    origins = places[relata] - _NORTH if viewer is None else np.asarray(viewer, dtype=np.float64)
    directions = direction_of(qualify(origins, places[relata], places[referents]))
    shares = _shares(places, turns, boxes, chosen, support, reach)
    frame = " wrt absolute" if viewer is None else ""
    return tuple(_atoms(names, chosen, directions, shares < _HALF_WAY, frame))


def _chosen(pairs: Sequence[tuple[int, int]] | None, count: int) -> IntArray:
    every = [(i, j) for i in range(count) for j in range(i)] if pairs is None else list(pairs)
    chosen = np.array(every, dtype=np.int64).reshape(-1, 2)
    if len(chosen) and (chosen.min() < 0 or chosen.max() >= count or (chosen[:, 0] == chosen[:, 1]).any()):
        raise ValueRangeError("pairs", every, f"two different numbers from 0 to {count - 1} each")
    return chosen


def _shares(
    places: FloatArray,
    turns: FloatArray,
    boxes: FloatArray,
    pairs: IntArray,
    support: ConvexPolygon | None,
    reach: float,
) -> FloatArray:
    """Return how far along the way from contact to the edge each referent is: (P,), 0 at contact."""
    referents, relata = pairs.T
    offsets = places[referents] - places[relata]
    theta = np.arctan2(offsets[:, 1], offsets[:, 0])
    own, yaws = 0.5 * boxes[referents][:, ::-1], turns[relata]
    contact = _contact(own + 0.5 * boxes[relata][:, ::-1], theta - yaws)
    edge = contact + reach
    if support is not None:
        margins = np.stack([support.box_reach(yaw, *half) for yaw, half in zip(yaws, own, strict=True)])
        edge = support.ray_lengths(support.nearest(places[relata]), unit(theta), margins)
    way = np.maximum(edge - contact, np.finfo(np.float64).tiny)
    return np.asarray((np.hypot(offsets[:, 0], offsets[:, 1]) - contact) / way)


def _contact(halves: FloatArray, angles: FloatArray) -> FloatArray:
    """Return how far apart two boxes touch, their half lengths and half widths (P, 2) added, along angles (P,)."""
    off = np.abs(unit(angles))
    sides = np.divide(halves, off, out=np.full_like(halves, np.inf), where=off > 0.0)
    return np.where(halves.any(axis=-1), sides.min(axis=-1), 0.0)


def _atoms(
    names: Sequence[str], pairs: IntArray, directions: IntArray, is_close: npt.NDArray[np.bool_], frame: str
) -> Iterator[str]:
    for (referent, relatum), direction, close in zip(
        pairs.tolist(), directions.tolist(), is_close.tolist(), strict=True
    ):
        arguments = f"({names[referent]}, {names[relatum]})"
        if direction >= 0:
            yield f"{DIRECTIONS[direction]}{arguments}{frame}"
        yield f"{'close-to' if close else 'distant-from'}{arguments}"
