import json

import pytest
import typer
from rich.console import Console

from qsrlang.cli import explain_error as verb
from qsrlang.errors import UnknownNameError
from qsrlang.language.codes import CODES


@pytest.fixture
def explain(capsys):
    """Run the verb itself: returns what it prints."""

    def run(*words):
        app = typer.Typer()
        app.command()(verb.explain_error)
        app(words, standalone_mode=False)
        return capsys.readouterr().out

    return run


def test_a_page_is_printed_as_it_is_written_where_there_is_no_terminal(explain):
    out = explain("Q203")
    assert out.startswith("# Q203: unknown relation\n")
    assert "```qsr rejected" in out
    assert explain("q203") == out


def test_a_terminal_gets_the_page_laid_out(explain, monkeypatch):
    monkeypatch.setattr(verb, "Console", lambda: Console(force_terminal=True, width=100, color_system=None))
    out = explain("Q203")
    assert "Q203: unknown relation" in out
    assert "observe left_of(Cup, Plate)." in out
    assert "```" not in out


@pytest.mark.parametrize("code", CODES)
def test_every_code_has_a_page(explain, code):
    assert json.loads(explain(code, "--format", "json")) == {"code": code, "page": verb.page_of(code)}


def test_without_a_code_all_are_listed(explain):
    assert explain().splitlines() == [f"{code}  {title}" for code, title in CODES.items()]
    assert json.loads(explain("--format", "json")) == CODES


def test_an_unknown_code_gives_the_nearest(explain):
    with pytest.raises(UnknownNameError, match=r"unknown code 'Q202'; did you mean 'Q\d0\d'\? known: Q101"):
        explain("Q202")
    with pytest.raises(UnknownNameError, match="known: Q101"):
        explain("../../../pyproject")
