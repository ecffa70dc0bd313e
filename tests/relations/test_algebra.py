import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.language.source import Source
from qsrlang.language.syntax import And
from qsrlang.relations.algebra import compose, converse, neighbours
from qsrlang.relations.build import build_graph
from qsrlang.relations.consistency.claims import facts_of
from qsrlang.relations.consistency.orders import contradiction
from qsrlang.relations.qualify import DIRECTIONS, TPCC, UNDEFINED, direction_of, qualify

AXES = {"behind-of": 0, "left-of": 1, "in-front-of": 2, "right-of": 3}
FIGURE_2 = (
    "in-front-of(Keyboard, Monitor) ∧ left-of(Laptop, Keyboard) ∧ right-of(Cup, Keyboard) ∧ "
    "behind-of(Bottle, Cup) ∧ close-to(Bottle, Cup)"
)


def relation_of(offset):
    """The quarter in which an offset lies, away from the diagonals."""
    return DIRECTIONS[round(math.atan2(offset[1], offset[0]) / (math.pi / 2)) % 4]


def conflict(atoms, relations):
    """The atoms of a shortest contradiction."""
    return tuple(fact.atom for fact in contradiction(facts_of(atoms, relations)))


def relations():
    return build_graph(Source("<text>", "")).symbols.relations


def atoms_of(*texts):
    formula = qsr.parse(f"observe {' ∧ '.join(texts)}.").document.statements[0].formula
    return formula.parts if isinstance(formula, And) else (formula,)


offsets = st.tuples(st.integers(-9, 9), st.integers(-9, 9)).filter(lambda o: abs(o[0]) != abs(o[1]))


@given(offsets, offsets)
def test_converse_and_composition_hold_of_every_three_points(ab, bc):
    assert relation_of((-ab[0], -ab[1])) == converse(relation_of(ab))
    ac = (ab[0] + bc[0], ab[1] + bc[1])
    if abs(ac[0]) != abs(ac[1]):
        assert relation_of(ac) in compose(relation_of(ab), relation_of(bc))


def test_composition_is_exactly_what_points_can_do():
    points = [o for o in product(range(-4, 5), repeat=2) if abs(o[0]) != abs(o[1])]
    seen = {(first, second): set() for first in AXES for second in AXES}
    for ab, bc in product(points, points):
        ac = (ab[0] + bc[0], ab[1] + bc[1])
        if abs(ac[0]) != abs(ac[1]):
            seen[relation_of(ab), relation_of(bc)].add(relation_of(ac))
    for (first, second), possible in seen.items():
        assert compose(first, second) == possible


def test_neighbours_lie_on_either_side():
    assert neighbours("left-of") == {"behind-of", "in-front-of"}
    for name, other in product(AXES, AXES):
        assert (other in neighbours(name)) == ((AXES[name] - AXES[other]) % 4 in (1, 3))
    with pytest.raises(qsr.UnknownNameError, match="left-of"):
        converse("left_of")


def test_the_scene_of_figure_2_is_consistent_and_one_more_atom_gives_a_conflict_of_four():
    assert conflict(atoms_of(FIGURE_2), relations()) == ()
    found = conflict(atoms_of(FIGURE_2, "left-of(Bottle, Laptop)"), relations())
    assert {atom.span.text for atom in found} == {
        "left-of(Laptop, Keyboard)",
        "right-of(Cup, Keyboard)",
        "behind-of(Bottle, Cup)",
        "left-of(Bottle, Laptop)",
    }


def test_a_contradicting_scene_is_a_warning_with_every_place():
    text = f"scene(Monitor, Keyboard, Laptop, Cup, Bottle) ⇔\n  {FIGURE_2} ∧\n  left-of(Bottle, Laptop)."
    (finding,) = [f for f in qsr.parse_knowledge(text).diagnostics if f.code == "Q515"]
    places = [finding.span, *(label.span for label in finding.labels)]
    assert [place.text.split("(")[0] for place in places] == ["left-of", "right-of", "behind-of", "left-of"]
    assert places[-1].line == 3


def test_relations_that_exclude_each_other_on_one_pair_are_a_conflict_of_two():
    found = conflict(atoms_of("close-to(A, B)", "left-of(A, C)", "distant-from(A, B)"), relations())
    assert [atom.relation.text for atom in found] == ["close-to", "distant-from"]
    assert conflict(atoms_of("close-to(A, B)", "distant-from(B, A)"), relations()) == ()


def test_frames_are_kept_apart():
    assert conflict(atoms_of("left-of(A, B)", "left-of(B, A)"), relations())
    assert not conflict(atoms_of("left-of(A, B)", "left-of(B, A) wrt absolute"), relations())
    assert not conflict(atoms_of("left-of(A, B) wrt intrinsic", "left-of(B, A) wrt intrinsic"), relations())


def test_a_disjunction_with_a_consistent_part_is_no_contradiction():
    text = "dynamic A, B. observe (left-of(A, B) ∧ right-of(A, B)) ∨ behind-of(A, B)."
    assert "Q515" not in [f.code for f in qsr.parse_knowledge(text).diagnostics]


pairs = st.tuples(st.sampled_from(list(AXES)), st.sampled_from("ABCDE"), st.sampled_from("ABCDE"))
scenes = st.lists(pairs.filter(lambda one: one[1] != one[2]), min_size=1, max_size=8)


def feasible(atoms):
    """A slow oracle: whether both orders of every atom can be met, by relaxing all distances to their longest paths."""
    names = sorted({argument.text for atom in atoms for argument in atom.arguments})
    signs = {"behind-of": (1, 1), "left-of": (1, -1), "in-front-of": (-1, -1), "right-of": (-1, 1)}
    for axis in (0, 1):
        height = dict.fromkeys(names, 0)
        for _ in names:
            for atom in atoms:
                referent, relatum = (argument.text for argument in atom.arguments)
                low, high = (
                    (relatum, referent) if signs[atom.relation.text][axis] > 0 else (referent, relatum)
                )
                height[high] = max(height[high], height[low] + 1)
        if max(height.values()) >= len(names):
            return False
    return True


@given(scenes)
def test_a_conflict_is_found_exactly_where_no_points_exist_and_it_is_minimal(scene):
    atoms = atoms_of(*(f"{name}({a}, {b})" for name, a, b in scene))
    found = conflict(atoms, relations())
    assert bool(found) != feasible(atoms)
    assert not found or not feasible(found)
    for one in found:
        assert feasible([atom for atom in found if atom is not one])


def slow_tpcc(origin, relatum, referent):
    """The definition, by angles."""
    if tuple(origin) == tuple(relatum):
        return "tri" if tuple(relatum) == tuple(referent) else "dou"
    if tuple(relatum) == tuple(referent):
        return "sam"
    d, v = np.subtract(relatum, origin), np.subtract(referent, relatum)
    angle = math.degrees(math.atan2(v[1], v[0]) - math.atan2(d[1], d[0])) % 360.0
    straight = {0: "sb", 90: "sl", 180: "sf", 270: "sr", 360: "sb"}
    near = min(straight, key=lambda one: abs(one - angle))
    if abs(near - angle) < 1e-7:
        name = straight[near]
    else:
        name = ("lb", "bl", "fl", "lf", "rf", "fr", "br", "rb")[int(angle // 45)]
    return ("c" if v @ v < d @ d else "d") + name


grid = st.tuples(st.integers(-6, 6), st.integers(-6, 6))


@given(grid, grid, grid)
def test_tpcc_agrees_with_its_definition(origin, relatum, referent):
    found = TPCC[int(qualify(np.array(origin), np.array(relatum), np.array(referent)))]
    expected = slow_tpcc(origin, relatum, referent)
    d, v = np.subtract(relatum, origin), np.subtract(referent, relatum)
    on_diagonal = abs(d @ v) == abs(d[0] * v[1] - d[1] * v[0]) != 0
    if on_diagonal:
        assert direction_of(TPCC.index(found)) in (0, 2)
    else:
        assert found == expected


def test_every_relation_of_tpcc_occurs_and_the_sectors_are_those_of_moratz():
    rng = np.random.default_rng(1)
    points = rng.integers(-4, 5, (3, 20_000, 2)).astype(float)
    assert set(np.unique(qualify(*points))) == set(range(len(TPCC)))
    quarters = {name: DIRECTIONS[direction_of(code)] for code, name in enumerate(TPCC[:12])}
    assert {name[1:] for name, of in quarters.items() if of == "behind-of"} == {"lb", "rb", "sb"}
    assert {name[1:] for name, of in quarters.items() if of == "left-of"} == {"bl", "fl", "sl"}
    assert {name[1:] for name, of in quarters.items() if of == "in-front-of"} == {"lf", "rf", "sf"}
    assert {name[1:] for name, of in quarters.items() if of == "right-of"} == {"fr", "br", "sr"}


@given(st.floats(0.01, 50.0), st.floats(-math.pi, math.pi), st.floats(0.01, 50.0), st.floats(-9.0, 9.0))
def test_points_exactly_behind_are_straight_behind_in_any_direction(base, heading, beyond, shift):
    origin = np.array([shift, -shift])
    ahead = np.array([math.cos(heading), math.sin(heading)])
    relatum = origin + base * ahead
    names = [TPCC[qualify(origin, relatum, relatum + step * ahead)] for step in (beyond, -beyond)]
    assert [name[1:] for name in names] == ["sb", "sf"]


@given(st.lists(st.floats(-5.0, 5.0), min_size=6, max_size=6), st.floats(-4.0, 4.0), st.floats(0.1, 3.0))
def test_tpcc_is_blind_to_rigid_motion_and_scale(numbers, angle, scale):
    points = np.array(numbers).reshape(3, 2)
    turn = scale * np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    d, v = points[1] - points[0], points[2] - points[1]
    lengths = np.hypot(*d), np.hypot(*v)
    bearing = math.degrees(math.atan2(d[0] * v[1] - d[1] * v[0], d @ v))
    clear = (
        min(lengths) > 1e-3
        and abs(lengths[0] - lengths[1]) > 1e-6
        and abs(bearing / 45 - round(bearing / 45)) > 1e-6
    )
    if clear:
        assert qualify(*points) == qualify(*(points @ turn.T + 1.0))


def test_odd_triples():
    nan = np.array([np.nan, 0.0])
    assert qualify(nan, np.zeros(2), np.ones(2)) == UNDEFINED
    assert direction_of(np.array([UNDEFINED, TPCC.index("sam")])).tolist() == [-1, -1]
    assert qualify(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 2))).shape == (0,)
    with pytest.raises(qsr.ValueRangeError, match="shape"):
        qualify(np.zeros(3), np.zeros(3), np.zeros(3))
    with pytest.raises(qsr.ValueRangeError, match="shape"):
        qualify(np.zeros((2, 2)), np.zeros((3, 2)), np.zeros(2))


def test_a_rounding_error_behind_the_relatum_is_straight_behind():
    """Equation 1 wrapped in floating point: -1e-16 + 2 pi rounds to 2 pi, which is no sector of a table of sectors."""
    origin, relatum = np.array([0.0, 0.0]), np.array([1.0, 0.0])
    for side in (-1e-16, 0.0, 1e-16, -1e-12, 1e-12):
        assert TPCC[qualify(origin, relatum, np.array([1.5, side]))] == "csb"
        assert TPCC[qualify(origin, relatum, np.array([3.5, side]))] == "dsb"
        assert 0.0 <= qsr.relative_angle(origin, relatum, np.array([1.5, side])) < 2.0 * math.pi
    beside = [TPCC[qualify(origin, relatum, np.array([1.5, side]))] for side in (1e-6, -1e-6)]
    assert beside == ["clb", "crb"]


@given(grid, grid)
def test_degenerate_triples_have_relations_of_their_own(one, other):
    a, b = np.array(one, dtype=float), np.array(other, dtype=float)
    assert TPCC[qualify(a, a, a)] == "tri"
    if one != other:
        assert TPCC[qualify(a, b, b)] == "sam"
        assert TPCC[qualify(a, a, b)] == "dou"
        assert TPCC[qualify(a, b, a)] == "dsf"
    assert direction_of(np.array([TPCC.index(name) for name in ("sam", "dou", "tri")])).tolist() == [-1] * 3
