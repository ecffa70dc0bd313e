import json

import pytest
from experiments.test_search_verbs import app
from typer.testing import CliRunner

import qsrlang as qsr
from qsrlang.errors import FileError, ValueRangeError
from qsrlang.experiments.days import by_nearest_landmark, search_and_learn
from qsrlang.learning.merging import learned_before

DAYS = 12


@pytest.fixture(scope="module")
def course(unchanged_cell, tmp_path_factory):
    """A course of DAYS days in one go, and the file it learned into."""
    file = tmp_path_factory.mktemp("course") / "learned.qsr"
    return search_and_learn(unchanged_cell, file, DAYS, seed=3, variant="one"), file


def test_the_robot_learns_where_the_cup_is_and_then_searches_by_that(course):
    """The cup stands 0.4 m from the table's middle, on the right as seen from the table's front: cup-2 of the cell."""
    days, file = course
    assert [day.number for day in days] == list(range(1, DAYS + 1))
    told = [day.told for day in days]
    assert not told[0] and told[-1] and told == sorted(told)
    learned = qsr.load(str(file))
    (x, y), _ = learned.where("Cup").mixture.moments()
    assert (x, y) == pytest.approx((3.5, 1.4), abs=0.12)
    assert any("Cup from Table is new" in day.change for day in days)
    taught = file.read_text().partition("# Learned")[0]
    assert "landmark table-1" in taught and "observe" not in taught and "believe" not in taught


def test_things_move_from_day_to_day(course):
    _, file = course
    with qsr.ObservationStore(file.with_suffix(".sqlite")) as store:
        seen = store.query(place="cell")
    cups = seen.among("kind", ["Cup"])
    assert len(set(cups.number("x").round(3))) == len(cups) > 5
    assert 0.01 < cups.number("x").std() < 0.12


def test_an_interrupted_course_goes_on_and_ends_as_one_in_one_go(course, unchanged_cell, tmp_path):
    """The second interruption leaves the store one day ahead of the file, as between the two writes."""
    days, whole = course
    file = tmp_path / "learned.qsr"
    search_and_learn(unchanged_cell, file, 4, seed=3, variant="one")
    behind = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.suffix != ".sqlite"}
    search_and_learn(unchanged_cell, file, 5, seed=3, variant="one")
    for path in tmp_path.iterdir():
        if path.suffix == ".sums":
            path.unlink()
    for name, text in behind.items():
        (tmp_path / name).write_bytes(text)
    rest = search_and_learn(unchanged_cell, file, DAYS, seed=3, variant="one")
    assert rest == days[5:]
    assert file.read_bytes() == whole.read_bytes()
    assert search_and_learn(unchanged_cell, file, DAYS, seed=3, variant="one") == ()


def test_what_people_wrote_stays_and_what_was_learned_elsewhere_is_not_lost(unchanged_cell, tmp_path):
    file = tmp_path / "learned.qsr"
    search_and_learn(unchanged_cell, file, 1, seed=3)
    by_hand = "# Mine.\n" + file.read_text()
    file.write_text(by_hand)
    search_and_learn(unchanged_cell, file, 2, seed=3)
    assert file.read_text().startswith("# Mine.\n")
    assert sum(learned_before(file).sources.values()) > 0
    file.with_suffix(".sqlite").unlink()
    before = file.read_bytes()
    with pytest.raises(FileError, match=r"was learned from more than learned\.sqlite holds"):
        search_and_learn(unchanged_cell, file, 3, seed=3)
    assert file.read_bytes() == before


def test_courses_that_make_no_sense_are_refused(unchanged_cell, tmp_path):
    with pytest.raises(FileError, match=r"does not end in \.qsr"):
        search_and_learn(unchanged_cell, tmp_path / "learned.txt")
    with pytest.raises(ValueRangeError, match="the number of days"):
        search_and_learn(unchanged_cell, tmp_path / "learned.qsr", 0)
    assert not list(tmp_path.iterdir())


def test_each_thing_is_told_by_the_landmark_nearest_to_it():
    def row(name, x):
        shared = dict.fromkeys(("place", "support", "source"), "") | dict.fromkeys(
            ("time", "y", "z", "yaw", "length", "width", "height"), 0.0
        )
        return shared | {"scene": "day 1", "object": name, "kind": name[0], "x": x, "confidence": 1.0}

    seen = qsr.Observations.of([row("m-1", 0.0), row("m-2", 5.0), row("c-1", 4.0), row("k-1", 1.0)])
    paired = by_nearest_landmark(seen, 2)
    assert paired.text("object") == ["m-2", "c-1", "m-1", "k-1"]
    assert paired.text("scene") == ["day 1, c-1", "day 1, c-1", "day 1, k-1", "day 1, k-1"]
    assert by_nearest_landmark(seen, 0) is seen


def test_the_verb_tells_each_day_and_what_was_done_before(unchanged_cell, tmp_path):
    words = ["search", str(unchanged_cell), "--learn", str(tmp_path / "cups.qsr"), "--seed", "1", "--days"]
    first = CliRunner().invoke(app, [*words, "2"])
    assert first.exit_code == 0, first.output
    assert [line.split()[0] for line in first.output.splitlines()[:3]] == ["day", "1", "2"]
    again = CliRunner().invoke(app, [*words, "3"])
    assert "days up to 2 were done before" in again.output
    last = json.loads(CliRunner().invoke(app, [*words, "4", "--format", "json"]).stdout)
    assert [day["number"] for day in last] == [4]


@pytest.mark.parametrize("option", [["--explain"], ["--trial", "1"], ["--output", "x"]])
def test_what_learning_does_not_heed_is_refused(option, unchanged_cell, tmp_path):
    refused = CliRunner().invoke(
        app, ["search", str(unchanged_cell), "--learn", str(tmp_path / "x.qsr"), *option]
    )
    assert refused.exit_code == 2
    assert "--learn" in refused.output
