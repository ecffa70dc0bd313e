"""What is legal but probably not meant: a rule each, told as warnings."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.silencing import unsilenced
from qsrlang.language.source import Source
from qsrlang.relations.build import Built
from qsrlang.relations.graph import Landmark
from qsrlang.relations.linting.formulas import disjunctions, implied_atoms
from qsrlang.relations.linting.frames import ambiguous_frames, disagreeing_frames
from qsrlang.relations.linting.linted import Linted
from qsrlang.relations.linting.names import uncapitalised_classes, unplaced_classes, unused_imports
from qsrlang.relations.linting.weights import impossible_contexts, missing_shares, zero_weights


class Rule(NamedTuple):
    """A rule: the code of its findings, why they matter, and what finds them."""

    code: str
    reason: str
    find: Callable[[Linted], Iterator[Diagnostic]]


RULES = (
    Rule("Q503", "a class that nothing places cannot be sought", unplaced_classes),
    Rule(
        "Q504",
        "what is left of the shares goes elsewhere; a missing alternative looks the same",
        missing_shares,
    ),
    Rule("Q505", "what weighs nothing says nothing", zero_weights),
    Rule("Q506", "an atom that follows from another narrows the answer twice", implied_atoms),
    Rule("Q507", "left and right of a thing with a front are the viewer's or its own", ambiguous_frames),
    Rule("Q508", "an import that nothing uses hides a misspelt name, or is a leftover", unused_imports),
    Rule("Q509", "what is said in a context that never comes is never heard", impossible_contexts),
    Rule(
        "Q510",
        "the alternatives of a disjunction weigh the same; 'believe' gives each its share",
        disjunctions,
    ),
    Rule("Q511", "a capital tells classes from landmarks, relations and roles", uncapitalised_classes),
    Rule("Q514", "the viewer sees another side than the one by the front of the thing", disagreeing_frames),
)


def lint(
    built: Built,
    source: Source,
    viewer: tuple[float, float] | None = None,
    landmarks: tuple[Landmark, ...] = (),
) -> tuple[Diagnostic, ...]:
    """Return what the rules find in one source of what was built, in the order of the text.

    Frames are judged for a viewer at (x, y) [m], if one is given, and for further landmarks beside those of the text.
    A comment `# allow Q503` on the line of a finding, or alone on the line before, silences it.
    """
    linted = Linted.of(built, source, viewer, landmarks)
    found = [finding for rule in RULES for finding in rule.find(linted)]
    return unsilenced(sorted(found, key=lambda finding: (finding.span.start, finding.code)))
