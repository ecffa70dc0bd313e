"""Which names may stand where the grammar expects one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from qsrlang.editor.describing import facts
from qsrlang.language.expecting import Expectation
from qsrlang.language.lexing import Word
from qsrlang.relations.build import Built
from qsrlang.relations.occurrences import occurrences

SHOWN_FACTS = 2

_ARGUMENTS = ("role", "class", "landmark")
_WANTED_AFTER = {
    "WHERE": _ARGUMENTS,
    "VIEWS": _ARGUMENTS,
    "LANDMARKS": _ARGUMENTS,
    "EXPLAIN": (*_ARGUMENTS, "relation"),
    "SAMPLE": ("scene", "surface", "landmark"),
    "WRT": ("class", "landmark"),
    "OBSERVE": ("relation", "scene"),
    "TIMES": ("relation", "scene"),
    "ROOM": ("room",),
    "AS": (),
    "DECLARE": (),
    "LANDMARK": (),
    "RELATION": (),
    "SCENE": (),
}
_WANTED_AFTER_COLON = {"ON": ("surface",), "CONVERSE": ("relation",), "DISJOINT": ("relation",)}


class Candidate(NamedTuple):
    """A name that may stand somewhere, what it names, and what is known of it in a few words."""

    text: str
    kind: str
    detail: str


def candidates(expectation: Expectation, built: Built) -> Iterator[Candidate]:
    """Yield the names that fit where the grammar expects one; in a scene's formula, its members and the landmarks."""
    wanted = wanted_kinds(expectation)
    in_atom = wanted == _ARGUMENTS
    members = list(_members(expectation.words)) if in_atom else []
    others = ("landmark",) if members else wanted
    named = dict.fromkeys([*members, *((kind, name) for kind in others for name in names_of(kind, built))])
    taken = _arguments_so_far(expectation.words) if in_atom else set()
    for kind, name in named:
        if name not in taken:
            known_as = _kind_of(kind, name, built)
            told = [fact for fact in facts(known_as, name, built) if not fact.endswith(": any")]
            yield Candidate(name, known_as, ", ".join(told[:SHOWN_FACTS]))


def wanted_kinds(expectation: Expectation) -> tuple[str, ...]:
    """Return what kinds of names fit, told by the words that are still open."""
    types = [word.type if word is not None else "" for word in expectation.open]
    last, before = ["", "", *types][-1], ["", "", *types][-2]
    if last in ("LPAR", "COMMA", "LBRACE"):
        return _wanted_in_list(types)
    if last == "COLON":
        return _WANTED_AFTER_COLON.get(before, ("class",))
    return _WANTED_AFTER.get(last, ("relation",))


def names_of(kind: str, built: Built) -> Iterable[str]:
    """Return the names of a kind, in the order they were met; a surface is a class that supports things."""
    symbols = built.symbols
    match kind:
        case "surface":
            return [one.name for one in symbols.classes.values() if one.is_surface]
        case "room":
            return dict.fromkeys(one.name for one in occurrences(built.library) if one.kind == "room")
        case _:
            tables: Mapping[str, Iterable[str]] = {
                "class": symbols.classes,
                "landmark": symbols.landmarks,
                "relation": symbols.relations,
                "scene": symbols.scenes,
                "role": symbols.roles,
                "default": symbols.defaults,
            }
            return tables[kind]


def _wanted_in_list(types: list[str]) -> tuple[str, ...]:
    """Return what fits after a parenthesis, a brace or a comma: told by what stands before the list."""
    if "DEFAULTS" in types:
        return ("default",)
    if "LPAR" not in types:
        return ()
    opening = len(types) - 1 - types[::-1].index("LPAR")
    before, head = ["", "", *types[:opening]][-1], ["", "", *types[:opening]][-2]
    if before == "NAME":
        return {"RELATION": (), "SCENE": ("class", "landmark")}.get(head, _ARGUMENTS)
    return {"SCENE": ("class", "landmark")}.get(before, ("relation",))


def _kind_of(kind: str, name: str, built: Built) -> str:
    if kind == "surface":
        return "class"
    return "landmark" if kind == "class" and name in built.symbols.landmarks else kind


def _members(words: tuple[Word, ...]) -> Iterator[tuple[str, str]]:
    """Yield the members of the scene whose formula is being written: its roles, and its classes and landmarks."""
    types = [word.type for word in words]
    if types[:1] != ["SCENE"] or "IFF" not in types:
        return
    for at in range(1, types.index("IFF")):
        if types[at] == "NAME" and types[at + 1] == "COLON":
            yield "role", str(words[at])
        elif types[at] == "NAME" and types[at - 1] != "COLON" and types[at + 1] != "LPAR":
            yield "class", str(words[at])


def _arguments_so_far(words: tuple[Word, ...]) -> set[str]:
    types = [word.type for word in words]
    opening = len(types) - types[::-1].index("LPAR") if "LPAR" in types else len(types)
    return {str(word) for word in words[opening:] if word.type == "NAME"}
