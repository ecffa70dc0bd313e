"""A small sample of what tests/fuzz/fuzz_language.py does at length."""

from itertools import islice

import pytest
from fuzz import harness
from fuzz.fuzz_language import fuzz
from fuzz.mutations import CHANGES, mutate

from qsrlang.relations import imports

MUTATIONS = 2_000


def test_changed_texts_give_diagnostics_and_no_other_exception(monkeypatch, capsys):
    monkeypatch.setattr(imports, "parse_source", imports.parse_source)
    harness.parse_files_once()
    tried, failures = fuzz(harness, MUTATIONS, seed=1, seconds=600)
    assert tried == MUTATIONS
    assert failures == 0, capsys.readouterr().out


def test_a_seed_repeats_its_texts():
    assert list(islice(harness.cases(3), 50)) == list(islice(harness.cases(3), 50))
    assert list(islice(harness.cases(3), 50)) != list(islice(harness.cases(4), 50))


@pytest.mark.parametrize("change", dict.fromkeys(CHANGES), ids=lambda change: change.__name__)
def test_every_change_changes_something_and_takes_any_text(change):
    chance = harness.random.Random(1)
    texts = ["", " ", "\ud800", "dynamic Cup, Plate. observe left-of(Cup, Plate)."]
    changed = [change(text, chance, texts) for text in texts * 20]
    assert changed != texts * 20


def test_a_failure_is_told_with_a_minimal_text(capsys):
    def break_on_x(text):
        if "x" in text and "y" in text:
            raise KeyError("x and y")

    assert isinstance(harness.failure(break_on_x, "axby"), KeyError)
    assert harness.failure(break_on_x, "ab") is None
    text = harness.report(break_on_x, "some text with x and some with y in it")
    assert text.startswith("break_on_x('xy')\n")
    assert "KeyError: 'x and y'" in text


def test_mutations_make_from_one_to_four_changes():
    chance = harness.random.Random(2)
    assert len({mutate("dynamic Cup.", chance, ["static Plate."]) for _ in range(200)}) > 100
