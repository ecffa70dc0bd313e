"""The REPL without a terminal: its commands one by one, a pipe in place of a person, and keys in place of hands."""

import io
import json
import sys
from pathlib import Path

import pytest
from prompt_toolkit.completion import CompleteEvent
from prompt_toolkit.document import Document
from prompt_toolkit.input import create_pipe_input
from prompt_toolkit.output import DummyOutput
from rich.console import Console

from qsrlang.cli.shell.commands import COMMANDS
from qsrlang.cli.shell.completing import ShellCompleter
from qsrlang.cli.shell.inputs import is_command
from qsrlang.cli.shell.prompt import KeptHistory, make_prompt
from qsrlang.cli.shell.saving import read_knowledge
from qsrlang.cli.shell.session import Session
from qsrlang.cli.shell.shell import Shell
from qsrlang.cli.shell.turns import take
from qsrlang.relations.imports import shipped_knowledge

LANDMARKS = """landmark monitor-1 : Monitor at (1.2 m, 3 m) facing -90 deg.
landmark desk-1 : Desk at (1.2 m, 2.8 m) facing -90 deg."""


@pytest.fixture(autouse=True)
def own_places(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


@pytest.fixture
def shell():
    """A shell as a person has it, that prints into a text."""
    console = Console(file=io.StringIO(), width=100, highlight=False)
    return Shell(Session.begin(read_knowledge("office/desk")), console, console, console, is_interactive=True)


def says(shell, *inputs):
    """What the shell prints in answer to the last of some inputs."""
    for text in inputs:
        start = shell.answers.file.tell()
        take(shell, text)
    return shell.answers.file.getvalue()[start:]


@pytest.fixture
def piped(qsr_command, monkeypatch):
    """`qsr repl ...` with a text, or bytes, on its standard input."""

    def run(text, *words):
        given = text if isinstance(text, bytes) else text.encode()
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(given), encoding="utf-8"))
        return qsr_command("repl", *words)

    return run


# A pipe


def test_a_pipe_gets_answers_alone(piped):
    code, out, err = piped("where Cup\n  wrt Keyboard?", "office/desk")
    assert (code, err) == (0, "")
    assert "0.850" in out
    assert "qsr>" not in out
    assert "▀" not in out
    assert "\x1b" not in out


def test_statements_of_a_pipe_are_known_to_its_queries(piped):
    code, out, _ = piped("static A.\ndynamic\nB.\nobserve left-of(B, A).\nwhere B?\n:list\n")
    assert code == 0
    assert "session:4: observe left-of(B, A)" in out or "session:3: observe left-of(B, A)" in out
    assert "dynamic\n" in out


def test_json_is_one_value_a_line(piped):
    code, out, _ = piped("where Cup?\n:world\nwhere Mouse?\ncheck?\n", "office/desk", "--format", "json")
    values = [json.loads(line) for line in out.splitlines()]
    assert code == 0
    assert [value["target"] for value in values[:2]] == ["Cup", "Mouse"]
    assert {finding["code"] for finding in values[2]} >= {"Q601"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("where Cupp?", "did you mean 'Cup'"),
        ("wher Cup?", "Q101"),
        ("static A", "Q104"),
        ("in room r { observe left-of(Cup, Mouse).", "Q105"),
        ("observe left_of(Cup, Mouse).\nwhere Cup?", "Q203"),
        (":nonsense", "unknown command ':nonsense'"),
        (":lod x", "did you mean ':load'"),
        (":load nowhere.qsr", "nowhere.qsr"),
        (":load \0.qsr", "no usable path"),
        (":save", "is named"),
        (":undo x", "the number of inputs"),
        (":undo 0", "the number of inputs"),
        (":world somewhere", "room NAME"),
        (":graph Nothing", "unknown object"),
        (":plot", "the query"),
        (":plot prob left-of(Cup, Keyboard)? a.png", "the query to draw"),
        (":time wher?", "Q101"),
        (":help nothing", "unknown command"),
        ("prob left-of(Nothing, Cup)?", "Nothing"),
        (b"static \xff\xfe.", "Q101"),
        ("static \x1b[31mA.", "Q101"),
    ],
)
def test_what_is_wrong_is_told_and_the_exit_code_says_so(piped, tmp_path, text, message):
    code, _, err = piped(text, "office/desk")
    assert code == 2
    assert message in err
    assert "\x1b" not in err
    assert [path.name for path in tmp_path.iterdir()] == []


def test_a_pipe_goes_on_after_a_mistake(piped):
    code, out, _ = piped("where Cupp?\nwhere Cup?\n", "office/desk")
    assert code == 2
    assert "0.850" in out


def test_a_file_that_cannot_be_used_ends_a_pipe(piped, tmp_path):
    (tmp_path / "bad.qsr").write_text("static A\nstatic B.")
    code, out, err = piped("where A?", "bad.qsr")
    assert (code, out) == (2, "")
    assert "Q104" in err
    assert piped("where A?", "nowhere/at/all")[0] == 2


def test_quit_ends_a_pipe(piped):
    assert "0.850" not in piped(":quit\nwhere Cup?\n", "office/desk")[1]


# The commands


def test_statements_are_added_taken_back_and_added_again(shell):
    assert says(shell, "dynamic Mug.") == "added as line 2\n"
    assert "added as lines 3 to 4" in says(shell, "observe right-of(Mug,\n  Keyboard).")
    assert says(shell, ":undo").splitlines() == ["- observe right-of(Mug,", "-   Keyboard)."]
    assert says(shell, ":redo").splitlines() == ["+ observe right-of(Mug,", "+   Keyboard)."]
    assert says(shell, ":undo 2", ":undo") == "nothing to take back\n"
    assert "nothing was taken back" in says(shell, ":redo 9", ":redo")
    assert "Mug" in shell.session.built.symbols.classes


def test_an_input_with_a_query_in_it_is_one_step(shell):
    shown = says(shell, "dynamic Mug. observe right-of(Mug, Keyboard). where Mug? dynamic Jar.")
    assert "where Mug" in shown
    assert says(shell, ":undo").count("-") == 4 - 1
    assert shell.session.knowledge.stated == ()


def test_an_input_stops_at_its_first_mistake(shell):
    shown = says(shell, "observe left_of(Cup, Mouse). where Cup?")
    assert "Q203" in shown
    assert "weight" not in shown
    assert shell.session.knowledge.stated == ()


def test_warnings_are_shown_and_the_statement_is_added(shell):
    shown = says(shell, "scene(Cup, Vase) ⇔ left-of(Vase, Cup).")
    assert "warning[Q502]" in shown
    assert "added as line 2" in shown


def test_answers_have_a_picture(shell):
    shown = says(shell, LANDMARKS, "where Cup?")
    assert "frame: map" in shown
    assert "M monitor-1 ↓" in shown
    assert "└" in shown


def test_load_reload_clear_and_undo(shell, tmp_path):
    (tmp_path / "my desk.qsr").write_text("static A.")
    says(shell, "dynamic Mug.")
    shown = says(shell, ':load "my desk.qsr"')
    assert "loaded my desk.qsr" in shown
    (kept,) = (tmp_path / "state" / "qsr").glob("kept-*.qsr")
    assert kept.name in shown.replace("\n", "")
    says(shell, "static B.")
    (tmp_path / "my desk.qsr").write_text("static A, C.")
    says(shell, ":reload")
    assert set(shell.session.built.symbols.classes) == {"A", "B", "C"}
    says(shell, ":clear")
    assert set(shell.session.built.symbols.classes) == {"A", "C"}
    assert "back to office/desk" in says(shell, ":undo 4")
    assert "Mug" in shell.session.built.symbols.classes


def test_a_file_is_mended_and_loaded_again(shell, tmp_path):
    (tmp_path / "bad.qsr").write_text("static A")
    assert "Q104" in says(shell, ":load bad.qsr")
    assert "Cup" in shell.session.built.symbols.classes
    empty = Shell(
        Session.begin(), shell.answers, shell.notes, shell.errors, is_interactive=True, file="bad.qsr"
    )
    (tmp_path / "bad.qsr").write_text("static A.")
    assert "loaded bad.qsr" in says(empty, ":reload")
    assert set(empty.session.built.symbols.classes) == {"A"}


def test_save_writes_what_check_accepts(shell, qsr_command, tmp_path):
    says(shell, "dynamic Mug.", "observe right-of(Mug, Keyboard).")
    assert says(shell, ":save mine.qsr") == "saved to mine.qsr\n"
    assert qsr_command("check", "mine.qsr")[0] == 0
    assert "is there already" in says(shell, ":save mine.qsr")
    assert "is there already" in says(shell, ":save")
    assert says(shell, "dynamic Jar.", ":save!") == "saved to mine.qsr\n"
    assert "3   observe right-of(Mug, Keyboard)." in says(shell, ":list")
    assert (tmp_path / "mine.qsr").read_text().endswith("dynamic Jar.\n")


def test_list_tells_lines_and_what_is_saved(shell):
    says(shell, "dynamic Mug.", ":save mine.qsr", "## A jar.\ndynamic Jar.")
    assert says(shell, ":list").splitlines() == [
        "2   dynamic Mug.",
        "3 * ## A jar.",
        "4 * dynamic Jar.",
        "beside mine.qsr",
    ]


def test_world_shows_and_changes_what_queries_are_asked_in(shell):
    says(shell, LANDMARKS)
    shown = says(shell, "in room r133 { believe left-of(Cup, Keyboard). }", ":world")
    for word in ("no room", "rooms that contexts speak of: r133", "monitor-1", "1.20", "150 × 80", "surface"):
        assert word in shown
    assert says(shell, ":world room r133 viewer (0 m, 0 m)") == "room r133 viewer (0 m, 0 m)\n"
    assert "1.000" in says(shell, "where Cup wrt Keyboard?")
    assert "no context speaks of room r134" in says(shell, ":world room r134")
    assert "no room" in says(shell, ":world none")
    assert "0.850" in says(shell, "where Cup wrt Keyboard?")


def test_graph_shows_shares_relations_and_lines(shell):
    shown = says(shell, ":graph")
    for word in (
        "0.850",
        "right-of(Cup, Keyboard)",
        "office/desk.qsr:27",
        "behind-of(Bottle, Cup) ∧ close-to",
    ):
        assert word in shown
    assert "Laptop" not in says(shell, ":graph Cup")
    assert "elsewhere" in says(shell, "believe 0.7 :: left-of(Printer, Monitor).", ":graph Printer")
    assert "no relations" in says(shell, ":load core", ":graph")


def test_plot_writes_a_picture(shell, tmp_path):
    assert says(shell, ":plot where Cup wrt Keyboard?") == "where-Cup-wrt-Keyboard.png\n"
    assert says(shell, ":plot") == "where-Cup-wrt-Keyboard-2.png\n"
    assert says(shell, ":plot where Cup my cup.svg") != "my cup.svg\n"
    assert says(shell, ":plot where Cup? my cup.svg") == "my cup.svg\n"
    assert (tmp_path / "where-Cup-wrt-Keyboard.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (tmp_path / "my cup.svg").read_bytes()


def test_time_tells_milliseconds(shell):
    assert says(shell, ":time where Cup?").count(" ms") == 2


def test_lint_and_check_show_all_findings(shell):
    says(shell, "believe 0.5 :: left-of(Laptop, Monitor).")
    shown = says(shell, ":lint")
    assert shown == says(shell, "check?")
    assert shown.index("Q504") < shown.index("session:2:1")
    assert "Q601" not in shown, "what is overridden in the imported file alone is not this one's affair"
    assert "nothing to complain of" in says(shell, ":load core", "check?")


def test_help_knows_every_command(shell):
    shown = says(shell, ":help")
    assert shown == says(shell, "help")
    assert max(len(line.rstrip()) for line in shown.splitlines()) <= 80
    for command in COMMANDS.values():
        assert command.usage in shown
        assert command.summary in says(shell, f":help {command.name}")
    assert "Q203" in says(shell, ":help q203")


def test_a_command_may_be_shortened_where_that_is_clear(shell):
    assert "parsed in" in says(shell, ":t where Cup?")
    assert "unknown command ':l'" in says(shell, ":l")
    assert "unknown command ':'" in says(shell, ":")


def test_leaving_asks_once_where_something_is_not_saved(shell):
    assert "2 statements are not saved" in says(shell, "dynamic Mug. dynamic Jar.", ":quit")
    assert not shell.has_left
    says(shell, ":list", ":quit")
    assert not shell.has_left
    says(shell, ":quit")
    assert shell.has_left


@pytest.mark.parametrize(
    "inputs", [("quit",), (":exit",), ("dynamic Mug.", ":quit!"), ("dynamic Mug.", ":q!")]
)
def test_leaving_at_once(shell, inputs):
    says(shell, *inputs)
    assert shell.has_left


def test_an_unexpected_error_is_one_line_and_its_details_are_in_the_log(shell, tmp_path, monkeypatch):
    def fail(self, query):
        raise ZeroDivisionError("division\nby zero")

    monkeypatch.setattr(Session, "ask", fail)
    shown = says(shell, "where Cup?")
    assert "ZeroDivisionError: division by zero" in shown
    assert "Traceback" not in shown
    log = (tmp_path / "state" / "qsr" / "log").read_text()
    assert "Traceback" in log
    assert "where Cup?" in log


def test_the_session_of_the_documents_is_what_happens(shell):
    """Every line that is shown is said, in this order; what is left out there is tables."""
    page = Path(__file__).parents[2].joinpath("docs", "how-to", "repl.md").read_text(encoding="utf-8")
    shown = [line[4:] for line in page.splitlines() if line.startswith("    ")]
    said = ""
    for line in shown:
        if line.startswith("qsr> "):
            said = says(shell, line.removeprefix("qsr> "))
        else:
            assert line in said
            said = said[said.index(line) :]
    assert len(shown) > 10


# Keys


def typed(shell, keys, tmp_path):
    """What a prompt returns for some keys."""
    with create_pipe_input() as keyboard:
        keyboard.send_text(keys)
        return make_prompt(shell, tmp_path / "history", keyboard, DummyOutput()).prompt()


def test_an_input_goes_on_over_lines(shell, tmp_path):
    assert typed(shell, "where\rCup\r?\r", tmp_path) == "where\nCup\n?"
    assert typed(shell, "in room r {\robserve left-of(A, B).\r}\r", tmp_path).endswith("}")
    assert typed(shell, ":list\r", tmp_path) == ":list"
    assert typed(shell, "where Cup\r\r", tmp_path) == "where Cup\n"
    assert typed(shell, "static A.\x1b\rstatic B.\r", tmp_path) == "static A.\nstatic B."


@pytest.mark.parametrize(
    ("begun", "completed"),
    [
        ("where K", "where Keyboard"),
        ("obs", "observe"),
        ("observe behind", "observe behind-of"),
        ("static A. wh", "static A. where"),
        (":rel", ":reload"),
        (":load tum-kitchen/r", ":load tum-kitchen/relations"),
        (":load mi", ":load mine.qsr"),
        (":world weeke", ":world weekend"),
        (":world room r1", ":world room r133"),
        (":plot where Lap", ":plot where Laptop"),
        (":graph Bot", ":graph Bottle"),
        (":help un", ":help undo"),
    ],
)
def test_tab_completes(shell, tmp_path, begun, completed):
    (tmp_path / "mine.qsr").write_text("static A.")
    take(shell, "in room r133 { observe left-of(Cup, Keyboard). }")
    offers = offers_for(shell, begun)
    assert {begun[: len(begun) + offer.start_position] + offer.text for offer in offers} == {completed}


def offers_for(shell, begun):
    return list(ShellCompleter(shell).get_completions(Document(begun), CompleteEvent()))


def test_every_offer_goes_on_from_what_was_typed(shell):
    for begun in (
        "",
        "w",
        ":",
        ":help ",
        ":world ",
        "where ",
        "static A { ",
        "in room r {\n ob",
        "where Cup? ",
    ):
        offers = offers_for(shell, begun)
        assert offers, begun
        assert all(-len(begun) <= offer.start_position <= 0 for offer in offers)
    assert {"Cup", "Desktop-PC"} <= {offer.text for offer in offers_for(shell, "where ")}


def test_completion_never_fails(shell, tmp_path, monkeypatch):
    monkeypatch.setattr("qsrlang.cli.shell.completing.complete", lambda *words, **more: 1 / 0)
    assert offers_for(shell, "where K") == []
    assert "ZeroDivisionError" in (tmp_path / "state" / "qsr" / "log").read_text()


def test_what_was_typed_comes_back(shell, tmp_path):
    typed(shell, "where\rCup?\r", tmp_path)
    assert typed(shell, "\x1b[A\r", tmp_path) == "where\nCup?"
    assert typed(shell, "observe left-of(\x03\x03where Mouse?\r", tmp_path) == "where Mouse?"
    assert typed(shell, "\x1b[A\x1b[ACup, Mouse).\r", tmp_path) == "observe left-of(Cup, Mouse)."
    with pytest.raises(EOFError):
        typed(shell, "\x04", tmp_path)


def test_history_is_kept_in_a_file_where_that_can_be(tmp_path):
    history = KeptHistory(tmp_path / "deep" / "history")
    for text in ("where Cup?", "static A\n{ front: yes }.", "\n\nodd\n\n", "+plus", "\udc80"):
        history.store_string(text)
    loaded = list(KeptHistory(tmp_path / "deep" / "history").load_history_strings())
    assert loaded[::-1][:4] == ["where Cup?", "static A\n{ front: yes }.", "\n\nodd\n\n", "+plus"]
    (tmp_path / "file").write_text("")
    blocked = KeptHistory(tmp_path / "file" / "history")
    blocked.store_string("where Cup?")
    assert list(blocked.load_history_strings()) == []


def test_no_command_begins_a_statement():
    assert not any(is_command(word) for word in ("static", "where", "in", *shipped_knowledge()))
