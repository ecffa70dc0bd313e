"""How far statements are trusted: what makes a prior of places out of a mixture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.belief import prior_of


@dataclass(frozen=True, slots=True)
class Doubt:
    """How far statements are not trusted: a share of the prior is even over all places, another is loosely as told.

    prior = floor / K + (1 - floor) [(1 - loose) p + loose q] on the K places, with the mixture p as it is told and q
    the same with all standard deviations `stretch` times as large: the contaminated normal of Tukey (1960), for
    things that were moved, though not far.
    """

    floor: float = 0.0
    loose: float = 0.0
    stretch: float = 3.0

    def __post_init__(self) -> None:
        for what, share in (("floor of a belief", self.floor), ("loose share of a belief", self.loose)):
            if not 0.0 <= share <= 1.0:
                raise ValueRangeError(f"the {what}", share, "a share from 0 to 1")
        if not 1.0 <= self.stretch < math.inf:
            raise ValueRangeError("the stretch of a belief", self.stretch, "a number of at least 1")

    def prior(self, mixture: GaussianMixture, places_map: npt.ArrayLike, claimed: float = 1.0) -> FloatArray:
        """Return the prior (K,) of places (K, 2) [m], of which the statements place a share `claimed`: a sum of 1.

        Even where the mixture puts nothing on any of them.
        """
        places = frozen_array("the places of a belief", places_map, (None, 2))
        density = self.loosened(mixture).pdf(places)
        return prior_of(density, len(places), 1.0 - claimed * (1.0 - self.floor) if density.any() else 1.0)

    def loosened(self, mixture: GaussianMixture) -> GaussianMixture:
        """Return (1 - loose) sum_i w_i N(mu_i, Sigma_i) + loose sum_i w_i N(mu_i, stretch^2 Sigma_i)."""
        if self.loose == 0.0:
            return mixture
        return GaussianMixture(
            np.concatenate([(1.0 - self.loose) * mixture.weights, self.loose * mixture.weights]),
            np.concatenate([mixture.means, mixture.means]),
            np.concatenate([mixture.covariances, self.stretch**2 * mixture.covariances]),
        )
