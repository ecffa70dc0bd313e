import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from language_strategies import documents, queries

from qsrlang.language.parser import parse, parse_query
from qsrlang.language.printing.amounts import amount_text, number_text, quantity_text
from qsrlang.language.printing.printer import print_document, print_formula, print_query, print_statement
from qsrlang.language.printing.spelling import SIGNS
from qsrlang.language.source import Source, Span
from qsrlang.language.syntax import Dimension, Quantity
from qsrlang.relations.imports import find_knowledge, read_source, shipped_knowledge

SPELLINGS = sorted(SIGNS)
NOWHERE = Span(Source("<drawn>", ""), 0, 0)

CANONICAL = """\
language 1.

import "office/desk".
import "lab.qsr" as lab.

defaults { reach: 75 cm, strength: 10, patience: 1 h, part: 50 % }.

## A doc comment
##
## of three lines.
surface Desk { size: 150 cm × 80 cm, height: 75 cm }.
static Monitor { size: 55 cm × 20 cm × 40 cm, front: yes, on: Desk }, Printer.

landmark monitor-1 : Monitor at (120 cm, 3 m, 74 cm) facing -90 deg ± (2 cm, 2 cm, 3 deg).

scene breakfast(left: Cup, Plate) ⇔ right-of(left, Plate) ∧ (on(left, Plate) ∨ ¬in(left, Plate)).

believe 0.15 :: left-of(Cup, Keyboard) | 0.75 :: right-of(Cup, Keyboard) wrt intrinsic | elsewhere.

observe right-of(Cup, Keyboard).
observe 449 × right-of(Mouse, Keyboard) ~ normal((-7 cm, -31 cm), (12 cm, 20 cm), 0.12).

observe 12 × breakfast.

require ¬(close-to(Cup, Laptop) ∧ lab.left-of(Cup, Laptop)).
require 0.9 :: ¬behind-of(Mug, Monitor).

relation beside(referent, relatum) {
    angle: mix(normal(90 deg, 15 deg), uniform(-100 deg, -80 deg), any),
    distance: uniform(0 cm, 30 cm),
    converse: beside,
    disjoint: (left-of, right-of),
    symmetric: yes
}.
relation inside(referent, relatum) { region: inside, disjoint: on }.
relation says-nothing(referent, relatum) { symmetric: no }.

in room r133, from 08:00 to 24:00, weekday {
    believe 0.7 :: right-of(Keyboard, Monitor) | 0.3 :: in-front-of(Keyboard, Monitor).

    ## Inside.
    observe 12 × breakfast.
}

in weekend { }
"""
QUERIES = [
    "where left: Cup wrt Keyboard given left-of(Cup, Keyboard) ∧ ¬on(Cup, Desk) in room r133, weekend at 09:30?",
    "prob right-of(Cup, Keyboard) given close-to(Cup, Keyboard)?",
    "explain Cup wrt Keyboard?",
    "explain right-of(Cup, Keyboard) wrt intrinsic at 00:00?",
    "views Cup?",
    "landmarks left: Cup in weekday?",
    "sample desk 100?",
    "sample?",
    "check?",
]


@settings(max_examples=60)
@given(documents, st.sampled_from(SPELLINGS))
def test_what_is_printed_reads_back_as_the_same_document(document, spelling):
    parsed = parse(print_document(document, spelling))
    assert parsed.diagnostics == ()
    assert parsed.document == document


@settings(max_examples=60)
@given(queries, st.sampled_from(SPELLINGS))
def test_what_is_printed_reads_back_as_the_same_query(query, spelling):
    assert parse_query(print_query(query, spelling)) == query


def test_every_statement_has_one_canonical_form():
    parsed = parse(CANONICAL)
    assert parsed.diagnostics == ()
    assert print_document(parsed.document) == CANONICAL


def test_a_statement_on_its_own_keeps_its_doc_comment():
    (statement,) = parse("##  Fig. 2.\nscene(A,B)iff left-of( A,B )&on(A,B).").document.statements
    assert print_statement(statement) == "## Fig. 2.\nscene(A, B) ⇔ left-of(A, B) ∧ on(A, B)."
    assert print_statement(statement, "ascii") == "## Fig. 2.\nscene(A, B) <=> left-of(A, B) and on(A, B)."
    assert print_formula(statement.formula) == "left-of(A, B) ∧ on(A, B)"


@pytest.mark.parametrize("text", QUERIES)
def test_every_query_has_one_canonical_form(text):
    assert print_query(parse_query(text)) == text


def test_the_ascii_form_has_no_other_characters_than_the_names():
    ascii_text = print_document(parse(CANONICAL).document, "ascii")
    assert ascii_text.isascii()
    assert parse(ascii_text).document == parse(CANONICAL).document


def test_a_relation_named_elsewhere_is_no_alternative_elsewhere():
    (believe,) = parse("believe (elsewhere(A, B)) ∧ on(A, B) | elsewhere.").document.statements
    assert print_statement(believe) == "believe (elsewhere(A, B)) ∧ on(A, B) | elsewhere."
    query = parse_query("explain elsewhere(A, B)?")
    assert print_query(query) == "explain elsewhere(A, B)?"


@pytest.mark.parametrize("name", shipped_knowledge())
def test_shipped_knowledge_reads_back(name):
    document = parse(read_source(find_knowledge(name)).text).document
    for spelling in SPELLINGS:
        assert parse(print_document(document, spelling)).document == document


@pytest.mark.parametrize(
    ("value", "dimension", "text"),
    [
        (0.08, Dimension.LENGTH, "8 cm"),
        (0.3, Dimension.LENGTH, "30 cm"),
        (3.0, Dimension.LENGTH, "3 m"),
        (0.1 + 0.2, Dimension.LENGTH, "30.000000000000004 cm"),
        (-0.0, Dimension.LENGTH, "-0 cm"),
        (1e-9, Dimension.LENGTH, "1e-9 m"),
        (1.7e308, Dimension.LENGTH, "1.7e308 m"),
        (-math.pi / 2, Dimension.ANGLE, "-90 deg"),
        (math.pi / 16, Dimension.ANGLE, "11.25 deg"),
        (1.0, Dimension.ANGLE, "1 rad"),
        (0.07, Dimension.FRACTION, "7 %"),
        (7200.0, Dimension.DURATION, "2 h"),
        (90.0, Dimension.DURATION, "90 s"),
    ],
)
def test_a_quantity_is_written_in_the_unit_that_makes_it_shortest(value, dimension, text):
    assert amount_text(value, dimension) == text
    assert quantity_text(Quantity(NOWHERE, value, dimension)) == text


def test_a_bare_number_keeps_its_sign():
    assert quantity_text(Quantity(NOWHERE, -2.5, Dimension.NUMBER)) == "-2.5"
    assert number_text(1e22) == "1e22"


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_any_length_and_angle_reads_back_to_the_last_bit(value):
    length, angle = amount_text(value, Dimension.LENGTH), amount_text(value, Dimension.ANGLE)
    (landmark,) = parse(f"landmark a : B at ({length}, 0 m) facing {angle}.").document.statements
    assert (landmark.position[0], landmark.facing) == (value, value)
    assert math.copysign(1.0, landmark.position[0]) == math.copysign(1.0, value)
