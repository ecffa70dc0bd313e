"""Colours by the TextMate grammar: what is committed is what is generated, and it colours as Pygments does."""

import json
import re
from pathlib import Path

import pytest

from qsrlang.editor.highlighting import TOKENS, QSRLexer
from qsrlang.editor.patterns import Ink
from qsrlang.editor.textmate import textmate_grammar, textmate_text

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "editors" / "vscode"
GENERATED = EXTENSION / "syntaxes" / "qsr.tmLanguage.json"
CORPUS = ROOT / "tests" / "corpus"
PROGRAMS = sorted(
    path for path in [*CORPUS.rglob("*.qsr"), *(ROOT / "knowledge").rglob("*.qsr")] if path.is_file()
)
FIG_2 = """\
## Fig. 2 of the paper.
scene(Monitor, Cup) ⇔
    right-of(Cup, Keyboard) ∧ beside(left: Cup, monitor-1).  # as printed
observe 85 × left-of(Cup, Keyboard) ~ normal((-7 cm, 3 cm), (1 cm, 2 cm)).
"""


class Reader:
    """Reads text by a TextMate grammar, line by line with a stack of rules, as editors do."""

    def __init__(self, grammar):
        self.repository = grammar["repository"]
        self.stack = [{"patterns": grammar["patterns"]}]

    def read(self, text):
        """Every character of a text that is not blank, with its scope."""
        return [
            (character, scope)
            for line in text.splitlines(keepends=True)
            for piece, scope in self.line(line)
            for character in piece
            if not character.isspace()
        ]

    def line(self, line):
        position = 0
        while position < len(line):
            found = self.next(line, position)
            if found is None:
                yield line[position:], ""
                return
            rule, match, captures = found
            yield line[position : match.start()], ""
            yield from self.captured(match, captures, rule.get("name", ""))
            if "begin" in rule and "end" not in rule.get("ended", {}):
                self.stack.append(rule)
            elif rule.get("ended"):
                self.stack.pop()
            assert match.end() > position or rule.get("ended"), f"no way on at {line[position:]!r}"
            position = match.end()

    def next(self, line, position):
        """The first rule that matches from a position on; where several do, the end of what is open, then the first."""
        candidates = []
        if "end" in self.stack[-1]:
            ended = {"ended": True}
            candidates.append((self.stack[-1]["end"], ended, self.stack[-1].get("endCaptures", {})))
        for rule in self.rules(self.stack[-1]["patterns"]):
            captures = rule.get("beginCaptures", {}) if "begin" in rule else rule.get("captures", {})
            candidates.append((rule.get("begin") or rule["match"], rule, captures))
        best = None
        for regex, rule, captures in candidates:
            match = re.compile(regex).search(line, position)
            if match and (best is None or match.start() < best[1].start()):
                best = rule, match, captures
        return best

    def rules(self, patterns):
        for pattern in patterns:
            if "include" in pattern:
                yield from self.rules(self.repository[pattern["include"].removeprefix("#")]["patterns"])
            else:
                yield pattern

    @staticmethod
    def captured(match, captures, name):
        position = match.start()
        for number in range(1, (match.re.groups if captures else 0) + 1):
            if match[number]:
                yield match.string[position : match.start(number)], name
                yield match[number], captures.get(str(number), {}).get("name", name)
                position = match.end(number)
        yield match.string[position : match.end()], name


def by_textmate(text):
    return Reader(textmate_grammar()).read(text)


def by_pygments(text):
    inks = {token: ink for ink, token in TOKENS.items()}
    lexer = QSRLexer(stripnl=False, ensurenl=False)
    return [
        (character, f"{inks[kind].value}.qsr" if kind in inks else "")
        for kind, value in lexer.get_tokens(text)
        for character in value
        if not character.isspace()
    ]


def one_namespace(read):
    """Pygments has one kind for rooms and prefixes."""
    prefix, room = f"{Ink.PREFIX.value}.qsr", f"{Ink.ROOM.value}.qsr"
    return [(character, prefix if scope == room else scope) for character, scope in read]


def test_the_committed_grammar_is_what_is_generated():
    remedy = "run 'python -m qsrlang.editor.textmate > editors/vscode/syntaxes/qsr.tmLanguage.json'"
    assert GENERATED.read_text(encoding="utf-8") == textmate_text(), remedy


def test_the_scene_of_the_paper():
    words = {}
    for character, scope in by_textmate(FIG_2):
        words[scope] = words.get(scope, "") + character
    assert words["comment.block.documentation.qsr"] == "##Fig.2ofthepaper."
    assert words["comment.line.number-sign.qsr"] == "#asprinted"
    assert words["keyword.control.qsr"] == "sceneobserve"
    assert words["keyword.operator.qsr"] == "⇔∧×-"
    assert words["support.function.relation.qsr"] == "right-ofleft-of"
    assert words["support.function.density.qsr"] == "normal"
    assert words["entity.name.function.relation.qsr"] == "beside"
    assert words["entity.name.type.class.qsr"] == "MonitorCupCupKeyboardCupCupKeyboard"
    assert words["variable.parameter.role.qsr"] == "left"
    assert words["variable.other.qsr"] == "monitor-1"
    assert words["constant.numeric.qsr"] == "857312"
    assert words["keyword.other.unit.qsr"] == "cmcmcmcm"
    assert "" not in words


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.name)
def test_it_colours_as_pygments_does(path):
    text = path.read_text(encoding="utf-8-sig")
    assert one_namespace(by_textmate(text)) == one_namespace(by_pygments(text))


def test_it_names_nothing_that_is_not_there():
    grammar = textmate_grammar()
    included = re.findall(r'"include": "#([^"]*)"', json.dumps(grammar))
    assert set(included) == set(grammar["repository"])


def test_the_extension_names_files_that_are_there():
    package = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    (language,), (grammar,) = package["contributes"]["languages"], package["contributes"]["grammars"]
    assert language["extensions"] == [".qsr"]
    assert grammar["language"] == language["id"]
    assert grammar["scopeName"] == textmate_grammar()["scopeName"]
    for named in (package["main"], language["configuration"], grammar["path"]):
        assert (EXTENSION / named).is_file()
    for file in ("language-configuration.json", "package.json"):
        json.loads((EXTENSION / file).read_text(encoding="utf-8"))
    command = re.search(r'args: \["(\w+)"\]', (EXTENSION / "extension.js").read_text(encoding="utf-8"))
    assert command is not None
    assert command[1] == "lsp"
