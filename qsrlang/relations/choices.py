"""From the statements of one context to choices between constraints."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping

from qsrlang.language.diagnostics import Label
from qsrlang.language.statements import (
    Alternative,
    Believe,
    Elsewhere,
    Observe,
    ObserveScene,
    Require,
    Scene,
    Statement,
)
from qsrlang.language.syntax import Formula, Name, Role, atoms_of
from qsrlang.relations.evidence import Evidence, check_atoms, evidence_of, with_roles
from qsrlang.relations.graph import Choice, Requirement
from qsrlang.relations.graph import Statement as Citation
from qsrlang.relations.precedence import settle
from qsrlang.relations.symbols import Symbols

_SHARE_SLACK = 1e-9


def build_choices(
    statements: Iterable[Statement], seen: Mapping[str, float], symbols: Symbols
) -> tuple[Choice, ...]:
    """Return the choices of one context: on one pair, shares win over counts, and counts over scenes.

    `seen` tells how often each named scene was observed.
    """
    beliefs: list[tuple[Believe, list[Evidence]]] = []
    counts: list[Evidence] = []
    scenes: list[Evidence] = []
    for statement in statements:
        match statement:
            case Believe():
                beliefs.append((statement, _belief(statement, symbols)))
            case Observe(count=count, formula=formula, fit=fit):
                counts += evidence_of(count, formula, fit, statement, symbols)
            case Scene():
                count = seen.get(statement.name.text, 1.0) if statement.name else 1.0
                scenes += evidence_of(count, _formula(statement, symbols), None, statement, symbols)
    return settle(beliefs, counts, scenes, symbols)


def requirements(statements: Iterable[Statement], symbols: Symbols) -> tuple[Requirement, ...]:
    """Return what is required."""
    required = [one for one in statements if isinstance(one, Require) and check_atoms(one.formula, symbols)]
    return tuple(Requirement(one.share, one.formula, Citation.at(one.span)) for one in required)


def scene_counts(statements: Iterable[Statement], symbols: Symbols) -> dict[str, float]:
    """Return how often each named scene was observed."""
    counts: dict[str, float] = defaultdict(float)
    for statement in statements:
        if isinstance(statement, ObserveScene) and symbols.resolve_scene(statement.scene):
            counts[statement.scene.text] += statement.count
    return counts


def _belief(believe: Believe, symbols: Symbols) -> list[Evidence]:
    _check_shares(believe, symbols)
    without = all(alternative.share is None for alternative in believe.alternatives)
    equal = 1.0 / len(believe.alternatives)
    found: list[Evidence] = []
    for one in believe.alternatives:
        share = equal if without else (one.share or 0.0)
        if not isinstance(one.formula, Elsewhere):
            found += evidence_of(share, one.formula, one.fit, one, symbols)
    return found


def _check_shares(believe: Believe, symbols: Symbols) -> None:
    given = [one for one in believe.alternatives if one.share is not None]
    bare = [one for one in believe.alternatives if one.share is None]
    nowhere = [one for one in believe.alternatives if isinstance(one.formula, Elsewhere)]
    for again in nowhere[1:]:
        first = (Label(nowhere[0].span, "first given here"),)
        symbols.report("Q305", "'elsewhere' is given twice", again, labels=first)
    missing = [one for one in bare if not isinstance(one.formula, Elsewhere)]
    if given and missing:
        labels = tuple(Label(one.span, f"this one has {one.share:g}") for one in given)
        message = "some alternatives have a share and some have none"
        symbols.report("Q402", message, missing[0], "this one has none", labels=labels)
    total = sum(one.share or 0.0 for one in given)
    if total > 1.0 + _SHARE_SLACK:
        _report_total(believe, total, given, symbols)


def _report_total(believe: Believe, total: float, given: list[Alternative], symbols: Symbols) -> None:
    labels = tuple(Label(one.span, f"{one.share:g} of it") for one in given) if len(given) > 1 else ()
    help_text = "shares of exclusive alternatives sum to at most 1; the rest is elsewhere"
    symbols.report("Q401", f"the shares sum to {total:g}", believe, "", help_text, labels)


def _formula(scene: Scene, symbols: Symbols) -> Formula:
    """Return a scene's formula with its roles told apart; what is not among its members is reported."""
    roles: dict[str, Role] = {}
    for member in scene.members:
        if isinstance(member, Role):
            _take_role(member, roles, symbols)
    formula = with_roles(scene.formula, roles)
    members = {member.text for member in scene.members}
    for atom in atoms_of(formula):
        for argument in atom.arguments:
            if argument.text not in members and _known(argument, symbols):
                help_text = f"add '{argument}' to the scene's members"
                symbols.report(
                    "Q211", f"'{argument}' is not among the scene's members", argument, "", help_text
                )
    return formula


def _take_role(member: Role, roles: dict[str, Role], symbols: Symbols) -> None:
    first = roles.setdefault(member.role.text, member)
    if first.kind != member.kind:
        labels = (Label(first.span, f"here it is a {first.kind}"),)
        symbols.report("Q410", f"the role '{member.role}' stands for two classes", member, labels=labels)


def _known(argument: Name | Role, symbols: Symbols) -> bool:
    return isinstance(argument, Role) or argument.text in symbols.classes
