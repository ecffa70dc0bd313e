"""Completions: what the grammar accepts, and the names that fit, in whatever state the text is."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.editor.completion import complete
from qsrlang.editor.vocabulary import Kind, vocabulary
from qsrlang.language.expecting import expected_after
from qsrlang.language.grammar import spellings
from qsrlang.language.source import Source
from qsrlang.language.splitting import Kind as PieceKind
from qsrlang.language.splitting import split
from qsrlang.relations.build import build_graph
from qsrlang.relations.occurrences import occurrences

CORPUS = Path(__file__).parents[1] / "corpus"
PROGRAMS = sorted((CORPUS / "accepted").glob("*.qsr"))
KNOWN = """\
surface Desk { size: 150 cm × 80 cm, height: 75 cm }.
static Monitor { front: yes, on: Desk }.
dynamic Keyboard { on: Desk }, Cup { size: 8 cm × 8 cm × 10 cm, on: Desk }, Tasse.
landmark monitor-1 : Monitor at (1 m, 2 m) facing -90 deg.
scene breakfast(left: Cup, Keyboard) ⇔ left-of(left, Keyboard).
relation beside(referent, relatum) { angle: any, distance: uniform(0 cm, 30 cm) }.
in room r133 { observe left-of(Cup, Keyboard). }
"""
BUILT = build_graph(Source("known", KNOWN))


def completions(text, query=False):
    """What may be written at the bar of a text that follows what is known; without a bar, at its end."""
    before, _, after = text.partition("¦")
    start = "" if query else KNOWN
    return complete(start + before + after, len(start + before), BUILT, query)


def texts(text, query=False):
    return [one.text for one in completions(text, query)]


def kinds(text, query=False):
    return {one.kind for one in completions(text, query)}


@pytest.mark.parametrize(
    ("text", "expected", "refused"),
    [
        ("", ["scene", "believe", "in", "landmark"], ["where", "Cup", "}"]),
        ("obs", ["observe"], ["scene"]),
        ("OBS", ["observe"], ["scene"]),
        ("observe ", ["left-of", "beside", "breakfast", "not", "¬"], ["Cup", "and"]),
        ("observe 3 × b", ["beside", "behind-of", "between", "breakfast"], ["left-of", "believe"]),
        ("believe 70 ", ["%", "::"], ["cm"]),
        ("believe 70 % :: on(Cup, Desk) | ", ["left-of", "elsewhere"], ["breakfast"]),
        ("observe left-of(", ["Cup", "Keyboard", "monitor-1", "left: Cup"], ["left-of", "breakfast"]),
        ("observe left-of(C", ["Cup"], ["Keyboard"]),
        ("observe left-of(Cup, ", ["Keyboard"], ["Cup"]),
        ("observe left-of(Cup, Keyboard) ", ["and", "∧", "or", "wrt", "~", "."], ["×", "Cup"]),
        ("observe left-of(Cup, Keyboard) w", ["wrt"], ["."]),
        ("observe left-of(Cup, Keyboard) wrt ", ["relative", "intrinsic", "absolute"], ["Cup"]),
        ("scene(Cup, low: Tasse) ⇔ left-of(", ["Cup", "low", "monitor-1"], ["Keyboard", "Tasse"]),
        ("scene(Cup, low: Tasse) ⇔ left-of(Cup, ", ["low"], ["Cup"]),
        ("scene(", ["Cup", "Desk"], ["left-of"]),
        ("scene(low: ", ["Cup"], ["monitor-1"]),
        ("dynamic Mug { ", ["size", "height", "front", "on"], ["angle"]),
        ("dynamic Mug { on: ", ["Desk"], ["Cup"]),
        ("dynamic Mug { front: ", ["yes", "no"], []),
        ("dynamic Mug { size: 8 ", ["cm", "m", "×"], ["deg", "s"]),
        ("dynamic Mug { size: 8c", ["cm"], ["m"]),
        ("landmark cup-1 : ", ["Monitor", "Desk"], ["monitor-1"]),
        ("landmark cup-1 : Cup at (3 m, 2 m) ", ["facing", "±"], ["at"]),
        ("landmark cup-1 : Cup at (3 m, 2 m) facing 3 ", ["deg", "rad"], ["cm"]),
        ("in ", ["room", "from", "weekday", "weekend"], ["scene"]),
        ("in room ", ["r133"], ["Cup"]),
        ("in room r133 { ", ["observe", "believe", "require", "scene", "}"], ["static", "import", "in"]),
        ("import ", ['"office/desk"'], ['"core"', "Cup"]),
        ('import "', ["office/desk", "kitchen/cups"], ["core"]),
        ('import "office/d', ["office/desk"], ["kitchen/cups"]),
        ('import "office/desk" ', ["as"], []),
        ("relation r(a, b) { ", ["angle", "distance", "region", "converse"], ["size"]),
        ("relation r(a, b) { angle: ", ["normal", "uniform", "mix", "any"], ["left-of"]),
        ("relation r(a, b) { converse: b", ["beside", "between"], ["Cup"]),
        ("relation r(a, b) { disjoint: (left-of, ", ["beside"], ["Cup"]),
        ("relation r(a, b) { distance: uniform(3 ", ["cm", "%"], ["deg"]),
        ("defaults { ", ["reach", "strength"], ["Cup"]),
        ("static Mug. # allow Q50", ["Q503", "Q504"], ["Q201", "Q601"]),
        ("observe left-of(Cup,\nobs", ["observe"], []),
        ("observe left-of(Cup,\nobserve right-of(", ["Cup", "Keyboard"], []),
        ("observe § left-of(Cup 9, ", ["Keyboard"], ["left-of"]),
        ("observe left-of(¦Cup, Keyboard).", ["Tasse"], ["left-of"]),
    ],
)
def test_what_may_be_written(text, expected, refused):
    found = texts(text)
    assert set(expected) <= set(found)
    assert not set(refused) & set(found)
    assert len(found) == len(set(found))


@pytest.mark.parametrize("text", ["# obs", "## A cup ", "static M", "landmark ", "scene ", "dynamic Cup, "])
def test_where_nothing_can_be_known(text):
    assert not {"class", "landmark", "relation", "scene", "role"} & kinds(text)


@pytest.mark.parametrize(
    ("text", "expected", "refused"),
    [
        ("", ["where", "prob", "check"], ["scene", "import"]),
        ("whe", ["where"], ["prob"]),
        ("where ", ["Cup", "left: Cup", "monitor-1"], ["left-of"]),
        ("where Cup ", ["given", "in", "at", "wrt", "?"], ["and"]),
        ("where Cup wrt ", ["Keyboard"], ["left: Cup"]),
        ("where Cup given ", ["left-of", "not"], ["Cup"]),
        ("where Cup in room ", ["r133"], []),
        ("prob left-of(", ["Cup"], ["left-of"]),
        ("explain ", ["Cup", "left-of"], []),
        ("sample ", ["breakfast", "Desk", "monitor-1"], ["Cup"]),
        ("views T", ["Tasse"], ["Cup"]),
    ],
)
def test_what_may_be_asked(text, expected, refused):
    found = texts(text, query=True)
    assert set(expected) <= set(found)
    assert not set(refused) & set(found)


def test_each_completion_says_what_it_is():
    (cup,) = (one for one in completions("observe left-of(Cu") if one.kind == "class")
    assert (cup.text, cup.detail) == ("Cup", "dynamic, 8 cm × 8 cm × 10 cm (width × depth × height)")
    assert cup.start == len(KNOWN) + len("observe left-of(")
    (beside,) = (one for one in completions("observe beside") if one.kind == "relation")
    assert beside.detail == "distance: 0 cm to 30 cm"
    (conjunction,) = (one for one in completions("observe left-of(Cup, Keyboard) an"))
    assert (conjunction.text, conjunction.kind, conjunction.detail) == ("and", "keyword", "∧")
    assert {one.kind for one in completions("in room r")} == {"room"}
    assert {one.kind for one in completions('import "o')} == {"file"}
    assert {one.kind for one in completions("# allow Q6")} == {"code"}


def test_names_of_an_import_under_a_prefix():
    built = build_graph(Source("other", 'import "office/desk" as lab.\n'))
    text = 'import "office/desk" as lab.\nobserve left-of(lab.'
    assert {"lab.Cup", "lab.Monitor"} <= {one.text for one in complete(text, len(text), built)}


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_every_word_of_a_program_could_have_been_completed(path):
    """Apart from what is new where it stands: numbers, times, names that are defined, signs in a second spelling.

    So are classes that only scenes bring in, and `between(Cup, Plate, Plate)` names a thing twice.
    """
    source = Source(path.name, path.read_text(encoding="utf-8-sig"), path)
    built = build_graph(source)
    names = [one for one in occurrences(built.library) if one.span.source is source]
    referring = {one.span.start for one in names if not one.defines and one.name == one.span.text}
    for piece in split(source):
        words = expected_after(piece.span).words if piece.kind is not PieceKind.CONTEXT_END else ()
        for word in words:
            if (word.type in spellings() and first_spelling(word)) or word.start_pos in referring:
                before = f"{source.text[: word.start_pos]} "
                found = complete(before, len(before), built)
                assert str(word) in {one.text for one in found}, f"{word} at {word.start_pos}"


def first_spelling(word):
    operator = vocabulary().kinds[word.type] is Kind.OPERATOR
    return not operator or word[0].isalpha() or word == spellings()[word.type][0]


@pytest.mark.parametrize("path", PROGRAMS[::6], ids=lambda path: path.stem)
def test_a_program_that_is_being_typed_can_always_be_completed(path):
    text = path.read_text(encoding="utf-8-sig")
    for position in range(0, len(text) + 1, 3):
        for one in complete(text[:position], position, BUILT):
            assert text[one.start : position].casefold() == one.text[: position - one.start].casefold()


@given(
    st.text(st.sampled_from('scene(A, b: C) ⇔ .?{}|::0.3 cm\n"#é😀 in on observe\x00')), st.integers(-3, 60)
)
def test_nothing_that_can_be_typed_is_too_much(text, position):
    for one in complete(text, position, BUILT) + complete(text, position, BUILT, query=True):
        assert 0 <= one.start <= len(text)
        assert one.text


def test_what_is_longer_than_any_statement_is_left_alone():
    text = "observe " + "left-of(Cup, Keyboard) ∧ " * 1000
    assert complete(text, len(text), BUILT) == ()
