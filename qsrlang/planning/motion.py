"""What it costs a robot to get to a view and to look."""

from __future__ import annotations

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.ways import Ways
from qsrlang.planning.sensing import Robot

MIN_LOOK = 1e-6
"""A look is never taken to cost nothing [s]."""


def first_costs(
    robot: Robot, pose: Pose2, ways: Ways, places: IntArray, yaws: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return travel [m], turn [rad] and seconds (N,) from a pose to views at places of `ways` (1, P) with `yaws` (N,).

    c = travel / speed + turn / turn rate + dwell.
    """
    zeros = np.zeros(len(places), dtype=np.int64)
    travel = ways.lengths[0, places]
    turn = ways.turning(np.full(len(places), pose.yaw), zeros, yaws, places)
    return (
        travel,
        turn,
        np.asarray(travel / robot.speed + turn / robot.turn_rate + max(robot.dwell, MIN_LOOK)),
    )


def costs_between(robot: Robot, ways: Ways, places: IntArray, yaws: FloatArray) -> FloatArray:
    """Return the seconds (N, N) from each of N views, at places of `ways` (P, P), to each other, its look included."""
    starts, ends = np.meshgrid(places, places, indexing="ij")
    out, home = np.meshgrid(yaws, yaws, indexing="ij")
    turn = ways.turning(out, starts, home, ends)
    return np.asarray(
        ways.lengths[starts, ends] / robot.speed + turn / robot.turn_rate + max(robot.dwell, MIN_LOOK)
    )
