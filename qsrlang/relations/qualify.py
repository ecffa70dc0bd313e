"""Poses to relations: the ternary point configuration calculus (TPCC) over many triples at once."""

from __future__ import annotations

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.errors import ValueRangeError

# Moratz, Nebel and Freksa 2003; Dylla and Moratz 2004. Twelve directions, counter-clockwise from straight behind,
# each close (c) or distant (d); and the degenerate ones: sam (referent on relatum), dou (relatum on origin), tri (all).
_DIRECTIONS = ("sb", "lb", "bl", "sl", "fl", "lf", "sf", "rf", "fr", "sr", "br", "rb")
SAM, DOU, TRI, UNDEFINED = 24, 25, 26, 27
TPCC = (*(f"c{one}" for one in _DIRECTIONS), *(f"d{one}" for one in _DIRECTIONS), "sam", "dou", "tri")
DIRECTIONS = ("behind-of", "left-of", "in-front-of", "right-of")
STRAIGHT = 1e-9
_SECTORS = np.array([0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 0] * 2 + [-1] * 4)


def qualify(origins: FloatArray, relata: FloatArray, referents: FloatArray) -> IntArray:
    """Return the TPCC relation (N,) of each referent to its relatum as seen from its origin: an index into TPCC.

    With d = relatum - origin and v = referent - relatum, the direction is that of v in the frame of d (straight on is
    behind, for the paper's relative angle 0 lies behind the relatum); the referent is close where |v| < |d|. Within
    STRAIGHT [rad] of an axis it is on it, since coordinates are rounded. A diagonal belongs to behind or in front.
    Points are (N, 2) or (2,), in one frame [m]; a triple with a coordinate that is no number is
    UNDEFINED. Raises ValueRangeError where the shapes do not fit.
    """
    points = [np.asarray(one, dtype=np.float64) for one in (origins, relata, referents)]
    try:
        a, b, c = np.broadcast_arrays(*points)
    except ValueError:
        raise ValueRangeError(
            "the shape of the points", [one.shape for one in points], "(N, 2) each"
        ) from None
    if a.ndim > 2 or a.shape[-1:] != (2,):
        raise ValueRangeError("the shape of the points", a.shape, "(N, 2) or (2,)")
    codes: IntArray = _qualify(*(np.ascontiguousarray(one.reshape(-1, 2)) for one in (a, b, c)))
    return codes.reshape(a.shape[:-1])


def direction_of(codes: IntArray) -> IntArray:
    """Return which of DIRECTIONS each TPCC relation is; -1 for the degenerate ones.

    behind = {sb, lb, rb}, left = {bl, sl, fl}, front = {lf, sf, rf}, right = {fr, sr, br}, close or distant.
    """
    return np.asarray(_SECTORS[codes])


@njit(cache=True)
def _qualify(origins: FloatArray, relata: FloatArray, referents: FloatArray) -> IntArray:  # pragma: no cover
    codes = np.empty(len(origins), dtype=np.int64)
    for n in range(len(origins)):
        dx, dy = relata[n, 0] - origins[n, 0], relata[n, 1] - origins[n, 1]
        vx, vy = referents[n, 0] - relata[n, 0], referents[n, 1] - relata[n, 1]
        codes[n] = _relation(dx, dy, vx, vy)
    return codes


@njit(cache=True, inline="always")
def _relation(dx: float, dy: float, vx: float, vy: float) -> int:  # pragma: no cover
    along, left = dx * vx + dy * vy, dx * vy - dy * vx
    base, own = dx * dx + dy * dy, vx * vx + vy * vy
    if not np.isfinite(base + own):
        return UNDEFINED
    if base == 0.0:
        return TRI if own == 0.0 else DOU
    if own == 0.0:
        return SAM
    tiny = STRAIGHT * STRAIGHT * base * own
    along, left = along if along * along > tiny else 0.0, left if left * left > tiny else 0.0
    return _direction(along, left) + (0 if own < base else 12)


@njit(cache=True, inline="always")
def _direction(along: float, left: float) -> int:  # pragma: no cover
    if left == 0.0:
        return 0 if along > 0.0 else 6
    if along == 0.0:
        return 3 if left > 0.0 else 9
    steep = abs(left) > abs(along)
    if left > 0.0:
        return (2 if steep else 1) if along > 0.0 else (4 if steep else 5)
    return (10 if steep else 11) if along > 0.0 else (8 if steep else 7)
