"""Trees: things each placed by one other, by one choice between single constraints on that pair."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from qsrlang.mixtures.worlds.evidence import telling
from qsrlang.mixtures.worlds.plans import Step, step_of
from qsrlang.mixtures.worlds.roles import instances_in_roles
from qsrlang.mixtures.worlds.supports import Seat, in_region
from qsrlang.relations.graph import Alternative, Authority, Choice, RelationGraph


@dataclass(frozen=True, slots=True, eq=False)
class Twig:
    """A step that places a thing, and the choice of its constraint, with the alternatives to that."""

    step: Step
    choice: Choice
    alternatives: tuple[Alternative, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Tree:
    """Twigs from landmarks on, in the order of placing, and where things sit."""

    twigs: tuple[Twig, ...]
    seats: Mapping[str, Seat]


def tree_of(graph: RelationGraph, names: Iterable[str]) -> Tree | None:
    """Return what names are placed by, if nothing else tells of it; None where it is no tree.

    There what is open about one pair does not depend on what is about another, but for whether things are placed.
    """
    names = tuple(names)
    return graph.derived(
        ("tree", names), lambda: _tree(graph, names), lambda tree: len(tree.twigs) if tree else 0
    )


def _tree(graph: RelationGraph, names: tuple[str, ...]) -> Tree | None:
    if graph.evidence and telling(graph, names):
        return None
    seats: dict[str, Seat] = {}
    twigs: list[Twig] = []
    if all(_grown(graph, name, seats, twigs) for name in names):
        return Tree(tuple(twigs), seats)
    return None


def _grown(graph: RelationGraph, name: str, seats: dict[str, Seat], twigs: list[Twig]) -> bool:
    """Add a name and all that it is placed by to a tree, if it is of one."""
    way: dict[str, Choice] = {}
    while name not in seats:
        instances = graph.instances_of(name)
        if len(instances) == 1:
            seats[name] = Seat(instances[0].name, instances[0])
            break
        choice = None if instances else _own_choice(graph, name)
        if choice is None or name in way:
            return False
        way[name] = choice
        name = choice.alternatives[0].constraints[0].relatum
    for name, choice in reversed(way.items()):
        said = choice.alternatives[0].constraints[0]
        seats[name] = Seat(name, seats[said.relatum].root)
        twigs.append(Twig(step_of(graph, said, seats), choice, _alternatives(choice)))
    return True


def _alternatives(choice: Choice) -> tuple[Alternative, ...]:
    """Return the alternatives of a choice; those of scenes, whatever was counted, have a total share of 1."""
    if choice.authority is not Authority.SCENE:
        return choice.alternatives
    total = sum([one.share for one in choice.alternatives])
    return tuple([Alternative(one.share / total, one.constraints) for one in choice.alternatives])


def _own_choice(graph: RelationGraph, name: str) -> Choice | None:
    """Return all that is said of a thing, if that is one choice between single constraints on one pair."""
    choices = graph.choices_for(name)
    if len(choices) != 1 or len(choices[0].governs) != 1 or instances_in_roles(graph, name):
        return None
    relatum = choices[0].alternatives[0].constraints[0].relatum
    for alternative in choices[0].alternatives:
        said = alternative.constraints[0]
        if len(alternative.constraints) > 1 or said.referent != name or said.relatum != relatum:
            return None
        if said.towards is not None or in_region(said) or graph.pair_of(said) not in choices[0].governs:
            return None
    return choices[0]
