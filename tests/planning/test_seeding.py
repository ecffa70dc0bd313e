import itertools

import pytest

from qsrlang.errors import ValueRangeError
from qsrlang.planning.seeding import TrialSeeds


def test_every_stream_is_its_own():
    draws = set()
    for seed, trial, step in itertools.product(range(3), range(3), range(3)):
        seeds = TrialSeeds(seed, trial)
        draws |= {seeds.candidates(step).random(), seeds.pick(step).random()}
    assert len(draws) == 2 * 27


def test_a_stream_depends_on_nothing_else():
    used = TrialSeeds(4, 2)
    used.candidates(0).random(1_000)
    used.pick(3).random(7)
    assert used.candidates(3).random() == TrialSeeds(4, 2).candidates(3).random()


@pytest.mark.parametrize(("seed", "trial"), [(-1, 0), (0, -1)])
def test_negative_seeds_are_refused(seed, trial):
    with pytest.raises(ValueRangeError):
        TrialSeeds(seed, trial)
