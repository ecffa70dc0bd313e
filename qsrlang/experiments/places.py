"""Places: what a scenario's maps become once they are read, and the world its robot acts in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from qsrlang.arrays import BoolArray
from qsrlang.errors import FileError, NoNavigablePoseError, ValueRangeError
from qsrlang.experiments.presets import Body
from qsrlang.experiments.scenarios import MapFiles, Scenario
from qsrlang.maps.navigation import NavigationGrid, occupancy_from_voxels
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.octomap import read_octomap
from qsrlang.maps.rosmap import read_ros_map
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.roomfiles import load_room
from qsrlang.simulation.rooms import Room
from qsrlang.simulation.survey import survey_room
from qsrlang.simulation.world import PybulletWorld


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """The maps the robot is given, and the room they show where the room is one of ours.

    `reachable` holds the cells that the robot reaches from its start.
    """

    occupancy: OccupancyGrid
    voxels: VoxelGrid
    room: Room | None
    reachable: NavigationGrid


def read_place(scenario: Scenario) -> Place:
    """Return the maps of a scenario: read from its files, or made by a survey of its room.

    Raises FileError for missing or damaged maps, OutsideMapError and BlockedPoseError for a start where the robot
    cannot stand, NoNavigablePoseError where it can stand nowhere.
    """
    room = None
    if isinstance(scenario.place, MapFiles):
        occupancy = read_ros_map(scenario.place.occupancy)
        voxels = read_octomap(scenario.place.octomap).voxel_grid()
    else:
        room = load_room(scenario.place)
        occupancy, voxels = survey_room(room)
    ground = safe_ground(occupancy, voxels, scenario)
    return Place(occupancy, voxels, room, ground.reachable_from(scenario.start))


def safe_ground(occupancy: OccupancyGrid, voxels: VoxelGrid, scenario: Scenario) -> NavigationGrid:
    """Return where the robot's centre may be: the plane map inflated by its clearance, less what its body would touch.

    The paper samples poses from the plane map alone; a map made near the floor does not show the tops of tables,
    so cells within the robot's footprint of voxels at the height of its body are left out here.
    """
    mapped = NavigationGrid.from_occupancy(occupancy, scenario.robot.clearance)
    touching = _near_bodies(occupancy, voxels, scenario.floor_height, scenario.body)
    navigable = mapped.navigable & ~touching
    if not navigable.any():
        raise NoNavigablePoseError(occupancy.source, scenario.robot.clearance)
    return NavigationGrid(occupancy, scenario.robot.clearance, navigable)


def _near_bodies(occupancy: OccupancyGrid, voxels: VoxelGrid, floor: float, body: Body) -> BoolArray:
    bodies = occupancy_from_voxels(voxels, floor, body.band)
    centres = occupancy.centres_of(np.moveaxis(np.indices(occupancy.cells.shape), 0, -1))
    rows, columns = np.moveaxis(bodies.cells_of(centres), -1, 0)
    inside = bodies.covers(centres)
    blocked = np.zeros(occupancy.cells.shape, dtype=bool)
    blocked[inside] = bodies.cells[rows[inside], columns[inside]] == Cell.OCCUPIED
    if not blocked.any():
        return blocked
    return np.asarray(ndimage.distance_transform_edt(~blocked) * occupancy.resolution <= body.footprint)


def build_world(scenario: Scenario, place: Place, variant: str) -> PybulletWorld:
    """Return the simulated world of a variant: the place, the objects that are truly there, and the robot."""
    objects = [
        Placement(
            name=placed.name,
            kind=placed.kind,
            x=placed.x,
            y=placed.y,
            z=placed.z,
            size=(placed.size[0], placed.size[1], placed.size[2]),
        )
        for placed in scenario.placed(variant)
    ]
    try:
        return _world(scenario, place, objects)
    except ValueRangeError as error:
        raise FileError(scenario.path, str(error), "change the placements") from None


def _world(scenario: Scenario, place: Place, objects: list[Placement]) -> PybulletWorld:
    robot, camera, start = scenario.robot, scenario.camera, scenario.start
    if place.room is not None:
        return PybulletWorld.from_room(place.room, objects, robot, camera, start)
    return PybulletWorld.from_voxels(place.voxels, objects, robot, camera, start, scenario.floor_height)
