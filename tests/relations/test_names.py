"""Prefixes, roles, cycles, lost definitions: what names stand for."""

import pytest

import qsrlang as qsr
from qsrlang.language.source import Source
from qsrlang.relations.build import build_graph


def write(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def built(text):
    return build_graph(Source("<text>", text))


def codes(text):
    return [finding.code for finding in built(text).diagnostics]


def findings(path):
    try:
        return qsr.load(path).diagnostics
    except qsr.LanguageError as error:
        return error.diagnostics


LAB = (
    "static Bench { front: yes }. dynamic Cup. "
    "landmark b : Bench at (0 m, 0 m) facing 0 deg. observe left-of(Cup, Bench)."
)


def test_an_alias_keeps_two_files_apart(tmp_path):
    write(tmp_path, "lab.qsr", LAB)
    path = write(
        tmp_path,
        "a.qsr",
        'import "lab.qsr" as lab. import "lab.qsr" as old. dynamic Cup. observe left-of(Cup, lab.Bench).',
    )
    known = qsr.load(path)
    assert set(known.classes) == {"Cup", "lab.Cup", "lab.Bench", "old.Cup", "old.Bench"}
    assert {landmark.name: landmark.kind for landmark in known.landmarks} == {
        "lab.b": "lab.Bench",
        "old.b": "old.Bench",
    }
    assert len(known.where("lab.Cup").weights) == 1
    assert "left-of" in known.graph.relations, "built-in relations bear no prefix"


def test_prefixes_add_up_and_roles_parameters_and_rooms_bear_none(tmp_path):
    inner = """
    relation beside(referent, relatum) { angle: any, disjoint: off }.
    relation off(referent, relatum) { angle: any }.
    dynamic P, Q.
    scene(left: P, right: P, Q) ⇔ beside(left, Q) ∧ beside(right: P, Q).
    in room r { observe beside(P, Q). }
    """
    write(tmp_path, "inner.qsr", inner)
    write(tmp_path, "outer.qsr", 'import "inner.qsr" as in-side.')
    graph = qsr.load(write(tmp_path, "a.qsr", 'import "outer.qsr" as out.')).graph
    assert graph.roles == {"left: out.in-side.P": "out.in-side.P", "right: out.in-side.P": "out.in-side.P"}
    assert graph.relations["out.in-side.beside"].disjoint == ("out.in-side.off",)


def test_an_error_under_a_prefix_shows_the_text_as_it_was_typed(tmp_path):
    write(tmp_path, "lab.qsr", "dynamic Cup. static Bench.\nobserve left-of(Cop, Bench).")
    (finding,) = findings(write(tmp_path, "a.qsr", 'import "lab.qsr" as lab.'))
    assert (finding.code, finding.span.text, finding.span.line) == ("Q201", "Cop", 2)
    assert [edit.text for edit in finding.edits] == ["Cup"]


def test_a_file_that_imports_itself_under_a_prefix_is_refused(tmp_path):
    (finding,) = findings(write(tmp_path, "a.qsr", 'import "a.qsr" as me.'))
    assert finding.code == "Q209"
    write(tmp_path, "c.qsr", 'import "b.qsr" as b.')
    assert {f.code for f in findings(write(tmp_path, "b.qsr", 'import "c.qsr" as c.'))} == {"Q209"}


def test_a_prefix_used_twice_shows_both_places(tmp_path):
    write(tmp_path, "lab.qsr", LAB)
    write(tmp_path, "other.qsr", "dynamic Pot.")
    found = findings(write(tmp_path, "a.qsr", 'import "lab.qsr" as lab.\nimport "other.qsr" as lab.'))
    (finding,) = found
    assert (finding.code, finding.span.line, finding.labels[0].span.line) == ("Q213", 2, 1)


def test_imports_stay_below_the_first_file(tmp_path, monkeypatch):
    write(tmp_path, "secret.qsr", "dynamic Secret.")
    inside = write(tmp_path, "in/a.qsr", 'import "../secret.qsr".')
    (finding,) = findings(inside)
    assert finding.code == "Q209"
    assert "QSR_PATH" in finding.help
    (tmp_path / "in" / "link.qsr").symlink_to(tmp_path / "secret.qsr")
    assert [f.code for f in findings(write(tmp_path, "in/b.qsr", 'import "link.qsr".'))] == ["Q209"]
    monkeypatch.setenv("QSR_PATH", str(tmp_path))
    assert "Secret" in qsr.load(inside).classes


@pytest.mark.parametrize(
    "target", ["", " ", "..", "/", "a\\0b.qsr", "a" * 5000 + ".qsr", "office/", "//etc/passwd", "."]
)
def test_an_odd_import_is_a_finding(target):
    assert codes(f'import "{target}".') == ["Q209"]
    assert codes(f'import "{target}" as x.') == ["Q209"]


def test_a_null_in_an_import_is_a_finding():
    assert "Q209" in codes('import "a\0b.qsr".')


def test_roles_tell_two_of_one_class_apart():
    text = (
        "dynamic Cup, Plate. scene(Plate, left: Cup, right: Cup) ⇔ "
        "left-of(left, Plate) ∧ right-of(right: Cup, left: Cup)."
    )
    one = built(text)
    assert one.diagnostics == ()
    assert one.graph.roles == {"left: Cup": "Cup", "right: Cup": "Cup"}
    pairs = {pair for choice in one.graph.choices for pair in choice.governs}
    assert pairs == {("left: Cup", "Plate"), ("right: Cup", "left: Cup")}
    assert one.graph.roles_of("Cup") == ("left: Cup", "right: Cup")
    assert one.graph.class_of("left: Cup") == "Cup"


def test_a_role_stands_for_one_class_and_must_be_a_member():
    assert "Q410" in codes("dynamic A, B, C. scene(left: A, left: B, C) ⇔ left-of(left, C).")
    assert codes("dynamic A, C. scene(left: A, C) ⇔ left-of(right: A, C).") == ["Q211"]
    assert codes("dynamic A, C. observe left-of(A, A).") == ["Q407"]


def test_what_a_broken_definition_would_define_is_not_reported_again():
    text = (
        "dynamic Cup { size: 8 × 8 cm }, Plate.\nobserve left-of(Cup, Plate).\n"
        "landmark p : Plate at (0, 0 m).\nobserve left-of(Cup, p)."
    )
    assert codes(text) == ["Q301", "Q301"]


def test_cyclic_anchoring_shows_the_cycle():
    findings = built(
        "dynamic A, B, C.\nobserve left-of(A, B).\nobserve left-of(B, C).\nobserve right-of(C, A)."
    ).diagnostics
    (finding,) = findings
    assert (finding.code, finding.span.line) == ("Q513", 2)
    assert [label.span.line for label in finding.labels] == [3, 4]
    assert not finding.is_error
    loop = "dynamic A, B. observe left-of(A, B). observe right-of(B, A). "
    assert codes(loop) == ["Q513"]
    assert codes(loop + "static M. observe left-of(A, M).") == []
    assert "Q513" not in codes(loop + "landmark b : B at (0 m, 0 m) facing 0 deg.")


def test_a_belief_may_say_elsewhere():
    text = "dynamic Cup. static M {{ front: yes }}. believe {}."
    shares = {
        "0.7 :: left-of(Cup, M) | elsewhere": [0.7],
        "0.7 :: left-of(Cup, M) | 0.3 :: elsewhere": [0.7],
        "left-of(Cup, M) | right-of(Cup, M) | elsewhere": [1 / 3, 1 / 3],
    }
    for belief, expected in shares.items():
        one = built(text.format(belief))
        assert one.diagnostics == ()
        assert [a.share for a in one.graph.choices[0].alternatives] == expected
    assert codes(text.format("0.7 :: left-of(Cup, M) | 0.4 :: elsewhere")) == ["Q401"]
    assert codes(text.format("0.7 :: left-of(Cup, M) | elsewhere | elsewhere")) == ["Q305"]


def test_relations_have_two_or_three_arguments_and_say_something():
    assert codes("dynamic A. static B, C. observe between(A, B, C).") == []
    assert codes("dynamic A. static B, C. observe between(A, B).") == ["Q404"]
    assert codes("dynamic A. static B, C. observe left-of(A, B, C).") == ["Q404"]
    assert codes("dynamic A. observe left-of(A).") == ["Q404"]
    assert codes("relation near(a, b, c, d) { angle: any }.") == ["Q404"]
    assert codes("relation near(referent, relatum) { symmetric: yes }.") == ["Q411"]


def test_regions_and_second_relata_make_constraints_of_their_own():
    one = built(
        "dynamic A. surface B. static C. observe on(A, B) ∧ left-of(A, B) ∧ between(A, B, C) ∧ close-to(A, B)."
    )
    assert one.diagnostics == ()
    ((alternative,),) = {choice.alternatives for choice in one.graph.choices}
    told = {(c.relatum, c.towards, tuple(a.relation.name for a in c.atoms)) for c in alternative.constraints}
    assert told == {("B", None, ("on",)), ("B", None, ("left-of", "close-to")), ("B", "C", ("between",))}
