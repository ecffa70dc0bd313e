"""Whatever a file holds, only diagnostics come out, and each can be shown."""

import json
import unicodedata
from itertools import cycle
from pathlib import Path
from threading import Event, Thread

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.language.diagnostics import Diagnostic, Label
from qsrlang.language.parser import MAX_FINDINGS, parse
from qsrlang.language.source import MAX_SOURCE_BYTES, Source, Span, read_source
from qsrlang.relations.build import build_graph
from qsrlang.relations.imports import MAX_FILES
from qsrlang.relations.layers import MAX_CONTEXTS

MEGABYTE = 1_000_000
# Controls, invisible marks, surrogates, and separators that end a line.
UNSHOWN = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}
REORDERING = "\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"


def codes(text):
    """Return the codes that a text gives; showing each finding must not fail."""
    found = build_graph(Source("<bad>", text)).diagnostics
    for finding in found:
        shown(finding)
    return [finding.code for finding in found]


def shown(finding):
    json.dumps(finding.to_json()).encode("utf-8")
    return finding.render()


def write(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def findings_of(path):
    return [(one.code, shown(one)) for one in build_graph(read_source(path)).diagnostics]


@pytest.mark.parametrize(
    "text",
    [
        "observe " + "(" * MEGABYTE + ".",
        "observe " + "(" * (MEGABYTE // 2) + "left-of(A, B)" + ")" * (MEGABYTE // 2) + ".",
        "observe " + "((a(A, B)) ∧ " * 1000 + "a(A, B)" + ")" * 1000 + ".",
    ],
)
def test_deep_parentheses_give_one_finding(text):
    assert codes(text) == ["Q102"]


@pytest.mark.parametrize(
    "text", [")" * MEGABYTE, "¬" * MEGABYTE, "{" * 100_000, "." * 5_000, '"' * MEGABYTE, "#" * MEGABYTE]
)
def test_a_megabyte_of_one_sign_gives_findings_only(text):
    assert set(codes(text)) <= {"Q101", "Q102", "Q104", "Q105", "Q106"}


def test_a_hundred_thousand_statements_are_read():
    text = "dynamic Cup, Plate.\n" + "language 1.\n" * 99_998 + "observe left-of(Cup, Plate).\n"
    built = build_graph(Source("<long>", text))
    assert built.diagnostics == ()
    assert len(built.library.documents[-1].statements) == 100_000
    assert len(built.graph.choices) == 1


def test_of_a_hundred_thousand_mistakes_a_bounded_number_is_told():
    found = parse("}\n" * 100_000).diagnostics
    assert len(found) == MAX_FINDINGS + 1
    assert found[-1].code == "Q107"
    assert str(MAX_FINDINGS) in shown(found[-1])


def test_contexts_are_bounded():
    one = "in room r{} {{ believe left-of(Cup, Plate). }}\n"
    head = "dynamic Cup, Plate.\n"
    assert codes(head + "".join(one.format(number) for number in range(MAX_CONTEXTS))) == []
    assert codes(head + "".join(one.format(number) for number in range(MAX_CONTEXTS + 1))) == ["Q108"]


def test_a_statement_of_many_words_is_read():
    classes = ", ".join(f"C{number}" for number in range(20_000))
    assert parse(f"dynamic {classes}.").diagnostics == ()


@pytest.mark.parametrize("odd", ["\0", "\ud800", "\udfff", "\x1b[31m", "\x7f", "\ufffe", "\U000e0001"])
def test_odd_characters_are_refused_where_they_stand(odd):
    (finding,) = parse(f"dynamic Cup{odd}, Plate.").diagnostics
    assert finding.code == "Q101"
    assert finding.span.column == 12
    assert odd not in shown(finding)


@pytest.mark.parametrize("blank", ["\x0b", "\x1c", "\x85", "\xa0", "\u2003", "\u2028", "\u3000"])
def test_unusual_blanks_lose_nothing(blank):
    """They may be blanks like others, or be refused; what follows them is read."""
    parsed = parse(f"dynamic Cup,{blank}Plate.")
    assert parsed.diagnostics or [one.name.text for one in parsed.document.statements[0].classes] == [
        "Cup",
        "Plate",
    ]


@pytest.mark.parametrize("odd", ["\0", "\ud800", "\x1b[31m", "\u202e"])
def test_odd_characters_in_comments_and_quotes_do_no_harm(odd):
    assert set(codes(f"# {odd}\ndynamic Cup.")) <= {"Q512"}
    found = build_graph(Source("<bad>", f'import "a{odd}.qsr".')).diagnostics
    (finding,) = [one for one in found if one.code != "Q512"]
    assert finding.code == "Q209"
    assert odd not in shown(finding)


@pytest.mark.parametrize("mark", REORDERING)
def test_marks_that_reorder_the_text_are_told(mark):
    (finding,) = parse(f"dynamic Cup. # {mark}\n").diagnostics
    assert (finding.code, finding.is_error, finding.span.column) == ("Q512", False, 16)
    assert mark not in shown(finding)


@pytest.mark.parametrize("end", ["\r\n", "\n", "\r\r\n"])
def test_line_ends_tabs_and_a_byte_order_mark_change_nothing(tmp_path, end):
    text = "dynamic Cup,\n\tPlate.\n# seen\nobserve left-of(Cup,\tPlate).\n"
    path = tmp_path / "a.qsr"
    path.write_bytes(b"\xef\xbb\xbf" + text.replace("\n", end).encode())
    assert findings_of(path) == []
    assert build_graph(read_source(path)).library.documents[-1] == parse(text).document


def test_places_after_windows_line_ends_and_tabs_are_right():
    (finding,) = parse("dynamic Cup.\r\n\tobserve 3 left-of(Cup, Plate).\r\n").diagnostics
    assert (finding.span.line, finding.span.column) == (2, 12)
    lines = shown(finding).splitlines()
    assert lines[3].index("left-of") == lines[4].index("^^^^^^^")


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"dynamic Cup\xe9.", "dynamic Cup.".encode("utf-16")])
def test_what_is_not_utf8_is_told_in_one_line(tmp_path, content):
    path = tmp_path / "a.qsr"
    path.write_bytes(content)
    with pytest.raises(qsr.FileError, match="UTF-8"):
        read_source(path)
    importing = write(tmp_path, "b.qsr", 'import "a.qsr".')
    assert [code for code, _ in findings_of(importing)] == ["Q209"]


def test_a_large_file_is_refused_unread(tmp_path):
    path = tmp_path / "a.qsr"
    with path.open("wb") as file:
        file.truncate(MAX_SOURCE_BYTES + 1)
    with pytest.raises(qsr.FileError, match="larger"):
        read_source(path)


def test_a_folder_and_a_file_that_may_not_be_read_are_refused(tmp_path):
    (tmp_path / "folder.qsr").mkdir()
    importing = write(tmp_path, "b.qsr", 'import "folder.qsr".')
    assert [code for code, _ in findings_of(importing)] == ["Q209"]
    with pytest.raises(qsr.FileError, match="directory"):
        read_source(tmp_path / "folder.qsr")


def test_imports_may_form_a_cycle_of_any_length(tmp_path):
    for number in range(20):
        write(tmp_path, f"f{number}.qsr", f'import "f{(number + 1) % 20}.qsr".\ndynamic C{number}.')
    built = build_graph(read_source(tmp_path / "f7.qsr"))
    assert built.diagnostics == ()
    assert set(built.graph.classes) == {f"C{number}" for number in range(20)}


def test_a_chain_of_imports_is_bounded(tmp_path):
    for number in range(MAX_FILES + 3):
        write(tmp_path, f"f{number}.qsr", f'import "f{number + 1}.qsr".')
    (code, text) = findings_of(tmp_path / "f0.qsr")[-1]
    assert code == "Q209"
    assert str(MAX_FILES) in text


def test_a_cycle_under_prefixes_is_refused(tmp_path):
    write(tmp_path, "a.qsr", 'import "b.qsr" as b.')
    write(tmp_path, "b.qsr", 'import "a.qsr" as a.')
    assert [code for code, _ in findings_of(tmp_path / "a.qsr")] == ["Q209"]


@pytest.mark.parametrize("target", ["../secret.qsr", "sub/../../secret.qsr", "./../secret.qsr", "{absolute}"])
def test_imports_do_not_lead_out_of_the_folder(tmp_path, target):
    secret = write(tmp_path, "secret.qsr", "dynamic Diary.")
    inside = write(tmp_path, "home/a.qsr", f'import "{target.format(absolute=secret)}".')
    write(tmp_path, "home/sub/b.qsr", "")
    ((code, text),) = findings_of(inside)
    assert code == "Q209"
    assert "outside" in text


def test_links_do_not_lead_out_of_the_folder(tmp_path):
    write(tmp_path, "secret.qsr", "dynamic Diary.")
    inside = write(tmp_path, "home/a.qsr", 'import "link.qsr".')
    (tmp_path / "home" / "link.qsr").symlink_to(tmp_path / "secret.qsr")
    assert [code for code, _ in findings_of(inside)] == ["Q209"]
    (tmp_path / "home" / "folder").symlink_to(tmp_path, target_is_directory=True)
    inside.write_text('import "folder/secret.qsr".')
    assert [code for code, _ in findings_of(inside)] == ["Q209"]


def test_folders_named_by_the_environment_may_be_imported_from(tmp_path, monkeypatch):
    write(tmp_path, "lib/b.qsr", "dynamic Cup.")
    inside = write(tmp_path, "home/a.qsr", 'import "../lib/b.qsr".')
    monkeypatch.setenv("QSR_PATH", str(tmp_path / "lib"))
    assert findings_of(inside) == []
    monkeypatch.setenv("QSR_PATH", str(tmp_path / "other"))
    assert [code for code, _ in findings_of(inside)] == ["Q209"]


def test_a_link_that_leads_to_itself_is_refused(tmp_path):
    (tmp_path / "loop.qsr").symlink_to(tmp_path / "loop.qsr")
    importing = write(tmp_path, "a.qsr", 'import "loop.qsr".')
    assert [code for code, _ in findings_of(importing)] == ["Q209"]


def test_a_link_inside_the_folder_is_followed_and_read_once(tmp_path):
    write(tmp_path, "b.qsr", "dynamic Cup.")
    (tmp_path / "c.qsr").symlink_to(tmp_path / "b.qsr")
    importing = write(tmp_path, "a.qsr", 'import "b.qsr". import "c.qsr".')
    assert findings_of(importing) == []


@pytest.mark.parametrize(
    "target", ["office/../../x", "../../../etc/passwd", "/etc/passwd", "core\\0", "n" * 5000, "", "."]
)
def test_odd_names_of_shipped_files_are_refused(target):
    assert codes(f'import "{target}".') == ["Q209"]


@pytest.mark.parametrize(
    "target", ["n" * 5000 + ".qsr", "a\0.qsr", "\ud800.qsr", ".qsr", "/.qsr", "a/" * 3000 + "b.qsr"]
)
def test_odd_paths_are_refused(target):
    assert codes(f'import "{target}".') == ["Q209"]


def test_findings_show_the_text_that_was_read_whatever_becomes_of_the_file(tmp_path):
    path = write(tmp_path, "a.qsr", "dynamic Cup.\nobserve left-of(Cup, Plaet).\n")
    built = build_graph(read_source(path))
    path.write_text("")
    (finding,) = built.diagnostics
    assert "observe left-of(Cup, Plaet)." in shown(finding)
    path.unlink()
    assert "observe left-of(Cup, Plaet)." in shown(finding)


def test_a_file_that_is_replaced_while_it_is_read_gives_one_of_its_states(tmp_path):
    """A writer that puts whole files in place is never seen half way."""
    path = write(tmp_path, "a.qsr", "")
    states = [f"dynamic C{number}.\n" * (1 + 400 * number) for number in range(4)]
    stop = Event()
    writer = Thread(target=replace_until, args=(stop, path, states))
    writer.start()
    try:
        seen = {read_source(path).text for _ in range(200)}
    finally:
        stop.set()
        writer.join()
    assert seen <= {"", *states}


def replace_until(stop, path, states):
    for text in cycle(states):
        if stop.is_set():
            return
        path.with_suffix(".new").write_text(text)
        path.with_suffix(".new").replace(path)


def test_an_imported_file_that_vanishes_is_told(tmp_path, monkeypatch):
    path = write(tmp_path, "a.qsr", 'import "b.qsr".')
    target = write(tmp_path, "b.qsr", "dynamic Cup.")
    resolve = Path.resolve

    def vanish(self, strict=False):
        found = resolve(self, strict)
        if self.name == "b.qsr":
            target.unlink(missing_ok=True)
        return found

    monkeypatch.setattr(Path, "resolve", vanish)
    assert [code for code, _ in findings_of(path)] == ["Q209"]


def test_an_imported_file_that_changes_between_two_imports_is_read_once(tmp_path):
    write(tmp_path, "b.qsr", "dynamic Cup.")
    path = write(
        tmp_path, "a.qsr", 'import "b.qsr".\nimport "./b.qsr".\ndynamic Plate. observe left-of(Cup, Plate).'
    )
    assert findings_of(path) == []


anything = st.text(st.characters(codec=None), max_size=20)


@given(anything, st.data())
@settings(max_examples=60)
def test_any_finding_about_any_text_can_be_shown(text, data):
    """Places may be anywhere, the end of the text too; names and notes may hold anything."""
    source = Source(data.draw(anything), text)
    places = st.integers(0, len(text)).flatmap(
        lambda start: st.tuples(st.just(start), st.integers(start, len(text) + 1))
    )
    spans = [Span(source, *data.draw(places)) for _ in range(3)]
    labels = tuple(Label(span, data.draw(anything)) for span in spans[1:])
    finding = Diagnostic(
        "Q101", data.draw(anything), spans[0], data.draw(anything), data.draw(anything), labels
    )
    rendered = shown(finding)
    rendered.encode("utf-8")
    assert {unicodedata.category(one) for one in rendered.replace("\n", "")}.isdisjoint(UNSHOWN)
