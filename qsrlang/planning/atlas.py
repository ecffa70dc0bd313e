"""Atlases: what a camera would show from a lattice of places, for every heading, made once for a whole search."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import TURN
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.ways import Ways, lattice
from qsrlang.planning.detecting import Detector
from qsrlang.planning.sight import Sight
from qsrlang.planning.views import Views

MAX_HEADINGS = 360


@dataclass(frozen=True, slots=True)
class Lattice:
    """Where an atlas puts its views: places every `spacing` [m], `headings` at each, and tilts [rad] of the camera.

    Without `tilts` the camera keeps its own. Of the places, `offered` are drawn anew for each decision.
    """

    spacing: float = 0.3
    headings: int = 24
    tilts: tuple[float, ...] = ()
    offered: int = 20

    def __post_init__(self) -> None:
        if not 0.0 < self.spacing < math.inf:
            raise ValueRangeError("the spacing of views", self.spacing, "a positive number of metres")
        if not 1 <= self.headings <= MAX_HEADINGS:
            raise ValueRangeError("the number of headings", self.headings, f"1 to {MAX_HEADINGS}")
        if self.offered < 1:
            raise ValueRangeError("the number of places offered", self.offered, "at least 1")
        if not all(abs(tilt) < math.pi / 2 for tilt in self.tilts):
            raise ValueRangeError("the tilts of a camera", self.tilts, "within a quarter turn")


@dataclass(frozen=True, slots=True, eq=False)
class Atlas:
    """Views from P places (P, 2) [m]: `place_of` (N,) says from which; `ways` (P, P) lead from place to place.

    `offered` of the places are drawn for each decision.
    """

    places: FloatArray
    ways: Ways
    views: Views
    place_of: IntArray
    offered: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", frozen_array("the places of an atlas", self.places, (None, 2)))
        place_of = frozen_array("the places of views", self.place_of, (len(self.views),), np.int64)
        object.__setattr__(self, "place_of", place_of)

    @classmethod
    def of(
        cls,
        navigation: NavigationGrid,
        sight: Sight,
        points_map: FloatArray,
        detector: Detector,
        grid: Lattice,
    ) -> Atlas:
        """Return the views of points (K, 3) from a lattice of the navigable cells.

        One ray joins a place and a point, whatever the heading: the frustum of each heading then picks from what is
        clear. Headings are counted from the grid's own x axis, so the atlas moves with its map.
        """
        places = lattice(navigation, grid.spacing)
        ways = Ways.among(navigation, places)
        return cls.at(places, ways, navigation.grid.origin.yaw, sight, points_map, detector, grid)

    @classmethod
    def at(
        cls,
        places: FloatArray,
        ways: Ways,
        yaw: float,
        sight: Sight,
        points_map: FloatArray,
        detector: Detector,
        grid: Lattice,
    ) -> Atlas:
        """Return the views from given places (P, 2) with their `ways`, headings counted from `yaw` [rad]."""
        points = frozen_array("the points of an atlas", points_map, (None, 3))
        tilts = np.array(grid.tilts or (sight.camera.tilt,))
        headings = yaw + TURN * np.arange(grid.headings) / grid.headings
        gazes = np.stack(np.meshgrid(headings, tilts, indexing="ij"), axis=-1).reshape(-1, 2)
        place_of = np.repeat(np.arange(len(places)), len(gazes))
        around = np.tile(gazes, (len(places), 1))
        poses = np.column_stack([places[place_of], around[:, 0]])
        clear = sight.all_round(places, points)
        seen = sight.turned(poses, around[:, 1], place_of, clear, points)
        return cls(
            places, ways, sight.gathered(poses, around[:, 1], points, seen, detector), place_of, grid.offered
        )

    def drawn(self, rng: np.random.Generator) -> BoolArray:
        """Return which places (P,) are offered this time, each as likely as any other."""
        count = len(self.places)
        offered = np.zeros(count, dtype=np.bool_)
        offered[rng.permutation(count)[: self.offered]] = True
        return offered
