"""The grammar means one thing: Earley's parser, which finds every derivation, finds one, and the same as LALR."""

import pytest
from grammar_sentences import SEPARATORS, samples_of, sentences, through
from hypothesis import given, settings
from hypothesis import strategies as st
from lark import Lark, Token, Tree
from lark.lexer import Lexer

from qsrlang.language.grammar import grammar_text, reader
from qsrlang.language.lexing import Excerpt, Word
from qsrlang.language.nodes.questions import NodeBuilder
from qsrlang.language.parser import parse
from qsrlang.language.source import Source, Span
from qsrlang.language.table import STARTS


class GivenTokens(Lexer):
    """Hands on tokens that were made before, so that the grammar is tried and not the lexer."""

    def __init__(self, conf):
        pass

    def lex(self, tokens):
        yield from tokens


@pytest.fixture(scope="module")
def earley():
    return Lark(
        grammar_text(),
        parser="earley",
        lexer=GivenTokens,
        ambiguity="explicit",
        start=list(STARTS),
        keep_all_tokens=True,
        maybe_placeholders=False,
    )


def written(pairs, separators):
    """Return a text and its tokens with their places."""
    text, words = "", []
    for (kind, value), separator in zip(pairs, separators, strict=True):
        words.append(Word(kind, value, len(text), len(text) + len(value)))
        text += value + separator
    return text, words


@st.composite
def programs(draw, start):
    pairs = draw(sentences(start))
    separators = [draw(st.sampled_from(SEPARATORS)) for _ in pairs]
    return written(pairs, separators)


def built(tree, builder):
    """Return the node of a derivation, built as the LALR parser builds it: from the leaves up."""
    if not isinstance(tree, Tree):
        return tree
    children = [built(child, builder) for child in tree.children]
    make = getattr(builder, tree.data, None)
    return make(children) if make else Tree(tree.data, children)


def by_earley(earley, words, start, source):
    """Return the derivation's node and what was found wrong in it; fails where there are several."""
    tree = earley.parse(words, start=start)
    assert not list(tree.find_data("_ambig")), tree.pretty()
    builder = NodeBuilder()
    builder.start(source)
    return built(tree, builder), builder.findings


def by_lalr(text, start, source):
    lark, builder = reader()
    builder.start(source)
    return lark.parse(Excerpt.of(Span(source, 0, len(text))), start=start), builder.findings


def tokens_of(text, start):
    """Return the kinds of tokens that the contextual lexer sees."""
    lark, builder = reader()
    builder.start(Source("", text))
    interactive = lark.parse_interactive(Excerpt.of(Span(Source("", text), 0, len(text))), start=start)
    return [token.type for token in interactive.exhaust_lexer()]


def agree(earley, text, words, start):
    source = Source("<sentence>", text)
    node, findings = by_earley(earley, words, start, source)
    same, same_findings = by_lalr(text, start, source)
    assert repr(node) == repr(same)
    assert [(f.code, f.span) for f in findings] == [(f.code, f.span) for f in same_findings]


@pytest.mark.parametrize("start", STARTS)
@given(st.data())
@settings(max_examples=60)
def test_a_random_sentence_has_one_derivation_and_both_parsers_find_it(earley, start, data):
    text, words = data.draw(programs(start))
    agree(earley, text, words, start)


@pytest.mark.parametrize("start", STARTS)
def test_a_sentence_through_each_rule_has_one_derivation_and_both_parsers_find_it(earley, start):
    rows = [through(start, rule) for rule in reader().lark.rules]
    assert any(rows)
    for terminals in filter(None, rows):
        pairs = [(terminal, samples_of(terminal)[0]) for terminal in terminals]
        agree(earley, *written(pairs, [" "] * len(pairs)), start)


def test_every_rule_is_needed_by_some_start():
    needless = [rule for rule in reader().lark.rules if not any(through(start, rule) for start in STARTS)]
    assert [str(rule) for rule in needless if rule.expansion] == []


@given(st.data())
@settings(max_examples=60)
def test_the_contextual_lexer_sees_the_tokens_that_were_written(data):
    start = data.draw(st.sampled_from(STARTS))
    text, words = data.draw(programs(start))
    assert tokens_of(text, start) == [word.type for word in words]


@given(programs("document"))
def test_statement_by_statement_gives_what_the_whole_text_gives(program):
    text, _ = program
    parsed = parse(text)
    document, findings = by_lalr(text, "document", Source("<text>", text))
    assert {f.code for f in findings} <= {f.code for f in parsed.diagnostics}
    if not parsed.diagnostics:
        assert parsed.document == document


def test_the_grammar_has_no_conflict():
    """Shift/reduce conflicts would be resolved in silence; strict tables refuse them."""
    Lark(grammar_text(), parser="lalr", lexer=GivenTokens, start=list(STARTS), strict=True)


def test_the_oracle_sees_an_ambiguity_and_a_conflict_where_there_is_one():
    doubtful = 'start: start "+" start | "a"'
    tokens = [Token(kind, "") for kind in ("A", "PLUS", "A", "PLUS", "A")]
    tree = Lark(doubtful, parser="earley", lexer=GivenTokens, ambiguity="explicit").parse(tokens)
    assert list(tree.find_data("_ambig"))
    with pytest.raises(Exception, match="Shift/Reduce conflict"):
        Lark(doubtful, parser="lalr", lexer=GivenTokens, strict=True)
