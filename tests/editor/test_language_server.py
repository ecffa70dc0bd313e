"""The language server, driven over stdio by a client in another process."""

from pathlib import Path

import pytest
from editor_client import Editor
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from qsrlang.resources import resource_path

LAB = """\
surface Bench { size: 2 m × 1 m, height: 90 cm }.
## Glass, and it breaks.
dynamic Flask { size: 8 cm × 8 cm × 20 cm, on: Bench }.
"""
MAIN = """\
import "lab.qsr" as lab.
## Gefäß 😀 auf dem Tisch.
dynamic Gefäß, Tasse.  /* 😀 */
observe left-of(Gefäß, Tasse) ∧ close-to(Gefäß, Tasse).
observe right-of(lab.Flask, Gefäß).
""".replace("/* 😀 */", "# 😀")
MISTAKES = MAIN.replace("left-of(Gefäß, Tasse)", "left_of(Gefäß, Tase)") + "static Tür { size: 3 }.\n"


@pytest.fixture(scope="module")
def editor(tmp_path_factory):
    folder = tmp_path_factory.mktemp("knowledge")
    (folder / "lab.qsr").write_text(LAB, encoding="utf-8")
    editor = Editor(folder)
    yield editor
    editor.stop()


@pytest.fixture
def main(editor):
    editor.open("main.qsr", MAIN)
    yield editor
    editor.close("main.qsr")


def codes(findings):
    return [(one.code, one.range.start.line, one.range.start.character) for one in findings]


def units(text, mark, encoding="utf-16-le", size=2):
    """The line of a mark, and where it begins there in units of an encoding."""
    before = text[: text.index(mark)].split("\n")
    return len(before) - 1, len(before[-1].encode(encoding)) // size


def test_it_says_what_it_can(editor):
    able = editor.capabilities
    assert able.position_encoding == types.PositionEncodingKind.Utf16
    for feature in (
        able.hover_provider,
        able.completion_provider,
        able.definition_provider,
        able.references_provider,
        able.document_formatting_provider,
        able.code_action_provider,
    ):
        assert feature
    assert able.rename_provider.prepare_provider


def test_findings_come_with_every_change(editor):
    found = editor.open("main.qsr", MISTAKES)
    assert codes(found) == [
        ("Q203", *units(MISTAKES, "left_of")),
        ("Q201", *units(MISTAKES, "Tase)")),
        ("Q101", *units(MISTAKES, "}.\n")),
    ]
    assert found[1].range.end == types.Position(*units(MISTAKES, ") ∧"))
    assert all(one.severity is types.DiagnosticSeverity.Error for one in found)
    assert "did you mean 'left-of'" in found[0].message
    assert editor.change("main.qsr", MAIN) == []
    (warning,) = editor.change("main.qsr", MAIN + "static tür.\n")
    assert (warning.code, warning.severity) == ("Q511", types.DiagnosticSeverity.Warning)
    assert codes(editor.save("main.qsr")) == codes([warning])
    editor.close("main.qsr")
    editor.comes_to_show("main.qsr", [])


def test_units_before_a_finding_are_counted_as_the_protocol_says(editor):
    text = "dynamic Gefäß. observe on(Gefäß, 😀).\n"
    (found,) = editor.open("face.qsr", text)
    assert (found.range.start.line, found.range.start.character) == units(text, "😀")
    after = "observe on(A, B). # 😀😀\nobserve on(Gefäß, A). # 😀 ∧\nscene(A, B) ⇔ on(A, B)."
    assert codes(editor.change("face.qsr", after))[0][1:] == units(after, "Gefäß")
    editor.close("face.qsr")


def test_other_encodings_can_be_agreed_on(tmp_path):
    editor = Editor(tmp_path, encodings=[types.PositionEncodingKind.Utf8])
    try:
        text = "scene(Gefäß, B) ⇔ on(Gefäß, C)."
        found = editor.open("face.qsr", text)
        assert editor.capabilities.position_encoding == types.PositionEncodingKind.Utf8
        places = [place for _, *place in codes(found)]
        assert list(units(text, "C)", "utf-8", 1)) in places
    finally:
        editor.stop()


def test_hover(main):
    told = main.hover("main.qsr", "Flask")
    assert "dynamic Flask { size: 8 cm × 8 cm × 20 cm, on: Bench }" in told
    assert "Glass, and it breaks." in told
    assert "stands on lab.Bench" in told
    assert "*lab.qsr:3*" in told
    relation = main.hover("main.qsr", "close-to")
    assert "0 % to 50 % of the way to the edge of the support" in relation
    assert "core.qsr" in relation
    assert main.hover("main.qsr", "observe") is None


def test_completion(main):
    main.change("main.qsr", MAIN + "observe left-of(Gefäß, T")
    found = main.complete("main.qsr", "(Gefäß, T")
    assert set(found) >= {"Tasse"}
    main.change("main.qsr", MAIN + "😀 observe right-of(lab.")
    found = main.complete("main.qsr", "😀 observe right-of(lab.")
    assert set(found) == {"lab.Bench", "lab.Flask"}
    assert found["lab.Flask"].detail == "dynamic, 8 cm × 8 cm × 20 cm (width × depth × height)"
    assert found["lab.Flask"].text_edit.range.start.character == len("😀 observe right-of(") + 1
    main.change("main.qsr", MAIN + "observe right-of(Tasse, Gefäß) ")
    found = main.complete("main.qsr", "observe right-of(Tasse, Gefäß) ")
    assert {"∧", "and", "wrt"} <= set(found)
    assert not {"(", ".", "~"} & set(found)


def test_definition(main):
    (flask,) = main.define("main.qsr", "Flask")
    assert flask.uri == main.uri("lab.qsr")
    assert (flask.range.start.line, flask.range.start.character) == units(LAB, "Flask")
    (relation,) = main.define("main.qsr", "left-of", within=len("left-of"))
    assert Path(relation.uri.removeprefix("file://")) == resource_path("knowledge", "core.qsr").resolve()
    (prefix,) = main.define("main.qsr", "lab.Flask")
    assert prefix.uri == main.uri("main.qsr")
    assert (prefix.range.start.line, prefix.range.start.character) == (0, MAIN.index("lab.\n"))
    (file,) = main.define("main.qsr", '"lab.qsr"')
    assert (file.uri, file.range.start) == (main.uri("lab.qsr"), types.Position(0, 0))
    assert main.define("main.qsr", "observe") == []


def test_references(main):
    places = main.refer("main.qsr", "Gefäß, Tasse.")
    assert {one.uri for one in places} == {main.uri("main.qsr")}
    assert len(places) == 4
    assert len(main.refer("main.qsr", "Gefäß, Tasse.", declaration=False)) == 3
    flask = main.refer("main.qsr", "Flask")
    assert {one.uri for one in flask} == {main.uri("main.qsr"), main.uri("lab.qsr")}
    assert main.refer("main.qsr", "observe") == []


def test_rename_in_every_file_that_mentions_it(main):
    other = 'import "lab.qsr".\nobserve on(Flask, Bench). # Flask\n'
    main.open("other.qsr", other)
    main.open("lab.qsr")
    new = main.rename("lab.qsr", "Flask", "Kölbchen")
    assert new == {
        "lab.qsr": LAB.replace("Flask", "Kölbchen"),
        "main.qsr": MAIN.replace("Flask", "Kölbchen"),
        "other.qsr": other.replace("(Flask", "(Kölbchen"),
    }
    main.close("other.qsr")
    main.close("lab.qsr")
    assert set(main.rename("main.qsr", "Flask", "Kölbchen")) == {"main.qsr", "lab.qsr"}
    assert main.rename("main.qsr", "lab.Flask", "labor") == {
        "main.qsr": MAIN.replace("as lab", "as labor").replace("lab.Flask", "labor.Flask")
    }


def test_what_can_be_renamed(main):
    offered = main.prepare_rename("main.qsr", "Flask", within=2)
    assert offered.placeholder == "Flask"
    assert (offered.range.start.line, offered.range.start.character) == units(MAIN, "Flask")
    assert main.prepare_rename("main.qsr", "observe") is None
    with pytest.raises(JsonRpcException, match=r"defined in core\.qsr, which came with qsrlang"):
        main.prepare_rename("main.qsr", "left-of")


@pytest.mark.parametrize(
    ("mark", "new", "reason"),
    [
        ("left-of", "links-von", r"defined in core\.qsr"),
        ("Flask", "9 lives", "is no name"),
        ("Flask", "and", "is a word of the language"),
        ("Flask", "Bench", "is used already"),
        ("Tasse", "Gefäß", "is used already"),
    ],
)
def test_what_cannot_be_renamed(main, mark, new, reason):
    with pytest.raises(JsonRpcException, match=reason):
        main.rename("main.qsr", mark, new)


def test_what_cannot_be_read_is_mended_before_a_name_changes(main):
    main.change("main.qsr", MAIN + "observe on(Tasse.\n")
    with pytest.raises(JsonRpcException, match="cannot be read"):
        main.rename("main.qsr", "Tasse", "Becher")
    assert "Napf" in main.rename("main.qsr", "Gefäß, Tasse.", "Napf")["main.qsr"]


def test_formatting(main):
    loose = MAIN.replace("Gefäß, Tasse) ∧ close-to", "Gefäß ,Tasse)   &  close-to")
    main.change("main.qsr", loose)
    assert main.format("main.qsr") == MAIN
    main.change("main.qsr", MAIN)
    assert main.format("main.qsr") == MAIN


def test_code_actions(editor):
    found = editor.open("main.qsr", MISTAKES)
    offered = editor.actions("main.qsr", found[0])
    (title,) = (one for one in offered if one.startswith("did you mean"))
    action = offered[title]
    assert action.kind == types.CodeActionKind.QuickFix
    assert action.diagnostics[0].code == "Q203"
    mended = editor.edited("main.qsr", action.edit.changes[editor.uri("main.qsr")])
    assert mended == MISTAKES.replace("left_of", "left-of")
    every = offered["mend all that is sure"]
    assert every.kind == types.CodeActionKind.SourceFixAll
    all_mended = editor.edited("main.qsr", every.edit.changes[editor.uri("main.qsr")])
    assert "left-of(Gefäß, Tasse)" in all_mended
    editor.close("main.qsr")


def test_a_warning_can_be_allowed_where_it_is(main):
    text = MAIN + "in room r1 {\n    observe on(Tasse, Gefäß) ∨ in(Tasse, Gefäß).\n}\n"
    warning = next(one for one in main.change("main.qsr", text) if one.code == "Q510")
    allowing = main.actions("main.qsr", warning)["allow Q510 here"]
    silent = main.edited("main.qsr", allowing.edit.changes[main.uri("main.qsr")])
    assert "\n    # allow Q510\n    observe on(Tasse" in silent
    assert "Q510" not in [one.code for one in main.change("main.qsr", silent)]


def test_open_texts_stand_for_their_files(main):
    main.open("lab.qsr")
    main.change("lab.qsr", LAB.replace("Flask", "Retort"))
    main.comes_to_show("main.qsr", ["Q201"])
    main.close("lab.qsr")
    main.comes_to_show("main.qsr", [])


def test_errors_of_imported_files_are_shown_there(main):
    lab = main.folder / "lab.qsr"
    lab.write_text(LAB + "static .\n", encoding="utf-8")
    try:
        main.save("main.qsr")
        main.comes_to_show("lab.qsr", ["Q101"])
    finally:
        lab.write_text(LAB, encoding="utf-8")
    main.save("main.qsr")
    main.comes_to_show("lab.qsr", [])


def test_a_file_that_appears_is_imported(main):
    main.change("main.qsr", MAIN + 'import "new.qsr".\nobserve on(Fresh, Gefäß).\n')
    main.comes_to_show("main.qsr", ["Q209", "Q201"])
    (main.folder / "new.qsr").write_text("dynamic Fresh.\n")
    event = types.FileEvent(main.uri("new.qsr"), types.FileChangeType.Created)
    main.call(main.client.workspace_did_change_watched_files, types.DidChangeWatchedFilesParams([event]))
    main.comes_to_show("main.qsr", [])


def test_texts_that_are_saved_nowhere(editor):
    """Their address is no path; they see the shipped files all the same."""
    address = "untitled:Untitled-1"
    text = 'import "office/desk".\nobserve on(Cup, Desk).\nobserve on(Cop, Desk).\n'
    found = editor.open(address, text)
    assert codes(found) == [("Q201", 2, 11)]
    assert "dynamic Cup" in editor.hover(address, "Cup")
    editor.close(address)


def test_what_is_no_knowledge_at_all_does_no_harm(editor):
    for text in ("", "\0\0", "{" * 5000, "🙈" * 1000, "scene(" * 2000, "\ud7ff\u202e # ?"):
        editor.open("odd.qsr", text)
        assert editor.hover("odd.qsr", "") is None
        editor.complete("odd.qsr", text)
        editor.format("odd.qsr")
        editor.close("odd.qsr")
    assert not editor.messages
