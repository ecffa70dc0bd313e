import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.language import syntax as s
from qsrlang.language.grammar import reader
from qsrlang.language.parser import parse_source
from qsrlang.language.source import MAX_SOURCE_BYTES, Source, read_source
from qsrlang.language.words import WORD

FORMULA = """scene(Monitor, Keyboard, Laptop, Cup, Bottle) ⇔
    in-front-of(Keyboard, Monitor) ∧ left-of(Laptop, Keyboard) ∧ right-of(Cup, Keyboard) ∧
    behind-of(Bottle, Cup) ∧ close-to(Bottle, Cup)."""
ASCII = str.maketrans({"⇔": "iff", "∧": "&", "∨": "or", "¬": "!", "×": "x"})


def only(text):
    parsed = qsr.parse(text)
    assert parsed.diagnostics == ()
    (statement,) = parsed.document.statements
    return statement


def test_the_paper_s_formula_is_legal_as_printed():
    scene = only(FORMULA)
    assert [name.text for name in scene.members] == ["Monitor", "Keyboard", "Laptop", "Cup", "Bottle"]
    assert [atom.relation.text for atom in scene.formula.parts] == [
        "in-front-of",
        "left-of",
        "right-of",
        "behind-of",
        "close-to",
    ]


def test_both_spellings_mean_the_same():
    assert qsr.parse(FORMULA).document == qsr.parse(FORMULA.translate(ASCII)).document
    text = "observe 3 × (¬left-of(A, B) ∨ close-to(A, B)) ∧ behind-of(A, C)."
    assert qsr.parse(text).document == qsr.parse(text.translate(ASCII)).document


def test_quantities_are_converted_once_and_exactly():
    landmark = only("landmark a : B at (30cm, 1200 mm, 0.74 m) facing 180 deg ± (2 cm, 2 cm, 90 deg).")
    assert landmark.position == (0.3, 1.2, 0.74)
    assert landmark.facing == math.pi
    assert landmark.deviation == (0.02, 0.02, math.pi / 2)


def test_conjunctions_are_n_ary_and_double_negation_vanishes():
    observe = only("observe a(A, B) ∧ (b(A, B) ∧ c(A, B)) ∧ ¬¬d(A, B).")
    assert [part.relation.text for part in observe.formula.parts] == ["a", "b", "c", "d"]


def test_counts_fits_and_shares():
    assert only("observe left-of(A, B).").count == 1.0
    fit = only("observe 449 × right-of(A, B) ~ normal((-7 cm, -31 cm), (12 cm, 20 cm), 0.12).").fit
    assert (fit.mean, fit.deviation, fit.correlation) == ((-0.07, -0.31), (0.12, 0.2), 0.12)
    believe = only("believe 15 % :: left-of(A, B) | 0.85 :: right-of(A, B).")
    assert [alternative.share for alternative in believe.alternatives] == [0.15, 0.85]
    assert only("believe left-of(A, B) | right-of(A, B).").alternatives[0].share is None


def test_a_query_may_leave_out_its_question_mark():
    assert qsr.parse_query("where Cup") == qsr.parse_query("where Cup?")
    assert qsr.parse_query("where Cup wrt Keyboard?").relatum.text == "Keyboard"
    with pytest.raises(qsr.LanguageError, match="Q101"):
        qsr.parse_query("whence Cup?")


def test_a_landmark_on_its_own():
    assert qsr.parse_landmark("m : Monitor at (0 m, 1 m) facing -90 deg").name.text == "m"
    assert qsr.parse_place("1.2 m, 50 cm") == (1.2, 0.5)


def test_a_diagnostic_shows_file_line_column_caret_and_a_suggestion():
    text = "dynamic Cup, Plate.\nobserve close-to(Cup, Plate) ∧\n   left_of(Cup, Plate).\n"
    with pytest.raises(qsr.LanguageError) as caught:
        qsr.parse_knowledge(text, "office.qsr")
    assert str(caught.value) == (
        "error[Q203]: unknown relation 'left_of'\n"
        "  --> office.qsr:3:4\n"
        "  |\n"
        "3 |    left_of(Cup, Plate).\n"
        "  |    ^^^^^^^ no relation of this name here\n"
        "   = help: did you mean 'left-of' (core.qsr:11)?"
    )


def test_every_mistake_comes_in_one_run():
    text = "static A { size: 8 × 8 cm }.\nstatic B.\nobserve 3 left-of(B, B).\nlandmark b : B at (1 m, 1 m, 1 m, 1 m)."
    assert [finding.code for finding in qsr.parse(text).diagnostics] == ["Q301", "Q101", "Q304"]


def test_spans_point_at_the_text_they_were_read_from():
    scene = only(FORMULA)
    for atom in scene.formula.parts:
        assert atom.span.text.startswith(atom.relation.text)
    assert scene.formula.parts[3].span.line == 3


@given(st.text(max_size=200))
def test_any_text_gives_diagnostics_and_no_other_exception(text):
    parsed = parse_source(Source("<any>", text))
    for finding in parsed.diagnostics:
        assert finding.render()


@given(st.lists(st.sampled_from([*" .,:()|{}~∧¬⇔×\n", "believe ", "left-of", "Cup", "3 cm", "scene", "#"])))
def test_any_row_of_words_gives_diagnostics_and_no_other_exception(words):
    for finding in qsr.parse("".join(words)).diagnostics:
        assert finding.render()


def test_nesting_is_bounded_and_the_parser_does_not_recurse():
    assert qsr.parse("observe " + "(" * 99 + "a(A, B)" + ")" * 99 + ".").diagnostics == ()
    (finding,) = qsr.parse("observe " + "(" * 200_000 + ".").diagnostics
    assert finding.code == "Q102"
    assert isinstance(only("observe " + "¬" * 20_001 + "a(A, B).").formula, s.Not)


def test_a_missing_or_odd_file_is_a_one_line_error(tmp_path):
    with pytest.raises(qsr.FileError, match=r"nowhere\.qsr.*; give the path"):
        qsr.load("nowhere.qsr")
    with pytest.raises(qsr.FileError, match="office/desk"):
        qsr.load("office/desc")
    with pytest.raises(qsr.FileError, match="no such file is shipped"):
        qsr.load("../../etc/passwd")
    binary = tmp_path / "b.qsr"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(qsr.FileError, match="UTF-8"):
        qsr.load(binary)
    binary.write_bytes(b" " * (MAX_SOURCE_BYTES + 1))
    with pytest.raises(qsr.FileError, match="larger"):
        read_source(binary)


def test_windows_line_ends_and_a_byte_order_mark_change_nothing(tmp_path):
    path = tmp_path / "w.qsr"
    path.write_bytes(b"\xef\xbb\xbf" + FORMULA.replace("\n", "\r\n").encode())
    assert parse_source(read_source(path)).document == qsr.parse(FORMULA).document


def test_names_may_use_any_script_and_the_grammar_says_so():
    names = [
        "Cup",
        "Tisch-Größe",
        "杯子",
        "प्याला",
        "ถ้วย",
        "కప్పు",
        "பாத்திரம்",
        "कप-बोर्ड",
        "e\u0301tage\u0300re",
        "чашка",
    ]
    declared = only(f"static {', '.join(names)}.")
    assert [one.name.text for one in declared.classes] == names
    terminal = next(one for one in reader().lark.terminals if one.name == "NAME")
    word = re.sub(r"\\u([0-9a-f]{4})", lambda match: chr(int(match[1], 16)), WORD)
    assert terminal.pattern.value == rf"{word}(?:\.{word})*"


def test_a_query_may_end_in_a_comment():
    assert qsr.parse_query("where Cup # in the kitchen") == qsr.parse_query("where Cup?")
