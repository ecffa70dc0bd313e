from hypothesis import given
from hypothesis import strategies as st

from qsrlang.language.printing.layout import Break, Close, Open, lay_out
from qsrlang.language.printing.sentence import Remark

CALL = [
    "f(",
    Open(),
    Break("", tight=True),
    "one,",
    Break(),
    "two",
    Break("", closing=True),
    Close.GROUP,
    ").",
]
FILLED = [CALL[0], Open(filled=True), *CALL[2:-1], ") and so on."]


def test_a_group_stays_on_its_line_if_it_fits_with_what_follows():
    assert lay_out(CALL, width=12) == "f(one, two)."
    assert lay_out(CALL, width=11) == "f(\n    one,\n    two\n)."


def test_lines_are_indented_from_where_the_statement_is():
    assert lay_out(CALL, indent=4, width=15) == "f(\n        one,\n        two\n    )."
    assert lay_out(CALL, indent=4, width=16) == "f(one, two)."


def test_a_filled_group_ends_only_the_lines_that_must_end():
    assert lay_out(FILLED, width=22) == "f(one, two) and so on."
    assert lay_out(FILLED, width=21) == "f(\n    one, two\n) and so on."
    assert lay_out(FILLED, width=11) == "f(\n    one,\n    two\n) and so on."


def test_an_aligned_group_begins_its_lines_below_its_first():
    parts = ["static ", Open(None, broken=True), "A,", Break(), "B", Close.GROUP, "."]
    assert lay_out(parts) == "static A,\n       B."


def test_a_comment_ends_its_line_and_those_of_the_groups_around_it():
    remarks = (Remark("# behind", True, False), Remark("# alone", False, True))
    inner = [Open(), Break("", tight=True), "x", Break(remarks=remarks), "y", Close.GROUP]
    assert lay_out(["a", Open(), Break(), *inner, Close.GROUP]) == (
        "a\n    \n        x  # behind\n\n        # alone\n        y"
    )


@given(st.lists(st.integers(1, 12), min_size=1, max_size=30), st.integers(12, 40), st.booleans())
def test_no_line_is_wider_than_it_may_be_if_every_word_fits(lengths, width, filled):
    words = ["w" * length for length in lengths]
    parts = [Open(0, filled=filled)]
    for word in words:
        parts += [word, Break()]
    text = lay_out([*parts[:-1], Close.GROUP], width=width)
    assert text.split() == words
    assert all(len(line) <= width for line in text.splitlines())
