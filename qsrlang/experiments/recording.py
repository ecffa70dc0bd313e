"""The per-trial CSV: appended while a comparison runs, read again to go on, written whole and sorted at the end."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from types import TracebackType

from qsrlang.errors import FileError
from qsrlang.experiments.trials import DECIMALS, Trial
from qsrlang.files import write_whole

MAX_BYTES = 200_000_000
TRIAL_COLUMNS = ("arm", "trial", "found", "seconds", "poses", "travel", "object")


@dataclass(frozen=True, slots=True)
class Experiment:
    """What every row of a file has in common; rows of different experiments never share a file."""

    scenario: str
    variant: str
    target: str
    camera: str
    robot: str
    seed: int
    fingerprint: str


EXPERIMENT_COLUMNS = tuple(field.name for field in fields(Experiment))
HEADER = (*EXPERIMENT_COLUMNS, *TRIAL_COLUMNS)


class Recording:
    """A CSV file that is open for one experiment; trials that it held when it was opened are `kept`.

    A half line at the end, left by an interruption, is dropped. Raises FileError where the file belongs to
    another experiment or is no such file.
    """

    def __init__(self, path: Path, experiment: Experiment) -> None:
        self.path = path
        self._experiment = experiment
        self.kept = read_trials(path, experiment) if path.exists() else ()
        self._write_whole(self.kept)
        try:
            self._file = path.open("a", encoding="utf-8", newline="")
        except OSError as error:
            raise _unwritable(path, error) from None

    def __enter__(self) -> Recording:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def add(self, trial: Trial) -> None:
        """Append one trial: a whole line, handed to the system at once."""
        self._file.write(_lines([self._row(trial)]))
        self._file.flush()

    def finish(self, trials: Iterable[Trial], arms: Sequence[str]) -> None:
        """Write the file anew, whole and sorted: arms in the given order, others after them by name."""
        self._file.close()
        place = {arm: number for number, arm in enumerate(arms)}
        self._write_whole(
            sorted(trials, key=lambda trial: (place.get(trial.arm, len(place)), trial.arm, trial.number))
        )

    def _row(self, trial: Trial) -> tuple[str, ...]:
        experiment = tuple(str(getattr(self._experiment, name)) for name in EXPERIMENT_COLUMNS)
        seconds, travel = (f"{value:.{DECIMALS}f}" for value in (trial.seconds, trial.travel))
        found = "1" if trial.found else "0"
        return (
            *experiment,
            trial.arm,
            str(trial.number),
            found,
            seconds,
            str(trial.poses),
            travel,
            trial.detected,
        )

    def _write_whole(self, trials: Iterable[Trial]) -> None:
        text = _lines([HEADER, *(self._row(trial) for trial in trials)])
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _unwritable(self.path, error) from None
        write_whole(self.path, text)


def read_trials(path: Path, experiment: Experiment) -> tuple[Trial, ...]:
    """Return the finished trials of a file; raises FileError where it is not a file of this experiment."""
    text = _text(path)
    rows = list(csv.reader(io.StringIO(text[: text.rfind("\n") + 1])))
    if not rows and ",".join(HEADER).startswith(text):
        return ()
    if not rows or tuple(rows[0]) != HEADER:
        raise FileError(path, "not a file of per-trial results", "give another file to --output")
    trials = {}
    for number, row in enumerate(rows[1:], 2):
        trial = _trial(path, number, row, experiment)
        trials[trial.arm, trial.number] = trial
    return tuple(trials.values())


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise FileError(path, f"larger than {MAX_BYTES} bytes", "give another file to --output")
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise FileError(
            path, (error.strerror or "cannot be read").lower(), "give another file to --output"
        ) from None
    except UnicodeDecodeError:
        raise FileError(path, "not a text file", "give another file to --output") from None


def _trial(path: Path, number: int, row: list[str], experiment: Experiment) -> Trial:
    if len(row) != len(HEADER):
        raise FileError(
            path, f"line {number} has {len(row)} fields of {len(HEADER)}", "mend or delete the file"
        )
    _check_experiment(path, row, experiment)
    arm, trial, found, seconds, poses, travel, name = row[len(EXPERIMENT_COLUMNS) :]
    try:
        return Trial(
            arm, int(trial), {"0": False, "1": True}[found], float(seconds), int(poses), float(travel), name
        )
    except (ValueError, KeyError):
        raise FileError(path, f"line {number} cannot be understood", "mend or delete the file") from None


def _check_experiment(path: Path, row: list[str], experiment: Experiment) -> None:
    for name, has in zip(EXPERIMENT_COLUMNS, row, strict=False):
        wants = str(getattr(experiment, name))
        if has != wants:
            raise FileError(
                path,
                f"holds trials of {name} {has}, not {wants}",
                "give another file to --output, or delete this one to begin anew",
            )


def _lines(rows: Iterable[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def _unwritable(path: Path, error: OSError) -> FileError:
    return FileError(
        path, f"cannot be written: {(error.strerror or 'no reason given').lower()}", "give another --output"
    )
