"""Which rules and words of the grammar some texts use."""

from lark import Lark

from qsrlang.language.grammar import grammar_text
from qsrlang.language.table import STARTS

IGNORED = {"WS", "COMMENT"}


class Usage:
    """What has been used so far."""

    def __init__(self):
        self._lark = Lark(
            grammar_text(),
            parser="lalr",
            lexer="contextual",
            start=list(STARTS),
            keep_all_tokens=True,
            maybe_placeholders=False,
        )
        self._rules = set()
        self.words = set()
        parser = self._lark.parser.parser.parser
        parser.callbacks = {rule: self._recording(rule, make) for rule, make in parser.callbacks.items()}

    def _recording(self, rule, make):
        def record(children):
            self._rules.add(rule)
            return make(children)

        return record

    def read(self, text, start):
        """Record what a text uses."""
        tree = self._lark.parse(text, start=start)
        self.words |= {(token.type, token.value) for token in tree.scan_values(lambda value: True)}

    def unused(self):
        """Return the rules that were not used, as `origin: expansion`."""
        named = (rule for rule in self._lark.rules if rule not in self._rules)
        return sorted(f"{rule.origin.name}: {' '.join(one.name for one in rule.expansion)}" for rule in named)

    def terminals(self):
        """Return the names of all terminals that the parser sees."""
        return {terminal.name for terminal in self._lark.terminals} - IGNORED
