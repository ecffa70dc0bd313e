"""`%load_ext qsrlang` in a shell of IPython."""

import re
import sys

import pytest

import qsrlang as qsr
from qsrlang.cli import notebook
from qsrlang.cli.displays import table_html

InteractiveShell = pytest.importorskip(
    "IPython.core.interactiveshell", reason="IPython is not installed"
).InteractiveShell

KNOWN = """\
import "office/desk".
landmark monitor-1 : Monitor at (1 m, 2 m) facing -90 deg.
"""


@pytest.fixture
def shell():
    shell = InteractiveShell()
    shell.run_line_magic("load_ext", notebook.__name__)
    yield shell
    shell.run_line_magic("unload_ext", notebook.__name__)


def run(shell, cell):
    outcome = shell.run_cell(cell)
    return outcome.result if outcome.success else outcome


def html(shell, value):
    return shell.display_formatter.format(value)[0]["text/html"]


def test_a_cell_is_knowledge(shell, capsys):
    run(shell, f"%%qsr desk\n{KNOWN}")
    assert isinstance(shell.user_ns["desk"], qsr.KnowledgeBase)
    assert "Cup" in shell.user_ns["desk"].classes
    assert capsys.readouterr().out == "desk: 9 classes, 1 landmark, 5 related pairs\n"
    run(shell, "%%qsr\ndynamic Cup, Plate.")
    assert shell.user_ns["kb"].classes == ("Cup", "Plate")


def test_warnings_of_the_cell_are_told(shell, capsys):
    run(shell, "%%qsr\nscene(Cup, Plate) ⇔ right-of(Cup, Plate).")
    assert "warning[Q502]: no statement declares Cup, Plate\n  --> <kb>:1:7" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("cell", "said"),
    [
        ("%%qsr\nstatik Cup.\nobserve left_of(Cup, Cup).", "error[Q203]: unknown relation 'left_of'"),
        ("%%qsr 9x\nstatic Cup.", "error: the name after %%qsr is '9x'"),
        ("%qsr where Cup?", "error: unknown knowledge 'kb'"),
        ("import qsrlang as qsr\nqsr.load('nowhere.qsr')", "error: nowhere.qsr"),
    ],
)
def test_mistakes_are_told_without_a_traceback(shell, capsys, cell, said):
    outcome = run(shell, cell)
    assert not outcome.success
    told = capsys.readouterr()
    assert said in told.err
    assert "Traceback" not in told.err + told.out
    assert "kb" not in shell.user_ns


def test_other_errors_keep_their_traceback(shell, capsys):
    assert not run(shell, "1 / 0").success
    assert "ZeroDivisionError" in capsys.readouterr().out


def test_a_line_is_a_question(shell):
    run(shell, f"%%qsr desk\n{KNOWN}")
    answer = run(shell, "%qsr where Cup?")
    assert isinstance(answer, qsr.Where)
    assert answer.weights == pytest.approx([0.85, 0.15])
    run(shell, "answer = %qsr where Cup wrt Keyboard ?")
    assert shell.user_ns["answer"].frame == "Keyboard"
    assert isinstance(run(shell, "%qsr where Laptop"), qsr.Where)


def test_the_variable_is_asked_as_it_is_now(shell):
    run(shell, "%%qsr desk\nimport 'office/desk'.".replace("'", '"'))
    run(shell, "desk = desk.with_landmarks('m-1 : Monitor at (5 m, 2 m) facing 0 deg')")
    assert run(shell, "%qsr where Cup?").frame == "map"


def test_questions_in_cells_and_strings_stay_as_they_are():
    lines = ["text = '%qsr where Cup?'\n", "%qsr where Cup??\n", "%qsr where Cup\n", "Cup?\n"]
    assert notebook.keep_question(lines) == [lines[0], "%qsr where Cup\n", lines[2], lines[3]]


def test_knowledge_is_shown_as_tables(shell):
    run(shell, f"%%qsr desk\n{KNOWN}")
    shown = html(shell, shell.user_ns["desk"])
    assert '<td style="text-align: left">Desktop-PC</td>' in shown
    assert "<th>size [cm]</th>" in shown
    assert ">monitor-1</td>" in shown
    assert "office/desk.qsr:26" in shown
    plain = shell.display_formatter.format(shell.user_ns["desk"])[0]["text/plain"]
    assert plain == "9 classes, 1 landmark, 5 related pairs"


def test_answers_are_shown_as_a_table_and_a_picture(shell):
    run(shell, f"%%qsr desk\n{KNOWN}")
    placed, relative = run(shell, "%qsr where Cup?"), run(shell, "%qsr where Cup wrt Keyboard?")
    for answer in (placed, relative):
        shown = html(shell, answer)
        assert "<th>weight</th>" in shown
        assert "<code>office/desk.qsr:27: observe 85 × right-of(Cup, Keyboard)</code>" in shown
        assert re.search(r'<img [^>]*src="data:image/png;base64,iVBOR\w+', shown)
        assert shell.display_formatter.format(answer)[0]["text/plain"] == str(answer)


def test_a_probability_is_shown_with_its_error(shell):
    run(shell, f"%%qsr desk\n{KNOWN}")
    shown = html(shell, run(shell, "%qsr prob right-of(Cup, Keyboard)?"))
    assert "<th>standard error</th>" in shown
    assert ">0.8499</td>" in shown


@pytest.mark.parametrize(
    ("query", "words"),
    [
        ("explain Cup", ("where Cup", "0.850", "observe 85 × right-of(Cup, Keyboard)")),
        ("explain right-of(Cup, Keyboard)", ("holds in", "observe 85 × right-of(Cup, Keyboard)")),
        ("landmarks Bottle", ("<table", ">Cup</td>", ">Keyboard</td>")),
        ("sample Bottle 20", ("<table", ">Bottle</td>", "20 scenes")),
        ("check", ("consistent",)),
    ],
)
def test_every_other_answer_is_shown_too(shell, query, words):
    run(shell, f"%%qsr desk\n{KNOWN}")
    shown = html(shell, run(shell, f"%qsr {query}?"))
    for word in words:
        assert word in shown
    assert "object at 0x" not in shown


def test_a_search_is_shown_step_by_step(shell):
    story = qsr.search("kitchen", planner="qsr", seed=1)
    shown = html(shell, story)
    assert "Search for Cup" in shown
    assert shown.count("<tr>") == 2 + 1 + len(story.steps)
    assert "<img" in shown
    assert "looked from" in shell.display_formatter.format(story)[0]["text/plain"]


def test_a_comparison_is_shown_as_a_table(shell):
    made = qsr.Experiment("kitchen", "A", "Cup", "narrow", "steady", 7, "0123456789ab")
    trials = tuple(qsr.Trial("random", number, True, 40.0, 3, 10.0, "cup") for number in range(4))
    comparison = qsr.Comparison(made, ("random",), 4, trials)
    shown = html(shell, comparison)
    assert "<th>travel [m]</th>" in shown
    assert ">random</td>" in shown
    assert "95 % intervals" in shown
    assert "random" in shell.display_formatter.format(comparison)[0]["text/plain"]


def test_what_is_shown_cannot_be_mistaken_for_markup():
    from rich.table import Table

    table = Table(title="a < b")
    table.add_column("[bold]x[/bold] & y")
    table.add_row("<script>")
    shown = table_html(table)
    assert "<b>a &lt; b</b>" in shown
    assert "<th>x &amp; y</th>" in shown
    assert "&lt;script&gt;" in shown


def test_unloading_leaves_nothing(shell):
    shell.run_line_magic("unload_ext", notebook.__name__)
    assert "qsr" not in shell.magics_manager.magics["line"]
    assert "qsr" not in shell.magics_manager.magics["cell"]
    assert notebook.keep_question not in shell.input_transformers_cleanup
    assert shell.custom_exceptions == ()
    assert "text/html" not in shell.display_formatter.format(qsr.parse_knowledge(""))[0]
    shell.run_line_magic("load_ext", notebook.__name__)


def test_the_extension_needs_no_ipython_to_be_imported():
    assert "IPython" not in vars(sys.modules[notebook.__name__])
