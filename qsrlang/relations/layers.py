"""What holds in given circumstances: the choices of the most specific context first, and the others' beneath."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cmp_to_key
from itertools import combinations

from qsrlang.language.diagnostics import Label
from qsrlang.language.statements import Context, Statement
from qsrlang.relations.choices import build_choices, requirements, scene_counts
from qsrlang.relations.contexts import Circumstances, compatible, implies, matches, more_specific, rank
from qsrlang.relations.graph import Alternative, Choice, Pair, Requirement, pair_of
from qsrlang.relations.symbols import Symbols

MAX_CONTEXTS = 256


@dataclass(frozen=True, slots=True)
class Layer:
    """What one context says; `context` is None for what holds everywhere and always."""

    context: Context | None
    choices: tuple[Choice, ...]
    requirements: tuple[Requirement, ...]

    @property
    def pairs(self) -> frozenset[Pair]:
        """The pairs it speaks of."""
        return frozenset(pair for choice in self.choices for pair in choice.governs)


def build_layers(statements: Iterable[Statement], symbols: Symbols) -> tuple[Layer, ...]:
    """Return what holds everywhere, and then what each context says; equally specific ones on one pair are reported."""
    everywhere = tuple(one for one in statements if not isinstance(one, Context))
    contexts = tuple(one for one in statements if isinstance(one, Context))
    seen = scene_counts(everywhere, symbols)
    layers = [_layer(None, everywhere, seen, symbols)]
    layers += [_layer(one, one.statements, seen, symbols) for one in contexts]
    _refuse_equals(layers[1:], symbols)
    return tuple(layers)


def in_force(
    layers: Iterable[Layer], circumstances: Circumstances, symbols: Symbols
) -> tuple[tuple[Choice, ...], tuple[Requirement, ...]]:
    """Return the choices and requirements that hold: on each pair, those of the most specific matching context."""
    matching = [one for one in layers if one.context is None or matches(one.context, circumstances)]
    covered: frozenset[Pair] = frozenset()
    choices: list[Choice] = []
    for layer in sorted(matching, key=cmp_to_key(_order)):
        beneath = (_beneath(choice, covered, symbols) for choice in layer.choices)
        choices += [choice for choice in beneath if choice.governs]
        covered |= layer.pairs
    return tuple(choices), tuple(one for layer in matching for one in layer.requirements)


def _layer(
    context: Context | None, statements: tuple[Statement, ...], seen: Mapping[str, float], symbols: Symbols
) -> Layer:
    if context is not None:
        seen = {**seen, **scene_counts(statements, symbols)}
    return Layer(context, build_choices(statements, seen, symbols), requirements(statements, symbols))


def _order(one: Layer, other: Layer) -> int:
    if one.context is None or other.context is None:
        return (one.context is None) - (other.context is None)
    return more_specific(other.context, one.context) - more_specific(one.context, other.context)


def _beneath(choice: Choice, covered: frozenset[Pair], symbols: Symbols) -> Choice:
    if not choice.governs & covered:
        return choice
    free = tuple(
        Alternative(
            one.share, tuple(c for c in one.constraints if pair_of(c, symbols.class_of) not in covered)
        )
        for one in choice.alternatives
    )
    return replace(choice, governs=choice.governs - covered, alternatives=free)


def _refuse_equals(layers: Iterable[Layer], symbols: Symbols) -> None:
    """Report contexts that can match together, are equally specific, and speak of one pair that none settles."""
    speaking: dict[Pair, list[Context]] = defaultdict(list)
    for layer in layers:
        for pair in layer.pairs:
            speaking[pair] += [layer.context] if layer.context and layer.context.conditions else []
    for pair, contexts in sorted(speaking.items()):
        if len(contexts) > MAX_CONTEXTS:
            _report_many(pair, contexts[MAX_CONTEXTS], symbols)
            continue
        for one, other in combinations(contexts, 2):
            if _rivals(one, other) and not _settled(one, other, contexts):
                _report_rivals(pair, one, other, symbols)


def _report_many(pair: Pair, context: Context, symbols: Symbols) -> None:
    message = f"more than {MAX_CONTEXTS} contexts speak of {pair[0]} and {pair[1]}"
    symbols.report("Q108", message, context, "this is one too many")


def _rivals(one: Context, other: Context) -> bool:
    if not compatible((*one.conditions, *other.conditions)):
        return False
    return not more_specific(one, other) and not more_specific(other, one)


def _settled(one: Context, other: Context, contexts: Iterable[Context]) -> bool:
    """Return whether a context holds wherever both do and is more specific than either."""
    both = replace(one, conditions=(*one.conditions, *other.conditions))
    least = max(rank(one), rank(other))
    return any(rank(context) > least and implies(both, context) for context in contexts)


def _report_rivals(pair: Pair, one: Context, other: Context, symbols: Symbols) -> None:
    head = replace(other, span=replace(other.span, end=other.conditions[-1].span.end))
    labels = (Label(replace(one.span, end=one.conditions[-1].span.end), "the other context"),)
    message = f"two equally specific contexts speak of {pair[0]} and {pair[1]}"
    help_text = "add a context with the conditions of both, or one more condition to one of them"
    symbols.report("Q409", message, head, "both can match at once", help_text, labels)
