"""How probable a formula is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from qsrlang.arrays import FloatArray
from qsrlang.errors import ImpossibleConditionError, UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom, Formula, atoms_of
from qsrlang.mixtures.draws.conditioning import Drawing, draw_scenes, effective_draws, ratio_error
from qsrlang.mixtures.draws.conditions import Condition, assumed_atoms, conditions_on, objects_of
from qsrlang.mixtures.manner import Manner
from qsrlang.mixtures.solving.pairs import direction_probability
from qsrlang.mixtures.solving.tables import MAX_ATOMS, TruthTables, truth_of
from qsrlang.mixtures.solving.trees import tree_table
from qsrlang.mixtures.solving.weighing import Assumed, Solved, solve_worlds
from qsrlang.mixtures.weighed import Weighed
from qsrlang.mixtures.worlds.chains import broken_chains, is_tied
from qsrlang.relations.graph import RelationGraph

EXACT, GAUSSIAN, DRAWS = "exact", "Gaussian", "draws"


@dataclass(frozen=True, slots=True)
class Probability:
    """How probable a formula is, and how that was found.

    `method` is "exact" (the share of the stated densities), "Gaussian" (that of the worlds' Gaussians) or "draws": then
    there is a standard error, and `draws` is how many independent draws would be as good. `assumed` are the texts of
    what was given or required, `dropped` the prior mass of the combinations of alternatives that were left out.
    """

    formula: str
    value: float
    method: str
    standard_error: float = 0.0
    draws: float | None = None
    assumed: tuple[str, ...] = ()
    dropped: float = 0.0

    def to_json(self) -> dict[str, object]:
        """Return the answer as plain data."""
        return {
            "formula": self.formula,
            "probability": self.value,
            "method": self.method,
            "standard_error": self.standard_error,
            "effective_draws": self.draws,
            "assumed": list(self.assumed),
            "dropped": self.dropped,
        }

    def __str__(self) -> str:
        given = f" given {', '.join(self.assumed)}" if self.assumed else ""
        error = f" ± {self.standard_error:.1g}" if self.method == DRAWS else f" ({self.method})"
        return f"prob {self.formula}{given}: {self.value:.4f}{error}"


@dataclass(frozen=True, slots=True, eq=False)
class Proved:
    """How probable a formula is, and the worlds behind that, with the share of each in which it holds."""

    answer: Probability
    worlds: Sequence[Weighed]
    shares: Sequence[float]


def probability(graph: RelationGraph, formula: Formula, given: Formula | None, how: Manner) -> Probability:
    """Return P(formula | given, requirements), as `prove` does; of trees without telling worlds apart."""
    found = _of_tree(graph, (_Question.of(graph, formula, given),), how.viewer)
    return found[0] if found else prove(graph, formula, given, how).answer


def probabilities(
    graph: RelationGraph, formulas: Sequence[Formula], given: Formula | None, how: Manner
) -> tuple[Probability, ...]:
    """Return P(formula | given, requirements) of several formulas; of trees all from one table."""
    found = _of_tree(graph, [_Question.of(graph, one, given) for one in formulas], how.viewer)
    return found or tuple(probability(graph, one, given, how) for one in formulas)


@dataclass(frozen=True, slots=True, eq=False)
class _Question:
    """A formula, the conditions on what it depends on, and the different atoms of all of them."""

    formula: Formula
    conditions: tuple[Condition, ...]
    atoms: tuple[Atom, ...]

    @classmethod
    def of(cls, graph: RelationGraph, formula: Formula, given: Formula | None) -> _Question:
        conditions = conditions_on(graph, objects_of(formula), given)
        atoms = (*atoms_of(formula), *assumed_atoms(conditions))
        return cls(formula, conditions, tuple(dict.fromkeys(atoms)))

    @property
    def names(self) -> tuple[str, ...]:
        """The things that it speaks of."""
        return objects_of(*self.atoms)

    @property
    def texts(self) -> tuple[str, ...]:
        """What is assumed, as it was written."""
        return tuple([one.text for one in self.conditions])


def _of_tree(
    graph: RelationGraph, questions: Sequence[_Question], viewer: Pose2 | None
) -> tuple[Probability, ...] | None:
    atoms = tuple(dict.fromkeys([atom for one in questions for atom in one.atoms]))
    if len(atoms) > MAX_ATOMS:
        return None
    table = tree_table(graph, objects_of(*atoms), TruthTables(graph, atoms, viewer))
    if table is None:
        return None
    return tuple([_read_off(table, _Telling.of(one, atoms), one) for one in questions])


def _read_off(table: FloatArray, telling: _Telling, question: _Question) -> Probability:
    true, whole = telling.weighed(table)
    if not whole > 0.0:
        raise ImpossibleConditionError(question.texts, 0)
    return Probability(text_of(question.formula), min(true / whole, 1.0), EXACT, assumed=question.texts)


def prove(graph: RelationGraph, formula: Formula, given: Formula | None, how: Manner) -> Proved:
    """Return P(formula | given, requirements) over worlds and places, with its proof.

    By truth tables of the stated densities where those tell; of one direction, with nothing assumed, by the Gaussian
    of each world; else by weighted draws of the true densities. What a world does not place holds in no relation there.
    Raises UnreachedTargetError where no world places something, ImpossibleConditionError, NoRoomError,
    MissingFacingError.
    """
    question = _Question.of(graph, formula, given)
    for name in question.names:
        if not is_tied(graph, name):
            raise UnreachedTargetError(name, broken_chains(graph, name))
    found = _without_draws(graph, question, how.viewer, how.bounds.worlds)
    return found or _by_draws(graph, question, how.drawing())


def _without_draws(
    graph: RelationGraph, question: _Question, viewer: Pose2 | None, limit: int
) -> Proved | None:
    if len(question.atoms) > MAX_ATOMS:
        return None
    solution = solve_worlds(graph, question.names, viewer, limit, question.atoms, is_needed=False)
    tables, telling = TruthTables(graph, question.atoms, viewer), _Telling.of(question, question.atoms)
    told = []
    for one in solution.worlds:
        found = telling.masses(tables.of(one)) or _by_cone(graph, question, telling, one, viewer)
        if found is None:
            return None
        told.append(found)
    masses = [one.weight * whole for one, (_, whole, _) in zip(solution.worlds, told, strict=True)]
    total = sum(masses)
    if not total > 0.0:
        raise ImpossibleConditionError(question.texts, 0)
    worlds = [Assumed(one, mass / total) for one, mass in zip(solution.worlds, masses, strict=True)]
    shares = [true / whole if whole > 0.0 else 0.0 for true, whole, _ in told]
    value = sum(one.weight * share for one, share in zip(worlds, shares, strict=True))
    method = EXACT if all(exact for *_, exact in told) else GAUSSIAN
    text = text_of(question.formula)
    answer = Probability(text, min(value, 1.0), method, assumed=question.texts, dropped=solution.dropped)
    return Proved(answer, worlds, shares)


def _by_cone(
    graph: RelationGraph, question: _Question, telling: _Telling, solved: Solved, viewer: Pose2 | None
) -> tuple[float, float, bool] | None:
    """Return the mass of a world in which one direction holds or not, by its Gaussian, and that of the world."""
    if question.conditions or len(question.atoms) != 1:
        return None
    share = direction_probability(graph, solved, question.atoms[0], viewer)
    return None if share is None else (float(telling.held @ [1.0 - share, share]), 1.0, False)


@dataclass(frozen=True, slots=True, eq=False)
class _Telling:
    """Where, among the combinations of atoms, a formula holds, and how its conditions weigh them."""

    held: FloatArray
    assumed: FloatArray | None

    @classmethod
    def of(cls, question: _Question, atoms: Sequence[Atom]) -> _Telling:
        """Return what is to be told of a question, all of whose atoms are among `atoms`."""
        held, assumed = truth_of(question.formula, atoms).astype(float), None
        for one in question.conditions:
            factor = one.factor(truth_of(one.formula, atoms))
            held, assumed = held * factor, factor if assumed is None else assumed * factor
        return cls(held, assumed)

    def weighed(self, table: FloatArray) -> tuple[float, float]:
        """Return the mass of a table in which formula and conditions hold, and that of the conditions."""
        whole = 1.0 if self.assumed is None else float((table * self.assumed).sum())
        return float((table * self.held).sum()), whole

    def masses(self, found: tuple[FloatArray, bool] | None) -> tuple[float, float, bool] | None:
        """Return the mass of a world's table in which formula and conditions hold, that of the latter, and if exact."""
        return None if found is None else (*self.weighed(found[0]), found[1])


def _by_draws(graph: RelationGraph, question: _Question, drawing: Drawing) -> Proved:
    formula, conditions = question.formula, question.conditions
    drawn, dropped = draw_scenes(graph, objects_of(formula), conditions, drawing, tuple(atoms_of(formula)))
    held = [one.outlook.holds(formula) for one in drawn]
    masses = [float(one.weights @ is_held) for one, is_held in zip(drawn, held, strict=True)]
    value = sum(masses)
    answer = Probability(
        text_of(formula),
        min(value, 1.0),
        DRAWS,
        ratio_error(drawn, held, value),
        effective_draws(drawn),
        question.texts,
        dropped,
    )
    weights = [one.weight for one in drawn]
    shares = [mass / weight if weight > 0.0 else 0.0 for mass, weight in zip(masses, weights, strict=True)]
    return Proved(answer, drawn, shares)


def text_of(formula: Formula) -> str:
    """Return a formula as it was written, on one line."""
    return " ".join(formula.span.text.split())
