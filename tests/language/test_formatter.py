import re
from itertools import cycle

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from language_strategies import documents

from qsrlang.language.parser import MAX_NESTING, parse
from qsrlang.language.printing.formatter import format_source
from qsrlang.language.printing.layout import WIDTH
from qsrlang.language.printing.printer import print_document
from qsrlang.language.printing.spelling import SIGNS
from qsrlang.language.source import Source
from qsrlang.relations.imports import find_knowledge, read_source, shipped_knowledge

SPELLINGS = sorted(SIGNS)
WORDS = re.compile(
    r'"[^"\n]*"|#[^\n]*|::|<=>|\+-|\d{1,2}:\d\d|\d+(?:\.\d+)?(?:[eE][+-]?\d+)?'
    r"|[^\W\d]\w*(?:-\w+)*(?:\.[^\W\d]\w*(?:-\w+)*)*|\S"
)
BETWEEN = [
    *(" ", "   ", "\t", "\n", "\r\n", "\n\n\n\n"),
    *(" # behind\n", "\n# alone\n", "\n\n# after a blank line\r\n", "#\n\n#two\n"),
    *(" ## doc behind\n", "\n## doc\n", "# a\x0b## b\n", "# \" ( { } . ' \n"),
]
SCRAPS = [*'.,:()|{}~∧¬⇔×?"# \r\n\x0b\u2028', "\r\n", "\n\n\n", "##", "# c\n", "## d\n", '# "\n']
SCRAPS += ["in weekday {", "in x {", "}.", "\n}\n", "scene(A, B)", "iff", "and", "elsewhere", "3 x "]
SCRAPS += ["observe a(B, C).", "a(B, C)", "a(B, C).", "believe ", "observe ", "0.5 ::", "where A?"]
SCRAPS += ["static A, B.", "A { size: 3 cm x 4 cm }", "oops.", "oops", "language 1."]


def formatted(text, spelling="unicode"):
    return format_source(Source("<text>", text), spelling)


def comments(text):
    marks = re.findall(r'"[^"\n]*"|#[^\n]*', text)
    return [mark.rstrip() for mark in marks if mark.startswith("#")]


def agree(text):
    """Formatting keeps the document, what is wrong with it, and all comments; done twice, it changes nothing."""
    read = parse(text)
    for spelling in SPELLINGS:
        result = formatted(text, spelling)
        again = parse(result)
        assert again.document == read.document
        assert [one.code for one in again.diagnostics] == [one.code for one in read.diagnostics]
        assert comments(result) == comments(text)
        assert formatted(result, spelling) == result
        assert "\r\n" not in result


@settings(max_examples=100)
@given(documents, st.lists(st.sampled_from(BETWEEN), min_size=1, max_size=20), st.sampled_from(SPELLINGS))
def test_comments_and_line_ends_may_stand_between_any_two_words(document, between, spelling):
    words = WORDS.findall(print_document(document, spelling))
    ends = ["\n" if word.startswith("#") else "" for word in words]
    text = "".join(word + end + gap for word, end, gap in zip(words, ends, cycle(between), strict=False))
    assert parse(text).diagnostics == ()
    agree(text)


@given(st.lists(st.sampled_from(SCRAPS), max_size=15).map("".join))
def test_texts_with_mistakes_keep_their_meaning_too(text):
    agree(text)


@settings(max_examples=50)
@given(documents)
def test_what_is_printed_is_formatted_already_and_both_spellings_mean_the_same(document):
    text = print_document(document)
    assert formatted(text) == text
    assert parse(formatted(text, "ascii")).document == document


@pytest.mark.parametrize("name", shipped_knowledge())
def test_shipped_knowledge(name):
    text = read_source(find_knowledge(name)).text
    agree(text)
    assert all(len(line) <= WIDTH for line in formatted(text).splitlines() if "#" not in line)


FORMATTED = {
    "blanks and signs": (
        "surface   Desk{size:150cm x 80 cm,height:75cm}.observe 85*left-of(left:Cup,Desk)&!on( Cup,Desk ).",
        "surface Desk { size: 150 cm × 80 cm, height: 75 cm }.\n"
        "observe 85 × left-of(left: Cup, Desk) ∧ ¬on(Cup, Desk).\n",
    ),
    "numbers and units stay as they were typed": (
        "landmark desk-1:Desk at(1.20m,280 cm)facing - 90.0deg+-(2 cm,2 cm,3 deg).",
        "landmark desk-1 : Desk at (1.20 m, 280 cm) facing -90.0 deg ± (2 cm, 2 cm, 3 deg).\n",
    ),
    "a scene that fits stays on its line": (
        "scene breakfast(Plate, Cup)⇔right-of(Cup, Plate)∧\nclose-to(Cup, Plate).",
        "scene breakfast(Plate, Cup) ⇔ right-of(Cup, Plate) ∧ close-to(Cup, Plate).\n",
    ),
    "a scene whose atoms began on a line of their own keeps them there": (
        "scene(Plate, Cup) ⇔\n right-of(Cup, Plate) ∧ close-to(Cup, Plate).",
        "scene(Plate, Cup) ⇔\n    right-of(Cup, Plate) ∧\n    close-to(Cup, Plate).\n",
    ),
    "a scene too long for a line": (
        "scene(Monitor, Keyboard, Laptop, Cup) ⇔ in-front-of(Keyboard, Monitor) ∧ left-of(Laptop, Keyboard) ∧"
        " (right-of(Cup, Keyboard) ∨ ¬close-to(Cup, Keyboard)).",
        "scene(Monitor, Keyboard, Laptop, Cup) ⇔\n"
        "    in-front-of(Keyboard, Monitor) ∧\n"
        "    left-of(Laptop, Keyboard) ∧\n"
        "    (right-of(Cup, Keyboard) ∨ ¬close-to(Cup, Keyboard)).\n",
    ),
    "fields one per line where they do not fit": (
        "relation beside(referent,relatum){angle:mix(normal(90 deg,15 deg),normal(-90 deg,15 deg)),"
        "distance:uniform(0 cm,30 cm)}.",
        "relation beside(referent, relatum) {\n"
        "    angle: mix(normal(90 deg, 15 deg), normal(-90 deg, 15 deg)),\n"
        "    distance: uniform(0 cm, 30 cm)\n"
        "}.\n",
    ),
    "classes one per line if they were written so": (
        "static Printer,\n    Desktop-PC,\nLamp.\ndynamic Cup, Plate,\n    Spoon.",
        "static Printer,\n       Desktop-PC,\n       Lamp.\ndynamic Cup, Plate, Spoon.\n",
    ),
    "alternatives below each other if they were written so or do not fit": (
        "believe 0.5::left-of(A,B)\n|right-of(A,B).\n"
        "believe 0.15 :: left-of(Cup, Keyboard) ∧ close-to(Cup, Keyboard)"
        " | 0.75 :: right-of(Cup, Keyboard) | elsewhere.",
        "believe 0.5 :: left-of(A, B) |\n"
        "        right-of(A, B).\n"
        "believe 0.15 :: left-of(Cup, Keyboard) ∧ close-to(Cup, Keyboard) |\n"
        "        0.75 :: right-of(Cup, Keyboard) |\n"
        "        elsewhere.\n",
    ),
    "contexts are blocks, without a full stop behind them": (
        "in room r133,from 08:00 to 12:00{believe on(A,B).\n\n\n\nobserve 2 x on(A,B).}.in weekday{}",
        "in room r133, from 08:00 to 12:00 {\n"
        "    believe on(A, B).\n"
        "\n"
        "    observe 2 × on(A, B).\n"
        "}\n"
        "in weekday { }\n",
    ),
    "comments stay with what they stand at": (
        "\n\n# first\n\n\n## doc\nstatic A, # why\nB. # behind\n# last",
        "# first\n\n## doc\nstatic A,  # why\n       B.  # behind\n# last\n",
    ),
    "a comment waits for the next place where a line may end": (
        "static A { size: 3 cm # width\n × 4 cm, on: B # support\n }.",
        "static A {\n    size: 3 cm × 4 cm,  # width\n    on: B  # support\n}.\n",
    ),
    "a doc comment inside a statement does not become that of the next": (
        "observe a(A, B) ## no doc\n.\nobserve b(A, B).",
        "observe a(A, B)  ## no doc\n.\nobserve b(A, B).\n",
    ),
    "what cannot be read stays as it was typed": (
        'observe   a(A B) .  oops   "  .\nobserve   b(A,B).',
        'observe   a(A B) .  oops   "  .\nobserve b(A, B).\n',
    ),
    "nothing": ("\n \n", ""),
}


@pytest.mark.parametrize(("text", "expected"), FORMATTED.values(), ids=FORMATTED)
def test_layout(text, expected):
    assert formatted(text) == expected
    agree(text)


def test_the_paper_s_scene_is_left_as_it_is_in_the_shipped_file():
    text = read_source(find_knowledge("office/desk")).text
    scene = text[text.index("## Fig. 2.") : text.index("## Section II.A")]
    assert scene in formatted(text)


def test_many_items_fill_their_lines():
    members = ", ".join(f"Thing-{number}" for number in range(40))
    first, *inner, last = formatted(f"scene({members}) ⇔ on(Thing-1, Thing-2).").splitlines()
    assert (first, last) == ("scene(", ") ⇔ on(Thing-1, Thing-2).")
    assert all(WIDTH - 12 < len(line) <= WIDTH for line in inner[:-1])
    assert len(inner) == 5


def test_names_longer_than_a_line_stand_on_lines_of_their_own():
    name = "A" * WIDTH
    assert formatted(f"observe on({name}, {name}).") == f"observe on(\n    {name},\n    {name}\n).\n"


def test_parentheses_as_deep_as_can_be_read_are_formatted():
    text = "require " + "(" * (MAX_NESTING - 1) + "a(B,C)" + " ∧ d(E,F)) ∨ g(H,I)" * (MAX_NESTING - 1) + "."
    assert parse(text).diagnostics == ()
    agree(text.replace("))", "))\n# deep\n"))


def test_the_ascii_spelling():
    text = "scene(A) ⇔ ¬a(A, B) ∨ (¬b(A, B) ∧ c(A, B)). static A { size: 1 m * 2 m }."
    assert formatted(text, "ascii") == (
        "scene(A) <=> not a(A, B) or (not b(A, B) and c(A, B)).\nstatic A { size: 1 m x 2 m }.\n"
    )
