from qsrlang.language.diagnostics import Diagnostic, Severity
from qsrlang.language.silencing import allowed, unsilenced
from qsrlang.language.source import Source, Span

TEXT = """\
dynamic cup.  # allow Q511, Q503 for now
# allow Q504
## A doc comment in between.
believe on(cup, Desk).
believe on(cup, Desk).

# allow Q505

observe on(cup, Desk).
import "# allow Q508".
## allow Q509
# allow Q5100
"""


def codes(line):
    return allowed(Source("<text>", TEXT)).get(line, frozenset())


def test_a_comment_silences_its_own_line():
    assert codes(1) == {"Q511", "Q503"}


def test_a_comment_alone_silences_the_next_line_that_is_none():
    assert codes(4) == {"Q504"}
    assert codes(5) == codes(9) == frozenset()


def test_strings_doc_comments_and_longer_codes_silence_nothing():
    assert codes(10) == codes(11) == codes(12) == frozenset()
    assert allowed(Source("<text>", "dynamic cup.")) == {}


def test_warnings_and_information_are_silenced_but_never_errors():
    source = Source("<text>", "dynamic cup.  # allow Q511")
    place = Span(source, 8, 11)
    heard = [Diagnostic("Q511", "", place), Diagnostic("Q503", "", place, severity=Severity.WARNING)]
    silenced = [Diagnostic("Q511", "", place, severity=one) for one in (Severity.WARNING, Severity.INFO)]
    assert unsilenced([*silenced, *heard]) == tuple(heard)
