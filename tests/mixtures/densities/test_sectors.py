"""Directions in which relations hold: quarters, central parts, shares of cells, and truth tables of both."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.geometry.angles import TURN, wrap
from qsrlang.mixtures.densities.sectors import Arcs, arcs_of, covered

HEAD = "static M {{ front: yes }}. dynamic A. landmark m : M at (0 m, 0 m) facing 180 deg. {}"
RELATIONS = qsr.parse_knowledge(HEAD.format("")).graph.relations
arcs = st.tuples(st.floats(-7.0, 7.0), st.floats(0.0, TURN - 0.2))
cells = st.floats(0.001, 0.1)


def relation(angle):
    return qsr.parse_knowledge(f"relation r(a, b) {{ angle: {angle} }}.").graph.relations


@pytest.mark.parametrize(
    ("name", "middle"), [("behind-of", 0.0), ("left-of", 90.0), ("in-front-of", 180.0), ("right-of", 270.0)]
)
def test_the_four_directions_are_quarters(name, middle):
    ((start, width),) = arcs_of(RELATIONS[name], RELATIONS).arcs
    assert width == pytest.approx(0.5 * math.pi, abs=1e-9)
    assert float(wrap(np.array(start + 0.5 * width - math.radians(middle)))) == pytest.approx(0.0, abs=1e-9)


def test_a_relation_that_excludes_none_holds_in_its_central_part():
    normal = relation("normal(30 deg, 10 deg)")
    ((start, width),) = arcs_of(normal["r"], normal).arcs
    assert math.degrees(width) == pytest.approx(2 * 19.59964, abs=1e-4)
    assert math.degrees(start) == pytest.approx(30.0 - 19.59964, abs=1e-4)
    uniform = relation("uniform(20 deg, 80 deg)")
    ((start, width),) = arcs_of(uniform["r"], uniform).arcs
    assert math.degrees(start), math.degrees(width) == pytest.approx((20.0, 60.0), abs=1e-6)


def test_a_mix_has_an_arc_for_each_part_and_no_angle_is_all_around():
    mix = relation("mix(normal(90 deg, 10 deg), normal(-90 deg, 10 deg))")
    found = arcs_of(mix["r"], mix).arcs
    assert len(found) == 2
    middles = sorted(math.degrees(start + 0.5 * width) % 360.0 for start, width in found)
    assert middles == pytest.approx([90.0, 270.0], abs=1e-6)
    assert arcs_of(RELATIONS["close-to"], RELATIONS).arcs == ((0.0, TURN),)


@given(arcs, st.floats(-7.0, 7.0), cells)
@settings(max_examples=100)
def test_the_covered_share_of_a_cell_is_the_mean_of_what_it_contains(arc, angle, cell):
    one = Arcs((arc,))
    fine = angle + cell * ((np.arange(4000) + 0.5) / 4000.0 - 0.5)
    found = covered(one.parts(np.array([angle]), cell), cell, (1,))
    assert found[0] == pytest.approx(one.contain(fine).mean(), abs=2e-3)


def test_no_arcs_and_a_full_turn():
    angles = np.linspace(-3.0, 3.0, 7)
    assert not Arcs(()).contain(angles).any()
    assert (covered(Arcs(()).parts(angles, 0.1), 0.1, (7,)) == 0.0).all()
    assert Arcs(((1.0, TURN),)).contain(angles).all()
    assert (covered(Arcs(((1.0, TURN),)).parts(angles, 0.1), 0.1, (7,)) == 1.0).all()


SIDES = ("behind-of", "left-of", "in-front-of", "right-of")


@given(st.floats(-180.0, 180.0), st.floats(3.0, 60.0), st.sampled_from(["relative", "intrinsic", "absolute"]))
@settings(max_examples=40)
def test_exclusive_sides_of_one_pair_are_never_both_and_always_one(mean, deviation, frame):
    """Their common edge may cut a cell of the quadrature."""
    text = f"relation r(a, b) {{ angle: normal({mean:.3f} deg, {deviation:.3f} deg) }}. observe r(A, M) wrt {frame}."
    known = qsr.parse_knowledge(HEAD.format(text))
    sides = [f"{one}(A, M)" for one in SIDES]
    assert known.prob(" ∨ ".join(sides)).value == pytest.approx(1.0, abs=1e-12)
    for one, other in pairwise(sides):
        both = known.prob(f"{one} ∧ {other}")
        assert both.method == "exact"
        assert both.value == pytest.approx(0.0, abs=1e-12)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=15)
def test_truth_tables_are_those_of_draws(seed):
    """Within 5 standard errors of 40,000 draws, and 1e-3 of the quadrature."""
    rng = np.random.default_rng(seed)
    mean, deviation = rng.uniform(-180.0, 180.0), rng.uniform(10.0, 40.0)
    text = f"relation r(a, b) {{ angle: normal({mean:.3f} deg, {deviation:.3f} deg) }}. observe r(A, M)."
    known = qsr.parse_knowledge(HEAD.format(text))
    x, y = known.sample("A", 40_000, rng=rng).positions[:, 0].T
    angle, way = np.degrees(np.arctan2(y, x)), np.hypot(x, y)
    left, far = np.abs(angle - 90.0) <= 45.0, way >= 0.5 * known.graph.reach
    for formula, held in (
        ("left-of(A, M) ∧ distant-from(A, M)", left & far),
        ("left-of(A, M) ∨ distant-from(A, M)", left | far),
        ("¬left-of(A, M) ∧ ¬distant-from(A, M)", ~left & ~far),
    ):
        found = known.prob(formula)
        assert found.method == "exact"
        assert abs(found.value - held.mean()) < 5.0 * 0.5 / math.sqrt(40_000) + 1e-3
