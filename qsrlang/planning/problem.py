"""The choice a planner faces: views, what they would show, and what it costs to go from one to another."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.planning.instances import ONE, Instances
from qsrlang.planning.views import Views


@dataclass(frozen=True, slots=True, eq=False)
class ViewProblem:
    """N views of K places, of one target or of several, and the seconds that looking from them costs.

    `mass` (K,) is what is believed of the places, `goal_of` (K,) the number of the target each place is of, `absent`
    (G,) the mass of "not here", all of G targets on the scale of one instance; `instances` (G,) how many there may be.
    `first` (N,) is the time [s] from the robot to a view, its look included, `between` (N, N) from view to view;
    infinite where there is no way. `seconds` are left [s].

    The chance that target g is still unfound after looks S is phi_g(u_g(S)) with
    u_g(S) = absent_g + sum_{x of g} mass(x) prod_{v in S} (1 - d_v(x)), and a plan v_1, v_2, … costs
    sum_g integral_0^seconds phi_g(t) dt / phi_g(0): the expected time to each find, a failure at the limit.
    """

    views: Views
    mass: FloatArray
    first: FloatArray
    between: FloatArray
    seconds: float
    goal_of: IntArray
    absent: FloatArray
    instances: tuple[Instances, ...] = (ONE,)

    def __post_init__(self) -> None:
        count = len(self.views)
        mass = frozen_array("the mass of a problem", self.mass, (self.views.places,))
        absent = frozen_array("the absence of a problem", self.absent, (len(self.instances),))
        object.__setattr__(self, "mass", mass)
        object.__setattr__(self, "absent", absent)
        object.__setattr__(self, "first", _costs("first", self.first, (count,)))
        object.__setattr__(self, "between", _costs("between", self.between, (count, count)))
        if not self.seconds > 0.0:
            raise ValueRangeError("the time left", self.seconds, "a positive number of seconds")
        if (self.mass < 0.0).any() or (self.absent < 0.0).any():
            raise ValueRangeError("the mass of a problem", float(self.mass.min()), "at least 0")

    @classmethod
    def of_one(
        cls,
        views: Views,
        mass: npt.ArrayLike,
        first: npt.ArrayLike,
        between: npt.ArrayLike,
        seconds: float = math.inf,
        absent: float = 0.0,
        instances: Instances = ONE,
    ) -> ViewProblem:
        """Return the problem of one target."""
        goal_of = np.zeros(views.places, dtype=np.int64)
        return cls(
            views,
            np.asarray(mass),
            np.asarray(first),
            np.asarray(between),
            seconds,
            goal_of,
            np.array([absent]),
            (instances,),
        )

    def __len__(self) -> int:
        return len(self.views)

    @property
    def unseen(self) -> FloatArray:
        """u_g before any look: (G,)."""
        shares = np.bincount(self.goal_of, self.mass, minlength=len(self.instances))
        return np.asarray(self.absent + shares)

    def unfound(self, unseen: FloatArray) -> float:
        """Return sum_g phi_g(u_g) of unseen masses (G,)."""
        return float(
            sum(float(one.unfound(share)) for one, share in zip(self.instances, unseen, strict=True))
        )

    def gains(self) -> FloatArray:
        """Return for each view the chance to find a target by one look, summed over the targets: (N,)."""
        total, before = np.zeros(len(self)), self.unseen
        for goal, one in enumerate(self.instances):
            shown = self.views.values(np.where(self.goal_of == goal, self.mass, 0.0))
            now = float(one.unfound(before[goal]))
            if now > 0.0:
                total += 1.0 - one.unfound(np.maximum(before[goal] - shown, 0.0)) / now
        return total

    def cost_of(self, order: npt.ArrayLike) -> float:
        """Return the cost [s] of looking from views in an order: sum_i c_i phi(i - 1) / phi(0), then the time left.

        Without a limit it is the sum alone: the expected time until the target is found or the order is over.
        """
        mass, unseen, clock, cost, last = self.mass.copy(), self.unseen, 0.0, 0.0, -1
        scale = np.array([float(one.unfound(u)) for one, u in zip(self.instances, unseen, strict=True)])
        for view in np.asarray(order, dtype=np.int64):
            seconds = min(
                float(self.first[view] if last < 0 else self.between[last, view]), self.seconds - clock
            )
            cost += seconds * self._share(unseen, scale)
            clock, last = clock + seconds, int(view)
            if clock >= self.seconds:
                return cost
            mass = mass * (1.0 - self.views.row(last))
            unseen = self.absent + np.bincount(self.goal_of, mass, minlength=len(self.instances))
        rest = self.seconds - clock
        return cost if math.isinf(rest) else cost + rest * self._share(unseen, scale)

    def _share(self, unseen: FloatArray, scale: FloatArray) -> float:
        left = [float(one.unfound(u)) for one, u in zip(self.instances, unseen, strict=True)]
        return float(sum(now / before for now, before in zip(left, scale, strict=True) if before > 0.0))

    def take(self, views: npt.ArrayLike) -> ViewProblem:
        """Return the problem of some of the views."""
        chosen = np.asarray(views, dtype=np.int64)
        return ViewProblem(
            self.views.take(chosen),
            self.mass,
            self.first[chosen],
            self.between[np.ix_(chosen, chosen)],
            self.seconds,
            self.goal_of,
            self.absent,
            self.instances,
        )


def _costs(what: str, value: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    costs = np.asarray(value, dtype=np.float64)
    if costs.shape != shape or np.isnan(costs).any() or (costs <= 0.0).any():
        raise ValueRangeError(f"the costs of a problem ({what})", costs.shape, f"{shape}, above 0 s")
    return costs
