"""Presets: cameras, robots and planners as files under knowledge/presets/, so that no number hides in the code."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, TypeVar

from pydantic import Field

from qsrlang.errors import FileError, UnknownNameError, ValueRangeError
from qsrlang.experiments.tomlfiles import Entry, EntryT, read_entry
from qsrlang.geometry.viewcone import Sector, Triangle, ViewCone
from qsrlang.planning.atlas import MAX_HEADINGS, Lattice
from qsrlang.planning.detecting import Detector
from qsrlang.planning.doubt import Doubt
from qsrlang.planning.instances import Instances
from qsrlang.planning.outcome import Limits
from qsrlang.planning.repeats import Repeats
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.resources import resource_root

Positive = Annotated[float, Field(gt=0.0)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]
Count = Annotated[int, Field(ge=1, le=1_000_000)]


@dataclass(frozen=True, slots=True)
class Body:
    """How far a robot keeps from what the voxel map holds between two heights above the floor [m]."""

    footprint: float
    band: tuple[float, float]


class CameraEntry(Entry):
    """A camera file: lengths in metres, angles in degrees, a positive tilt looks up."""

    title: str
    near: Positive
    far: Positive
    horizontal_fov_deg: Annotated[float, Field(gt=0.0, lt=180.0)]
    vertical_fov_deg: Annotated[float, Field(gt=0.0, lt=180.0)]
    height: Positive
    tilt_deg: Annotated[float, Field(gt=-90.0, lt=90.0)]

    def camera(self) -> Camera:
        """Return the camera in metres and radians."""
        return Camera(
            near=self.near,
            far=self.far,
            horizontal_fov=math.radians(self.horizontal_fov_deg),
            vertical_fov=math.radians(self.vertical_fov_deg),
            height=self.height,
            tilt=math.radians(self.tilt_deg),
        )


class RobotEntry(Entry):
    """A robot file: clearance and footprint [m], speed [m/s], turn rate [rad/s], dwell at a look [s].

    `clearance` is the distance to keep from obstacles of the plane map, `footprint` that from what the voxel map
    holds between `band`, heights above the floor [m]: table tops that a scanner near the floor does not see.
    """

    title: str
    clearance: Positive
    footprint: Positive
    band: Annotated[list[float], Field(min_length=2, max_length=2)]
    speed: Positive
    turn_rate: Positive
    dwell: Annotated[float, Field(ge=0.0)]

    def robot(self) -> Robot:
        """Return the robot."""
        return Robot(self.clearance, self.speed, self.turn_rate, self.dwell)

    def body(self) -> Body:
        """Return what of the voxel map the robot keeps away from."""
        low, high = self.band
        if not low < high:
            raise ValueRangeError("the band", self.band, "two heights, the lower one first")
        return Body(self.footprint, (low, high))


class TriangleEntry(Entry):
    """A triangle that scores views [m]."""

    length: Positive
    half_width: Positive


class SectorEntry(Entry):
    """A ring sector that scores views [m, degrees]."""

    near: Annotated[float, Field(ge=0.0)]
    far: Positive
    fov_deg: Annotated[float, Field(gt=0.0, le=360.0)]


class SupportsEntry(Entry):
    """How supporting planes are found; heights are above the floor [m]."""

    method: Literal["pca", "mean-normal"]
    max_tilt_deg: Annotated[float, Field(gt=0.0, lt=90.0)]
    min_height: float | None = None
    max_height: float | None = None
    min_part: Count = 1


class SightEntry(Entry):
    """What planners with a belief assume of a look: how often it shows what is visible, where above a support the
    target's centre is [m], at how many times its size the rate is halved, and how often it reports what is not there.
    """

    detection_rate: Annotated[float, Field(gt=0.0, le=1.0)]
    aim_height: Annotated[float, Field(ge=0.0)]
    reach: Positive | None = None
    false_alarms: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.0

    def detector(self) -> Detector:
        """Return the detector."""
        return Detector(self.detection_rate, self.reach or math.inf, self.false_alarms)


class BeliefEntry(Entry):
    """The prior of planners with a belief: the share that is even over all supports whatever is known, the share of the
    rest that is taken loosely, with spreads `stretch` times as large, the chance that the target is not there, how
    many there may be (a whole number, or the mean of a Poisson number), and how much of a look is a repetition of
    one from the same pose.
    """

    floor: Share
    loose: Share = 0.0
    stretch: Annotated[float, Field(ge=1.0, allow_inf_nan=False)] = 3.0
    absent: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.0
    instances: Positive = 1.0
    poisson: bool = False
    repeated: Share = 0.0

    def doubt(self) -> Doubt:
        """Return how far the statements are not trusted."""
        return Doubt(self.floor, self.loose, self.stretch)

    def number(self) -> Instances:
        """Return how many instances there may be."""
        return Instances(self.instances, self.poisson)

    def repeats(self) -> Repeats:
        """Return how alike looks are."""
        return Repeats(self.repeated)


class LatticeEntry(Entry):
    """Where views are looked for: places every `spacing` [m], `offered` of which are drawn for each decision, and
    `headings` at each; without it, poses are drawn at random.

    `tilts_deg` are those the camera can take, its own where none is given.
    """

    spacing: Positive
    headings: Annotated[int, Field(ge=1, le=MAX_HEADINGS)]
    offered: Count
    tilts_deg: list[Annotated[float, Field(gt=-90.0, lt=90.0)]] = Field(default_factory=list, max_length=20)

    def lattice(self) -> Lattice:
        """Return the lattice."""
        return Lattice(
            self.spacing, self.headings, tuple(math.radians(tilt) for tilt in self.tilts_deg), self.offered
        )


class LimitsEntry(Entry):
    """When a search gives up: seconds and poses."""

    seconds: Positive
    poses: Count


class PlannerEntry(Entry):
    """A planner file: candidates, the cone that scores them, voxel weights, supports and limits."""

    title: str
    candidates: Count
    view: TriangleEntry | SectorEntry
    weight_floor: Annotated[float, Field(ge=0.0)]
    weight_gain: Annotated[float, Field(ge=0.0)]
    supports: SupportsEntry
    limits: LimitsEntry
    sight: SightEntry | None = None
    belief: BeliefEntry | None = None
    lattice: LatticeEntry | None = None

    @property
    def looks(self) -> SightEntry:
        """What planners with a belief assume of a look; ValueRangeError where the file does not say."""
        if self.sight is None:
            raise ValueRangeError(
                "the table 'sight' of the preset", "absent", "detection_rate and aim_height"
            )
        return self.sight

    def cone(self) -> ViewCone:
        """Return the view cone that scores the candidates."""
        if isinstance(self.view, TriangleEntry):
            return Triangle(self.view.length, self.view.half_width)
        return Sector(self.view.near, self.view.far, math.radians(self.view.fov_deg))

    def search_limits(self, override: LimitsEntry | None = None) -> Limits:
        """Return the limits of a search, those of a scenario before those of the preset."""
        limits = override or self.limits
        return Limits(limits.seconds, limits.poses, self.candidates)


@dataclass(frozen=True, slots=True)
class Preset:
    """A preset's name and the file it stands in."""

    name: str
    path: Path


ValueT = TypeVar("ValueT")


def find_preset(kind: str, name: str, beside: Path) -> Preset:
    """Return the preset `name` of a kind ("cameras", "robots", "planners"): shipped, or a .toml beside a scenario."""
    if name.endswith(".toml"):
        return Preset(Path(name).stem, beside / name)
    folder = resource_root("knowledge") / "presets" / kind
    known = sorted(path.stem for path in folder.glob("*.toml"))
    if name not in known:
        raise UnknownNameError(f"preset of {kind}", name, known)
    return Preset(name, folder / f"{name}.toml")


def read_camera(preset: Preset) -> Camera:
    """Return the camera of a preset file."""
    return _made(preset, CameraEntry, CameraEntry.camera)


def read_robot(preset: Preset) -> Robot:
    """Return the robot of a preset file."""
    return _made(preset, RobotEntry, RobotEntry.robot)


def read_body(preset: Preset) -> Body:
    """Return the body of a robot's preset file."""
    return _made(preset, RobotEntry, RobotEntry.body)


def read_planner(preset: Preset) -> PlannerEntry:
    """Return the planner of a preset file."""
    entry = read_entry(preset.path, PlannerEntry)
    _checked(preset, entry.cone)
    return entry


def _made(preset: Preset, model: type[EntryT], make: Callable[[EntryT], ValueT]) -> ValueT:
    entry = read_entry(preset.path, model)
    return _checked(preset, lambda: make(entry))


def _checked(preset: Preset, make: Callable[[], ValueT]) -> ValueT:
    try:
        return make()
    except ValueRangeError as error:
        raise FileError(preset.path, str(error), "change it") from None
