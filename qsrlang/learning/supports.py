"""On or in what things are found: Dirichlet-multinomial shares, each place with the same weight."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import gammaln

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.learning.experience import ObjectSums

MAX_SUPPORTS = 5
MIN_SHARE = 0.03
MIN_PLACES = 5
# What mostly stands here is furniture, which is no question of shares.
FLOOR = "Floor"
# Receptacles that close about what they hold; all others carry it on top.
CONTAINERS = frozenset(
    {
        "Cabinet",
        "Drawer",
        "Fridge",
        "Microwave",
        "Dishwasher",
        "Safe",
        "Box",
        "GarbageCan",
        "Pot",
        "Bowl",
        "Sink",
    }
    | {"SinkBasin", "BathtubBasin", "Bathtub", "LaundryHamper", "Cup", "Mug", "Pan"}
)
_LEAST, _MOST = -5.0, 7.0


@dataclass(frozen=True, slots=True, eq=False)
class SupportShares:
    """How a class of objects is spread over its supports: shares (S,), the missing rest is elsewhere.

    `concentration` is that of the Dirichlet about the shares of all classes, the one that makes the places likeliest.
    """

    kind: str
    relations: tuple[str, ...]
    supports: tuple[str, ...]
    shares: FloatArray
    concentration: float
    places: int


def support_shares(objects: ObjectSums) -> list[SupportShares]:
    """Return the shares of every class that was seen on or in something at MIN_PLACES or more places.

    shares = (c w + sum over places of their own shares) / (c + places): the Dirichlet posterior's mean, with w the
    shares over all classes and c the concentration that maximises the Dirichlet-multinomial likelihood of the classes.
    Furniture, which mostly stands on the floor, is left out.
    """
    rows = [row for row, key in enumerate(objects.keys) if objects.words[key[1]] != "" and key[0] != key[1]]
    keys, counts = objects.keys[rows], objects.totals[rows, 0]
    supports = np.unique(keys[:, 1])
    tables = {int(kind): _table(keys, counts, int(kind), supports) for kind in np.unique(keys[:, 0])}
    tables = {kind: table for kind, table in tables.items() if len(table) >= MIN_PLACES}
    if not tables:
        return []
    totals = np.stack([table.sum(axis=0) for table in tables.values()])
    overall = totals.sum(axis=0) / totals.sum()
    concentration = dirichlet_concentration(totals, overall)
    found = [_shares(objects, kind, one, supports, overall, concentration) for kind, one in tables.items()]
    told = [share for share in found if share.supports and share.supports[0] != FLOOR]
    return sorted(told, key=lambda share: share.kind)


def dirichlet_concentration(counts: FloatArray, shares: FloatArray) -> float:
    """Return the c that maximises sum over rows of log Dirichlet-multinomial(counts (R, S) | c shares (S,))."""

    def cost(logarithm: float) -> float:
        alpha = np.exp(logarithm) * np.maximum(shares, 1e-9)
        total = counts.sum(axis=1)
        rows = gammaln(alpha.sum()) - gammaln(alpha.sum() + total)
        return -float(rows.sum() + (gammaln(alpha + counts) - gammaln(alpha)).sum())

    return float(np.exp(minimize_scalar(cost, bounds=(_LEAST, _MOST), method="bounded").x))


def _table(keys: IntArray, counts: FloatArray, kind: int, supports: IntArray) -> FloatArray:
    """Return the part of each place's sightings of a class that was on or in each support: (P, S)."""
    own = keys[:, 0] == kind
    places = np.unique(keys[own, 2])
    table = np.zeros((len(places), len(supports)))
    rows, columns = np.searchsorted(places, keys[own, 2]), np.searchsorted(supports, keys[own, 1])
    np.add.at(table, (rows, columns), counts[own])
    return np.asarray(table / table.sum(axis=1, keepdims=True))


def _shares(
    objects: ObjectSums,
    kind: int,
    table: FloatArray,
    supports: IntArray,
    overall: FloatArray,
    concentration: float,
) -> SupportShares:
    shares = (concentration * overall + table.sum(axis=0)) / (concentration + len(table))
    order = [row for row in np.argsort(-shares) if shares[row] >= MIN_SHARE and table[:, row].any()]
    names = [objects.words[supports[row]] for row in order[:MAX_SUPPORTS]]
    return SupportShares(
        kind=objects.words[kind],
        relations=tuple("in" if name in CONTAINERS else "on" for name in names),
        supports=tuple(names),
        shares=shares[order[:MAX_SUPPORTS]],
        concentration=concentration,
        places=len(table),
    )
