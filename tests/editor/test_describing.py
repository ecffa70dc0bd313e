"""What a name stands for, in words."""

import re

from qsrlang.editor.describing import definition_of, facts, hover_text
from qsrlang.language.source import Source
from qsrlang.relations.build import build_graph

TEXT = """\
language 1.
## What holds things.
surface Desk { size: 150 cm × 80 cm, height: 75 cm }.
static Monitor { size: 55 cm × 20 cm × 40 cm, front: yes, on: Desk }, Lamp.
landmark m-1 : Monitor at (1.2 m, 3 m, 0.74 m) facing -90 deg ± (2 cm, 2 cm, 3 deg).
landmark l-1 : Lamp at (0 m, 0 m).
scene breakfast(left: Monitor, Plate) ⇔ left-of(Plate, left).
relation odd(a, b) { angle: mix(normal(45 deg, 15 deg), uniform(0 deg, 90 deg)), distance: uniform(0 cm, 30 cm),
    converse: odd, disjoint: (left-of, on), symmetric: yes }.
defaults { reach: 1 m }.
"""
BUILT = build_graph(Source("office.qsr", TEXT))


def test_classes():
    assert facts("class", "Desk", BUILT) == (
        "surface",
        "150 cm × 80 cm (width × depth)",
        "its top 75 cm above the floor",
    )
    assert facts("class", "Monitor", BUILT) == (
        "static",
        "55 cm × 20 cm × 40 cm (width × depth × height)",
        "stands on Desk",
        "has a front",
    )
    assert facts("class", "Plate", BUILT) == ("never declared: taken as a point",)


def test_landmarks():
    assert facts("landmark", "m-1", BUILT) == (
        "Monitor",
        "at (1.2 m, 3 m, 0.74 m)",
        "facing -90 deg",
        "± (2 cm, 2 cm, 3 deg)",
    )
    assert facts("landmark", "l-1", BUILT) == ("Lamp", "at (0 m, 0 m)", "no heading")


def test_built_in_relations_say_where_they_point():
    said = {name: facts("relation", name, BUILT) for name in BUILT.symbols.relations}
    assert said["behind-of"][0] == "angle: 0 deg ± 11.25 deg (behind)"
    assert said["left-of"][:2] == ("angle: 90 deg ± 11.25 deg (to the left)", "distance: any")
    assert said["in-front-of"][0] == "angle: 180 deg ± 11.25 deg (in front)"
    assert said["right-of"][0] == "angle: 270 deg ± 11.25 deg (to the right)"
    assert said["close-to"][:2] == (
        "angle: any",
        "distance: 0 % to 50 % of the way to the edge of the support",
    )
    assert said["on"] == ("on the top of the relatum",)
    assert said["in"] == ("inside the relatum",)
    assert said["between"][1] == "distance: 0 % to 100 % of the way between the relata"
    assert "from the one relatum towards the other" in said["between"][0]


def test_relations_of_one_s_own():
    assert facts("relation", "odd", BUILT) == (
        "angle: either 45 deg ± 15 deg (behind and to the left), or 0 deg to 90 deg, counter-clockwise, all alike",
        "distance: 0 cm to 30 cm",
        "converse: odd",
        "excludes: left-of, on",
        "symmetric",
    )


def test_scenes_and_roles():
    assert facts("scene", "breakfast", BUILT) == ("of left: Monitor, Plate",)
    assert facts("role", "left: Monitor", BUILT)[0] == "one of several Monitor"


def test_of_the_unknown_nothing_is_told():
    for kind in ("class", "landmark", "relation", "scene", "role", "default", "room", "prefix"):
        assert facts(kind, "nothing", BUILT) == ()
        assert definition_of(kind, "nothing", BUILT.library) is None
        assert hover_text(kind, "nothing", BUILT) == "```qsr\nnothing\n```"


def test_definitions_stand_alone():
    lamp = definition_of("class", "Lamp", BUILT.library)
    assert lamp is not None
    assert lamp.text == "static Lamp"
    reach = definition_of("default", "reach", BUILT.library)
    assert reach is not None
    assert (reach.text, reach.span.source.name) == ("reach: 1 m", "office.qsr")


def test_a_hover_has_definition_facts_comment_and_place():
    assert hover_text("class", "Desk", BUILT) == (
        "```qsr\nsurface Desk { size: 150 cm × 80 cm, height: 75 cm }\n```\n\n"
        "surface  \n150 cm × 80 cm (width × depth)  \nits top 75 cm above the floor\n\n"
        "What holds things.\n\n"
        "*office.qsr:3*"
    )
    assert re.search(r"\*core\.qsr:\d+\*$", hover_text("relation", "on", BUILT))


def test_a_long_definition_is_cut():
    atoms = " ∧\n".join(f"on(A{number}, B)" for number in range(50))
    members = ", ".join(f"A{number}" for number in range(50))
    built = build_graph(Source("long.qsr", f"scene long(B, {members}) ⇔ {atoms}.\n"))
    assert hover_text("scene", "long", built).count("\n") < 30
