"""Programs with their expected findings, in comments `# CODE line:column` at the end of each rejected one."""

import re
from pathlib import Path

import pytest

from qsrlang.language.source import read_source
from qsrlang.relations.build import build_graph

CORPUS = Path(__file__).parents[1] / "corpus"
EXPECTED = re.compile(r"^# (Q\d{3}) (\d+):(\d+)$", re.MULTILINE)


@pytest.mark.parametrize("path", sorted((CORPUS / "accepted").glob("*.qsr")), ids=lambda path: path.stem)
def test_accepted(path):
    findings = build_graph(read_source(path)).diagnostics
    assert [finding.render() for finding in findings if finding.is_error] == []


@pytest.mark.parametrize("path", sorted((CORPUS / "rejected").glob("*.qsr")), ids=lambda path: path.stem)
def test_rejected(path):
    source = read_source(path)
    expected = [(code, int(line), int(column)) for code, line, column in EXPECTED.findall(source.text)]
    findings = [finding for finding in build_graph(source).diagnostics if finding.is_error]
    assert [(f.code, f.span.line, f.span.column) for f in findings] == expected, [
        f.render() for f in findings
    ]


def test_every_error_code_but_none_else_is_in_the_corpus():
    from qsrlang.language.diagnostics import CODES

    found = {
        code
        for path in (CORPUS / "rejected").glob("*.qsr")
        for code, *_ in EXPECTED.findall(path.read_text())
    }
    assert found == {code for code in CODES if code < "Q202" or "Q202" < code < "Q500"}
