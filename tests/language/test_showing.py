"""Rendering, fixing, and writing whole."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.files import write_whole
from qsrlang.language.diagnostics import Diagnostic, Diagnostics, Edit, Label, Severity
from qsrlang.language.fixing import edited, sure_edits
from qsrlang.language.rendering import MAX_LINE, visible
from qsrlang.language.source import Source, Span


def span(text, word, source=None):
    source = source or Source("f.qsr", text)
    start = text.index(word)
    return Span(source, start, start + len(word))


def test_marks_on_one_line_share_it_and_gutters_are_as_wide_as_the_widest_number():
    text = "a b c\n" * 9 + "d e f\n"
    source = Source("f.qsr", text)
    labels = (Label(span(text, "f", source), "third"), Label(span(text, "b", source), "elsewhere"))
    finding = Diagnostic("Q101", "odd", span(text, "d", source), "first", "write g", labels)
    assert finding.render().splitlines() == [
        "error[Q101]: odd",
        "   --> f.qsr:10:1",
        "   |",
        "10 | d e f",
        "   | ^ first",
        "   |     - third",
        "   ::: f.qsr:1:3",
        "   |",
        " 1 | a b c",
        "   |   - elsewhere",
        "    = help: write g",
    ]


def test_wide_characters_take_two_columns_and_unseen_ones_are_shown():
    text = "杯子 x \x00\ud800\u202e\ty"
    shown = Diagnostic("Q101", "odd", span(text, "x"), "here").render().splitlines()
    assert shown[3] == "1 | 杯子 x \ufffd\ufffd\ufffd y"
    assert shown[4] == "  |      ^ here"
    assert visible("a\x1b[31m\ud800") == "a\ufffd[31m\ufffd"


def test_a_long_line_is_cut_around_the_place():
    text = "a" * 5000 + "X" + "b" * 5000
    shown = Diagnostic("Q101", "odd", span(text, "X")).render().splitlines()
    assert len(shown[3]) <= MAX_LINE + 4
    assert shown[3][shown[4].index("^")] == "X"


def test_findings_print_as_they_are_shown():
    parsed = qsr.parse("static A { size: 1 × 2 cm }.\nstatic B")
    assert str(parsed.diagnostics).count("error[Q") == 2
    assert isinstance(parsed.diagnostics.errors, Diagnostics)


def test_sure_edits_are_made_and_unsure_or_overlapping_ones_are_not():
    text = "one two three"
    source = Source("f.qsr", text)

    def finding(word, new, sure=True):
        place = span(text, word, source)
        return Diagnostic("Q101", "odd", place, edits=(Edit(place, new),), sure=sure)

    findings = [
        finding("one", "1"),
        finding("two", "2", sure=False),
        finding("three", "3"),
        finding("three", "4"),
    ]
    edits = sure_edits(source, findings)
    assert edited(text, edits) == "1 two 3"
    assert sure_edits(Source("other", text), findings) == ()


@given(st.text(max_size=30), st.data())
def test_edits_change_their_places_only(text, data):
    cuts = sorted(data.draw(st.lists(st.integers(0, len(text)), min_size=2, max_size=6)))
    source = Source("f", text)
    places = [Span(source, low, high) for low, high in zip(cuts[::2], cuts[1::2], strict=False)]
    edits = [Edit(place, f"<{number}>") for number, place in enumerate(places)]
    expected, position = "", 0
    for place, edit in zip(places, edits, strict=True):
        expected += text[position : place.start] + edit.text
        position = place.end
    assert edited(text, edits) == expected + text[position:]


def test_a_finding_is_plain_data_too():
    text = "static A"
    (finding,) = qsr.parse(text).diagnostics
    data = finding.to_json()
    assert (data["code"], data["severity"], data["line"], data["column"]) == (
        "Q104",
        Severity.ERROR.value,
        1,
        9,
    )
    assert data["edits"] == [{"file": "<text>", "line": 1, "column": 9, "length": 0, "text": "."}]


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    path = tmp_path / "a.qsr"
    write_whole(path, "Tisch-Größe")
    path.chmod(0o640)
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert path.stat().st_mode & 0o777 == 0o640
    link = tmp_path / "link.qsr"
    link.symlink_to(path)
    write_whole(link, "through")
    assert link.is_symlink()
    assert path.read_text() == "through"
    with pytest.raises(qsr.FileError, match="cannot be written"):
        write_whole(tmp_path / "nowhere" / "a.qsr", "x")
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["a.qsr", "link.qsr"]
