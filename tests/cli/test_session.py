"""A session as a value: what is typed, what is known, what is taken back, and what is written to files."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.cli.shell.inputs import Act, count_statements, group_lines, is_complete, last_passage, passages
from qsrlang.cli.shell.keeping import history_path, keep_session, log_failure, state_folder
from qsrlang.cli.shell.saving import read_knowledge, reload_file, save
from qsrlang.cli.shell.session import Session
from qsrlang.cli.shell.world import describe, enter, rooms_of
from qsrlang.errors import FileError, ValueRangeError
from qsrlang.language.diagnostics import LanguageError
from qsrlang.relations.build import build_graph
from qsrlang.relations.contexts import Circumstances
from qsrlang.relations.imports import read_source

STATEMENTS = (
    "dynamic Mug.",
    "dynamic Jar { size: 8.5 cm × 8.5 cm }.",
    "observe 3 × right-of(Cup, Keyboard).  # seen.today?",
    "## A doc comment. With full stops?\nbelieve 0.5 :: left-of(Laptop, Monitor).",
    "landmark monitor-1 : Monitor at (1.2 m, 3 m)\n    facing -90 deg.",
    "in room r133, weekday {\n    observe left-of(Mouse, Keyboard).\n    observe right-of(Mouse, Keyboard).\n}",
)
UNFINISHED = (
    "dynamic Mug",
    "dynamic Jar { size: 8.5",
    'import "office/desk.qsr',
    "in weekday, room r133 {\n    observe left-of(Mouse, Keyboard).",
    "where Cup given",
    "prob left-of(Cup, Keyboard)  # a full stop. here",
)
QUERIES = ("where Cup?", "where Cup\n    wrt Keyboard?", "where Cup in room r133 at 09:30?", "check?")


def messages_of(error):
    return [finding.code for finding in error.value.diagnostics]


@pytest.fixture
def desk():
    return Session.begin(read_knowledge("office/desk"))


# What is typed


@given(st.lists(st.sampled_from(STATEMENTS + QUERIES), min_size=1, max_size=6))
def test_an_input_falls_into_its_statements_and_queries(parts):
    found = list(passages("\n".join(parts)))
    asked = [part for part in parts if part in QUERIES]
    stated = [part for part in parts if part not in QUERIES]
    assert [passage.text for passage in found if passage.act is Act.ASK] == asked
    assert sum(count_statements(passage.text) for passage in found if passage.act is Act.STATE) == len(stated)
    rest = " ".join(passage.text for passage in found)
    for part in parts:
        at = rest.index(part.partition("\n")[0].strip())
        rest = rest[at:]


@given(st.lists(st.sampled_from(STATEMENTS + QUERIES), max_size=3), st.sampled_from(UNFINISHED))
def test_an_input_goes_on_until_its_last_statement_ends(parts, last):
    before = "".join(f"{part}\n" for part in parts)
    assert is_complete(before)
    assert not is_complete(before + last)
    assert last_passage(before + last) == len(before)


@pytest.mark.parametrize(
    ("text", "complete"),
    [
        ("", True),
        ("# only a comment", True),
        ("## of the next statement", False),
        ("static A { size: 8.5", False),
        ("static A { size: 8.", True),
        ('import "office/desk.qsr', False),
        ("observe left-of(lab.Cup", False),
        ("in room r { observe left-of(A, B).", False),
        ("in room r { observe left-of(A, B). }", True),
        ("where Cup", False),
        ("where Cup\n", True),
        ("static A\n", False),
        (":load", True),
        ("static A. :load", False),
        ("landmark a\n: A at (0 m, 0 m)", False),
        ("static A.\n:list", True),
        ("quit", True),
        ("}", True),
    ],
)
def test_what_is_complete(text, complete):
    assert is_complete(text) is complete


def test_lines_make_up_inputs():
    lines = [
        "static A.\n",
        "static\n",
        "B.\n",
        "where A?\n",
        ":list\n",
        "static C.\n",
        ":list\n",
        "where\n",
        "B?",
        "static D.",
    ]
    assert list(group_lines(lines)) == [
        "static A.\nstatic\nB.\nwhere A?\n",
        ":list\n",
        "static C.\n",
        ":list\n",
        "where\nB?",
        "static D.",
    ]


def test_a_query_at_the_end_may_lack_its_mark():
    assert [(one.act, one.text) for one in passages("static A. where A")] == [
        (Act.STATE, "static A. where A")
    ]
    assert [(one.act, one.text) for one in passages("where A\n")] == [(Act.ASK, "where A")]


# What is known


def test_what_is_stated_is_known_and_has_its_line(desk):
    session = desk.state("dynamic Mug.\n").state(
        "observe right-of(Mug, Keyboard).\nobserve close-to(Mug, Keyboard)."
    )
    assert session.source().text.splitlines()[0] == 'import "office/desk".'
    for line, one in session.knowledge.numbered():
        assert session.source().line_text(line) == one.text.splitlines()[0]
    answer = session.ask("where Mug?")
    assert any("session:3" in statement for statement in answer.components[0].statements)


def test_a_statement_with_errors_changes_nothing(desk):
    with pytest.raises(LanguageError) as error:
        desk.state("dynamic Mug. observe left_of(Mug, Keyboard).")
    assert messages_of(error) == ["Q203"]
    assert desk.knowledge.stated == ()
    assert desk == desk.undo()


def test_only_new_findings_are_told(desk):
    once = desk.state("scene(Cup, Vase) ⇔ left-of(Vase, Cup).")
    assert "Q502" in [finding.code for finding in once.findings_since(desk)]
    assert once.state("dynamic Jar.").findings_since(once) == ()


@given(st.lists(st.sampled_from(["state", "undo", "redo", "clear"]), max_size=12))
def test_undo_and_redo_walk_along_a_timeline(steps):
    session, timeline, now = Session.begin(), [()], 0
    for number, step in enumerate(steps):
        if step == "state":
            session = session.state(f"dynamic C{number}.")
            timeline, now = [*timeline[: now + 1], (*timeline[now], f"dynamic C{number}.")], now + 1
        elif step == "clear":
            session = session.become(type(session.knowledge)())
            timeline, now = [*timeline[: now + 1], ()], now + 1
        else:
            session = session.undo() if step == "undo" else session.redo()
            now = max(0, min(now + (1 if step == "redo" else -1), len(timeline) - 1))
        assert tuple(one.text for one in session.knowledge.stated) == timeline[now]
        assert set(session.built.symbols.classes) == {text[8:-1] for text in timeline[now]}
    assert session.undo(99).knowledge.stated == ()
    assert session.undo(99).redo(99).knowledge.stated == tuple(session.redo(99).knowledge.stated)


def test_an_input_of_several_parts_is_one_step(desk):
    changed = desk.state("dynamic Mug.").state("dynamic Jar.").as_one_step_from(desk)
    assert changed.undo().knowledge == desk.knowledge
    assert changed.undo().redo().knowledge == changed.knowledge


def test_a_session_is_asked_under_its_circumstances():
    session = Session.begin().state(
        "static Monitor. dynamic Cup.\n"
        "believe 0.9 :: left-of(Cup, Monitor) | 0.1 :: right-of(Cup, Monitor).\n"
        "in room r133, from 08:00 to 12:00 { believe 0.2 :: left-of(Cup, Monitor) | 0.8 :: right-of(Cup, Monitor). }"
    )
    assert session.ask("where Cup?").weights[0] == pytest.approx(0.9)
    there = enter(session, "room r133 at 09:30")
    assert there.ask("where Cup?").weights[0] == pytest.approx(0.8)
    assert enter(there, "at 12:00").ask("where Cup?").weights[0] == pytest.approx(0.9)
    assert enter(there, "none").circumstances == Circumstances()
    assert rooms_of(session.built) == ("r133",)


@given(
    st.none() | st.sampled_from(["r133", "Küche-2"]),
    st.none() | st.booleans(),
    st.none() | st.integers(0, 24 * 60 - 1),
)
def test_the_world_is_told_in_the_words_it_is_read_in(room, weekend, minutes):
    session = Session.begin()
    told = " ".join(
        filter(
            None,
            [
                room and f"room {room},",
                None if weekend is None else ("weekend" if weekend else "weekday"),
                None if minutes is None else f"at {minutes // 60}:{minutes % 60:02d}",
                "viewer (1 m, -50 cm)",
            ],
        )
    )
    there = enter(session, told)
    assert there.circumstances == Circumstances(room, weekend, minutes)
    assert (there.viewer.x, there.viewer.y) == (1.0, -0.5)
    again = enter(session, describe(there))
    assert (again.circumstances, again.viewer) == (there.circumstances, there.viewer)


@pytest.mark.parametrize(
    "text", ["kitchen", "room", "at 25:00", "at 9", "viewer (1 m)", "weekdays", "viewer 1 m, 2 m"]
)
def test_a_world_that_cannot_be_read_is_told(text):
    with pytest.raises((ValueRangeError, LanguageError)):
        enter(Session.begin(), text)


# What is written to files


def test_a_saved_file_says_what_the_session_knows(desk, tmp_path):
    path = tmp_path / "mine.qsr"
    session = desk.state("## The boss's.\ndynamic Mug. # blue").state("observe 3 × right-of(Mug, Keyboard).")
    saved = save(session, path)
    built = build_graph(read_source(path))
    assert not [finding for finding in built.diagnostics if finding.is_error]
    assert path.read_text(encoding="utf-8") == session.source().text
    assert set(built.symbols.classes) == set(session.built.symbols.classes)
    assert saved.unsaved == ()
    assert [one.text for one in saved.state("dynamic Jar.").unsaved] == ["dynamic Jar."]
    assert saved.undo().knowledge == session.undo().knowledge


def test_a_file_is_not_overwritten_unasked(desk, tmp_path):
    path = tmp_path / "mine.qsr"
    path.write_text("static A.\n")
    with pytest.raises(FileError, match="save!"):
        save(desk, path)
    assert path.read_text() == "static A.\n"
    save(desk, path, overwrite=True)
    assert path.read_text() == 'import "office/desk".\n'


@pytest.mark.parametrize("name", ["mine.txt", "nowhere/mine.qsr", f"{'x' * 300}.qsr"])
def test_a_place_that_cannot_be_written_is_told(desk, tmp_path, name):
    with pytest.raises(FileError):
        save(desk, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_imports_lead_on_where_they_led(tmp_path):
    (tmp_path / "rooms").mkdir()
    (tmp_path / "rooms" / "lab.qsr").write_text("static Bench.\n")
    (tmp_path / "all.qsr").write_text('import "rooms/lab.qsr".  # "rooms/lab.qsr"\nstatic Door.')
    session = Session.begin(read_knowledge(str(tmp_path / "all.qsr"))).state("static Window.")
    saved = save(session, tmp_path / "copy.qsr")
    assert (tmp_path / "copy.qsr").read_text() == session.source().text
    assert saved.source().text == session.source().text
    inner = save(Session.begin(read_knowledge(str(tmp_path / "rooms" / "lab.qsr"))), tmp_path / "lab.qsr")
    assert "Bench" in inner.built.symbols.classes
    deep = save(session, tmp_path / "rooms" / "deep.qsr")
    assert set(deep.built.symbols.classes) == {"Bench", "Door", "Window"}
    (tmp_path / "far").mkdir()
    with pytest.raises(LanguageError) as error:
        save(session, tmp_path / "far" / "deep.qsr")
    assert messages_of(error) == ["Q209"]
    assert list((tmp_path / "far").iterdir()) == []


def test_a_file_is_read_again_and_what_was_stated_stays(tmp_path):
    path = tmp_path / "mine.qsr"
    path.write_text("static A.")
    session = Session.begin(read_knowledge(str(path))).state("static B.")
    path.write_text("static A, C.")
    again = reload_file(session)
    assert set(again.built.symbols.classes) == {"A", "B", "C"}
    assert again.undo().knowledge == session.knowledge
    saved = save(again, path, overwrite=True).state("static D.")
    assert set(reload_file(saved).built.symbols.classes) == {"A", "B", "C", "D"}
    path.write_text("static A, B, C, D.")
    with pytest.raises(LanguageError):
        reload_file(saved)
    with pytest.raises(FileError):
        reload_file(Session.begin())


def test_what_was_not_saved_is_kept(desk, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    path = keep_session(desk.state("dynamic Mug."))
    assert path.parent == state_folder() == tmp_path / "qsr"
    assert "Mug" in Session.begin(read_knowledge(str(path))).built.symbols.classes


def test_keeping_never_fails(desk, tmp_path, monkeypatch):
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setenv("XDG_STATE_HOME", str(blocked))
    monkeypatch.setattr("tempfile.tempdir", str(blocked))
    assert keep_session(desk) is None
    assert log_failure(ValueError("odd"), "where Cup?") is None
    monkeypatch.setenv("XDG_STATE_HOME", "relative/is/ignored")
    assert state_folder().is_absolute()
    monkeypatch.setenv("QSR_HISTORY", str(tmp_path / "typed"))
    assert history_path() == tmp_path / "typed"
