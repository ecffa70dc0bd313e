from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from qsrlang.errors import FileError
from qsrlang.experiments.recording import HEADER, Experiment, Recording, read_trials
from qsrlang.experiments.trials import Trial

MADE = Experiment("kitchen", "A", "Cup", "narrow", "steady", 7, "0123456789ab")
TRIALS = [
    Trial("qsr", 1, True, 12.3456789, 2, 3.25, "cup-1"),
    Trial("random", 0, False, 120.0, 9, 31.0, ""),
    Trial("qsr", 0, True, 8.0, 1, 1.5, "cup-2"),
]


def write(path, trials, finish=False):
    with Recording(path, MADE) as recording:
        for trial in trials:
            recording.add(trial)
        if finish:
            recording.finish([*recording.kept, *trials], ("random", "qsr"))


def test_what_is_written_is_read_back(tmp_path):
    write(tmp_path / "t.csv", TRIALS)
    assert read_trials(tmp_path / "t.csv", MADE) == tuple(TRIALS)


def test_the_finished_file_is_sorted_and_plain(tmp_path):
    write(tmp_path / "t.csv", TRIALS, finish=True)
    common = "kitchen,A,Cup,narrow,steady,7,0123456789ab"
    assert (tmp_path / "t.csv").read_bytes().decode().split("\n") == [
        ",".join(HEADER),
        f"{common},random,0,0,120.000000,9,31.000000,",
        f"{common},qsr,0,1,8.000000,1,1.500000,cup-2",
        f"{common},qsr,1,1,12.345679,2,3.250000,cup-1",
        "",
    ]


def test_trials_are_on_disk_before_the_file_is_closed(tmp_path):
    with Recording(tmp_path / "t.csv", MADE) as recording:
        recording.add(TRIALS[0])
        assert read_trials(tmp_path / "t.csv", MADE) == (TRIALS[0],)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60, deadline=None)
@given(cut=st.integers(0, 400))
def test_an_interruption_anywhere_costs_at_most_the_last_line(tmp_path, cut):
    path = tmp_path / "t.csv"
    path.unlink(missing_ok=True)
    write(path, TRIALS)
    whole = path.read_bytes()
    kept = whole[: max(0, len(whole) - cut)]
    path.write_bytes(kept)
    lines = kept.count(b"\n")
    with Recording(path, MADE) as recording:
        assert recording.kept == tuple(TRIALS[: max(0, lines - 1)])
        for trial in TRIALS[len(recording.kept) :]:
            recording.add(trial)
        recording.finish(TRIALS, ("random", "qsr"))
    resumed = path.read_bytes()
    path.unlink()
    write(path, TRIALS, finish=True)
    assert resumed == path.read_bytes()


@pytest.mark.parametrize(
    "change",
    [
        {"scenario": "office"},
        {"variant": "B"},
        {"seed": 8},
        {"camera": "wide"},
        {"fingerprint": "ba9876543210"},
    ],
)
def test_a_file_of_another_experiment_is_refused(tmp_path, change):
    write(tmp_path / "t.csv", TRIALS)
    before = (tmp_path / "t.csv").read_bytes()
    (name, other), has = next(iter(change.items())), getattr(MADE, next(iter(change)))
    with pytest.raises(
        FileError, match=rf"t\.csv: holds trials of {name} {has}, not {other}; give another file"
    ):
        Recording(tmp_path / "t.csv", replace(MADE, **change))
    assert (tmp_path / "t.csv").read_bytes() == before


@pytest.mark.parametrize(
    "content",
    [
        b"a letter to my mother",
        b"a letter\nto my mother\n",
        b"\xff\xfe\x00",
        b"x,y\n1,2\n",
        (",".join(HEADER) + "\nkitchen,A\n").encode(),
        (
            ",".join(HEADER) + "\nkitchen,A,Cup,narrow,steady,7,0123456789ab,qsr,one,1,8.0,1,1.5,cup\n"
        ).encode(),
        (
            ",".join(HEADER) + "\nkitchen,A,Cup,narrow,steady,7,0123456789ab,qsr,1,yes,8.0,1,1.5,cup\n"
        ).encode(),
    ],
)
def test_a_file_that_is_not_ours_is_refused_and_left_alone(tmp_path, content):
    path = tmp_path / "t.csv"
    path.write_bytes(content)
    with pytest.raises(FileError) as caught:
        Recording(path, MADE)
    assert "\n" not in str(caught.value) and "t.csv" in str(caught.value)
    assert path.read_bytes() == content


def test_folders_are_made_and_impossible_places_named(tmp_path):
    write(tmp_path / "new" / "t.csv", TRIALS)
    assert (tmp_path / "new" / "t.csv").is_file()
    with pytest.raises(FileError, match="cannot be"):
        Recording(tmp_path / "new" / "t.csv" / "below.csv", MADE)
    with pytest.raises(FileError):
        Recording(tmp_path / "new", MADE)


def test_no_temporary_file_is_left(tmp_path):
    write(tmp_path / "t.csv", TRIALS, finish=True)
    assert [path.name for path in tmp_path.iterdir()] == ["t.csv"]
