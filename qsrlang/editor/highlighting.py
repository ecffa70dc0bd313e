"""The language as Pygments colours it, in terminals, documents and notebooks."""

from __future__ import annotations

from typing import Any

from pygments.lexer import RegexLexer, bygroups
from pygments.style import Style
from pygments.token import (
    Comment,
    Keyword,
    Name,
    Number,
    Operator,
    Punctuation,
    String,
    Text,
    Whitespace,
    _TokenType,
)

from qsrlang.editor.patterns import Ink, Pattern, Section, sections

TOKENS = {
    Ink.COMMENT: Comment.Single,
    Ink.DOC: String.Doc,
    Ink.STRING: String,
    Ink.NUMBER: Number,
    Ink.UNIT: Keyword.Type,
    Ink.STATEMENT: Keyword.Declaration,
    Ink.WORD: Keyword,
    Ink.CONSTANT: Keyword.Constant,
    Ink.FIELD: Name.Attribute,
    Ink.DENSITY: Name.Function.Magic,
    Ink.OPERATOR: Operator,
    Ink.SIGN: Punctuation,
    Ink.BUILTIN: Name.Builtin,
    Ink.RELATION: Name.Function,
    Ink.CLASS: Name.Class,
    Ink.INSTANCE: Name.Variable,
    Ink.ROLE: Name.Label,
    Ink.SCENE: Name.Entity,
    Ink.ROOM: Name.Namespace,
    Ink.PREFIX: Name.Namespace,
}


class QSRLexer(RegexLexer):
    """Lexer of the .qsr language: knowledge and queries; its tables are made from the grammar when first used."""

    name = "qsr"
    aliases = ("qsr",)
    filenames = ("*.qsr",)
    mimetypes = ("text/x-qsr",)

    @classmethod
    def get_tokendefs(cls) -> dict[str, list[Any]]:
        """Return the token table, which Pygments asks for when the first lexer is made."""
        return {name: _rules(section) for name, section in sections().items()}


class DarkStyle(Style):
    """Colours on a dark ground, as many editors show them."""

    name = "qsr-dark"
    background_color = "#1f1f1f"
    line_number_color = "#6e7681"
    styles = {  # noqa: RUF012  (Pygments reads this very name)
        Text: "#cccccc",
        Comment: "#6a9955",
        String: "#ce9178",
        String.Doc: "italic #8cb876",
        Number: "#b5cea8",
        Keyword: "#569cd6",
        Keyword.Declaration: "bold #c586c0",
        Keyword.Type: "#b5cea8",
        Operator: "#d4d4d4",
        Punctuation: "#cccccc",
        Name.Attribute: "#9cdcfe",
        Name.Function.Magic: "#4fc1ff",
        Name.Builtin: "#dcdcaa",
        Name.Function: "#dcdcaa",
        Name.Class: "#4ec9b0",
        Name.Variable: "#9cdcfe",
        Name.Label: "italic #9cdcfe",
        Name.Entity: "#dcb67a",
        Name.Namespace: "#4fc1ff",
    }


def _rules(section: Section) -> list[Any]:
    ending = [] if section.end is None else [(*_matching(section.end), "#pop")]
    return [*ending, (r"\n|[^\S\n]+", Whitespace), *(_rule(pattern) for pattern in section.patterns)]


def _rule(pattern: Pattern) -> tuple[Any, ...]:
    return (*_matching(pattern), pattern.section) if pattern.section else _matching(pattern)


def _matching(pattern: Pattern) -> tuple[str, Any]:
    tokens = [_token(ink) for ink in pattern.inks]
    each: Any = bygroups
    return pattern.regex, tokens[0] if len(tokens) == 1 else each(*tokens)


def _token(ink: Ink | None) -> _TokenType:
    return Text if ink is None else TOKENS[ink]
