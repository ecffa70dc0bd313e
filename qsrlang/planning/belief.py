"""What the robot believes of the supports: a weight per voxel, and a belief that what it sees keeps up to date."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.detecting import Detector
from qsrlang.planning.instances import ONE, Instances

_SUM_SLACK = 1e-9


def voxel_weights(
    mixture: GaussianMixture | None,
    voxels_map: npt.ArrayLike,
    floor: float,
    gain: float,
    claimed: float = 1.0,
) -> FloatArray:
    """Return P_QSR(v_i) = floor + gain * claimed * p(x_i), the weight of each support voxel: (K,).

    The paper's authors used floor 1 and gain 10. `p` is the density of the mixture in the map frame [1/m^2] at the
    voxel centres (K, 2) [m]; without a mixture every voxel weighs `floor`. `claimed` is the share of the mass
    that the statements place somewhere. Raises ValueRangeError on a negative floor or gain.
    """
    voxels = frozen_array("the voxels of a belief", voxels_map, (None, 2))
    for what, value in (("weight floor", floor), ("weight gain", gain)):
        if not 0.0 <= value < math.inf:
            raise ValueRangeError(f"the {what}", value, "a number of at least 0")
    if not 0.0 <= claimed <= 1.0:
        raise ValueRangeError("the claimed share", claimed, "a share from 0 to 1")
    if mixture is None or len(voxels) == 0:
        return np.full(len(voxels), float(floor))
    return np.asarray(floor + gain * claimed * mixture.pdf(voxels), dtype=np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class Belief:
    """Where one instance of a target is: a probability per place (K, 3) [m], and one for "not here".

    The places are where the target's centre would be. `prior` (K,) and `absent` sum to 1; `likelihood` (K,) and
    `absent_likelihood` are those of all that was seen so far, of any common scale. The posterior is
    b(x) = prior(x) likelihood(x) / (the sum of these + absent x absent_likelihood).
    """

    points_map: FloatArray
    prior: FloatArray
    absent: float
    likelihood: FloatArray
    absent_likelihood: float = 1.0
    instances: Instances = ONE

    def __post_init__(self) -> None:
        points = frozen_array("the places of a belief", self.points_map, (None, 3))
        object.__setattr__(self, "points_map", points)
        if len(points) == 0:
            raise ValueRangeError("the number of places of a belief", 0, "at least 1: no support was found")
        for name in ("prior", "likelihood"):
            value = frozen_array(f"the {name} of a belief", getattr(self, name), (len(points),))
            if (value < 0.0).any():
                raise ValueRangeError(f"the {name} of a belief", float(value.min()), "at least 0 everywhere")
            object.__setattr__(self, name, value)
        if not 0.0 <= self.absent < 1.0:
            raise ValueRangeError("the chance that the target is not here", self.absent, "0 or more, below 1")
        if abs(float(self.prior.sum()) + self.absent - 1.0) > _SUM_SLACK:
            raise ValueRangeError("the sum of a belief", float(self.prior.sum()) + self.absent, "1")

    @classmethod
    def of_weights(
        cls,
        points_map: npt.ArrayLike,
        weights: npt.ArrayLike,
        floor: float = 0.0,
        absent: float = 0.0,
        instances: Instances = ONE,
    ) -> Belief:
        """Return the prior (1 - absent) [(1 - floor) w(x) / sum w + floor / K] of weights (K,) of any scale.

        Raises ValueRangeError for weights below 0 or without a sum, and for a floor or an absence outside 0 to 1.
        """
        points = frozen_array("the places of a belief", points_map, (None, 3))
        prior = prior_of(weights, len(points), floor)
        return cls(points, (1.0 - absent) * prior, absent, np.ones(len(points)), 1.0, instances)

    @property
    def mass(self) -> FloatArray:
        """prior(x) likelihood(x), not normalised: (K,)."""
        return np.asarray(self.prior * self.likelihood)

    @property
    def absent_mass(self) -> float:
        """The same of "not here"."""
        return self.absent * self.absent_likelihood

    @property
    def unfound(self) -> float:
        """The sum of both."""
        return float(self.mass.sum()) + self.absent_mass

    @property
    def probabilities(self) -> FloatArray:
        """The posterior b(x) of one instance: (K,); with `absence_of_one` it sums to 1, unless nothing is left."""
        whole = self.unfound
        return self.mass / whole if whole > 0.0 else np.zeros(len(self.mass))

    @property
    def absence_of_one(self) -> float:
        """The posterior probability that one instance is not here."""
        whole = self.unfound
        return self.absent_mass / whole if whole > 0.0 else 1.0

    @property
    def absence(self) -> float:
        """The posterior probability that no instance is here."""
        return self.instances.none_here(float(self.mass.sum()), self.absent_mass)

    def after_miss(self, rates: npt.ArrayLike) -> Belief:
        """Return b'(x) ~ b(x) (1 - d(x)) after a look with detection rates d (K,) that did not show the target.

        Places out of view or hidden, d = 0, and "not here" keep their mass.
        """
        return replace(self, likelihood=self.likelihood * (1.0 - self._checked(rates)))

    def after_detection(self, rates: npt.ArrayLike, place: npt.ArrayLike, detector: Detector) -> Belief:
        """Return b'(x) ~ b(x) [d N(z; x) (1 - f) + (1 - d) f u(z)] after the target was reported at z (3,) [m].

        N spreads a report over the places around x, on the plane, by the detector's spread; f are its false alarms;
        u is even over the places in view. Of "not here" only f u(z) is left. Where the belief had ruled all of
        that out, it starts anew around z.
        """
        shown, f = self._checked(rates), detector.false_alarms
        near = self._near(place, detector.spread)
        stray: float = f / max(int(np.count_nonzero(shown)), 1)
        factor = shown * near * (1.0 - f) + (1.0 - shown) * stray
        if float((self.mass * factor).sum()) + self.absent_mass * stray <= 0.0:
            return replace(
                self,
                prior=near / near.sum(),
                absent=0.0,
                likelihood=np.ones(len(near)),
                absent_likelihood=1.0,
            )
        scale = max(float(factor.max()), stray)
        return replace(
            self,
            likelihood=self.likelihood * factor / scale,
            absent_likelihood=self.absent_likelihood * stray / scale,
        )

    def with_weights(self, weights: npt.ArrayLike, floor: float) -> Belief:
        """Return the belief with another prior and all that was seen so far: what is known has changed."""
        return replace(self, prior=(1.0 - self.absent) * prior_of(weights, len(self.prior), floor))

    def near(self, place: npt.ArrayLike, radius: float) -> float:
        """Return the posterior probability that one instance is within `radius` [m] of a place (2,), on the plane."""
        offsets = self.points_map[:, :2] - np.asarray(place, dtype=np.float64)[:2]
        squares = np.einsum("kd,kd->k", offsets, offsets)
        close = squares <= max(radius * radius, float(squares.min()))
        return float(self.probabilities[close].sum())

    def _near(self, place: npt.ArrayLike, spread: float) -> FloatArray:
        offsets = self.points_map[:, :2] - np.asarray(place, dtype=np.float64)[:2]
        squares = np.einsum("kd,kd->k", offsets, offsets)
        near = np.exp(-0.5 * (squares - squares.min()) / spread**2)
        return np.asarray(near / near.sum())

    def _checked(self, rates: npt.ArrayLike) -> FloatArray:
        shown = frozen_array("the detection rates of a look", rates, (len(self.prior),))
        if (shown < 0.0).any() or (shown > 1.0).any():
            raise ValueRangeError("a detection rate", [float(shown.min()), float(shown.max())], "0 to 1")
        return shown


def prior_of(weights: npt.ArrayLike, places: int, floor: float) -> FloatArray:
    """Return (1 - floor) w(x) / sum w + floor / K for weights (K,) of any scale: (K,), a sum of 1."""
    shares = frozen_array("the weights of a belief", weights, (places,))
    total = float(shares.sum())
    if (shares < 0.0).any() or (total <= 0.0 and floor < 1.0):
        raise ValueRangeError("the weights of a belief", total, "at least 0 everywhere, above 0 somewhere")
    if not 0.0 <= floor <= 1.0:
        raise ValueRangeError("the floor of a belief", floor, "a share from 0 to 1")
    claimed = (1.0 - floor) * shares / total if floor < 1.0 else np.zeros(places)
    return np.asarray(claimed + floor / max(places, 1))
