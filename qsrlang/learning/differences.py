"""What changed between two files of knowledge: pair by pair, in words and in bits."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnplaceableError
from qsrlang.learning.rhythm import DIRECTIONS, direction_numbers
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.relations.graph import Pair

DRAWS = 4000
_SAME_BITS = 0.005
_SAME_SHARE = 0.02
_SAME_METRES = 0.01


@dataclass(frozen=True, slots=True)
class Change:
    """What is said of a pair now that was not before: in words, and as D(new || old) [bit] with its standard error.

    `bits` is None where only one of the files speaks of the pair.
    """

    pair: Pair
    words: str
    bits: float | None = None
    error: float = 0.0


def differences(old: KnowledgeBase, new: KnowledgeBase) -> list[Change]:
    """Return what changed, the largest change first; D is the mean over draws of log2 new(x) / old(x).

    Each pair is compared by its own relative mixture (equation 2 of Kunze et al. 2014), whatever else is known.
    """
    before, after = _mixtures(old), _mixtures(new)
    changes = [Change(pair, "is new") for pair in sorted(after.keys() - before.keys())]
    changes += [Change(pair, "is gone") for pair in sorted(before.keys() - after.keys())]
    compared = [_compared(pair, before[pair], after[pair]) for pair in sorted(before.keys() & after.keys())]
    changed = [change for change in compared if change is not None]
    return [*sorted(changed, key=lambda change: -(change.bits or 0.0)), *changes]


def divergence_bits(new: GaussianMixture, old: GaussianMixture) -> tuple[float, float]:
    """Return D(new || old) [bit] and its standard error, by DRAWS draws of a generator with seed 0."""
    points = new.sample(DRAWS, np.random.default_rng(0))
    ratios = (new.logpdf(points) - old.logpdf(points)) / np.log(2.0)
    return float(max(ratios.mean(), 0.0)), float(ratios.std() / np.sqrt(DRAWS))


def _mixtures(knowledge: KnowledgeBase) -> dict[Pair, GaussianMixture]:
    """Return the relative mixture of each pair that a choice speaks of, for those that have one."""
    found: dict[Pair, GaussianMixture] = {}
    for choice in knowledge.graph.choices:
        for referent, relatum in sorted(choice.governs):
            graph = replace(knowledge.graph, choices=(choice,), landmarks=(), requirements=())
            try:
                found[referent, relatum] = KnowledgeBase(graph).where(referent, wrt=relatum).mixture
            except UnplaceableError:
                continue
    return found


def _compared(pair: Pair, old: GaussianMixture, new: GaussianMixture) -> Change | None:
    bits, error = divergence_bits(new, old)
    if bits < max(_SAME_BITS, 2.0 * error):
        return None
    words = [*_share_words(old, new), *_move_words(old, new), *_spread_words(old, new)]
    return Change(pair, "; ".join(words) or "another shape", bits, error)


def _share_words(old: GaussianMixture, new: GaussianMixture) -> list[str]:
    before, after = _direction_shares(old), _direction_shares(new)
    order = np.argsort(-np.abs(after - before))
    return [
        f"{DIRECTIONS[one]} {100 * before[one]:.0f} % → {100 * after[one]:.0f} %"
        for one in order
        if abs(after[one] - before[one]) >= _SAME_SHARE
    ]


def _direction_shares(mixture: GaussianMixture) -> FloatArray:
    points = mixture.sample(DRAWS, np.random.default_rng(1))
    return np.bincount(direction_numbers(points), minlength=len(DIRECTIONS)) / DRAWS


def _move_words(old: GaussianMixture, new: GaussianMixture) -> list[str]:
    (x, y), _ = new.moments()
    (x0, y0), _ = old.moments()
    moved = float(np.hypot(x - x0, y - y0))
    return [f"mean moved {100 * moved:.0f} cm"] if moved >= _SAME_METRES else []


def _spread_words(old: GaussianMixture, new: GaussianMixture) -> list[str]:
    gained = (old.entropy() - new.entropy()) / np.log(2.0)
    if abs(gained) < 10.0 * _SAME_BITS:
        return []
    return [f"{abs(gained):.1f} bits {'more' if gained > 0.0 else 'less'} certain"]
