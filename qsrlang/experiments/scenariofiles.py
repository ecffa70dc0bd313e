"""What a scenario file may say, field by field."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from qsrlang.experiments.presets import LimitsEntry
from qsrlang.experiments.tomlfiles import Entry
from qsrlang.planning.planners.planner import PlannerName

MAX_PLACEMENTS = 1_000
MAX_ARMS = 100
MAX_METRES = 10_000.0

Coordinate = Annotated[float, Field(ge=-MAX_METRES, le=MAX_METRES)]
Side = Annotated[float, Field(gt=0.0, le=MAX_METRES)]
Name = Annotated[str, Field(pattern=r"^[\w][\w.+-]*$", max_length=80)]


class MapEntry(Entry):
    """Where the maps come from: a ROS map and an OctoMap, or a built-in room that the robot maps itself.

    Paths are absolute, beside the scenario, or in the data folder. `floor_height` is the z of the floor [m].
    """

    occupancy: str | None = None
    octomap: str | None = None
    room: str | None = None
    floor_height: Coordinate = 0.0

    @model_validator(mode="after")
    def _one_source(self) -> MapEntry:
        pair = (self.occupancy is not None, self.octomap is not None)
        if any(pair) == (self.room is not None) or any(pair) != all(pair):
            raise ValueError("expected either 'occupancy' and 'octomap', or 'room'")
        return self


class StartEntry(Entry):
    """Where the robot starts, map frame [m, degrees]."""

    x: Coordinate
    y: Coordinate
    facing_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0


class PlacementEntry(Entry):
    """An object that is truly there: its centre in the map frame, and its size [m].

    It is let down onto the surface below `z`; without `z`, onto the highest one that an arm reaches.
    """

    name: Name
    kind: Name
    x: Coordinate
    y: Coordinate
    z: Coordinate | None = None
    size: Annotated[list[Side], Field(min_length=3, max_length=3)]


class ArmEntry(Entry):
    """A search method: its planner, and the knowledge and preset it uses in place of the scenario's."""

    planner: PlannerName
    knowledge: str | None = None
    preset: str | None = None


class ScenarioEntry(Entry):
    """A scenario file."""

    title: str
    target: Name
    map: MapEntry
    start: StartEntry
    knowledge: str
    landmarks: list[str] = Field(default_factory=list, max_length=MAX_PLACEMENTS)
    robot: str
    camera: str
    preset: str
    limits: LimitsEntry | None = None
    placements: Annotated[list[PlacementEntry], Field(min_length=1, max_length=MAX_PLACEMENTS)]
    variants: dict[Name, list[Name]] = Field(default_factory=dict, max_length=MAX_ARMS)
    arms: Annotated[dict[Name, ArmEntry], Field(min_length=1, max_length=MAX_ARMS)]

    @model_validator(mode="after")
    def _names_fit(self) -> ScenarioEntry:
        names = [placement.name for placement in self.placements]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"two placements are named '{twice[0]}'")
        for variant, members in self.variants.items():
            missing = [name for name in members if name not in names]
            if missing:
                raise ValueError(
                    f"variant '{variant}' names '{missing[0]}', which is not placed; placed: {', '.join(names)}"
                )
        return self
