"""docs/explanation/paper.md names a module and a test for each item of the paper: they exist."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "explanation" / "paper.md").read_text(encoding="utf-8")
NAMED = sorted(set(re.findall(r"`((?:qsrlang|tests|knowledge|grammars)/[^`]+)`", PAGE)))


@pytest.mark.parametrize("name", NAMED)
def test_what_the_page_names_exists(name):
    path, _, test = name.partition("::")
    assert (ROOT / path).is_file()
    if test:
        tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
        assert test in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


def test_the_page_covers_every_numbered_item():
    for item in (
        "Equation 1",
        "Equation 2",
        "Equation 3",
        "Algorithm 1",
        "Table I:",
        "Table II:",
        "Table III:",
    ):
        assert item in PAGE
    for number in range(2, 9):
        assert re.search(rf"Figs?\. (\d and )?{number}", PAGE), number
