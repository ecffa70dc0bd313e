"""Surveys: what a robot is told of a built-in room, from depth images that it takes on a tour of the room."""

from __future__ import annotations

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.mapping import VoxelMapper
from qsrlang.maps.navigation import occupancy_from_voxels
from qsrlang.maps.occupancy import OccupancyGrid
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.simulation.depth import depth_image
from qsrlang.simulation.robot import RobotBody
from qsrlang.simulation.rooms import Room
from qsrlang.simulation.scene import Scene, scene_of_room

SURVEY_ROBOT = Robot(clearance=0.35, speed=0.5, turn_rate=1.0, dwell=0.0)
SURVEY_CAMERA = Camera(near=0.2, far=4.0, horizontal_fov=1.31, vertical_fov=1.05, height=1.7, tilt=-0.5)
RESOLUTION = 0.05
MAPPED_HEIGHT = 2.0
MARGIN = 0.2
IMAGE_WIDTH, IMAGE_HEIGHT = 200, 150
HEADINGS = 5
LATTICE = 0.5
TOUR_SPACING = 1.8
MAX_PLACES = 2_000


def survey_room(
    room: Room, robot: Robot = SURVEY_ROBOT, camera: Camera = SURVEY_CAMERA
) -> tuple[OccupancyGrid, VoxelGrid]:
    """Return the plane map and the voxel map (0.05 m) that a robot makes of the static part of a room.

    It drives over a lattice of places it finds free, looks around from some of them with a depth camera, and
    integrates the images. Nothing is read from the room's description but its outer bounds and its start.
    """
    scene = scene_of_room(room.static_part)
    try:
        places = tour(scene, robot, camera, room.start)
        voxels = _mapped(scene, camera, places)
    finally:
        scene.engine.close()
    return occupancy_from_voxels(voxels, 0.0), voxels


def tour(scene: Scene, robot: Robot, camera: Camera, start: Pose2) -> FloatArray:
    """Return places (P, 2) to look around from, TOUR_SPACING apart, the start first."""
    reached = _reached(scene, RobotBody(scene.engine, robot, camera, scene.floor), start.position)
    chosen = reached[:1]
    while True:
        gaps = np.hypot(*(reached[:, None] - chosen[None]).transpose(2, 0, 1)).min(axis=1)
        near_enough = np.where(gaps >= TOUR_SPACING, gaps, np.inf)
        if not np.isfinite(near_enough).any():
            return chosen
        chosen = np.vstack([chosen, reached[near_enough.argmin()]])


def _reached(scene: Scene, body: RobotBody, start: FloatArray) -> FloatArray:
    """Return the lattice places (K, 2) that the robot reaches, driving from free place to free neighbour."""
    places = {(0, 0): start}
    frontier = [(0, 0)]
    while frontier and len(places) < MAX_PLACES:
        here = frontier.pop(0)
        for step in ((1, 0), (0, 1), (-1, 0), (0, -1)):
            there = (here[0] + step[0], here[1] + step[1])
            goal = start + LATTICE * np.array(there)
            if there not in places and _inside(scene, goal) and _drives(body, places[here], goal):
                places[there] = goal
                frontier.append(there)
    body.vanish()
    return np.array(list(places.values()))


def _inside(scene: Scene, place: FloatArray) -> bool:
    x0, y0, x1, y1 = scene.bounds
    return bool(x0 <= place[0] <= x1 and y0 <= place[1] <= y1)


def _drives(body: RobotBody, start: FloatArray, goal: FloatArray) -> bool:
    reached, _, _ = body.follow(Pose2(float(start[0]), float(start[1])), goal[None], 0.0)
    return bool((reached.position == goal).all())


def _mapped(scene: Scene, camera: Camera, places: FloatArray) -> VoxelGrid:
    """Return the voxel map from images taken at places (P, 2), HEADINGS of them around each."""
    x0, y0, x1, y1 = scene.bounds
    low = np.array([x0, y0, scene.floor]) - MARGIN - 0.5 * RESOLUTION
    size = np.array([x1, y1, scene.floor + MAPPED_HEIGHT]) + MARGIN - low
    nx, ny, nz = np.ceil(size / RESOLUTION).astype(int).tolist()
    mapper = VoxelMapper(low, (nx, ny, nz), RESOLUTION)
    for place in places:
        for yaw in np.linspace(-np.pi, np.pi, HEADINGS, endpoint=False):
            pose = Pose2(float(place[0]), float(place[1]), float(yaw))
            image = depth_image(scene.engine, camera, pose, scene.floor, IMAGE_WIDTH, IMAGE_HEIGHT)
            mapper.insert(image.eye, image.points.reshape(-1, 3), max_range=camera.far)
    return mapper.grid(scene.source)
