"""Which of all pairs to write: those that tell most of places not seen, and no circles."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Sequence

import numpy as np

from qsrlang.learning.experience import ObjectSums
from qsrlang.learning.learner import Learned, LearnedPair
from qsrlang.learning.supports import SupportShares

MAX_RELATA = 2
MIN_GAIN = 0.1
MIN_PLACES = 5
MIN_SEEN = 10
LEAST_SIDE = 0.01


def selected(learned: Learned, shares: Sequence[SupportShares], objects: ObjectSums) -> list[LearnedPair]:
    """Return the pairs to write, by relatum: for each referent the MAX_RELATA that gain most over all places.

    A pair gains MIN_GAIN nats an object or more, over MIN_SEEN sightings at MIN_PLACES places or more
    (at all, where there are fewer). What
    carries the referent is left out, for that cuts its density already, and so is a relatum that is found on several
    supports itself. Of two classes the relatum is the one with the greater product of what it tells of others, over all
    its pairs, and its size, for indirect search pays where the landmark is easier to see (Wixson and Ballard 1994); so
    no circle of references can close.
    """
    carriers = {(share.kind, support) for share in shares for support in share.supports}
    roaming = {share.kind for share in shares if len(share.supports) > 1}
    most = max(
        (one.cells.place_count for one in (*learned.pairs.values(), *learned.local.values())), default=0
    )
    telling = [
        one
        for one in (*learned.pairs.values(), *learned.local.values())
        if _tells(one, min(MIN_PLACES, most)) and one.pair not in carriers and one.pair[1] not in roaming
    ]
    told: defaultdict[str, float] = defaultdict(float)
    for one in telling:
        told[one.pair[1]] += worth(one)
    rank = {name: (nats * _side(objects, name), name) for name, nats in told.items()}
    kept: dict[str, list[LearnedPair]] = {}
    for one in sorted(telling, key=lambda one: (-worth(one), one.pair)):
        referent, relatum = one.pair
        if rank[relatum] > rank.get(referent, (0.0, referent)) and len(kept.get(referent, ())) < MAX_RELATA:
            kept.setdefault(referent, []).append(one)
    return sorted((one for pairs in kept.values() for one in pairs), key=lambda one: one.pair[::-1])


def roots(kept: Collection[LearnedPair]) -> set[str]:
    """Return the classes that place others and are placed by none: the landmarks to start from."""
    return {one.pair[1] for one in kept} - {one.pair[0] for one in kept}


def worth(one: LearnedPair) -> float:
    """Return what a pair gains over all places [nat]."""
    return one.stack.gain * one.cells.place_count


def _side(objects: ObjectSums, name: str) -> float:
    """Return the side of a square as large as an object of a class seen from above [m]."""
    size = objects.size(name)
    return LEAST_SIDE if size is None else max(float(np.sqrt(size[0] * size[1])), LEAST_SIDE)


def _tells(one: LearnedPair, places: int) -> bool:
    known = one.cells.place_count >= places and float(one.cells.counts.sum()) >= MIN_SEEN
    return known and one.stack.gain >= MIN_GAIN and one.density.mixture is not None
