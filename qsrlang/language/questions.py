"""The queries of the language as nodes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from qsrlang.language.syntax import Argument, Atom, Formula, Name, Node


@dataclass(frozen=True, slots=True)
class Circumstances(Node):
    """Where and when a query is asked: a room, "weekday" or "weekend", minutes after midnight; None is not said."""

    room: Name | None = None
    days: str | None = None
    time: int | None = None


@dataclass(frozen=True, slots=True)
class Question(Node):
    """A query; `given` is what is assumed to hold besides, `circumstances` where and when it is asked."""

    given: Formula | None = field(default=None, kw_only=True)
    circumstances: Circumstances | None = field(default=None, kw_only=True)


@dataclass(frozen=True, slots=True)
class Where(Question):
    """`where Cup?`, or relative to a class: `where Cup wrt Keyboard?`."""

    target: Argument
    relatum: Name | None = None


@dataclass(frozen=True, slots=True)
class Prob(Question):
    """`prob right-of(Cup, Keyboard) given close-to(Cup, Keyboard)?`: how probable a formula is."""

    formula: Formula


@dataclass(frozen=True, slots=True)
class Explain(Question):
    """`explain Cup?`: every chain from a landmark; `explain right-of(Cup, Keyboard)?`: the proof of a probability."""

    subject: Argument | Atom
    relatum: Name | None = None


@dataclass(frozen=True, slots=True)
class Views(Question):
    """`views Cup?`: the best views on the loaded map."""

    target: Argument


@dataclass(frozen=True, slots=True)
class Landmarks(Question):
    """`landmarks Cup?`: landmarks ranked by how much knowing each one narrows the search."""

    target: Argument


@dataclass(frozen=True, slots=True)
class Sample(Question):
    """`sample desk 100?`: joint scenes; of a scene, a surface or a landmark, or of all that is known."""

    subject: Name | None
    count: int


@dataclass(frozen=True, slots=True)
class Check(Question):
    """`check?`: whether what is known is consistent."""


Query: TypeAlias = Where | Prob | Explain | Views | Landmarks | Sample | Check
