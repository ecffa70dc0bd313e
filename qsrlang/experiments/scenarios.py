"""Scenarios: a place, what is truly in it, what the robot knows and is, and the arms to compare."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from qsrlang.errors import FileError, UnknownNameError
from qsrlang.experiments.presets import (
    Body,
    PlannerEntry,
    find_preset,
    read_body,
    read_camera,
    read_planner,
    read_robot,
)
from qsrlang.experiments.scenariofiles import ArmEntry, PlacementEntry, ScenarioEntry
from qsrlang.experiments.tomlfiles import read_entry
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.noise import Noise
from qsrlang.planning.outcome import Limits
from qsrlang.planning.planners.planner import PlannerName
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.relations.imports import find_knowledge, read_library, read_source
from qsrlang.resources import data_root, resource_root

EVERYTHING = "all"

NamedT = TypeVar("NamedT")


@dataclass(frozen=True, slots=True)
class Arm:
    """One search method of a scenario: its planner's name, its knowledge, its preset and its limits."""

    name: str
    planner: PlannerName
    knowledge: str
    preset: PlannerEntry
    limits: Limits


@dataclass(frozen=True, slots=True)
class MapFiles:
    """The files of a place: a ROS map and an OctoMap."""

    occupancy: Path
    octomap: Path


@dataclass(frozen=True, slots=True)
class Scenario:
    """A scenario, its presets resolved. Poses are in the map frame [m, rad]; `floor_height` is the z of the floor [m].

    `place` is either a pair of map files or the name of a room. `variants` name the placements that exist.
    `fingerprint` changes with whatever the file and its presets say.
    """

    name: str
    path: Path
    title: str
    target: str
    place: MapFiles | str
    floor_height: float
    start: Pose2
    landmarks: tuple[str, ...]
    camera_name: str
    camera: Camera
    robot_name: str
    robot: Robot
    body: Body
    placements: tuple[PlacementEntry, ...]
    variants: Mapping[str, tuple[str, ...]]
    arms: Mapping[str, Arm]
    noise: Noise
    fingerprint: str

    def arm(self, name: str) -> Arm:
        """Return an arm by its name; raises UnknownNameError."""
        return _named(f"arm of {self.path}:", name, self.arms)

    def variant(self, name: str | None) -> str:
        """Return the variant's name, the first of the file where none is given; raises UnknownNameError."""
        if name is None:
            return next(iter(self.variants))
        _named(f"variant of {self.path}:", name, self.variants)
        return name

    def placed(self, variant: str) -> tuple[PlacementEntry, ...]:
        """Return the placements that exist in a variant."""
        members = _named(f"variant of {self.path}:", variant, self.variants)
        return tuple(placement for placement in self.placements if placement.name in members)


def load_scenario(
    scenario: str | Path,
    camera: str | None = None,
    robot: str | None = None,
    knowledge: str | None = None,
    noise: Noise | None = None,
) -> Scenario:
    """Return a shipped scenario by its name, or the one in a file whose path ends in .toml.

    `camera` and `robot` name presets, `knowledge` a .qsr file, to use in place of the scenario's; arms with knowledge
    of their own keep it. `noise` is how the camera errs, not at all by default. Raises FileError and UnknownNameError.
    """
    path = find_scenario(str(scenario))
    entry = read_entry(path, ScenarioEntry)
    if knowledge is not None:
        entry = entry.model_copy(update={"knowledge": str(find_knowledge(knowledge).resolve())})
    camera_preset = find_preset("cameras", camera or entry.camera, path.parent)
    robot_preset = find_preset("robots", robot or entry.robot, path.parent)
    made = Scenario(
        name=path.stem,
        path=path,
        title=entry.title,
        target=entry.target,
        place=_place(entry, path.parent),
        floor_height=entry.map.floor_height,
        start=Pose2(entry.start.x, entry.start.y, math.radians(entry.start.facing_deg)),
        landmarks=tuple(entry.landmarks),
        camera_name=camera_preset.name,
        camera=read_camera(camera_preset),
        robot_name=robot_preset.name,
        robot=read_robot(robot_preset),
        body=read_body(robot_preset),
        placements=tuple(entry.placements),
        variants=_variants(entry),
        arms={name: _arm(name, arm, entry, path.parent) for name, arm in entry.arms.items()},
        noise=noise or Noise(),
        fingerprint="",
    )
    return replace(made, fingerprint=_fingerprint(entry, made))


def find_scenario(name: str) -> Path:
    """Return the file of a scenario: a path that ends in .toml, or the name of a shipped one."""
    if name.endswith(".toml"):
        return Path(name)
    folder = resource_root("knowledge") / "worlds"
    known = scenario_names()
    if name not in known:
        raise UnknownNameError("scenario", name, known)
    return folder / f"{name}.toml"


def scenario_names() -> tuple[str, ...]:
    """Return the names of the shipped scenarios."""
    return tuple(sorted(path.stem for path in (resource_root("knowledge") / "worlds").glob("*.toml")))


def _place(entry: ScenarioEntry, beside: Path) -> MapFiles | str:
    room, occupancy, octomap = entry.map.room, entry.map.occupancy, entry.map.octomap
    if occupancy is not None and octomap is not None:
        return MapFiles(_map_file(occupancy, beside), _map_file(octomap, beside))
    assert room is not None
    return str(beside / room) if room.endswith(".toml") else room


def _map_file(name: str, beside: Path) -> Path:
    near = beside / name
    if Path(name).is_absolute() or near.is_file():
        return near
    path = data_root() / name
    if not path.is_file():
        raise FileError(path, "no such map", "set QSR_DATA to the folder that holds the maps")
    return path


def _arm(name: str, arm: ArmEntry, entry: ScenarioEntry, beside: Path) -> Arm:
    named = find_preset("planners", arm.preset or entry.preset, beside)
    preset = read_planner(named)
    if arm.planner not in ("random", "planes", "qsr") and preset.sight is None:
        raise FileError(
            named.path, "has no table 'sight'", f"arm '{name}' needs one, as in the preset 'aware'"
        )
    knowledge = arm.knowledge or entry.knowledge
    found = str(beside / knowledge) if knowledge.endswith(".qsr") else knowledge
    return Arm(name, arm.planner, found, preset, preset.search_limits(entry.limits))


def _variants(entry: ScenarioEntry) -> dict[str, tuple[str, ...]]:
    everything = {EVERYTHING: [placement.name for placement in entry.placements]}
    return {name: tuple(members) for name, members in (entry.variants or everything).items()}


def _fingerprint(entry: ScenarioEntry, made: Scenario) -> str:
    arms = made.arms.values()
    said = [
        entry.model_dump_json(),
        repr(made.camera),
        repr(made.robot),
        repr(made.body),
        *(repr(arm.preset) for arm in arms),
        *([] if made.noise.is_none else [repr(made.noise)]),
    ]
    digest = hashlib.sha256("\n".join(said).encode())
    told = (file for name in sorted({arm.knowledge for arm in arms}) for file in _knowledge_files(name))
    for path in (*told, *_files(made.place)):
        digest.update(path.read_bytes() if path.is_file() else b"")
    return digest.hexdigest()[:12]


def _knowledge_files(name: str) -> Iterable[Path]:
    """Return a knowledge file with all it imports; nothing where it is missing, which the arm will tell."""
    path = find_knowledge(name)
    return read_library(read_source(path)).files if path.is_file() else ()


def _files(place: MapFiles | str) -> Iterable[Path]:
    if isinstance(place, MapFiles):
        return place.occupancy, place.octomap
    return (
        Path(place)
        if place.endswith(".toml")
        else resource_root("knowledge") / "worlds" / "rooms" / f"{place}.toml",
    )


def _named(kind: str, name: str, known: Mapping[str, NamedT]) -> NamedT:
    if name not in known:
        raise UnknownNameError(kind, name, known)
    return known[name]
