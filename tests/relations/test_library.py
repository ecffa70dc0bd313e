import pytest

import qsrlang as qsr
from qsrlang.relations.build import build_graph
from qsrlang.relations.imports import find_knowledge, read_source, shipped_knowledge
from qsrlang.relations.linting.lint import lint


def write(folder, name, text):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_imports_may_form_a_cycle(tmp_path):
    write(tmp_path, "b.qsr", 'import "a.qsr". dynamic Plate.')
    known = qsr.load(write(tmp_path, "a.qsr", 'import "b.qsr". dynamic Cup. observe left-of(Cup, Plate).'))
    assert {"Cup", "Plate"} <= set(known.classes)


def test_a_path_is_taken_from_the_importing_file(tmp_path):
    (tmp_path / "sub").mkdir()
    write(tmp_path / "sub", "c.qsr", "dynamic Cup.")
    write(tmp_path / "sub", "b.qsr", 'import "c.qsr".')
    assert "Cup" in qsr.load(write(tmp_path, "a.qsr", 'import "sub/b.qsr".')).classes


def test_an_error_in_an_imported_file_is_told_with_its_place(tmp_path):
    write(tmp_path, "b.qsr", "static A { size: 8 × 8 cm }.")
    findings = qsr_findings(write(tmp_path, "a.qsr", 'import "b.qsr".\nobserve left-of(B, C).'))
    assert [(f.code, f.span.source.name.endswith("b.qsr")) for f in findings] == [
        ("Q201", False),
        ("Q201", False),
        ("Q301", True),
    ]


def qsr_findings(path):
    try:
        qsr.load(path)
    except qsr.LanguageError as error:
        return error.diagnostics
    return ()


def test_every_shipped_file_is_free_of_errors():
    assert {"core", "office/desk"} <= set(shipped_knowledge())
    for name in shipped_knowledge():
        qsr.load(name)


def test_the_built_in_relations_are_text_and_nowhere_in_code():
    known = qsr.parse_knowledge("")
    assert set(known.graph.relations) == {
        "behind-of",
        "left-of",
        "in-front-of",
        "right-of",
        "close-to",
        "distant-from",
        "between",
        "on",
        "in",
    }
    for name, relation in known.graph.relations.items():
        for other in relation.disjoint:
            assert name in known.graph.relations[other].disjoint
        if relation.converse:
            assert known.graph.relations[relation.converse].converse == name


def test_an_overridden_statement_is_told_as_information():
    known = qsr.load("office/desk")
    (told,) = known.diagnostics
    assert told.code == "Q601"
    assert not told.is_error
    assert "Cup and Keyboard" in told.message


def test_a_dynamic_landmark_and_an_undeclared_class_are_warnings():
    known = qsr.parse_knowledge(
        "scene(Cup, Plate) ⇔ left-of(Cup, Plate). landmark p : Plate at (0 m, 0 m) facing 0 deg."
    )
    assert [finding.code for finding in known.diagnostics] == ["Q502", "Q501"]
    assert len(known.where("Cup").weights) == 1


def test_what_nobody_saw_says_nothing():
    text = "dynamic Cup. static M { front: yes }. observe 0 × left-of(Cup, M). observe 2 × right-of(Cup, M)."
    assert len(qsr.parse_knowledge(text).where("Cup").weights) == 1


def test_a_belief_on_one_pair_leaves_the_other_pairs_of_an_observation_alone():
    text = (
        "dynamic A, B. static M { front: yes }. believe left-of(A, M)."
        "observe right-of(A, M) ∧ behind-of(B, A) ∧ close-to(B, A)."
    )
    known = qsr.parse_knowledge(text)
    assert [finding.code for finding in known.diagnostics] == []
    answer = known.where("B", {"M": qsr.Pose2(0.0, 0.0, 3.14159)})
    assert len(answer.weights) == 2, "the belief, updated by the observation"


def test_observations_that_say_the_same_are_counted_together():
    text = "dynamic A. static M { front: yes }. observe left-of(A, M)." + " observe 2 × right-of(A, M)." * 3
    answer = qsr.parse_knowledge(text).where("A")
    assert [round(weight, 12) for weight in answer.weights] == [round(6 / 7, 12), round(1 / 7, 12)]
    assert answer.components[0].statements == ("<text>:1: observe 2 × right-of(A, M) (and 2 more)",)


@pytest.mark.parametrize("name", shipped_knowledge())
def test_shipped_files_are_laid_out_and_lint_free(name):
    source = read_source(find_knowledge(name))
    assert qsr.format_source(source) == source.text
    assert [finding.render() for finding in lint(build_graph(source), source)] == []


SEVEN = """surface Desk { size: 150 cm × 80, height: 75 cm }.
static Monitor { size: 55 cm × 20 cm × 40 cm }.
static Monitor.
dynamic Keyboard, Cup
observe 3 right-of(Cup, Keyboard).
observe left_of(Cup, Keyboard).
observe left-of(Cup, Monitor) wrt intrinsic.
believe 0.7 :: left-of(Cup, Keyboard) | 0.6 :: right-of(Cup, Keyboard).
"""


def test_seven_mistakes_are_seven_findings_of_one_run_each_at_its_place(tmp_path):
    found = qsr.check(write(tmp_path, "seven.qsr", SEVEN))
    assert [(one.code, one.span.line, one.span.text) for one in found] == [
        ("Q301", 1, "80"),
        ("Q205", 3, "Monitor"),
        ("Q104", 4, "\n"),
        ("Q101", 5, "right-of"),
        ("Q203", 6, "left_of"),
        ("Q406", 7, "Monitor"),
        ("Q401", 8, "believe 0.7 :: left-of(Cup, Keyboard) | 0.6 :: right-of(Cup, Keyboard)"),
    ]
    assert found.errors == found
    assert [one.code for one in qsr.check_text(SEVEN)] == [one.code for one in found]
