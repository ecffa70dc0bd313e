import math
import tomllib

import pytest

from qsrlang.errors import (
    BlockedPoseError,
    FileError,
    NoNavigablePoseError,
    OutsideMapError,
    QSRError,
    UnknownNameError,
    UnreachedTargetError,
)
from qsrlang.experiments.comparing import compare
from qsrlang.experiments.presets import find_preset, read_camera, read_planner, read_robot
from qsrlang.experiments.scenariofiles import ScenarioEntry
from qsrlang.experiments.scenarios import load_scenario, scenario_names
from qsrlang.experiments.stories import open_search, search
from qsrlang.experiments.tomlfiles import read_entry
from qsrlang.geometry.viewcone import Triangle
from qsrlang.resources import data_root, resource_path, resource_root


def one_line(error):
    text = str(error.value)
    assert "\n" not in text
    return text


def test_a_scenario_is_read_whole(cell):
    scenario = load_scenario(cell)
    assert (scenario.name, scenario.target, tuple(scenario.arms)) == (
        "cell",
        "Cup",
        ("random", "planes", "qsr"),
    )
    assert scenario.variant(None) == "both"
    assert [placed.name for placed in scenario.placed("one")] == ["cup-2"]
    assert scenario.robot.speed == 0.3
    assert scenario.arm("qsr").limits.seconds == 120.0


def test_without_variants_everything_is_there(cell, change):
    change(cell, '[variants]\nboth = ["cup-1", "cup-2"]\none = ["cup-2"]\n', "")
    scenario = load_scenario(cell)
    assert [placed.name for placed in scenario.placed(scenario.variant(None))] == ["cup-1", "cup-2"]


def test_limits_and_presets_can_be_replaced(cell, change):
    change(cell, "[variants]", "[limits]\nseconds = 33.0\nposes = 4\n[variants]")
    assert load_scenario(cell).arm("qsr").limits.seconds == 33.0
    assert load_scenario(cell).arm("qsr").limits.poses == 4
    assert load_scenario(cell, camera="narrow", robot="steady").camera.far == 2.5


def test_the_fingerprint_follows_what_the_files_say(cell, change):
    first = load_scenario(cell).fingerprint
    cell.write_text(cell.read_text() + "\n# a remark\n")
    assert load_scenario(cell).fingerprint == first
    change(cell.with_name("slow.toml"), "speed = 0.3", "speed = 0.31")
    second = load_scenario(cell).fingerprint
    change(cell.with_name("cups.qsr"), "20 cm", "21 cm")
    third = load_scenario(cell).fingerprint
    assert len({first, second, third, load_scenario(cell, camera="narrow").fingerprint}) == 4


@pytest.mark.parametrize("name", scenario_names())
def test_shipped_scenarios_are_sound(name):
    entry = read_entry(resource_path("knowledge", "worlds", f"{name}.toml"), ScenarioEntry)
    if entry.map.room is None and not (data_root() / "tum_kitchen").is_dir():
        pytest.skip("the maps of the simulated kitchen are not there: set QSR_DATA")
    scenario = load_scenario(name)
    assert {"random", "planes", "qsr"} <= set(scenario.arms)
    assert tuple(scenario.variants) == ("A", "B", "C")
    assert {placed.kind for placed in scenario.placements} == {scenario.target}


def test_shipped_presets_are_sound():
    root = resource_root("knowledge") / "presets"
    readers = {"cameras": read_camera, "robots": read_robot, "planners": read_planner}
    for kind, read in readers.items():
        names = [path.stem for path in (root / kind).glob("*.toml")]
        assert names
        for name in names:
            assert read(find_preset(kind, name, root)) is not None


def test_the_preset_of_the_paper_holds_its_numbers():
    preset = read_planner(find_preset("planners", "kunze2014", resource_root("knowledge")))
    assert preset.cone() == Triangle(3.0, 1.0)
    assert (preset.candidates, preset.weight_floor, preset.weight_gain) == (20, 1.0, 10.0)
    assert (preset.limits.seconds, preset.limits.poses) == (120.0, 20)
    assert (preset.supports.method, math.radians(preset.supports.max_tilt_deg)) == (
        "mean-normal",
        math.pi / 8,
    )


BAD_TEXT = [
    ("target = ", "tagret = ", "unknown field 'tagret'", "remove it or use title, target"),
    ('target = "Cup"\n', "", "the field 'target' is missing", "add it"),
    (
        'planner = "qsr"',
        'planner = "qrs"',
        "field 'arms.qsr.planner'",
        "'random', 'planes', 'qsr', 'belief', 'nearest', 'index', 'rollout', 'tour' or 'exact'",
    ),
    ("x = 1.0", 'x = "one"', "field 'start.x'", "valid number"),
    ("x = 1.0", "x = inf", "field 'start.x'", "change it"),
    ("x = 1.0", "x = 1.0\nz = 2.0", "unknown field 'start.z'", "x, y, facing_deg"),
    ("size = [0.09, 0.09, 0.10]", "size = [0.09, 0.09]", "field 'placements.0.size'", "3 items"),
    ("size = [0.09, 0.09, 0.10]", "size = [0.09, 0.0, 0.1]", "field 'placements.0.size.1'", "greater than 0"),
    ('kind = "Cup"', 'kind = "Cup"\ncolour = "red"', "unknown field 'placements.0.colour'", "name, kind, x"),
    ('name = "cup-2"', 'name = "cup-1"', "two placements are named 'cup-1'", "change it"),
    ('one = ["cup-2"]', 'one = ["mug"]', "names 'mug', which is not placed", "cup-1, cup-2"),
    ('room = "room.toml"', "", "either 'occupancy' and 'octomap', or 'room'", "change it"),
    ('room = "room.toml"', 'octomap = "a.bt"', "either 'occupancy' and 'octomap', or 'room'", "change it"),
    ("[map]", "[map", "not TOML", "line"),
]


@pytest.mark.parametrize(("old", "new", "problem", "remedy"), BAD_TEXT)
def test_bad_scenarios_are_told_in_one_line(cell, change, old, new, problem, remedy):
    change(cell, old, new)
    with pytest.raises(FileError) as error:
        load_scenario(cell)
    text = one_line(error)
    assert text.startswith(f"{cell}: ")
    assert problem in text and remedy in text


def test_other_problems_of_a_file_are_counted(cell, change):
    change(cell, "x = 1.0\ny = 1.0", 'x = "a"\ny = "b"')
    with pytest.raises(FileError, match=r"and 1 more"):
        load_scenario(cell)


@pytest.mark.parametrize(
    ("content", "problem"), [(b"\xff\xfe", "UTF-8"), (b"", "missing"), (b"a = 1\n" * 200_000, "larger")]
)
def test_files_that_are_no_scenarios(cell, content, problem):
    cell.write_bytes(content)
    with pytest.raises(FileError, match=problem):
        load_scenario(cell)


def test_missing_files_are_named(cell, change):
    with pytest.raises(FileError, match=r"nothing\.toml: no such file"):
        load_scenario("nothing.toml")
    with pytest.raises(UnknownNameError, match="unknown scenario 'kitchn'; did you mean 'kitchen'"):
        load_scenario("kitchn")
    change(cell, 'camera = "wide"', 'camera = "wyde"')
    with pytest.raises(UnknownNameError, match=r"did you mean 'wide'\? known: morse2014, narrow, wide"):
        load_scenario(cell)
    change(cell, 'camera = "wyde"', 'camera = "mine.toml"')
    with pytest.raises(FileError, match=r"mine\.toml: no such file"):
        load_scenario(cell)


def test_impossible_presets_name_their_file(cell, change):
    change(cell.with_name("slow.toml"), "band = [0.1, 1.8]", "band = [1.8, 0.1]")
    with pytest.raises(FileError, match=r"slow\.toml: the band"):
        load_scenario(cell)


def test_absent_data_names_the_remedy(monkeypatch, tmp_path):
    monkeypatch.setenv("QSR_DATA", str(tmp_path))
    with pytest.raises(FileError, match=r"tum_kitchen\.yaml: no such map; set QSR_DATA"):
        load_scenario("tum-kitchen")


def test_an_unknown_arm_or_variant_names_the_file_and_the_known_ones(cell):
    with pytest.raises(UnknownNameError) as error:
        open_search(cell, planner="qrs")
    assert f"unknown arm of {cell}: 'qrs'; did you mean 'qsr'? known: planes, qsr, random" in one_line(error)
    with pytest.raises(UnknownNameError, match="known: both, one"):
        open_search(cell, variant="three")
    with pytest.raises(UnknownNameError, match="unknown arm"):
        compare(cell, ["random", "greedy"], trials=1)


def test_a_start_inside_a_table(cell, change):
    change(cell, "x = 1.0\ny = 1.0", "x = 3.6\ny = 1.8")
    with pytest.raises(BlockedPoseError) as error:
        search(cell)
    assert "the robot's start at (3.60 m, 1.80 m)" in one_line(error)
    assert "nearest free place" in one_line(error)


def test_a_start_outside_the_map(cell, change):
    change(cell, "x = 1.0", "x = 50.0")
    with pytest.raises(OutsideMapError, match="the robot's start"):
        search(cell)


def test_no_navigable_pose(cell, change):
    change(cell.with_name("slow.toml"), "clearance = 0.35", "clearance = 2.0")
    with pytest.raises(NoNavigablePoseError, match="lower the inflation radius"):
        search(cell)


def test_a_landmark_outside_the_map(cell, change):
    change(cell, "[map]", 'landmarks = ["table-9 : Table at (30 m, 1 m) facing 0 deg"]\n[map]')
    with pytest.raises(OutsideMapError) as error:
        search(cell)
    assert "landmark 'table-9' at (30.00 m, 1.00 m) lies outside the map" in one_line(error)


def test_knowledge_without_a_landmark_in_the_place_is_refused():
    """Its answer is relative to a class and says nothing of the map."""
    with pytest.raises(UnreachedTargetError, match="start at Monitor, which has no landmark"):
        open_search(load_scenario("kitchen", knowledge="office/desk"))


def test_knowledge_can_be_replaced(tmp_path):
    path = tmp_path / "mine.qsr"
    path.write_text('import "kitchen/cups".')
    given, shipped = load_scenario("kitchen", knowledge=str(path)), load_scenario("kitchen")
    assert given.arm("qsr").knowledge == str(path)
    assert given.fingerprint != shipped.fingerprint
    assert load_scenario("kitchen", knowledge=str(path)).fingerprint == given.fingerprint


def test_the_fingerprint_follows_imported_knowledge(cell):
    other = cell.with_name("more.qsr")
    other.write_text("dynamic Spoon2.")
    knowledge = cell.with_name("cups.qsr")
    knowledge.write_text('import "more.qsr".\n' + knowledge.read_text())
    first = load_scenario(cell).fingerprint
    other.write_text("dynamic Spoon3.")
    assert load_scenario(cell).fingerprint != first


def test_a_target_that_no_chain_reaches(cell):
    with pytest.raises(UnreachedTargetError) as error:
        search(cell, target="Spoon")
    assert "cups.qsr" in one_line(error) and "'Spoon'" in one_line(error)
    assert search(cell, target="Spoon", planner="random").found is False


def test_a_target_that_the_knowledge_does_not_know(cell):
    with pytest.raises(UnknownNameError, match=r"unknown class of .*cups\.qsr: 'Cupp'; did you mean 'Cup'"):
        search(cell, target="Cupp")


@pytest.mark.parametrize(
    ("name", "content", "problem"),
    [
        ("cups.qsr", "landmark.", "cups"),
        ("cups.qsr", "static Box.", "Cup"),
        ("room.toml", "name = 1", "room"),
    ],
)
def test_damaged_knowledge_and_rooms_are_errors_of_ours(cell, name, content, problem):
    cell.with_name(name).write_text(content)
    with pytest.raises(QSRError, match=problem):
        search(cell)


def test_a_cup_in_the_air_names_the_scenario(cell, change):
    change(cell, "x = 3.5\ny = 2.1", "x = 3.27\ny = 2.1")
    with pytest.raises(FileError) as error:
        search(cell)
    assert one_line(error).startswith(f"{cell}: ")
    assert "cup-1" in one_line(error)


def test_every_shipped_toml_parses():
    for path in (resource_root("knowledge") / "worlds").glob("*.toml"):
        assert tomllib.loads(path.read_text(encoding="utf-8"))
