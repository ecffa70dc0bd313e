"""Every place where a name is written."""

from itertools import pairwise
from pathlib import Path

import pytest

from qsrlang.language.source import Source, read_source
from qsrlang.relations.build import build_graph
from qsrlang.relations.occurrences import occurrences

CORPUS = Path(__file__).parents[1] / "corpus"
PROGRAMS = sorted((CORPUS / "accepted").glob("*.qsr"))


def found(text, path=None):
    """The names of a text, as kind, name and the text at the place, those that are defined there marked with a !."""
    source = Source("typed", text, path)
    names = occurrences(build_graph(source).library)
    return [
        (f"{one.kind}{'!' * one.defines}", one.name, one.span.text)
        for one in names
        if one.span.source is source
    ]


def test_classes_and_landmarks():
    assert found("surface Desk. static Monitor { on: Desk }. landmark m-1 : Monitor at (1 m, 2 m).") == [
        ("class!", "Desk", "Desk"),
        ("class!", "Monitor", "Monitor"),
        ("class", "Desk", "Desk"),
        ("landmark!", "m-1", "m-1"),
        ("class", "Monitor", "Monitor"),
    ]


def test_arguments_are_classes_or_landmarks():
    text = "static Cup, Monitor. landmark m-1 : Monitor at (1 m, 2 m). observe left-of(Cup, m-1)."
    assert found(text)[-3:] == [
        ("relation", "left-of", "left-of"),
        ("class", "Cup", "Cup"),
        ("landmark", "m-1", "m-1"),
    ]


def test_relations():
    text = (
        "relation near(a, b) { distance: any, converse: near, disjoint: (far, left-of) }. "
        "relation far(a, b) { angle: any }."
    )
    assert found(text) == [
        ("relation!", "near", "near"),
        ("relation", "near", "near"),
        ("relation", "far", "far"),
        ("relation", "left-of", "left-of"),
        ("relation!", "far", "far"),
    ]


def test_scenes_and_their_roles():
    text = "dynamic Cup, Plate. scene s(left: Cup, Plate) ⇔ on(left, Plate) ∧ ¬in(left: Cup, Plate). observe 3 × s."
    assert found(text)[2:] == [
        ("scene!", "s", "s"),
        ("role!", "left: Cup", "left"),
        ("class", "Cup", "Cup"),
        ("class", "Plate", "Plate"),
        ("relation", "on", "on"),
        ("role", "left: Cup", "left"),
        ("class", "Plate", "Plate"),
        ("relation", "in", "in"),
        ("role", "left: Cup", "left"),
        ("class", "Cup", "Cup"),
        ("class", "Plate", "Plate"),
        ("scene", "s", "s"),
    ]


def test_a_role_is_known_in_its_scene_alone():
    names = found("dynamic Cup, Plate. scene(left: Cup, Plate) ⇔ on(left, Plate). observe on(left, Plate).")
    assert [one for one in names if one[2] == "left"] == [
        ("role!", "left: Cup", "left"),
        ("role", "left: Cup", "left"),
        ("class", "left", "left"),
    ]


def test_classes_that_nothing_declares_are_defined_by_scenes():
    assert ("class!", "Cup", "Cup") in found("scene(Cup, Plate) ⇔ on(Cup, Plate).")
    assert ("class!", "Cup", "Cup") in found("scene(left: Cup, Plate) ⇔ on(left, Plate).")


def test_contexts_defaults_beliefs_and_requirements():
    text = (
        "dynamic A, B. defaults { reach: 1 m }. in room r1, room r2 { require ¬on(A, B). } "
        "believe 0.5 :: on(A, B) | elsewhere."
    )
    names = found(text)
    assert ("default!", "reach", "reach") in names
    assert [one for one in names if one[0] == "room"] == [("room", "r1", "r1"), ("room", "r2", "r2")]
    assert names.count(("relation", "on", "on")) == 2


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "north.qsr").write_text("static Sink.\n")
    (tmp_path / "lab.qsr").write_text(
        'import "north.qsr" as north.\ndynamic Flask.\nobserve left-of(Flask, north.Sink).\n'
    )
    return tmp_path


def test_prefixes_are_names_of_their_own(folder):
    text = 'import "lab.qsr" as lab.\nobserve left-of(lab.Flask, lab.north.Sink).\n'
    assert found(text, folder / "main.qsr") == [
        ("prefix!", "lab", "lab"),
        ("relation", "left-of", "left-of"),
        ("prefix", "lab", "lab"),
        ("class", "lab.Flask", "Flask"),
        ("prefix", "lab", "lab"),
        ("prefix", "lab.north", "north"),
        ("class", "lab.north.Sink", "Sink"),
    ]


def test_names_of_imported_files_bear_their_prefix_and_keep_their_places(folder):
    source = Source("typed", 'import "lab.qsr" as lab.\n', folder / "main.qsr")
    names = occurrences(build_graph(source).library)
    there = [
        (f"{one.kind}{'!' * one.defines}", one.name, one.span.text)
        for one in names
        if one.span.source.path == folder / "lab.qsr"
    ]
    assert there == [
        ("prefix!", "lab.north", "north"),
        ("class!", "lab.Flask", "Flask"),
        ("relation", "left-of", "left-of"),
        ("class", "lab.Flask", "Flask"),
        ("prefix", "lab.north", "north"),
        ("class", "lab.north.Sink", "Sink"),
    ]


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_names_agree_with_their_places(path):
    """A name is written as it is, after a prefix, or before its class; none lies over another; all that is known of
    classes, landmarks, relations and scenes is defined somewhere.
    """
    built = build_graph(read_source(path))
    names = occurrences(built.library)
    for one in names:
        own = one.name.partition(":")[0] if one.kind == "role" else one.name.split(".")[-1]
        assert own == one.span.text.split(".")[-1]
    for one, after in pairwise(names):
        assert one.span.source is not after.span.source or one.span.end <= after.span.start
    defined = {(one.kind, one.name) for one in names if one.defines}
    assert set(built.symbols.places) <= defined
    assert {("class", name) for name in built.symbols.classes} <= defined
