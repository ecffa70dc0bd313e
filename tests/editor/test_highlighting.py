"""Colours by Pygments: every word of the grammar where it stands, and nothing lost."""

import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pygments import highlight
from pygments.formatters import TerminalTrueColorFormatter
from pygments.token import Error, Keyword, Name, Number, Operator, Punctuation, String, Text, Token

from qsrlang.editor.highlighting import TOKENS, DarkStyle, QSRLexer
from qsrlang.editor.patterns import Ink
from qsrlang.editor.vocabulary import Kind, builtin_relations, vocabulary, words_of
from qsrlang.language.grammar import keywords, spellings

CORPUS = Path(__file__).parents[1] / "corpus"
SHIPPED = Path(__file__).parents[2] / "knowledge"
FIG_2 = """\
## Fig. 2 of the paper.
scene(Monitor, Cup) ⇔
    right-of(Cup, Keyboard) ∧ beside(left: Cup, monitor-1).  # as printed
"""


def tokens(text):
    """The words of a text with their kinds, blanks left out."""
    lexer = QSRLexer(stripnl=False, ensurenl=False)
    return [(value, kind) for kind, value in lexer.get_tokens(text) if value.strip()]


def test_the_scene_of_the_paper():
    assert tokens(FIG_2) == [
        ("## Fig. 2 of the paper.", String.Doc),
        ("scene", Keyword.Declaration),
        ("(", Punctuation),
        ("Monitor", Name.Class),
        (",", Punctuation),
        ("Cup", Name.Class),
        (")", Punctuation),
        ("⇔", Operator),
        ("right-of", Name.Builtin),
        ("(", Punctuation),
        ("Cup", Name.Class),
        (",", Punctuation),
        ("Keyboard", Name.Class),
        (")", Punctuation),
        ("∧", Operator),
        ("beside", Name.Function),
        ("(", Punctuation),
        ("left", Name.Label),
        (":", Punctuation),
        ("Cup", Name.Class),
        (",", Punctuation),
        ("monitor-1", Name.Variable),
        (")", Punctuation),
        (".", Punctuation),
        ("# as printed", Token.Comment.Single),
    ]


@pytest.mark.parametrize(
    ("text", "word", "kind"),
    [
        ("static Cup { size: 8 cm × 8 cm }.", "size", Name.Attribute),
        ("static Cup { size: 8cm x 8 cm }.", "cm", Keyword.Type),
        ("static Cup { size: 8 cm x 8 cm }.", "x", Operator),
        ("static Cup { front: yes }.", "yes", Keyword.Constant),
        ("believe 70 % :: on(A, B) | elsewhere.", "%", Keyword.Type),
        ("believe 70 % :: on(A, B) | elsewhere.", "on", Name.Builtin),
        ("believe 70 % :: on(A, B) | elsewhere.", "elsewhere", Keyword.Constant),
        ("static Cup { on: Desk }.", "on", Name.Attribute),
        ("landmark at : Monitor at (1 m, 2 m).", "Monitor", Name.Class),
        ("landmark desk-1 : Desk at (1 m, 2 m) facing -90 deg.", "facing", Keyword),
        ("landmark desk-1 : Desk at (1 m, 2 m) facing -90 deg.", "desk-1", Name.Variable),
        ("landmark desk-1 : Desk at (1.5e3 m, 2 m).", "1.5e3", Number),
        ("observe 3 × breakfast.", "breakfast", Name.Entity),
        ("scene breakfast(Cup, Plate) ⇔ on(Cup, Plate).", "breakfast", Name.Entity),
        ("observe on(Cup, lab.Desk).", "lab.Desk", Name.Class),
        ("observe on(Cup, lab.desk-1).", "lab.desk-1", Name.Variable),
        ("observe on(A, B) and not in(A, B).", "and", Operator),
        ("observe on(A, B) and not in(A, B).", "in", Name.Builtin),
        ("require not (on(A, B)).", "not", Operator),
        ("observe not-placed(A, B).", "not-placed", Name.Function),
        ("in room r133, weekday { observe on(A, B). }", "in", Keyword.Declaration),
        ("in room r133, weekday { observe on(A, B). }", "r133", Name.Namespace),
        ("in room r133, weekday { observe on(A, B). }", "weekday", Keyword.Constant),
        ("in room r133, weekday { observe on(A, B). }", "observe", Keyword.Declaration),
        ("in from 08:00 to 12:00 { }", "08:00", Number),
        ('import "office/desk" as lab.', '"office/desk"', String),
        ('import "office/desk" as lab.', "lab", Name.Namespace),
        ("defaults { reach: 75 cm }.", "reach", Name.Attribute),
        ("relation r(a, b) { angle: normal(90 deg, 3 deg) }.", "normal", Name.Function.Magic),
        ("relation r(a, b) { converse: left-of }.", "left-of", Name.Builtin),
        ("relation r(a, b) { converse: s }.", "s", Name.Function),
        ("where Cup given on(Cup, Desk) at 09:30?", "given", Keyword),
        ("where Cup in room r133?", "in", Keyword),
        ("observe on(A, B)\nbelieve on(A, B).", "believe", Keyword.Declaration),
        ("observe on(A, (\nbelieve on(A, B).", "believe", Keyword.Declaration),
    ],
)
def test_a_word_is_told_by_where_it_stands(text, word, kind):
    assert (word, kind) in tokens(text)


def test_every_word_that_begins_a_statement_is_shown_so():
    for word in words_of(vocabulary().of(Kind.STATEMENT)):
        assert tokens(f"{word} ")[0] == (word, Keyword.Declaration)


def test_every_word_and_sign_of_the_grammar_is_in_the_vocabulary():
    kinds = vocabulary().kinds
    assert set(kinds) == set(spellings())
    assert keywords() <= {word for kind in Kind for word in words_of(vocabulary().of(kind))}
    inside = {terminal for each in vocabulary().statements.values() for terminal in each}
    assert set(spellings()) <= inside | set(vocabulary().statements) | {"DOT", "QMARK"}


def test_the_kinds_follow_from_the_grammar():
    kinds = vocabulary().kinds
    assert {"WHERE", "IN", "SCENE"} <= set(vocabulary().of(Kind.STATEMENT))
    assert set(vocabulary().of(Kind.UNIT)) == {"UNIT", "PERCENT"}
    assert set(vocabulary().of(Kind.OPERATOR)) == {"AND", "OR", "NOT", "IFF", "TIMES", "PLUSMINUS"}
    assert set(vocabulary().of(Kind.DENSITY)) == {"NORMAL", "UNIFORM", "MIX"}
    assert kinds["CONVERSE"] is Kind.FIELD
    assert kinds["WRT"] is Kind.WORD
    assert kinds["FRAME"] is Kind.CONSTANT
    assert vocabulary().beginnings == set(vocabulary().statements) - {
        "WHERE",
        "PROB",
        "EXPLAIN",
        "VIEWS",
        "LANDMARKS",
        "SAMPLE",
        "CHECK",
    }


def test_built_in_relations_are_those_of_the_core():
    assert {"left-of", "on", "between"} <= set(builtin_relations())
    assert set(tokens("observe " + " ∧ ".join(f"{one}(A, B)" for one in builtin_relations()))) >= {
        (one, Name.Builtin) for one in builtin_relations()
    }


@pytest.mark.parametrize(
    "path", [*(CORPUS / "accepted").glob("*.qsr"), *SHIPPED.rglob("*.qsr")], ids=lambda path: path.name
)
def test_no_word_of_a_program_is_left_without_a_kind(path):
    kinds = {kind for _, kind in tokens(path.read_text(encoding="utf-8-sig"))}
    assert Error not in kinds
    assert Text not in kinds


@given(st.text(st.sampled_from('scene(A, b: C) ⇔ .?{}|::0.3 cm "#\n\tßé😀in') | st.characters(codec="utf-8")))
def test_no_character_is_lost_whatever_is_typed(text):
    lexer = QSRLexer(stripnl=False, ensurenl=False)
    shown = text.replace("\r\n", "\n").replace("\r", "\n").removeprefix("\ufeff")
    assert "".join(value for _, value in lexer.get_tokens(text)) == shown


def test_every_ink_has_a_colour():
    assert set(TOKENS) == set(Ink)
    styled = {kind for kind, style in DarkStyle if style["color"]}
    assert set(TOKENS.values()) <= styled
    assert "\x1b[" in highlight(FIG_2, QSRLexer(), TerminalTrueColorFormatter(style=DarkStyle))


def test_importing_it_reads_no_grammar():
    program = (
        "import qsrlang.editor.highlighting, qsrlang.language.grammar as grammar;"
        "print(grammar.reader.cache_info().currsize, grammar.spellings.cache_info().currsize)"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["0", "0"]


def test_pygments_knows_the_files_by_their_ending():
    assert QSRLexer.name == "qsr"
    assert QSRLexer.filenames == ("*.qsr",)
    assert QSRLexer.mimetypes == ("text/x-qsr",)
