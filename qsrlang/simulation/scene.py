"""Prepared scenes: a room or a voxel map as bodies, and the objects that rest in it."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from qsrlang.errors import OutsideMapError
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.simulation.engine import Engine
from qsrlang.simulation.mesh import Mesh, clear_boxes, mesh_of, write_obj
from qsrlang.simulation.objects import Placement, boxes_to_clear, settle, surface_below
from qsrlang.simulation.rooms import Colour, Room, Thing

VOXEL_COLOUR: Colour = (0.74, 0.72, 0.68)
Bounds = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Bodies at rest in an engine: things with their bodies, the floor's height [m], the bounds, a name."""

    engine: Engine
    things: tuple[tuple[Thing, int], ...]
    floor: float
    bounds: Bounds
    source: str


def scene_of_room(room: Room, placements: Sequence[Placement] = ()) -> Scene:
    """Build a furnished room, let its movable things settle, and place the objects.

    Raises OutsideMapError where a placement lies outside the room, ValueRangeError where one does not stay.
    """

    def build(engine: Engine) -> Scene:
        still = [(thing, _add(engine, thing)) for thing in room.things if not thing.movable]
        moving = [(thing, _add(engine, thing)) for thing in room.things if thing.movable]
        settle(engine, moving)
        placed = _place(engine, placements, 0.0, room.bounds, room.name)
        return Scene(engine, (*still, *moving, *placed), 0.0, room.bounds, room.name)

    return _in_new_engine(build)


def scene_of_voxels(voxels: VoxelGrid, placements: Sequence[Placement], floor: float) -> Scene:
    """Build the occupied voxels as one static body and place the objects; raises as `scene_of_room` does.

    Voxels in the box of a placement that names its height are cut out: a map may hold what once stood there.
    """

    def build(engine: Engine) -> Scene:
        occupied = clear_boxes(voxels, boxes_to_clear(placements))
        _add_mesh(engine, mesh_of(occupied, voxels.resolution, voxels.origin))
        bounds = _bounds(voxels)
        placed = _place(engine, placements, floor, bounds, voxels.source)
        return Scene(engine, tuple(placed), floor, bounds, voxels.source)

    return _in_new_engine(build)


def _in_new_engine(build: Callable[[Engine], Scene]) -> Scene:
    engine = Engine()
    try:
        return build(engine)
    except BaseException:
        engine.close()
        raise


def _add(engine: Engine, thing: Thing) -> int:
    return engine.add_parts(thing.parts, thing.position, thing.pose.yaw, thing.mass)


def _add_mesh(engine: Engine, mesh: Mesh) -> int:
    with tempfile.TemporaryDirectory(prefix="qsrlang-") as folder:
        path = Path(folder) / "voxels.obj"
        write_obj(mesh, path)
        return engine.add_mesh(path, VOXEL_COLOUR)


def _bounds(voxels: VoxelGrid) -> Bounds:
    x0, y0 = voxels.origin[:2].tolist()
    width, depth = voxels.voxels.shape[:2]
    return x0, y0, x0 + width * voxels.resolution, y0 + depth * voxels.resolution


def _place(
    engine: Engine, placements: Sequence[Placement], floor: float, bounds: Bounds, source: str
) -> list[tuple[Thing, int]]:
    dropped: list[tuple[Thing, int]] = []
    for placed in placements:
        x0, y0, x1, y1 = bounds
        if not (x0 <= placed.x <= x1 and y0 <= placed.y <= y1):
            raise OutsideMapError(placed.name, (placed.x, placed.y), bounds, source)
        thing = placed.thing(surface_below(engine, placed, floor))
        dropped.append((thing, _add(engine, thing)))
    settle(engine, dropped)
    return dropped
