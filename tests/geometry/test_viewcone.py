import math

import numpy as np
import pytest

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.viewcone import Sector, Triangle


def test_a_triangle_holds_its_corners_and_no_more():
    cone = Triangle(3.0, 1.0)
    points = np.array([[0.0, 0.0], [3.0, 1.0], [3.0, -1.0], [3.01, 0.0], [1.5, 0.51], [-0.1, 0.0]])
    assert cone.limits.contain(points).tolist() == [True, True, True, False, False, False]


def test_a_sector_has_a_near_and_a_far_side():
    cone = Sector(0.8, 2.5, math.radians(57.0))
    half = math.radians(28.0)
    points = np.array(
        [[0.5, 0.0], [0.8, 0.0], [2.5, 0.0], [2.6, 0.0], [2 * math.cos(half), 2 * math.sin(half)], [1.0, 1.0]]
    )
    assert cone.limits.contain(points).tolist() == [False, True, True, False, True, False]


@pytest.mark.parametrize("turn", [0.1, 0.5, 0.9, 1.0, 1.3, 1.9, 2.0])
def test_a_sector_of_any_width_is_its_angle(turn):
    cone = Sector(0.5, 2.0, turn * math.pi)
    angles = np.linspace(-math.pi, math.pi, 721)
    points = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    inside = cone.limits.contain(points)
    border = np.abs(np.abs(angles) - 0.5 * turn * math.pi) < 1e-9
    assert (inside == (np.abs(angles) <= 0.5 * turn * math.pi))[~border].all()


@pytest.mark.parametrize(
    "arguments", [(2.5, 0.8, 1.0), (0.8, 2.5, 0.0), (0.8, math.inf, 1.0), (-1.0, 2.0, 1.0)]
)
def test_a_sector_refuses_nonsense(arguments):
    with pytest.raises(ValueRangeError):
        Sector(*arguments)


def test_a_triangle_refuses_nonsense():
    with pytest.raises(ValueRangeError, match="length"):
        Triangle(0.0, 1.0)
