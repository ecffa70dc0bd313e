"""From places to atoms of the language, and back: what is written is what the engine says of the same places."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.language.source import Source
from qsrlang.relations.build import build_graph

VIEWER = (0.0, -2.0)


def test_atoms_as_a_viewer_sees_them():
    points = [(0.0, 0.0), (0.3, 0.0), (-0.1, 0.7)]
    assert qsr.relations_between(["Keyboard", "Cup", "Lamp"], points, VIEWER) == (
        "right-of(Cup, Keyboard)",
        "close-to(Cup, Keyboard)",
        "behind-of(Lamp, Keyboard)",
        "distant-from(Lamp, Keyboard)",
        "behind-of(Lamp, Cup)",
        "distant-from(Lamp, Cup)",
    )


def test_without_a_viewer_the_frame_is_that_of_the_map():
    said = qsr.relations_between(["A", "B"], [(0.0, 0.0), (1.0, 0.1)], pairs=[(1, 0), (0, 1)])
    assert said == (
        "right-of(B, A) wrt absolute",
        "distant-from(B, A)",
        "left-of(A, B) wrt absolute",
        "distant-from(A, B)",
    )


def test_boxes_and_the_edge_of_the_support_set_the_two_halves_of_the_way():
    desk = ConvexPolygon.rectangle(qsr.Pose2(0.0, 0.0), 2.0, 1.0)
    for share in (0.1, 0.49, 0.51, 0.9):
        # A box of 0.2 m right of one of 0.4 m: they touch at 0.3 m, and the edge is met at 1 - 0.1 = 0.9 m.
        place = 0.3 + share * 0.6
        said = qsr.relations_between(
            ["Keyboard", "Cup"],
            [(0.0, 0.0), (place, 0.0)],
            VIEWER,
            sizes=[(0.4, 0.4), (0.2, 0.2)],
            support=desk,
        )
        assert said == (
            "right-of(Cup, Keyboard)",
            f"{'close-to' if share < 0.5 else 'distant-from'}(Cup, Keyboard)",
        )


def test_a_box_is_turned_by_the_heading_of_the_relatum():
    sizes = [(1.0, 0.02), (0.0, 0.0)]
    for heading, share in ((0.0, 0.3), (0.5 * math.pi, 0.2)):
        contact = 0.5 if heading == 0.0 else 0.01
        points = [(0.0, 0.0), (0.0, contact + share * 0.75)]
        far = [(0.0, 0.0), (0.0, contact + (share + 0.4) * 0.75)]
        for place, name in ((points, "close-to"), (far, "distant-from")):
            said = qsr.relations_between(["A", "B"], place, sizes=sizes, headings=[heading, 0.0])
            assert said[1] == f"{name}(B, A)"


def test_points_in_one_place_have_no_direction_and_bad_input_is_refused():
    assert qsr.relations_between(["A", "B"], [(1.0, 1.0), (1.0, 1.0)]) == ("close-to(B, A)",)
    assert qsr.relations_between([], np.zeros((0, 2))) == ()
    with pytest.raises(qsr.ValueRangeError, match="points"):
        qsr.relations_between(["A", "B"], [(0.0, 0.0)])
    with pytest.raises(qsr.ValueRangeError, match="pairs"):
        qsr.relations_between(["A", "B"], np.eye(2), pairs=[(1, 1)])


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_random_scenes_are_consistent_text(seed):
    rng = np.random.default_rng(seed)
    names = [f"Thing{number}" for number in range(6)]
    said = qsr.relations_between(names, rng.uniform(-1.0, 1.0, (6, 2)))
    text = f"dynamic {', '.join(names)}.\nscene({', '.join(names)}) ⇔ {' ∧ '.join(said)}."
    built = build_graph(Source("<text>", text))
    assert built.diagnostics == ()
    assert qsr.find_conflicts(built.graph).is_consistent


def test_what_is_written_holds_where_the_engine_looks():
    """The direction and the half of the way of a placed object have probability one of being what was written."""
    for place in ((0.3, 0.05), (-0.4, 0.1), (0.05, 0.6), (0.1, -0.2)):
        said = qsr.relations_between(["Lamp", "Cup"], [(0.0, 0.0), place], VIEWER)
        text = (
            "static Lamp.\ndynamic Cup.\nlandmark l : Lamp at (0 m, 0 m) facing -90 deg.\n"
            f"landmark c : Cup at ({place[0]} m, {place[1]} m).\n"
        )
        known = qsr.parse_knowledge(text)
        for atom in said:
            answer = known.ask(f"prob {atom}?", viewer=qsr.Pose2(*VIEWER))
            assert answer.value == 1.0, atom
