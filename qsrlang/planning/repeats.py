"""Looks from nearly the same pose: how much of a second one is the first one over again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import wrap
from qsrlang.planning.views import Views

_NEGLIGIBLE = 0.01


@dataclass(frozen=True, slots=True)
class Repeats:
    """How alike two looks are: rho = share x exp(-(distance / length)^2 / 2 - (turn / angle)^2 / 2).

    With probability rho a look at a thing comes out as the earlier one did, else anew; after a miss its detection
    rate is therefore d (1 - rho). A share of 0 takes all looks for independent.
    """

    share: float = 0.9
    length: float = 0.5
    angle: float = 0.5

    def __post_init__(self) -> None:
        if not 0.0 <= self.share <= 1.0:
            raise ValueRangeError("the share of repeated looks", self.share, "0 to 1")
        for what, value in (("length", self.length), ("angle", self.angle)):
            if not 0.0 < value < math.inf:
                raise ValueRangeError(f"the {what} of repeated looks", value, "a positive number")

    def likeness(self, poses: FloatArray, pose: FloatArray) -> FloatArray:
        """Return rho of looks from poses (N, 3) and from a pose (3,): (N,)."""
        offsets = poses[:, :2] - pose[:2]
        apart = np.einsum("nd,nd->n", offsets, offsets) / self.length**2
        turned = (wrap(poses[:, 2] - pose[2]) / self.angle) ** 2
        return np.asarray(self.share * np.exp(-0.5 * (apart + turned)))


INDEPENDENT = Repeats(share=0.0)


@dataclass(frozen=True, slots=True, eq=False)
class PastLook:
    """A look that did not show the target: its pose (3,), and the detection rates (K,) it had."""

    pose: FloatArray
    rates: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", frozen_array("the pose of a look", self.pose, (3,)))
        object.__setattr__(self, "rates", frozen_array("its rates", self.rates, (None,)))


def discounted(views: Views, looks: Sequence[PastLook], repeats: Repeats) -> Views:
    """Return the views with d (1 - rho) for what a similar look has already failed to show, for every such look."""
    if not looks or repeats.share == 0.0:
        return views
    rates = views.rates.copy()
    for look in looks:
        likeness = repeats.likeness(views.poses, look.pose)
        for view in np.flatnonzero(likeness > _NEGLIGIBLE):
            part = slice(views.starts[view], views.starts[view + 1])
            again = look.rates[views.shown[part]] > 0.0
            rates[part] *= np.where(again, 1.0 - likeness[view], 1.0).astype(np.float32)
    return views.with_rates(rates)
