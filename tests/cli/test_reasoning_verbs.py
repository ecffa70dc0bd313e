"""`explain`, `landmarks`, `sample`, `check` and `prob` as a user asks them, at the command line and in the REPL."""

import io
import json

import pytest
from rich.console import Console

import qsrlang as qsr
from qsrlang.cli.shell.saving import read_knowledge
from qsrlang.cli.shell.session import Session
from qsrlang.cli.shell.shell import Shell
from qsrlang.cli.shell.turns import take

MONITOR = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 2 deg)"
CIRCLE = "dynamic A, B. observe left-of(A, B). observe right-of(B, A)."
ASKED = {
    "explain Cup?": ("where Cup", "0.850", "office/desk.qsr:27"),
    "explain right-of(Cup, Keyboard)?": ("prob right-of(Cup, Keyboard)", "holds in", "office/desk.qsr:27"),
    "landmarks Bottle?": ("Cup", "Keyboard", "Monitor"),
    "sample Bottle 20?": ("20 scenes", "Bottle", "Cup"),
    "prob right-of(Cup, Keyboard)?": ("right-of(Cup, Keyboard)", "0.8", "exact"),
    "prob right-of(Cup, Keyboard) given close-to(Bottle, Cup)?": ("given", "0.8"),
    "check?": ("consistent",),
}
KEYS = {
    "explain": {"answer", "proofs"},
    "landmarks": {"target", "basis", "landmarks"},
    "sample": {"scenes", "drawn", "assumed"},
    "prob": {"formula", "probability", "method", "standard_error", "effective_draws", "assumed", "dropped"},
}


def ask(qsr_command, query, *more):
    return qsr_command("ask", "office/desk", query, "--landmark", MONITOR, *more)


@pytest.mark.parametrize("query", ASKED)
def test_a_question_is_answered_in_text(qsr_command, query):
    code, out, err = ask(qsr_command, query)
    assert (code, err) == (0, "")
    for word in ASKED[query]:
        assert word in out
    assert "object at 0x" not in out


@pytest.mark.parametrize("query", [query for query in ASKED if query != "check?"])
def test_a_question_is_answered_as_json(qsr_command, query):
    code, out, err = ask(qsr_command, query, "--format", "json")
    assert (code, err) == (0, "")
    assert set(json.loads(out)) >= KEYS[query.split()[0]]


def test_numbers_are_those_of_the_library(qsr_command):
    known = qsr.load("office/desk").with_landmarks(MONITOR)
    _, out, _ = ask(qsr_command, "sample Bottle 3?", "--seed", "5", "--format", "json")
    assert json.loads(out) == known.ask("sample Bottle 3?", seed=5).to_json()
    _, out, _ = ask(qsr_command, "landmarks Bottle?", "--seed", "5", "--format", "json")
    assert json.loads(out) == known.ask("landmarks Bottle?", seed=5).to_json()
    _, out, _ = ask(qsr_command, "explain Cup?", "--format", "json")
    assert json.loads(out) == known.ask("explain Cup?").to_json()


@pytest.mark.parametrize("query", ["where A?", "explain A?", "sample A?", "prob left-of(A, B)?"])
def test_a_circle_is_printed_and_exits_with_2(qsr_command, tmp_path, query):
    path = tmp_path / "circle.qsr"
    path.write_text(CIRCLE)
    code, out, err = qsr_command("ask", path, query)
    assert (code, out) == (2, "")
    assert "A - B - A is a circle without a landmark" in " ".join(err.split())


def test_what_contradicts_itself_is_told(qsr_command, tmp_path):
    path = tmp_path / "contradiction.qsr"
    path.write_text(CIRCLE.replace("right-of(B, A)", "left-of(B, A)"))
    code, out, _ = qsr_command("ask", path, "check?")
    assert code == 0
    assert "2 atoms contradict each other" in out
    assert "left-of(A, B)" in out
    assert "left-of(B, A)" in out


@pytest.mark.parametrize(
    ("query", "message"),
    [
        ("explain Cupp?", "did you mean 'Cup'"),
        ("landmarks Cupp?", "did you mean 'Cup'"),
        ("sample Cupp 3?", "did you mean 'Cup'"),
        ("sample Cup 0?", "1 to 1000000 scenes"),
        ("prob left-of(Cup)?", "arguments"),
        ("prob left-of(Cup, Keyboard) given behind-of(Keyboard, Monitor)?", "assume less"),
        ("landmarks Desktop-PC wrt Cup?", "Q1"),
    ],
)
def test_what_cannot_be_answered_is_told_and_exits_with_2(qsr_command, query, message):
    code, _, err = ask(qsr_command, query)
    assert code == 2
    assert message in " ".join(err.split())


@pytest.fixture
def shell(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    console = Console(file=io.StringIO(), width=100, highlight=False)
    return Shell(Session.begin(read_knowledge("office/desk")), console, console, console, is_interactive=True)


@pytest.mark.parametrize("query", [query for query in ASKED if query != "check?"])
def test_the_repl_answers_the_same(shell, query):
    take(shell, f"landmark {MONITOR}.")
    start = shell.answers.file.tell()
    take(shell, query)
    said = shell.answers.file.getvalue()[start:]
    for word in ASKED[query]:
        assert word in said
