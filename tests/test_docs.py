"""Every code block of the documents and every example runs."""

import io
import re
import runpy
import shlex
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from learning.logs import desks

import qsrlang as qsr
from qsrlang.cli.main import main
from qsrlang.experiments.scenariofiles import ScenarioEntry
from qsrlang.relations.imports import find_knowledge, read_source

ROOT = Path(__file__).parents[1]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
BLOCK = re.compile(r"^```([\w ]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NEEDS_DATA = ("tum-kitchen", "kth3d_desks.csv")


def blocks(language):
    return [
        pytest.param(text, id=f"{path.relative_to(ROOT)}-{number}")
        for path in DOCUMENTS
        for number, (kind, text) in enumerate(BLOCK.findall(path.read_text(encoding="utf-8")))
        if kind == language
    ]


def test_every_block_says_what_it_is():
    kinds = {kind for path in DOCUMENTS for kind, _ in BLOCK.findall(path.read_text(encoding="utf-8"))}
    assert kinds <= {"python", "sh", "qsr", "qsr rejected", "text", "toml"}


def test_what_is_shown_of_rejected_knowledge_is_what_is_said():
    """A block of text directly after rejected knowledge shows its findings; there is no other text."""
    shown = re.compile(r"^```qsr rejected\n(.*?)^```\n```text\n(.*?)^```$", re.MULTILINE | re.DOTALL)
    texts = [text for path in DOCUMENTS for text in shown.findall(path.read_text(encoding="utf-8"))]
    assert texts
    for knowledge, said in texts:
        assert f"{qsr.check_text(knowledge, 'office.qsr').errors}\n" == said
    every = [kind for path in DOCUMENTS for kind, _ in BLOCK.findall(path.read_text(encoding="utf-8"))]
    assert every.count("text") == len(texts)


@pytest.mark.parametrize("text", blocks("python"))
def test_python_blocks_run(text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(compile(text, "<document>", "exec"), {"__name__": "__document__"})


@pytest.mark.parametrize("text", blocks("qsr"))
def test_knowledge_blocks_are_free_of_errors(text):
    qsr.parse_knowledge(text)


@pytest.mark.parametrize("text", blocks("toml"))
def test_scenario_blocks_have_the_fields_of_a_scenario(text):
    ScenarioEntry.model_validate(tomllib.loads(text))


@pytest.mark.parametrize("text", blocks("sh"))
def test_commands_run(text, tmp_path, monkeypatch, capsys):
    """`qsr` runs as typed, short of long comparisons; of `make`, the target must exist."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO()))
    Path("desk.qsr").write_text(qsr.format_source(read_source(find_knowledge("office/desk"))))
    qsr.write_observations(desks(6, 5, np.random.default_rng(0)), Path("log.csv"))
    targets = re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    for line in text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if not words:
            continue
        assert words[0] in ("make", "qsr"), line
        if words[0] == "make":
            assert words[1] in targets
        elif not any(name in words for name in NEEDS_DATA):
            run(monkeypatch, shortened(words))
    assert "Traceback" not in capsys.readouterr().err


def shortened(words):
    return ["2" if before == "--trials" else word for before, word in zip(["", *words], words, strict=False)]


def run(monkeypatch, words):
    monkeypatch.setattr(sys, "argv", words)
    try:
        main()
    except SystemExit as stop:
        assert not stop.code


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")
    assert capsys.readouterr().out


def test_links_between_documents_lead_somewhere():
    for path in DOCUMENTS:
        for target in re.findall(r"\]\(([^)#:]+)\)", path.read_text(encoding="utf-8")):
            assert (path.parent / target).exists(), f"{path}: {target}"
