import os

import pytest

from qsrlang.errors import QSRError, ValueRangeError
from qsrlang.experiments.cluster import work_through


class Multiplier:
    def __init__(self, factor):
        if factor == 0:
            raise ValueRangeError("the factor", 0, "something else")
        self.factor, self.made = factor, 1
        self.closed = False

    def __call__(self, job):
        if job == 13:
            raise ValueRangeError("the job", 13, "luck")
        if job == 66:
            os._exit(1)
        return job, self.factor * job, os.getpid()

    def close(self):
        self.closed = True


@pytest.mark.parametrize("processes", [1, 2])
def test_every_job_is_done_once(processes):
    done = sorted(work_through(Multiplier, 3, range(12), processes))
    assert [(job, value) for job, value, _ in done] == [(job, 3 * job) for job in range(12)]
    assert (os.getpid() in {pid for _, _, pid in done}) == (processes == 1)


@pytest.mark.parametrize("processes", [1, 2])
def test_errors_of_workers_arrive_in_one_line(processes):
    with pytest.raises(QSRError, match="the job is 13; expected luck"):
        list(work_through(Multiplier, 3, [13, 14, 15], processes))
    with pytest.raises(QSRError, match="the factor is 0"):
        list(work_through(Multiplier, 0, [1, 2, 3], processes))


def test_a_process_that_dies_is_told():
    with pytest.raises(QSRError, match="ended before its time"):
        list(work_through(Multiplier, 3, [66, 66, 66], 2))


def test_no_jobs_make_no_worker():
    assert list(work_through(Multiplier, 0, [], 2)) == []


@pytest.mark.parametrize("processes", [0, -1, 10_000])
def test_senseless_numbers_of_processes_are_refused(processes):
    with pytest.raises(ValueRangeError):
        list(work_through(Multiplier, 3, [1, 2], processes))
