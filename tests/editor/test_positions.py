"""Places as editors count them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lsprotocol.types import Position, PositionEncodingKind

from qsrlang.editor.positions import ruler
from qsrlang.language.source import Source, Span

TEXT = "Tisch-Größe 😀\r\nzwei\rdrei\u2028vier\n"


@pytest.mark.parametrize(
    ("encoding", "after_the_face"),
    [(PositionEncodingKind.Utf16, 14), (PositionEncodingKind.Utf8, 18), (PositionEncodingKind.Utf32, 13)],
)
def test_units_depend_on_the_encoding(encoding, after_the_face):
    end = TEXT.index("\r\n")
    assert ruler(TEXT, encoding).position(end) == Position(0, after_the_face)


def test_lines_end_as_the_protocol_says():
    """Not at a line separator, which Python's splitlines counts."""
    assert ruler(TEXT).position(TEXT.index("zwei")) == Position(1, 0)
    assert ruler(TEXT).position(TEXT.index("drei")) == Position(2, 0)
    assert ruler(TEXT).position(TEXT.index("vier")) == Position(2, 5)
    assert ruler(TEXT).position(len(TEXT)) == Position(3, 0)


def test_beyond_the_end():
    assert ruler(TEXT).offset(Position(0, 99)) == TEXT.index("\r\n")
    assert ruler(TEXT).offset(Position(99, 0)) == len(TEXT)
    assert ruler("").range(Span(Source("", ""), 0, 1)).end == Position(0, 0)


@given(st.text(), st.sampled_from(PositionEncodingKind), st.data())
def test_there_and_back(text, encoding, data):
    offset = data.draw(st.integers(0, len(text)))
    measure = ruler(text, encoding)
    back = measure.offset(measure.position(offset))
    inside_a_line_end = text[offset - 1 : offset + 1] == "\r\n"
    assert back == offset - inside_a_line_end


@given(st.text(st.sampled_from("aß😀\n\r")), st.sampled_from(PositionEncodingKind))
def test_places_keep_their_order(text, encoding):
    measure = ruler(text, encoding)
    places = [measure.position(offset) for offset in range(len(text) + 1)]
    assert places == sorted(places, key=lambda place: (place.line, place.character))
