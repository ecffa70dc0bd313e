"""Proof trees: why a target is where it is, or a formula as probable as it is, decision by decision."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.answers import Component, Where
from qsrlang.mixtures.inference import Placed
from qsrlang.mixtures.probability import Probability, Proved
from qsrlang.mixtures.weighed import MIN_WEIGHT, Weighed, component_of
from qsrlang.mixtures.worlds.drafts import Outcome
from qsrlang.relations.graph import Alternative, Choice, Constraint, Landmark

MAX_SHOWN = 12


@dataclass(frozen=True, slots=True, eq=False)
class Spot:
    """Where a thing is in a world: mean (2,) [m], and the greater and lesser deviation [m]."""

    name: str
    mean: FloatArray
    deviations: tuple[float, float]

    def __str__(self) -> str:
        (x, y), (major, minor) = self.mean.round(3) + 0.0, self.deviations
        return f"{self.name} at ({x:.3f}, {y:.3f}) ± {major:.3f} × {minor:.3f} m"


@dataclass(frozen=True, slots=True, eq=False)
class Reason:
    """One decision of a world: its share among the alternatives, the statements it rests on, and what they place."""

    share: float
    texts: tuple[str, ...]
    spots: tuple[Spot, ...] = ()

    def lines(self) -> Iterator[str]:
        """Yield it as lines of text."""
        for number, text in enumerate(self.texts):
            yield f"{self.share:.3f}  {text}" if number == 0 else f"       {text}"
        for spot in self.spots:
            yield f"         {spot}"


@dataclass(frozen=True, slots=True, eq=False)
class Proof:
    """One world: weight = (product of its reasons' shares) x evidence; `value` is what it says of the question.

    Of a target, `spot` is where that is, None where it is elsewhere, and `value` is 1 or 0; of a formula, `value` is
    the share of the world in which it holds.
    """

    weight: float
    evidence: float
    reasons: tuple[Reason, ...]
    value: float
    spot: Spot | None

    @property
    def prior(self) -> float:
        """The product of the shares."""
        product = 1.0
        for reason in self.reasons:
            product *= reason.share
        return product

    def to_json(self) -> dict[str, object]:
        """Return the proof as plain data."""
        return {
            "weight": self.weight,
            "prior": self.prior,
            "evidence": self.evidence,
            "value": self.value,
            "mean": None if self.spot is None else self.spot.mean.tolist(),
            "reasons": [
                {
                    "share": reason.share,
                    "statements": list(reason.texts),
                    "places": {spot.name: spot.mean.tolist() for spot in reason.spots},
                }
                for reason in self.reasons
            ],
        }


@dataclass(frozen=True, slots=True, eq=False)
class Explanation:
    """Why an answer is what it is: the worlds behind it, heaviest first; their weights sum to 1.

    Of a formula, sum of weight x value is its probability; of a target, the worlds that place it are the components
    of `where` (before those are reduced in number), and the weights of the others its `elsewhere`.
    """

    answer: Where | Probability
    proofs: tuple[Proof, ...]

    def to_json(self) -> dict[str, object]:
        """Return the explanation as plain data."""
        return {"answer": self.answer.to_json(), "proofs": [proof.to_json() for proof in self.proofs]}

    @property
    def assumed(self) -> tuple[str, ...]:
        """The texts of what was given or required."""
        return self.answer.assumed

    @property
    def draws(self) -> float | None:
        """How many independent draws would be as good, where the answer comes from draws."""
        return self.answer.draws

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> Iterator[str]:
        """Yield the tree as lines of text, up to MAX_SHOWN worlds of it."""
        yield _heading(self.answer)
        shown, rest = self.proofs[:MAX_SHOWN], self.proofs[MAX_SHOWN:]
        for number, proof in enumerate(shown, start=1):
            is_last = number == len(shown) and not rest
            yield from _branch(proof, isinstance(self.answer, Where), is_last)
        if rest:
            yield f"└─ {len(rest)} more worlds, together {sum(proof.weight for proof in rest):.3f}"


def explain_where(placed: Placed, target: str) -> Explanation:
    """Return why a target is where it is."""
    values = [1.0 if one.world.named(target) in one.plan.seats else 0.0 for one in placed.worlds]
    return Explanation(placed.answer, _proofs(placed.worlds, values, target))


def explain_probability(proved: Proved) -> Explanation:
    """Return why a formula is as probable as it is."""
    return Explanation(proved.answer, _proofs(proved.worlds, proved.shares, None))


def _proofs(worlds: Sequence[Weighed], values: Sequence[float], target: str | None) -> tuple[Proof, ...]:
    found = [
        _proof(one, value, target)
        for one, value in zip(worlds, values, strict=True)
        if one.weight >= MIN_WEIGHT
    ]
    return tuple(sorted(found, key=lambda proof: -proof.weight))


def _proof(weighed: Weighed, value: float, target: str | None) -> Proof:
    world, placed = weighed.world, _spots(weighed)
    names = {landmark.name: name for name, landmark in world.bindings}
    used = {str(constraint.statement) for constraint in weighed.plan.constraints}
    reasons = []
    for share, outcome in world.decided:
        texts, things = _told(outcome, names)
        texts = tuple(text for text in texts if text in used) or texts[:1]
        spots = tuple(placed.pop(name) for name in dict.fromkeys(things) if name in placed)
        reasons.append(Reason(share, texts, spots))
    reasons.reverse()
    spot = None
    if target is not None and value > 0.0:
        spot = _spot(world.named(target), component_of(weighed, target))
    return Proof(weighed.weight, weighed.weight / world.weight, tuple(reasons), value, spot)


def _spots(weighed: Weighed) -> dict[str, Spot]:
    """Return where the steps of a world place their referents."""
    spots = {}
    for step in weighed.plan.steps:
        if step.places:
            component = Component(1.0, *weighed.place(step.referent), ())
            spots[step.constraint.referent] = _spot(step.constraint.referent, component)
    return spots


def _spot(name: str, component: Component) -> Spot:
    major, minor, _ = component.ellipse
    return Spot(name, component.mean, (major, minor))


def _told(outcome: Outcome, names: dict[str, str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return a decision in words, and the referents that it speaks of."""
    match outcome:
        case Landmark(name=name, kind=kind):
            return (f"landmark {name}: the {names.get(name, kind)}",), ()
        case Alternative(constraints=constraints):
            texts = dict.fromkeys(str(one.statement) for one in constraints)
            return tuple(texts), tuple(one.referent for one in constraints)
        case Choice(governs=governs):
            who = ", ".join(sorted({referent for referent, _ in governs}))
            return (f"{who} elsewhere: where no statement names",), ()
        case Constraint(part=(number, count), statement=statement):
            return (f"part {number + 1} of {count}: {statement.text}",), ()
        case _:
            return (f"any: {outcome}",), ()


def _heading(answer: Where | Probability) -> str:
    if isinstance(answer, Probability):
        return str(answer)
    rest = f", elsewhere {answer.elsewhere:.3f}" if answer.elsewhere > 0.0 else ""
    rest += f", dropped {answer.dropped:.2g}" if answer.dropped > 0.0 else ""
    return f"where {answer.target}, frame: {answer.frame}{rest}"


def _branch(proof: Proof, is_place: bool, is_last: bool) -> Iterator[str]:
    said = (
        (str(proof.spot) if proof.spot else "elsewhere") if is_place else f"holds in {proof.value:.4f} of it"
    )
    mark, rail = ("└─", "  ") if is_last else ("├─", "│ ")
    yield f"{mark} {_weight(proof)}: {said}"
    for reason in proof.reasons:
        yield from (f"{rail}   {line}" for line in reason.lines())


def _weight(proof: Proof) -> str:
    """Return the weight, and where it is not the product of the shares alone, how it comes about."""
    if abs(proof.evidence - 1.0) <= 5e-4:
        return f"{proof.weight:.3f}"
    return f"{proof.weight:.3f} = {proof.prior:.3f} × evidence {proof.evidence:.3g}"
