"""Comparisons: arms times trials over processes, recorded as they go."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

from qsrlang.errors import ValueRangeError
from qsrlang.experiments.arms import TrialJob, TrialSetup, TrialWorker
from qsrlang.experiments.briefings import brief
from qsrlang.experiments.cluster import work_through
from qsrlang.experiments.places import read_place
from qsrlang.experiments.recording import Experiment, Recording
from qsrlang.experiments.scenarios import Scenario, load_scenario
from qsrlang.experiments.summaries import Comparison
from qsrlang.experiments.trials import Trial

MAX_TRIALS = 100_000

Progress = Callable[[int, int], None]


def compare(
    scenario: str | Path | Scenario,
    arms: Sequence[str] | None = None,
    trials: int = 200,
    seed: int = 0,
    variant: str | None = None,
    processes: int = 1,
    output: Path | str | None = None,
    progress: Progress | None = None,
    target: str | None = None,
) -> Comparison:
    """Run every arm `trials` times in a scenario, all with the same random numbers, and return what came of it.

    `arms` are names of the scenario's arms, all of them by default; `variant` says which objects exist, the first
    of the scenario by default. `output` is the per-trial CSV: finished trials that it holds are kept and not run
    again, new ones are appended as they end, and at the end it is written whole and sorted, the same for any
    number of processes. `progress` is called with the trials done and the trials wanted. Raises QSRError.
    """
    loaded = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    chosen = tuple(dict.fromkeys(arms if arms is not None else loaded.arms))
    for name in chosen:
        loaded.arm(name)
    if not chosen or not 1 <= trials <= MAX_TRIALS:
        raise ValueRangeError(
            "the number of trials", trials if chosen else 0, f"1 to {MAX_TRIALS}, of at least one arm"
        )
    made = experiment_of(loaded, seed, variant, target)
    jobs = [TrialJob(arm, number) for number in range(trials) for arm in chosen]
    with _recording(output, made) as recording:
        done = _run(loaded, made, jobs, processes, recording, progress)
        results = tuple(done[arm, number] for arm in chosen for number in range(trials))
        if recording is not None:
            recording.finish(done.values(), tuple(loaded.arms))
    return Comparison(made, chosen, trials, results)


def experiment_of(
    scenario: Scenario, seed: int, variant: str | None = None, target: str | None = None
) -> Experiment:
    """Return what the rows of a comparison's file have in common."""
    if seed < 0:
        raise ValueRangeError("the seed", seed, "a whole number of at least 0")
    return Experiment(
        scenario=scenario.name,
        variant=scenario.variant(variant),
        target=target or scenario.target,
        camera=scenario.camera_name,
        robot=scenario.robot_name,
        seed=seed,
        fingerprint=scenario.fingerprint,
    )


def _recording(output: Path | str | None, made: Experiment) -> AbstractContextManager[Recording | None]:
    return nullcontext() if output is None else Recording(Path(output), made)


def _run(
    scenario: Scenario,
    made: Experiment,
    jobs: Sequence[TrialJob],
    processes: int,
    recording: Recording | None,
    progress: Progress | None,
) -> dict[tuple[str, int], Trial]:
    done = {(trial.arm, trial.number): trial for trial in (recording.kept if recording else ())}
    left = [job for job in jobs if (job.arm, job.number) not in done]
    finished = len(jobs) - len(left)
    if progress is not None:
        progress(finished, len(jobs))
    if not left:
        return done
    for trial in work_through(TrialWorker, _setup(scenario, made, left), left, processes):
        done[trial.arm, trial.number] = trial
        finished += 1
        if recording is not None:
            recording.add(trial)
        if progress is not None:
            progress(finished, len(jobs))
    return done


def _setup(scenario: Scenario, made: Experiment, left: Sequence[TrialJob]) -> TrialSetup:
    arms = [scenario.arm(name) for name in dict.fromkeys(job.arm for job in left)]
    place = read_place(scenario)
    return TrialSetup(scenario, made.variant, place, brief(scenario, arms, place, made.target), made.seed)
