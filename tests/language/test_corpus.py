"""The programs under tests/corpus carry what is expected of them; UPDATE_GOLDEN=1 writes the rejected ones' anew."""

import os
import re
from pathlib import Path

import pytest
from corpus_expectations import Program, agree
from grammar_usage import Usage

from qsrlang.errors import QSRError
from qsrlang.language.codes import CODES
from qsrlang.language.grammar import spellings
from qsrlang.language.parser import parse_query
from qsrlang.language.source import read_source
from qsrlang.relations.build import build_graph
from qsrlang.relations.linting.lint import lint

CORPUS = Path(__file__).parents[1] / "corpus"
ACCEPTED = sorted(path.name for path in (CORPUS / "accepted").glob("*.qsr"))
REJECTED = sorted(path.name for path in (CORPUS / "rejected").glob("*.qsr"))
QUERIES = re.findall(
    r"^(accepted|rejected) (.*?)(?: # (Q\d{3}) (\d+))?$", (CORPUS / "queries.txt").read_text(), re.MULTILINE
)
EXPECTED = re.compile(r"^# (Q\d{3}) (\d+):(\d+)$", re.MULTILINE)
UPDATE = os.environ.get("UPDATE_GOLDEN") == "1"

# Ten thousand mistakes, or hundreds of contexts, are no program to be read; test_bad_input writes them.
BEYOND_THE_CORPUS = {"Q107", "Q108"}
# Rules that only ever give errors of meaning: relations of one object, a default or a condition given twice.
ALWAYS_WRONG = {
    "atom: NAME LPAR NAME RPAR",
    "atom: NAME LPAR NAME RPAR WRT FRAME",
    "atom: NAME LPAR role RPAR",
    "atom: NAME LPAR role RPAR WRT FRAME",
    "relation: RELATION NAME LPAR NAME RPAR LBRACE field RBRACE",
    "relation: RELATION NAME LPAR NAME RPAR LBRACE field __relation_star RBRACE",
    "__circumstances_star: __circumstances_star COMMA circumstance",
    "__defaults_star: __defaults_star COMMA default",
}
# No quantity of the language is a duration yet; these units only ever give Q302.
UNITS_WITHOUT_A_PLACE = {"s", "h"}


@pytest.mark.parametrize("name", ACCEPTED)
def test_accepted(name, monkeypatch):
    monkeypatch.chdir(CORPUS / "accepted")
    program = Program(name)
    assert [finding.render() for finding in program.built.diagnostics if finding.is_error] == []
    stated = program.stated()
    for key, rest, value in stated:
        true = program.value(key, rest)
        assert agree(value, true), f"{key} {rest}: stated {value}, but {true}"
    assert [key for key, *_ in stated if key != "warns"]
    if "warns" not in [key for key, *_ in stated]:
        assert [finding.render() for finding in program.findings()] == []


@pytest.mark.parametrize("name", REJECTED)
def test_rejected(name, monkeypatch):
    monkeypatch.chdir(CORPUS / "rejected")
    source = read_source(Path(name))
    found = build_graph(source).diagnostics
    rendered = "\n\n".join(finding.render() for finding in found) + "\n"
    golden = Path(name).with_suffix(".txt")
    if UPDATE:
        update(Path(name), golden, found, rendered)
        return
    expected = [(code, int(line), int(column)) for code, line, column in EXPECTED.findall(source.text)]
    assert [(f.code, f.span.line, f.span.column) for f in found if f.is_error] == expected, rendered
    assert expected
    assert rendered == golden.read_text(encoding="utf-8")


def update(path, golden, found, rendered):
    text = EXPECTED.sub("", path.read_text(encoding="utf-8")).rstrip("\n")
    places = [f"# {one.code} {one.span.line}:{one.span.column}" for one in found if one.is_error]
    path.write_text("\n".join([text, *places, ""]), encoding="utf-8")
    golden.write_text(rendered, encoding="utf-8")


def test_no_golden_text_is_left_over():
    assert sorted(path.stem for path in (CORPUS / "rejected").glob("*.txt")) == [
        name[:-4] for name in REJECTED
    ]


@pytest.mark.parametrize(("kind", "text", "code", "column"), QUERIES)
def test_queries(kind, text, code, column):
    if kind == "accepted":
        parse_query(text)
        return
    with pytest.raises(QSRError) as caught:
        parse_query(text)
    (finding,) = caught.value.diagnostics
    assert (finding.code, finding.span.column) == (code, int(column)), finding.render()


def test_the_corpus_is_large():
    assert len(ACCEPTED) >= 120
    assert len(REJECTED) >= 100


@pytest.fixture(scope="module")
def usage():
    found = Usage()
    for path in (CORPUS / "accepted").rglob("*.qsr"):
        found.read(path.read_text(encoding="utf-8"), "document")
    for kind, text, *_ in QUERIES:
        if kind == "accepted":
            found.read(text if text.endswith("?") else f"{text}?", "query")
    return found


def test_every_rule_of_the_grammar_is_used_in_every_form(usage):
    assert {re.sub(r"(__\w+?)_\d+", r"\1", rule) for rule in usage.unused()} == ALWAYS_WRONG


def test_every_terminal_is_used_in_every_spelling(usage):
    expected = {(name, word) for name, words in spellings().items() for word in words}
    expected -= {("UNIT", unit) for unit in UNITS_WITHOUT_A_PLACE}
    assert expected <= usage.words
    assert {name for name, _ in usage.words} >= usage.terminals()


def test_every_error_is_in_some_rejected_program():
    found = {
        code for name in REJECTED for code, *_ in EXPECTED.findall((CORPUS / "rejected" / name).read_text())
    }
    assert found | BEYOND_THE_CORPUS == {code for code in CODES if code < "Q5"}


def test_every_warning_is_in_some_program(monkeypatch):
    monkeypatch.chdir(CORPUS / "accepted")
    found = {one.code for name in ACCEPTED for one in Program(name).findings()}
    assert found == {code for code in CODES if code > "Q5"}


def test_a_silenced_warning_would_be_told(monkeypatch):
    monkeypatch.chdir(CORPUS / "accepted")
    for name in ("silenced_on_the_line.qsr", "silenced_on_the_line_before.qsr"):
        source = read_source(Path(name))
        loud = type(source)(source.name, source.text.replace("# allow ", "# "), source.path)
        codes = re.findall(r"# allow (Q\d+)", source.text)
        assert {finding.code for finding in lint(build_graph(loud), loud)} == set(codes)
