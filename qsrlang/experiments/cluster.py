"""Jobs spread over processes, each of which makes its own worker once."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from typing import Any, Protocol, TypeVar, cast

from qsrlang.errors import QSRError, ValueRangeError
from qsrlang.planning.threads import use_threads

MAX_PROCESSES = 256
JOBS_IN_HAND = 4

SetupT = TypeVar("SetupT")
JobT = TypeVar("JobT")
JobT_contra = TypeVar("JobT_contra", contravariant=True)
DoneT = TypeVar("DoneT")
DoneT_co = TypeVar("DoneT_co", covariant=True)


class Worker(Protocol[JobT_contra, DoneT_co]):
    """What does jobs, one after the other."""

    def __call__(self, job: JobT_contra) -> DoneT_co:
        """Do one job; the outcome depends on the job alone."""

    def close(self) -> None:
        """Free what the worker holds."""


def work_through(
    make: Callable[[SetupT], Worker[JobT, DoneT]], setup: SetupT, jobs: Sequence[JobT], processes: int
) -> Iterator[DoneT]:
    """Yield what became of the jobs, each as soon as it is done, in no order.

    `make(setup)` makes the worker, once in each process; with one process all happens in this one. `make`, `setup`
    and the jobs must pickle. Raises the errors of workers as QSRError.
    """
    if not 1 <= processes <= MAX_PROCESSES:
        raise ValueRangeError("the number of processes", processes, f"1 to {MAX_PROCESSES}")
    processes = min(processes, len(jobs))
    if processes <= 1:
        return _alone(make, setup, jobs)
    return _together(make, setup, jobs, processes)


def _alone(
    make: Callable[[SetupT], Worker[JobT, DoneT]], setup: SetupT, jobs: Sequence[JobT]
) -> Iterator[DoneT]:
    if not jobs:
        return
    worker = make(setup)
    try:
        for job in jobs:
            yield worker(job)
    finally:
        worker.close()


def _together(
    make: Callable[[SetupT], Worker[JobT, DoneT]], setup: SetupT, jobs: Sequence[JobT], processes: int
) -> Iterator[DoneT]:
    waiting = iter(jobs)
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(processes, context, _start, (make, setup))
    try:
        with _interrupts_kept_from_children():
            running = {pool.submit(_do, job) for job in islice(waiting, processes * JOBS_IN_HAND)}
        while running:
            done, running = wait(running, return_when=FIRST_COMPLETED)
            running |= {pool.submit(_do, job) for job in islice(waiting, len(done))}
            for future in done:
                yield cast(DoneT, _unpacked(future))
    except BrokenProcessPool:
        raise QSRError("a process ended before its time; try again with fewer --processes") from None
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _unpacked(future: Future[_Done | _Failed]) -> object:
    outcome = future.result()
    if isinstance(outcome, _Failed):
        raise QSRError(outcome.message)
    return outcome.value


@contextmanager
def _interrupts_kept_from_children() -> Iterator[None]:
    """Hold Ctrl-C back while processes start: they inherit the mask, so that only this process hears of it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@dataclass(frozen=True, slots=True)
class _Done:
    value: object


@dataclass(frozen=True, slots=True)
class _Failed:
    message: str


class _Seat:
    """The worker of this process, or why it could not be made."""

    worker: Worker[Any, object] | None = None
    problem: str = "the worker was not made"


def _start(make: Callable[[SetupT], Worker[JobT, DoneT]], setup: SetupT) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    use_threads(1)
    try:
        _Seat.worker = make(setup)
    except QSRError as error:
        _Seat.problem = str(error)


def _do(job: object) -> _Done | _Failed:
    if _Seat.worker is None:
        return _Failed(_Seat.problem)
    try:
        return _Done(_Seat.worker(job))
    except QSRError as error:
        return _Failed(str(error))
