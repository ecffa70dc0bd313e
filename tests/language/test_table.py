import json

import pytest

import qsrlang as qsr
from qsrlang.language import table
from qsrlang.language.grammar import grammar_text, reader
from qsrlang.resources import resource_path


def test_the_shipped_table_is_that_of_the_grammar():
    """Where this fails: python -m qsrlang.language.table > grammars/qsr.json"""
    shipped = json.loads(resource_path("grammars", table.FILE).read_text(encoding="utf-8"))["made of"]
    made = json.loads(table.table_text(grammar_text()))["made of"]
    assert shipped["sha256"] == made["sha256"]
    if shipped["lark"] == made["lark"]:
        assert table.load_parser(grammar_text()) is not None


def test_the_loaded_parser_is_the_one_that_is_made():
    loaded, made = table.load_parser(grammar_text()), table.make_parser(grammar_text())
    for text in ("where Cup wrt Keyboard?", "prob a(B, C) ∧ ¬ b(D, E) given c(F, G)?"):
        assert loaded.parse(text, start="query") == made.parse(text, start="query")
    assert [rule.origin for rule in loaded.rules] == [rule.origin for rule in made.rules]
    assert {one.name for one in loaded.terminals} == {one.name for one in made.terminals}


@pytest.mark.parametrize("content", ["", "[]", "{", '{"made of": {"lark": "0.0", "sha256": ""}}', "\x00"])
def test_another_table_is_passed_over(content, tmp_path, monkeypatch):
    path = tmp_path / "qsr.json"
    path.write_text(content)
    monkeypatch.setattr(table, "resource_path", lambda *_: path)
    assert table.load_parser(grammar_text()) is None


def test_without_a_table_everything_works(monkeypatch):
    def missing(*_):
        raise qsr.FileError("qsr.json", "no such file", "")

    monkeypatch.setattr(table, "resource_path", missing)
    reader.cache_clear()
    try:
        assert qsr.parse("static A.").diagnostics == ()
    finally:
        reader.cache_clear()
