"""What the robot believes of the supports: a weight per voxel."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.mixtures.gaussian import GaussianMixture


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
