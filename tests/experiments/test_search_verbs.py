import json

import pytest
import typer
from typer.testing import CliRunner

from qsrlang.cli.compare import compare
from qsrlang.cli.search import search
from qsrlang.errors import QSRError

app = typer.Typer(pretty_exceptions_enable=False)
app.command()(search)
app.command()(compare)


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_search_tells_every_step_and_draws_it(cell, tmp_path):
    result = run("search", cell, "--seed", 1, "--output", tmp_path / "pictures")
    assert result.exit_code == 0
    for part in (
        "A table in a small room",
        "Sought: Cup; arm qsr, variant both, camera wide, robot slow, seed 1.",
        "It believes: where Cup is",
        "Step 1",
        "looks from (",
        "rank 1 of 20 poses; the runner-up is worth",
        "saw cup-",
        "clock ",
        "Search for Cup",
        "found",
    ):
        assert part in result.output, part
    assert (tmp_path / "pictures" / "step-01.png").read_bytes().startswith(b"\x89PNG")


def test_search_as_json_says_the_same(cell, tmp_path):
    result = run("search", cell, "--seed", 1, "--format", "json", "--output", tmp_path / "pictures")
    story = json.loads(result.stdout)
    assert (story["scenario"], story["arm"], story["targets"], story["found"]) == (
        "cell",
        "qsr",
        ["Cup"],
        True,
    )
    assert story["poses"] == len(story["steps"]) == len(story["pictures"])
    last = story["steps"][-1]
    assert last["clock"] == pytest.approx(story["seconds"])
    assert story["finds"][0] in last["detections"]
    assert max(last["values"]) == last["value"]
    assert story["beliefs"][0]["components"][0]["mean"] == pytest.approx([3.6, 1.8])


def add_a_plate(cell, change):
    change(
        cell,
        "[variants]\n",
        '[[placements]]\nname = "plate-1"\nkind = "Plate"\nx = 3.6\ny = 1.8\nsize = [0.2, 0.2, 0.02]\n[variants]\n',
    )
    change(cell, '"cup-2"]\none', '"cup-2", "plate-1"]\none')
    change(cell, "[arms.random]", '[arms.belief]\nplanner = "belief"\npreset = "aware"\n[arms.random]')
    change(
        cell.with_name("cups.qsr"),
        "believe left-of",
        "observe 1 × in-front-of(Plate, Table) ~ normal((0 cm, 0 cm), (20 cm, 40 cm), 0).\nbelieve left-of",
    )


def test_one_of_each_of_several_classes_is_found(cell, change):
    add_a_plate(cell, change)
    several = ("--target", "Cup", "--target", "Plate", "--target", "Cup")
    told = run("search", cell, "--arm", "belief", *several, "--seed", 2, "--no-pictures")
    assert told.exit_code == 0, told.output
    assert "Sought: Cup, Plate;" in told.output
    assert "It believes: where Plate is" in told.output
    result = run(
        "search", cell, "--arm", "belief", *several, "--seed", 2, "--no-pictures", "--format", "json"
    )
    story = json.loads(result.stdout)
    assert story["targets"] == ["Cup", "Plate"] and story["found"]
    assert sorted(one["kind"] for one in story["finds"]) == ["Cup", "Plate"]
    assert len(story["beliefs"]) == 2
    for before, after in zip(story["steps"], story["steps"][1:], strict=False):
        seen = {one["kind"] for one in before["detections"]}
        assert after["wanted"] == [kind for kind in before["wanted"] if kind not in seen]


def test_only_planners_that_keep_a_belief_seek_several(cell, change):
    add_a_plate(cell, change)
    result = run("search", cell, "--target", "Cup", "--target", "Plate", "--no-pictures")
    assert isinstance(result.exception, QSRError)
    assert "the number of targets of the arm 'qsr' is 2" in str(result.exception)


def test_a_random_arm_has_no_reasons(cell, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("search", cell, "--arm", "random", "--no-pictures", "--variant", "one")
    assert "It uses no relations." in result.output
    assert "it picked one of 20 poses at random" in result.output
    assert not (tmp_path / "runs").exists()


def test_compare_prints_a_table_and_writes_every_trial(cell, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("compare", cell, "--arms", "qsr,random", "--trials", 3, "--seed", 2, "--processes", 1)
    assert result.exit_code == 0
    assert "cell, variant both: 3 trials an arm, seed 2" in result.stdout
    path = tmp_path / "runs" / "cell-both-wide-slow-seed-2.csv"
    assert path.read_text(encoding="utf-8").count("\n") == 7
    assert "every trial: runs/cell-both-wide-slow-seed-2.csv" in result.stderr


def test_compare_as_json_is_nothing_but_json(cell, tmp_path):
    output = tmp_path / "t.csv"
    result = run(
        "compare",
        cell,
        "--arms",
        "qsr",
        "--trials",
        2,
        "--output",
        output,
        "--processes",
        1,
        "--format",
        "json",
    )
    data = json.loads(result.stdout)
    assert (data["trials"], list(data["arms"]), data["camera"]) == (2, ["qsr"], "wide")


def test_mistakes_are_errors_of_ours(cell, tmp_path):
    (tmp_path / "file").write_text("")
    for arguments in (
        ("search", cell, "--arm", "greedy"),
        ("search", "nowhere"),
        ("search", cell, "--output", tmp_path / "file"),
        ("compare", cell, "--arms", "qsr,greedy"),
        ("compare", cell, "--variant", "D"),
        ("compare", cell, "--camera", "none"),
        ("compare", cell, "--output", cell),
    ):
        result = run(*arguments)
        assert isinstance(result.exception, QSRError), arguments
        assert "\n" not in str(result.exception)


def test_search_explains_what_views_were_worth_and_cost(cell):
    with cell.open("a", encoding="utf-8") as file:
        file.write('[arms.rollout]\nplanner = "rollout"\npreset = "lookahead"\n')
    told = run("search", cell, "--arm", "rollout", "--seed", 1, "--explain", "--no-pictures")
    assert told.exit_code == 0
    for part in ("seconds saved", "best view: (", "runner-up: (", "chance per second", "plan from there"):
        assert part in told.output, part
    story = json.loads(
        run("search", cell, "--arm", "rollout", "--seed", 1, "--no-pictures", "--format", "json").stdout
    )
    terms = story["steps"][0]["terms"]
    assert terms["index"] == pytest.approx(terms["gain"] / terms["seconds"])
    assert story["verdict"] == "found"
    plain = run("search", cell, "--seed", 1, "--explain", "--no-pictures")
    assert "it does not weigh what views cost" in plain.output


def test_compare_takes_a_camera_that_errs(cell, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = ("--arms", "qsr", "--trials", 3, "--variant", "one", "--processes", 1, "--format", "json")
    exact = run("compare", cell, *options)
    erring = run("compare", cell, *options, "--detection-rate", 0.05)
    assert exact.exit_code == erring.exit_code == 0
    assert len(list((tmp_path / "runs").glob("*.csv"))) == 2, "each has a file of its own"
    times = [json.loads(one.stdout)["arms"]["qsr"]["time_censored"] for one in (exact, erring)]
    assert times[0] < times[1]
    senseless = run("compare", cell, *options, "--detection-rate", 0.0)
    assert isinstance(senseless.exception, QSRError)
