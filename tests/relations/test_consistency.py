"""Consistency against slow and obvious oracles: all arrangements of four objects, and scenes that points do have."""

import math
from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.language.fixing import edited
from qsrlang.language.parser import parse_formula
from qsrlang.language.source import Source
from qsrlang.language.syntax import And, Atom, Not, Or
from qsrlang.relations.algebra import conceptual_neighbours, entailed
from qsrlang.relations.build import build_graph
from qsrlang.relations.consistency.deciding import find_conflicts
from qsrlang.relations.qualify import DIRECTIONS

SIGNS = {"behind-of": (1, 1), "left-of": (1, -1), "in-front-of": (-1, -1), "right-of": (-1, 1)}
CLASSES = "dynamic A, B, C, D.\n"
FIGURE_2 = """static Monitor.
dynamic Keyboard, Laptop, Cup, Bottle.
scene(Monitor, Keyboard, Laptop, Cup, Bottle) ⇔
    in-front-of(Keyboard, Monitor) ∧
    left-of(Laptop, Keyboard) ∧
    right-of(Cup, Keyboard) ∧
    behind-of(Bottle, Cup) ∧
    close-to(Bottle, Cup).
"""


def found(text):
    built = build_graph(Source("<text>", text))
    assert not built.diagnostics.errors, str(built.diagnostics)
    return find_conflicts(built.graph)


def texts(conflict):
    return [atom.span.text for atom in conflict.atoms]


def arrangements():
    """Every way in which four objects can be ordered along u and along w."""
    orders = [dict(zip("ABCD", one, strict=True)) for one in permutations(range(4))]
    return list(product(orders, orders))


ARRANGED = arrangements()


def holds(formula, orders):
    match formula:
        case Atom(relation=relation, arguments=(referent, relatum)):
            signs = SIGNS[relation.text]
            return all(
                sign * (order[referent.text] - order[relatum.text]) > 0
                for sign, order in zip(signs, orders, strict=True)
            )
        case Not(part=part):
            return not holds(part, orders)
        case And(parts=parts):
            return all(holds(part, orders) for part in parts)
        case Or(parts=parts):
            return any(holds(part, orders) for part in parts)


def possible(formulas):
    """Whether some arrangement makes all formulas true."""
    parsed = [parse_formula(one) for one in formulas]
    return any(all(holds(one, orders) for one in parsed) for orders in ARRANGED)


atoms = st.tuples(st.sampled_from(DIRECTIONS), st.permutations("ABCD")).map(
    lambda one: f"{one[0]}({one[1][0]}, {one[1][1]})"
)
formulas = st.recursive(
    atoms,
    lambda inner: st.one_of(
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: f"({' ∨ '.join(parts)})"),
        st.lists(inner, min_size=2, max_size=2).map(lambda parts: f"({' ∧ '.join(parts)})"),
        inner.map(lambda part: f"¬{part}"),
    ),
    max_leaves=3,
)


@settings(max_examples=100, deadline=None)
@given(st.lists(formulas, min_size=1, max_size=5))
def test_requirements_are_consistent_exactly_where_some_arrangement_meets_them(required):
    answer = found(CLASSES + "\n".join(f"require {one}." for one in required))
    assert answer.is_decided
    assert answer.is_consistent == possible(required)


@settings(max_examples=100, deadline=None)
@given(st.lists(atoms, min_size=2, max_size=9, unique=True))
def test_each_atom_of_a_conflict_is_needed_for_it(required):
    answer = found(CLASSES + "\n".join(f"require {one}." for one in required))
    assert answer.is_consistent == possible(required)
    for conflict in answer.conflicts:
        stated = texts(conflict)
        assert not possible(stated)
        for number in range(len(stated)):
            assert possible(stated[:number] + stated[number + 1 :])


@settings(max_examples=100, deadline=None)
@given(st.lists(atoms, min_size=3, max_size=7, unique=True))
def test_every_relaxation_of_the_only_conflict_makes_all_consistent(required):
    text = CLASSES + "\n".join(f"require {one}." for one in required)
    answer = found(text)
    if len(answer.conflicts) == 1:
        (conflict,) = answer.conflicts
        assert conflict.relaxations
        steps = [one.steps for one in conflict.relaxations]
        assert len(set(steps)) == 1
        for one in conflict.relaxations:
            if one.edits:
                assert found(edited(text, one.edits)).is_consistent
        if steps[0] != 1:
            assert not any(possible(one) for one in one_step_away(required, texts(conflict)))


def one_step_away(required, stated):
    """Every way to turn one of the atoms in conflict by a quarter."""
    for number, atom in enumerate(required):
        name, rest = atom.split("(")
        if atom in stated:
            at = DIRECTIONS.index(name)
            for near in (DIRECTIONS[at - 1], DIRECTIONS[(at + 1) % 4]):
                yield [*required[:number], f"{near}({rest}", *required[number + 1 :]]


beliefs = st.tuples(st.permutations("ABCD"), st.lists(st.sampled_from(DIRECTIONS), min_size=1, max_size=3))


@settings(max_examples=100, deadline=None)
@given(st.lists(beliefs, max_size=4, unique_by=lambda one: tuple(one[0][:2])), st.lists(atoms, max_size=3))
def test_alternatives_of_beliefs_are_told_where_no_arrangement_has_them(stated, required):
    sides = [
        [f"{name}({pair[0]}, {pair[1]})" for name in dict.fromkeys(names)] for *pair, names in _split(stated)
    ]
    text = CLASSES + "".join(f"believe {' | '.join(side)}.\n" for side in sides)
    text += "".join(f"require {one}.\n" for one in required)
    answer = found(text)
    certain = [*required, *(f"({' ∨ '.join(side)})" for side in sides)]
    assert answer.is_consistent == possible(certain)
    if answer.is_consistent:
        never = {one for side in sides if len(side) > 1 for one in side if not possible([*certain, one])}
        assert {one.atoms[0].span.text for one in answer.impossible} == never


def _split(stated):
    return [(pair[0], pair[1], names) for pair, names in stated]


def test_the_scene_of_figure_2_and_one_more_statement_give_the_conflict_of_four_with_places():
    assert found(FIGURE_2).is_consistent
    answer = found(FIGURE_2 + "observe left-of(Bottle, Laptop).")
    (conflict,) = answer.conflicts
    assert texts(conflict) == [
        "left-of(Laptop, Keyboard)",
        "right-of(Cup, Keyboard)",
        "behind-of(Bottle, Cup)",
        "left-of(Bottle, Laptop)",
    ]
    assert [atom.span.line for atom in conflict.atoms] == [5, 6, 7, 9]
    assert [one.steps for one in conflict.relaxations] == [1, 1, 1]
    assert conflict.relaxations[0].edits[0].text == "behind-of"
    shown = str(answer)
    assert "<text>:9:9: left-of(Bottle, Laptop)" in shown
    assert "the least change: <text>:9:9: 'behind-of(Bottle, Laptop)' in place of 'left-of'" in shown
    plain = answer.to_json()
    assert not plain["is_consistent"]
    assert plain["conflicts"][0]["atoms"][3] == {
        "file": "<text>",
        "line": 9,
        "column": 9,
        "length": 23,
        "text": "left-of(Bottle, Laptop)",
    }


def test_what_is_elsewhere_overridden_or_soft_contradicts_nothing():
    assert found(CLASSES + "observe left-of(A, B). require 0.9 :: right-of(A, B).").is_consistent
    assert found(CLASSES + "observe left-of(A, B). believe 0.4 :: left-of(B, A) | elsewhere.").is_consistent
    overridden = "scene(A, B) ⇔ left-of(A, B).\nbelieve right-of(A, B).\nrequire right-of(A, B)."
    assert found(CLASSES + overridden).is_consistent
    assert found(CLASSES + "observe 3 × left-of(A, B). observe right-of(A, B).").is_consistent


def test_an_alternative_that_leaves_the_rest_elsewhere_is_told_as_one_that_never_holds():
    answer = found(CLASSES + "observe left-of(A, B). believe 0.4 :: left-of(B, A) | elsewhere.")
    (never,) = answer.impossible
    assert never.share == pytest.approx(0.4)
    assert "an alternative of share 0.4 is never true: left-of(B, A)" in str(answer)


def test_two_conflicts_without_a_common_atom_are_both_told():
    answer = found(CLASSES + "require left-of(A, B) ∧ left-of(B, A) ∧ left-of(C, D) ∧ behind-of(C, D).")
    assert [len(one.atoms) for one in answer.conflicts] == [2, 2]
    assert all(one.relaxations for one in answer.conflicts)


def test_close_to_is_not_symmetric_and_frames_are_kept_apart():
    assert found(CLASSES + "require close-to(A, B) ∧ distant-from(B, A).").is_consistent
    assert not found(CLASSES + "require close-to(A, B) ∧ distant-from(A, B).").is_consistent
    assert found(CLASSES + "require left-of(A, B) ∧ left-of(B, A) wrt absolute.").is_consistent


def test_a_negation_is_shown_as_such():
    (conflict,) = found(CLASSES + "require ¬close-to(A, B).\nrequire close-to(A, B).").conflicts
    assert "¬close-to(A, B)" in str(conflict)
    (only,) = conflict.relaxations
    assert (only.edits[0].text, only.edits[0].span.line) == ("distant-from", 3)


LAB = """static Monitor { front: yes }, Lamp { front: yes }.
dynamic Cup, Pen, Book.
relation near(referent, relatum) { distance: uniform(0 cm, 30 cm) }.
relation far(referent, relatum) { distance: uniform(2 m, 5 m) }.
landmark m : Monitor at (0 m, 0 m) facing -90 deg.
landmark l : Lamp at (3 m, 0 m) facing -90 deg ± (5 cm, 5 cm, 0 deg).
"""


@pytest.mark.parametrize(
    ("statements", "conflict", "poses"),
    [
        ("observe near(Cup, Monitor) ∧ near(Cup, Lamp).", 2, ("l", "m")),
        ("observe near(Cup, m). observe near(Pen, Cup). observe near(Pen, l).", 3, ("l", "m")),
        ("observe left-of(Lamp, Monitor) wrt absolute.", 1, ("l", "m")),
        ("observe left-of(Lamp, Monitor).", 1, ("l", "m")),
        ("observe far(Cup, Pen). observe near(Cup, Book). observe near(Pen, Book).", 3, ()),
        ("observe behind-of(Cup, Monitor) ∧ near(Cup, Lamp).", 2, ("l", "m")),
        ("observe on(Cup, Table) ∧ near(Cup, Lamp).", 2, ("l", "t")),
    ],
)
def test_known_poses_and_distances_decide(statements, conflict, poses):
    table = "surface Table { size: 1 m × 1 m }.\nlandmark t : Table at (0 m, 0 m) facing 0 deg.\n"
    answer = found(LAB + (table if "Table" in statements else "") + statements)
    (one,) = answer.conflicts
    assert (len(one.atoms), one.poses) == (conflict, poses)


@pytest.mark.parametrize(
    "statements",
    [
        "observe right-of(Lamp, Monitor) wrt absolute.",
        "observe right-of(Lamp, Monitor).",
        "observe near(Cup, Monitor) ∧ right-of(Cup, Monitor).",
        "observe far(Cup, Pen) ∧ near(Cup, Book).",
        "observe right-of(Cup, Monitor) ∧ near(Cup, Lamp).",
    ],
)
def test_known_poses_leave_room(statements):
    assert found(LAB + statements).is_consistent


DESK = """surface Desk { size: 2 m × 1 m }.
static Monitor { on: Desk }.
dynamic Cup { on: Desk }, Pen.
relation far(referent, relatum) { distance: uniform(1.6 m, 5 m) }.
landmark m : Monitor at (0 m, 0 m) facing -90 deg.
landmark d : Desk at (DX m, 0 m) facing -90 deg.
"""


@pytest.mark.parametrize(
    ("referent", "shift", "consistent"), [("Cup", 0, False), ("Pen", 0, True), ("Cup", 9, True)]
)
def test_what_stands_on_a_desk_with_its_landmark_does_not_leave_it(referent, shift, consistent):
    answer = found(
        DESK.replace("DX", str(shift)) + f"observe left-of({referent}, Monitor) ∧ far({referent}, Monitor)."
    )
    assert answer.is_consistent == consistent
    assert [one.poses for one in answer.conflicts] == ([] if consistent else [("d", "m")])


def test_a_conflict_of_directions_alone_does_not_rest_on_poses():
    (conflict,) = found(LAB + "require left-of(Cup, m) ∧ right-of(Cup, m) ∧ near(Cup, l).").conflicts[:1]
    assert conflict.poses == ()


@pytest.mark.parametrize("name", ["behind-of", "right-of"])
def test_a_landmark_on_the_diagonal_may_be_of_either_side(name):
    placed = LAB.replace("(3 m, 0 m)", "(2 m, 2 m)").replace(" ± (5 cm, 5 cm, 0 deg)", "")
    assert found(f"{placed}observe {name}(Lamp, Monitor) wrt absolute.").is_consistent


def test_what_the_intrinsic_frame_calls_left_is_the_landmarks_own():
    assert found(LAB + "observe left-of(Lamp, Monitor) wrt intrinsic.").is_consistent
    assert not found(LAB + "observe right-of(Lamp, Monitor) wrt intrinsic.").is_consistent


coordinates = st.floats(-3.0, 3.0, allow_nan=False).map(lambda x: round(x, 2))
spots = st.lists(st.tuples(coordinates, coordinates), min_size=5, max_size=5, unique=True)


@settings(max_examples=40, deadline=None)
@given(spots, st.integers(0, 2**32 - 1))
def test_what_is_true_of_points_is_consistent_with_and_without_landmarks(points, seed):
    names = ["m", "l", "Cup", "Pen", "Book"]
    rng = np.random.default_rng(seed)
    pairs = [tuple(rng.permutation(5)[:2].tolist()) for _ in range(8)]
    stated = [one for one in qsr.relations_between(names, points, pairs=pairs) if "wrt absolute" in one]
    for i, j in pairs:
        length = math.dist(points[i], points[j])
        stated += [f"near({names[i]}, {names[j]})"] if length < 0.3 else []
        stated += [f"far({names[i]}, {names[j]})"] if 2.0 < length < 5.0 else []
    placed = LAB.replace("(0 m, 0 m)", "({} m, {} m)".format(*points[0]))
    placed = placed.replace("(3 m, 0 m)", "({} m, {} m)".format(*points[1]))
    required = "".join(f"require {one}.\n" for one in stated)
    assert found(placed + required).is_consistent, str(found(placed + required))
    anywhere = LAB.split("landmark")[0] + "dynamic m, l.\n"
    assert found(anywhere + required).is_consistent


@settings(max_examples=40, deadline=None)
@given(spots, st.lists(st.tuples(st.sampled_from(DIRECTIONS), st.permutations(range(5))), max_size=5))
def test_a_conflict_with_poses_is_minimal_too(points, said):
    names = ["m", "l", "Cup", "Pen", "Book"]
    placed = LAB.replace("(0 m, 0 m)", "({} m, {} m)".format(*points[0]))
    placed = placed.replace("(3 m, 0 m)", "({} m, {} m)".format(*points[1]))
    required = [f"{name}({names[p[0]]}, {names[p[1]]}) wrt absolute" for name, p in said]
    required += ["near(Cup, m)", "near(Pen, l)", "far(Pen, Cup)", "far(Book, m)"]
    for conflict in found(placed + "".join(f"require {one}.\n" for one in required)).conflicts:
        stated = texts(conflict)
        assert not found(placed + "".join(f"require {one}.\n" for one in stated)).is_consistent
        for number in range(len(stated)):
            rest = stated[:number] + stated[number + 1 :]
            assert found(placed + "".join(f"require {one}.\n" for one in rest)).is_consistent


def test_hundreds_of_atoms_and_one_wrong_one():
    rng = np.random.default_rng(4)
    points = rng.uniform(-5.0, 5.0, (80, 2))
    pairs = [tuple(sorted(rng.permutation(80)[:2].tolist(), reverse=True)) for _ in range(300)]
    names = [f"Thing{n}" for n in range(80)]
    said = [
        one for one in qsr.relations_between(names, points, pairs=list(dict.fromkeys(pairs))) if "-of(" in one
    ]
    text = f"dynamic {', '.join(names)}.\n" + "".join(f"require {one}.\n" for one in said)
    assert len(said) > 200
    assert found(text).is_consistent
    name, rest = said[100].split("(", 1)
    opposite = DIRECTIONS[(DIRECTIONS.index(name) + 2) % 4]
    broken = found(text + f"require {opposite}({rest}.\n")
    assert [len(one.atoms) for one in broken.conflicts] == [2]


# The closure of directions


@settings(max_examples=100, deadline=None)
@given(st.lists(atoms, max_size=7))
def test_entailed_directions_are_those_of_all_arrangements(given_atoms):
    parsed = [parse_formula(one) for one in given_atoms]
    fitting = [orders for orders in ARRANGED if all(holds(one, orders) for one in parsed)]
    seen = {
        name for name in DIRECTIONS for orders in fitting if holds(parse_formula(f"{name}(A, C)"), orders)
    }
    assert entailed(given_atoms, "A", "C") == seen


def test_entailed_along_a_chain_in_one_frame():
    chain = [f"left-of(X{n + 1}, X{n})" for n in range(50)]
    assert entailed(chain, "X50", "X0") == {"left-of"}
    assert entailed(chain, "X0", "X50") == {"right-of"}
    assert entailed(chain, "X0", "Y") == set(DIRECTIONS)
    assert entailed([*chain, "left-of(X0, X9)"], "X0", "X1") == frozenset()
    mixed = ["left-of(A, B) ∧ close-to(A, B)", "left-of(B, C) wrt absolute"]
    assert entailed(mixed, "A", "B") == {"left-of"}
    assert entailed(mixed, "B", "C") == set(DIRECTIONS)


def test_conceptual_neighbours_of_the_built_in_relations():
    relations = build_graph(Source("<text>", "")).graph.relations
    assert conceptual_neighbours(relations["left-of"]) == ("behind-of", "in-front-of")
    assert conceptual_neighbours(relations["close-to"]) == ("distant-from",)
    assert conceptual_neighbours(relations["on"]) == ()


@pytest.mark.parametrize(
    "statements",
    [
        "require near(Cup, Monitor) ∧ near(Cup, Lamp).",
        "observe near(Cup, Monitor). observe near(Cup, Lamp).",
        "observe near(Cup, Monitor) and near(Pen, Monitor) and near(Cup, Lamp).",
        "scene(Cup, Monitor, Lamp) ⇔ near(Cup, Monitor) ∧ near(Cup, Lamp).",
    ],
)
def test_the_last_resort_is_an_atom_less_as_an_edit_of_the_text(statements):
    (conflict,) = found(LAB + statements).conflicts
    assert len(conflict.relaxations) == 2
    for one in conflict.relaxations:
        assert (one.steps, "leave out" in one.text) == (None, True)
        assert found(edited(LAB + statements, one.edits)).is_consistent


def test_no_edit_takes_a_comment_or_the_side_of_a_disjunction():
    (conflict,) = found(LAB + "observe near(Cup, m) ∧ # or so ∧\n near(Cup, l).").conflicts
    assert [bool(one.edits) for one in conflict.relaxations] == [False, True]
    (conflict,) = found(LAB + "require near(Cup, m) ∨ near(Cup, m). require near(Cup, l).").conflicts
    assert [bool(one.edits) for one in conflict.relaxations] == [True, False, False]


# As findings


def told(text):
    return [one for one in qsr.check_text(text) if one.code == "Q515"]


def test_a_contradiction_across_statements_is_a_finding_with_places_and_an_edit_that_ends_it():
    text = FIGURE_2 + "observe left-of(Bottle, Laptop)."
    (finding,) = told(text)
    places = [finding.span, *(label.span for label in finding.labels)]
    assert [place.line for place in places] == [5, 6, 7, 9]
    assert "the least change: 'behind-of(Bottle, Laptop)' in place of 'left-of'" in finding.help
    assert not finding.sure
    assert told(edited(text, finding.edits)) == []


def test_a_formula_that_contradicts_itself_is_told_once_and_others_besides():
    text = CLASSES + "observe left-of(A, B) ∧ right-of(A, B).\nobserve left-of(C, D).\nrequire left-of(D, C)."
    assert [one.span.line for one in told(text)] == [2, 3]


def test_what_contradicts_itself_in_a_context_alone_is_told_there():
    text = CLASSES + "observe left-of(A, B).\nin room lab, from 08:00 to 10:00 {{ {} }}"
    (finding,) = told(text.format("require right-of(A, B)."))
    assert [finding.span.line, *(label.span.line for label in finding.labels)] == [2, 3]
    assert told(text.format("believe right-of(A, B). require right-of(A, B).")) == []
    assert told(text.format("observe left-of(C, D).")) == []
    two_rooms = "in room a { require left-of(A, B). }\nin room b { require left-of(B, A). }"
    assert told(CLASSES + two_rooms) == []


def test_a_comment_silences_a_contradiction():
    text = CLASSES + "observe left-of(A, B). # allow Q515\nrequire left-of(B, A)."
    assert told(text) == []
