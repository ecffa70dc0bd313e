"""The pages of the codes: one each, whose examples give what they say; UPDATE_GOLDEN=1 writes the index anew."""

import os
import re
from pathlib import Path

import pytest

from qsrlang.language.codes import CODES
from qsrlang.language.source import Source
from qsrlang.relations.build import build_graph
from qsrlang.relations.linting.lint import lint

PAGES = Path(__file__).parents[2] / "docs" / "language" / "codes"
BLOCK = re.compile(r"^```qsr( rejected)?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
GROUPS = {
    "1": "Syntax",
    "2": "Names",
    "3": "Quantities",
    "4": "Meaning",
    "5": "Warnings",
    "6": "Information",
}
# Ten thousand mistakes, or hundreds of contexts, are no example.
WITHOUT_EXAMPLE = {"Q107", "Q108"}
# Where the viewer stands that a page speaks of.
VIEWERS = {"Q514": (0.0, 2.0)}


def page(code):
    path = PAGES / f"{code}.md"
    return path.read_text(encoding="utf-8") if path.exists() else ""


def examples(rejected):
    return [
        pytest.param(code, text, id=code)
        for code in CODES
        for kind, text in BLOCK.findall(page(code))
        if bool(kind) == rejected
    ]


def findings(text, viewer=None):
    source = Source("<page>", text)
    built = build_graph(source)
    found = (*built.diagnostics, *lint(built, source, viewer))
    return [finding for finding in found if finding.span.source is source]


def test_there_is_one_page_for_each_code():
    assert sorted(path.stem for path in PAGES.glob("*.md")) == sorted([*CODES, "README"])


@pytest.mark.parametrize("code", CODES)
def test_a_page_begins_with_its_code_and_has_both_examples(code):
    assert page(code).startswith(f"# {code}: {CODES[code]}\n\n")
    kinds = [kind for kind, _ in BLOCK.findall(page(code))]
    assert kinds == ([] if code in WITHOUT_EXAMPLE else [" rejected", ""])
    assert (f"`# allow {code}`" in page(code)) == (code > "Q5")


@pytest.mark.parametrize(("code", "text"), examples(rejected=True))
def test_a_wrong_example_gives_this_code_and_no_other(code, text):
    found = findings(text, VIEWERS.get(code))
    assert {finding.code for finding in found} == {code}, "\n".join(f.render() for f in found)


@pytest.mark.parametrize(("code", "text"), examples(rejected=False))
def test_a_right_example_gives_no_finding(code, text):
    assert [finding.render() for finding in findings(text, VIEWERS.get(code))] == []


def index():
    """Return the text of the index."""
    parts = [
        "# The codes of all findings",
        "`qsr check` and `qsr lint` give each finding a code; `qsr explain-error Q203` prints its page in a terminal.\n"
        "Errors must be mended before a file can be used. Warnings and information are silenced on one line by a\n"
        "comment `# allow Q503` at its end, or alone on the line before; codes are separated by commas.",
    ]
    for digit, title in GROUPS.items():
        rows = [f"| [{code}]({code}.md) | {text} |" for code, text in CODES.items() if code[1] == digit]
        parts += [f"## {title}", "\n".join(["| code | what it tells |", "|---|---|", *rows])]
    return "\n\n".join(parts) + "\n"


def test_the_index_lists_every_code():
    path = PAGES / "README.md"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        path.write_text(index(), encoding="utf-8")
    assert path.read_text(encoding="utf-8") == index()
    assert {code[1] for code in CODES} == set(GROUPS)
