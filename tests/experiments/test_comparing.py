import csv
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import qsrlang
from qsrlang.errors import FileError, ValueRangeError
from qsrlang.experiments.comparing import compare
from qsrlang.experiments.scenarios import load_scenario
from qsrlang.experiments.stories import open_search, search

TRIALS = 5


@pytest.fixture(scope="module")
def uncut(unchanged_cell, tmp_path_factory):
    """A finished comparison and its CSV."""
    path = tmp_path_factory.mktemp("uncut") / "whole.csv"
    return compare(unchanged_cell, trials=TRIALS, seed=3, output=path), path.read_bytes()


@pytest.fixture
def whole(uncut, tmp_path):
    """The bytes of a finished comparison's CSV, which also stand in a file of their own."""
    (tmp_path / "whole.csv").write_bytes(uncut[1])
    return uncut[1]


def test_two_processes_write_the_same_bytes_as_one(cell, tmp_path, whole):
    compare(cell, trials=TRIALS, seed=3, processes=2, output=tmp_path / "two.csv")
    assert (tmp_path / "two.csv").read_bytes() == whole
    rows = list(csv.DictReader((tmp_path / "two.csv").read_text(encoding="utf-8").splitlines()))
    assert [(row["arm"], int(row["trial"])) for row in rows] == [
        (arm, number) for arm in ("random", "planes", "qsr") for number in range(TRIALS)
    ]


def test_the_file_holds_no_time_of_day(cell, tmp_path, whole):
    time.sleep(0.01)
    compare(cell, trials=TRIALS, seed=3, output=tmp_path / "later.csv")
    assert (tmp_path / "later.csv").read_bytes() == whole


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.77, 1.0])
def test_resuming_equals_never_having_stopped(cell, tmp_path, uncut, whole, share):
    path = tmp_path / "cut.csv"
    path.write_bytes(whole[: int(share * len(whole))])
    done = []
    result = compare(cell, trials=TRIALS, seed=3, output=path, progress=lambda now, wanted: done.append(now))
    assert path.read_bytes() == whole
    assert done[0] == max(0, whole[: int(share * len(whole))].count(b"\n") - 1)
    assert result == uncut[0]


def test_more_trials_and_arms_build_on_the_ones_there_are(cell, tmp_path, whole):
    path = tmp_path / "grown.csv"
    compare(cell, ["qsr"], trials=2, seed=3, output=path)
    compare(cell, ["planes"], trials=TRIALS, seed=3, output=path)
    compare(cell, trials=TRIALS, seed=3, output=path)
    assert path.read_bytes() == whole


def test_a_file_of_another_seed_variant_or_scenario_is_refused(cell, change, tmp_path, whole):
    for differing in ({"seed": 4}, {"seed": 3, "variant": "one"}):
        with pytest.raises(FileError, match=r"whole\.csv: holds trials of (seed 3|variant both)"):
            compare(cell, trials=TRIALS, output=tmp_path / "whole.csv", **differing)
    change(cell, "x = 3.5\ny = 2.1", "x = 3.6\ny = 2.1")
    with pytest.raises(FileError, match=r"holds trials of fingerprint .* give another file"):
        compare(cell, trials=TRIALS, seed=3, output=tmp_path / "whole.csv")
    assert (tmp_path / "whole.csv").read_bytes() == whole


def test_arms_share_their_candidates_and_trials_are_searches(cell):
    result = compare(cell, trials=3, seed=8)
    for arm in ("random", "planes", "qsr"):
        opening = open_search(cell, planner=arm)
        for trial in result.of(arm):
            story = opening.search(seed=8, trial=trial.number)
            assert (trial.found, trial.poses, trial.seconds) == (
                story.found,
                story.poses,
                pytest.approx(story.seconds if story.found else 120.0, abs=1e-6),
            )
    first = [search(cell, planner=arm, seed=8).steps[0].candidates.tolist() for arm in ("random", "qsr")]
    assert first[0] == first[1]


def test_arms_find_less_where_less_is_there(cell):
    both, one = (compare(cell, ["random"], trials=12, seed=1, variant=variant) for variant in ("both", "one"))
    assert all(trial.detected in ("cup-2", "") for trial in one.results)
    assert sum(trial.seconds for trial in one.results) >= sum(trial.seconds for trial in both.results)


def test_a_story_holds_all_that_a_picture_needs(cell):
    story = search(cell, seed=1)
    briefing = story.opening.briefing
    assert len(briefing.weights) == len(briefing.supports.centres)
    assert len(briefing.beliefs) == 1
    assert [mark.name for mark in briefing.landmarks] == ["table-1"]
    assert story.opening.place.reachable.is_navigable(story.steps[0].path).all()
    assert story.found and story.detection is not None and story.detection.kind == "Cup"


@pytest.mark.parametrize(
    "wrong", [{"trials": 0}, {"trials": 10**9}, {"seed": -1}, {"arms": []}, {"processes": 0}]
)
def test_senseless_numbers_are_refused(cell, wrong):
    with pytest.raises(ValueRangeError):
        compare(cell, **{"trials": 2, **wrong})


INTERRUPTED = """
import sys
from qsrlang.cli.compare import compare
import typer
if __name__ == "__main__":
    app = typer.Typer(pretty_exceptions_enable=False)
    app.command()(compare)
    app()
"""


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT to a process group, as Ctrl-C does")
@pytest.mark.parametrize("processes", [1, 2])
def test_ctrl_c_keeps_finished_trials_and_says_how_to_go_on(cell, tmp_path, processes):
    program, path = tmp_path / "program.py", tmp_path / "cut.csv"
    program.write_text(INTERRUPTED, encoding="utf-8")
    command = [sys.executable, str(program), str(cell), "--trials", "400", "--seed", "3"]
    command += ["--output", str(path), "--processes", str(processes)]
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([str(Path(qsrlang.__file__).parents[1]), *sys.path]),
    }
    running = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        start_new_session=True,
    )
    deadline = time.monotonic() + 60
    while (not path.is_file() or path.read_bytes().count(b"\n") < 6) and time.monotonic() < deadline:
        time.sleep(0.02)
    os.killpg(running.pid, signal.SIGINT)
    out, told = running.communicate(timeout=60)
    kept = path.read_bytes().count(b"\n") - 1
    assert (running.returncode, out) == (130, "")
    assert kept >= 5
    assert re.fullmatch(
        rf"interrupted: {kept} finished trials are kept in \S+; the same command goes on from there\n", told
    )
    done = []
    compare(cell, trials=4, seed=3, output=path, progress=lambda now, wanted: done.append(now))
    assert done[0] > 0
    assert load_scenario(cell).fingerprint.encode() in path.read_bytes()
