from dataclasses import replace

import numpy as np
import pytest
from learning.logs import EMPTY, desks, row

from qsrlang.geometry.angles import rotation
from qsrlang.learning.cells import cells_of
from qsrlang.learning.experience import experience_of
from qsrlang.learning.experts import EXPERTS, HeldOut, held_out
from qsrlang.learning.fits import fits_of, place_fits, reduced, written_mixture
from qsrlang.learning.fusion import learn_fusion
from qsrlang.learning.grids import sights_of
from qsrlang.learning.learner import MIN_PLACES, learn
from qsrlang.learning.observations import Observations
from qsrlang.learning.placements import placements_of
from qsrlang.learning.rectangles import rectangle_mass, upright_mass
from qsrlang.learning.rhythm import DIRECTIONS, direction_numbers, rhythm_of
from qsrlang.learning.specific import PlaceLearner
from qsrlang.learning.stacking import NOTHING, core_weights, stacked
from qsrlang.learning.sums import sums_of
from qsrlang.learning.supports import dirichlet_concentration, support_shares
from qsrlang.mixtures.gaussian import GaussianMixture

MOUSE, MUG = ("Mouse", "Keyboard"), ("Mug", "Keyboard")
SEEN = desks(8, 6, np.random.default_rng(11))
LEARNED = learn(sums_of(SEEN))


def grid(low, high, count=80):
    x, y = (low[k] + (np.arange(count) + 0.5) / count * (high[k] - low[k]) for k in (0, 1))
    cell = (high - low).prod() / count**2
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2), cell


def test_a_mass_on_a_rectangle_is_what_draws_say():
    mean, low, high = np.array([0.2, -0.1]), np.array([-0.3, -0.5]), np.array([0.6, 0.4])
    covariance = np.array([[0.09, 0.05], [0.05, 0.16]])
    points, cell = grid(low, high)
    sum_of_cells = GaussianMixture(np.ones(1), mean[None], covariance[None]).pdf(points).sum() * cell
    assert rectangle_mass(mean, covariance, low, high) == pytest.approx(sum_of_cells, abs=3e-4)
    straight = np.diag([0.09, 0.16])
    assert upright_mass(mean, np.sqrt(np.diag(straight)), low, high) == pytest.approx(
        rectangle_mass(mean, straight, low, high)
    )


@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_a_learned_density_sums_to_one_on_the_support(turn):
    density = LEARNED.pairs[MOUSE].density
    low, high = np.array([-0.3, -0.8]), np.array([0.5, 0.8])
    points, cell = grid(low, high)
    count = len(points)
    stance = (np.tile(low, (count, 1)), np.tile(high, (count, 1)), np.full(count, turn))
    assert density.pdf(points @ rotation(turn), *stance).sum() * cell == pytest.approx(1.0, abs=2e-2)


def test_what_holds_everywhere_is_learned_and_what_does_not_is_left_open():
    mouse, mug = LEARNED.pairs[MOUSE], LEARNED.pairs[MUG]
    assert mouse.stack.gain > 2.0
    assert mug.stack.gain < 0.1
    mean, _ = mouse.density.mixture.moments()
    np.testing.assert_allclose(mean, (0.0, -0.3), atol=0.06)


def test_of_a_pair_seen_at_few_places_nothing_is_known_but_what_was_seen_there():
    few = learn(sums_of(desks(MIN_PLACES - 1, 6, np.random.default_rng(0))))
    assert few.pairs == {} and len(few.core) == 0
    mouse, mug = few.local[MOUSE], few.local[MUG]
    assert mouse.stack.gain > 1.0 and mug.stack.gain < 0.2
    np.testing.assert_allclose(mouse.density.mixture.moments()[0], (0.0, -0.3), atol=0.06)


def test_held_out_densities_do_not_know_the_place():
    """What is seen at a place moves nothing of what its own sightings are told to be: others teach, it does not."""
    cells = cells_of(sums_of(SEEN).of_pair(*MOUSE))
    place = cells.places[0]
    own = cells.places == place
    before = held_out(cells)
    assert before.densities.shape == (len(cells), len(EXPERTS))
    doubled = replace(cells, spreads=np.where(own[:, None, None], 9.0 * cells.spreads, cells.spreads))
    after = held_out(doubled)
    np.testing.assert_allclose(after.densities[own], before.densities[own])
    assert not np.allclose(after.densities[~own], before.densities[~own])


def test_weights_go_to_the_expert_that_is_right_and_to_the_first_where_none_is():
    rng = np.random.default_rng(5)
    places = np.repeat(np.arange(6), 10)
    right = np.column_stack([np.full(60, 1.0), np.full(60, 3.0), rng.uniform(0.0, 0.5, 60)])
    wrong = np.column_stack([np.full(60, 1.0), np.where(places % 2, 1.5, 0.01), np.full(60, 0.1)])
    weights = np.full(60, 0.1)
    core = core_weights([HeldOut(right, weights, places), HeldOut(wrong, weights, places)])
    assert core.sum() == pytest.approx(1.0)
    good = stacked(HeldOut(right, weights, places), core)
    assert good.weights[1] > 0.9 and good.gain == pytest.approx(np.log(3.0), abs=0.1)
    none = stacked(
        HeldOut(np.column_stack([np.ones(60), np.full(60, 0.2)]), weights, places), np.array([0.5, 0.5])
    )
    assert none.concentration == NOTHING and none.gain == 0.0
    np.testing.assert_allclose(none.weights, [1.0, 0.0])


def test_reduction_keeps_the_moments():
    rng = np.random.default_rng(2)
    shapes = rng.normal(size=(12, 2, 2))
    mixture = GaussianMixture(
        rng.dirichlet(np.ones(12)),
        rng.normal(size=(12, 2)),
        shapes @ shapes.transpose(0, 2, 1) + 0.1 * np.eye(2),
    )
    for count in (5, 1):
        few = reduced(mixture, count)
        assert len(few) == count
        for one, other in zip(few.moments(), mixture.moments(), strict=True):
            np.testing.assert_allclose(one, other, atol=1e-12)


def test_fits_say_what_the_mixture_says():
    mixture = written_mixture(LEARNED.pairs[MOUSE].density)
    fits = fits_of(mixture, 48.0)
    assert sum(fit.count for fit in fits) == pytest.approx(48.0, abs=0.3)
    assert fits[0].relation == "right-of"
    largest = mixture.means[mixture.weights.argmax()]
    np.testing.assert_allclose(fits[0].mean, largest)
    own = LEARNED.pairs[MOUSE].cells
    here = place_fits(own.take(own.places == own.places[0]), mixture)
    assert sum(fit.count for fit in here) == pytest.approx(6.6, abs=0.01)


def test_directions_are_those_of_the_calculus():
    points = np.array([[1.0, 0.1], [0.1, 1.0], [-1.0, 0.1], [0.1, -1.0]])
    assert [DIRECTIONS[number] for number in direction_numbers(points)] == [
        "behind-of", "left-of", "in-front-of", "right-of",
    ]  # fmt: skip


def mug_log(shares, rng, places=5, days=12):
    rows = []
    for place in range(places):
        for day in range(days):
            for hour in range(0, 24, 3):
                at = {
                    "place": f"room-{place}",
                    "scene": f"{place}-{day}-{hour}",
                    "time": 86400.0 * day + 3600.0 * hour,
                }
                side = -0.4 if rng.random() < shares[hour] else 0.4
                rows += [row("Keyboard", 0.0, 0.0, support="", **at), row("Mug", 0.0, side, support="", **at)]
    return Observations.of(rows)


def test_a_daily_rhythm_is_recovered_and_none_is_made_up():
    """Fixed seed; among 60 other seeds of a log without a rhythm, none was seen in any."""
    hours = np.arange(24)
    truth = 0.5 + 0.4 * np.sin(2.0 * np.pi * hours / 24.0)
    found = rhythm_of(cells_of(sums_of(mug_log(truth, np.random.default_rng(1))).of_pair(*MUG)))
    assert found.order > 0
    right = found.shares[:, DIRECTIONS.index("right-of")]
    assert np.sqrt(np.mean((right - truth) ** 2)) < 0.1
    assert found.ratios(6.0)[DIRECTIONS.index("right-of")] > 1.5
    flat = rhythm_of(cells_of(sums_of(mug_log(np.full(24, 0.5), np.random.default_rng(3))).of_pair(*MUG)))
    assert flat.order == 0
    np.testing.assert_allclose(flat.shares, flat.shares[:1].repeat(24, axis=0))


def test_a_place_of_its_own_is_learned_from_a_few_scans_and_not_at_all_from_none():
    general = desks(8, 6, np.random.default_rng(3))
    learner = PlaceLearner.of(sums_of(general), [MOUSE, MUG])
    left = desks(1, 6, np.random.default_rng(4), left=1.0)
    nothing = sums_of(left).at(["nowhere"])
    assert learner.density(MOUSE, nothing) is learner.general.pairs[MOUSE].density
    own = learner.density(MOUSE, sums_of(left))
    assert own.mixture.moments()[0][1] > 0.1
    placed = placements_of(left)
    rows = np.flatnonzero(np.array(left.text("object"))[placed.referents] == "Mouse")
    rows = [r for r in rows if left.text("object")[placed.relata[r]] == "Keyboard"]
    stance = placed.points[rows], placed.low[rows], placed.high[rows], placed.turns[rows]
    there, anywhere = own.pdf(*stance), learner.general.pairs[MOUSE].density.pdf(*stance)
    assert np.log(there / anywhere).mean() > 1.0


def test_neighbours_are_fused_and_sum_to_one():
    fusion = learn_fusion(SEEN, LEARNED, ["Mouse"])
    assert fusion.exponents[MOUSE] > 0.3
    sight = sights_of(SEEN, "Mouse")[3]
    logs = fusion.log_density(sight, 0.02)
    cells = len(logs) - 1
    assert np.exp(logs[:-1]).sum() * sight.area / cells == pytest.approx(1.0)
    assert logs[-1] > np.log(4.0 / sight.area)


def test_shares_of_supports_are_dirichlet_means():
    rows = []
    for number in range(40):
        at = {"place": f"room-{number}", "scene": str(number)}
        for support in ("Table", "Cabinet"):
            rows.append(EMPTY | at | {"object": support, "kind": support})
        for kind, share in (("Plate", 0.25), ("Cup", 0.75), ("Fork", 0.25)):
            on = "Table" if number < share * 40 else "Cabinet"
            rows.append(EMPTY | at | {"object": kind, "kind": kind, "support": on})
    plate = next(
        one for one in support_shares(experience_of(Observations.of(rows)).objects) if one.kind == "Plate"
    )
    assert plate.supports == ("Cabinet", "Table") and plate.relations == ("in", "on")
    overall = np.array([7.0, 5.0]) / 12.0
    expected = (plate.concentration * overall + np.array([30.0, 10.0])) / (plate.concentration + 40.0)
    np.testing.assert_allclose(plate.shares, expected)


def test_the_concentration_of_a_dirichlet_is_recovered():
    """Fixed seed; over 100 seeds the estimate was within a factor of 1.5 in 99."""
    rng = np.random.default_rng(8)
    shares = np.array([0.2, 0.3, 0.5])
    counts = np.stack([rng.multinomial(50, rng.dirichlet(6.0 * shares)) for _ in range(400)])
    assert dirichlet_concentration(counts, shares) == pytest.approx(6.0, rel=0.3)
