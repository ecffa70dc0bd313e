"""Whether relations lead anywhere: classes that are placed by each other alone can never be anchored."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Set
from graphlib import CycleError, TopologicalSorter

from qsrlang.language.diagnostics import Label, Severity
from qsrlang.language.syntax import Atom
from qsrlang.relations.symbols import Symbols


def report_unanchored(symbols: Symbols) -> None:
    """Report each cycle of relations from which no chain leads out to where a chain may start."""
    chains: dict[str, set[str]] = defaultdict(set)
    for atom in symbols.related:
        referent, *relata = _names(atom)
        chains[referent].update(relata)
    names = {*chains, *(name for relata in chains.values() for name in relata)}
    starts = {name for name in names if name not in chains or _anchors(name, symbols)}
    floating = {name: chains[name] for name in names - _leading_to(starts, chains)}
    while cycle := _cycle(floating):
        _report(cycle, symbols)
        floating = {name: floating[name] for name in floating.keys() - _leading_to(set(cycle), floating)}


def _anchors(name: str, symbols: Symbols) -> bool:
    kind = symbols.roles.get(name, symbols.class_of(name))
    has_landmark = any(landmark.kind == kind for landmark in symbols.landmarks.values())
    return has_landmark or symbols.classes[kind].kind != "dynamic"


def _leading_to(goals: Set[str], chains: Mapping[str, Iterable[str]]) -> set[str]:
    """Return the goals and every name from which a chain leads to one of them."""
    before: dict[str, list[str]] = defaultdict(list)
    for name, relata in chains.items():
        for relatum in relata:
            before[relatum].append(name)
    found, waiting = set(goals), list(goals)
    while waiting:
        fresh = [name for name in before[waiting.pop()] if name not in found]
        found.update(fresh)
        waiting += fresh
    return found


def _cycle(chains: Mapping[str, Iterable[str]]) -> list[str]:
    """Return the names along one cycle, or nothing where there is none."""
    try:
        TopologicalSorter(chains).prepare()
    except CycleError as error:
        return list(error.args[1][1:])
    return []


def _report(cycle: list[str], symbols: Symbols) -> None:
    inside = {_names(atom): atom for atom in reversed(symbols.related) if set(_names(atom)) <= set(cycle)}
    first, *others = sorted(inside.values(), key=lambda atom: (atom.span.source.name, atom.span.start))
    labels = tuple(Label(atom.span, "and back by this") for atom in others)
    message = f"{' and '.join(sorted(cycle))} are placed by each other alone"
    note = "no chain leads from here to a landmark"
    help_text = "relate one of them to a static class, or give one a landmark"
    symbols.report("Q513", message, first, note, help_text, labels, Severity.WARNING)


def _names(atom: Atom) -> tuple[str, ...]:
    return tuple(argument.text for argument in atom.arguments)
