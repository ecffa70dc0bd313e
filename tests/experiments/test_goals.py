"""Goals of arms: what is known and seen becomes a belief, and arms with a belief run like any other."""

from pathlib import Path

import numpy as np
import pytest

from qsrlang.experiments.comparing import compare
from qsrlang.experiments.goals import Reminder, extent_of, weights_of
from qsrlang.experiments.presets import find_preset, read_planner
from qsrlang.experiments.scenarios import load_scenario
from qsrlang.experiments.stories import open_search
from qsrlang.mixtures.loading import load
from qsrlang.planning.noise import Noise
from qsrlang.planning.ranking import DOUBT
from qsrlang.planning.world import Detection

PRESET = read_planner(find_preset("planners", "lookahead", Path()))
KEYBOARD = Detection("keyboard-1", "Keyboard", (4.6, 11.3, 0.76))
PLACES = np.array([[x, y] for x in np.arange(0.2, 8.0, 0.1) for y in np.arange(7.6, 12.0, 0.1)])


@pytest.fixture
def looking_ahead(cell):
    with cell.open("a", encoding="utf-8") as file:
        for arm in ("index", "rollout"):
            file.write(f'[arms.{arm}]\nplanner = "{arm}"\npreset = "lookahead"\n')
    return cell


def test_a_keyboard_on_the_way_moves_the_cups_to_its_right_at_once():
    reminder = Reminder("kitchen/cups", (), "Cup", PRESET, PLACES)
    before = weights_of(PRESET, load("kitchen/cups").where("Cup"), PLACES)
    after = reminder.weights([KEYBOARD])
    right, elsewhere = (np.hypot(*(PLACES - place).T) < 0.3 for place in ([5.06, 11.31], [2.05, 11.4]))
    assert after[right].sum() > 1.3 * before[right].sum()
    assert 0.5 * before[elsewhere].sum() < after[elsewhere].sum() < before[elsewhere].sum(), (
        "two desks are left"
    )
    assert after.sum() == pytest.approx(before.sum())


def test_what_was_known_before_or_is_no_relatum_changes_nothing():
    reminder = Reminder("kitchen/cups", (), "Cup", PRESET, PLACES)
    assert reminder.weights([Detection("monitor-1", "Monitor", (1.6, 11.73, 0.95))]) is None
    assert reminder.weights([Detection("duck-1", "Duck", (1.0, 1.0, 1.0))]) is None


def test_sizes_that_are_known_say_where_the_centre_of_a_target_is():
    known = load("kitchen/cups")
    extent, rise = extent_of(known, "Cup", PRESET)
    assert (extent.radius, extent.half_height, rise) == pytest.approx((0.045, 0.05, 0.05))
    plain = read_planner(find_preset("planners", "tabletops", Path()))
    assert extent_of(known, "Cup", plain)[0].size == 0.0


def test_arms_that_look_ahead_find_the_cup_and_say_why(looking_ahead):
    story = open_search(looking_ahead, planner="rollout", variant="one").search(seed=2)
    assert story.found
    step = story.steps[0]
    assert step.unit == "seconds saved"
    assert step.terms.expected[step.chosen] == step.terms.expected.min()


def test_processes_change_nothing_and_noise_is_shared(looking_ahead):
    scenario = load_scenario(looking_ahead, noise=Noise(0.6, 0.1))
    plain = load_scenario(looking_ahead)
    assert scenario.fingerprint != plain.fingerprint
    alone = compare(scenario, ["qsr", "rollout"], trials=4, seed=3, variant="one")
    spread = compare(scenario, ["qsr", "rollout"], trials=4, seed=3, variant="one", processes=2)
    assert alone.results == spread.results
    exact = compare(plain, ["rollout"], trials=4, seed=3, variant="one")
    assert sum(t.seconds for t in exact.of("rollout")) <= sum(t.seconds for t in alone.of("rollout"))


def test_a_false_alarm_is_no_find(looking_ahead):
    scenario = load_scenario(looking_ahead, noise=Noise(0.01, 0.95))
    trials = compare(scenario, ["qsr"], trials=6, seed=1, variant="one").results
    fooled = [trial for trial in trials if trial.detected == "false alarm"]
    assert fooled
    assert all(not trial.found and trial.seconds == 120.0 for trial in fooled)


@pytest.mark.parametrize("name", ["lookahead", "lookahead-drawn", "lookahead-wary"])
def test_presets_doubt_as_much_as_views_that_are_asked_for(name):
    assert read_planner(find_preset("planners", name, Path())).belief.doubt() == DOUBT
