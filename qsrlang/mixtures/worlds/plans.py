"""Plans: in which order the constraints of a world place its objects, from landmarks to a target."""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from qsrlang.language.syntax import Atom
from qsrlang.mixtures.worlds.chains import needed_for
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.mixtures.worlds.supports import Seat, Support, in_region, stated_regions, support_of
from qsrlang.relations.graph import AtomicRelation, Constraint, Landmark, RelationGraph, Statement


@dataclass(frozen=True, slots=True)
class Step:
    """One constraint in the order of placing; `places` is False where it only adds to what is placed already.

    `second` is the second relatum of a ternary relation.
    """

    constraint: Constraint
    referent: Seat
    relatum: Seat
    second: Seat | None
    support: Support | None
    places: bool

    def saying(self, constraint: Constraint) -> Step:
        """Return the same step with another constraint on the same pair."""
        if constraint is self.constraint:
            return self
        return Step(constraint, self.referent, self.relatum, self.second, self.support, self.places)


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The landmarks of a world, the steps that place its objects, and where each object sits in the state.

    `constraints` are those that the steps come from, and the regions that bound their distances, in their order. Plans
    that differ in nothing but what their constraints say have one `layout`.
    """

    landmarks: tuple[Landmark, ...]
    steps: tuple[Step, ...]
    seats: Mapping[str, Seat]
    constraints: tuple[Constraint, ...]
    layout: Layout

    @property
    def fused(self) -> int:
        """How many steps add to what is placed already."""
        return sum(not step.places for step in self.steps)


@dataclass(frozen=True, slots=True)
class _Pattern:
    """A plan, and which of its world's constraints each of its constraints and steps is."""

    plan: Plan
    order: tuple[int, ...]
    stepping: tuple[int, ...]

    def filled(self, constraints: tuple[Constraint, ...]) -> Plan:
        """Return the plan of another world, whose constraints speak of the same pairs."""
        plan = self.plan
        steps = tuple(
            step.saying(constraints[at]) for step, at in zip(plan.steps, self.stepping, strict=True)
        )
        used = tuple(constraints[at] for at in self.order)
        return Plan(plan.landmarks, steps, plan.seats, used, plan.layout)


def plan_world(graph: RelationGraph, world: World, *targets: str, asked: Sequence[Atom] = ()) -> Plan:
    """Return how a world places targets; those that no chain of it ties to a landmark have no seat."""
    (plan,) = plan_worlds(graph, (world,), *targets, asked=asked)
    return plan


def plan_worlds(
    graph: RelationGraph, worlds: Iterable[World], *targets: str, asked: Sequence[Atom] = ()
) -> tuple[Plan, ...]:
    """Return how each world places targets; worlds whose constraints speak of the same pairs are planned once.

    What bounds the distances of the atoms that are `asked` about is among the landmarks.
    """
    patterns: dict[object, _Pattern] = {}
    plans = []
    for world in worlds:
        pairs = tuple([(one.referent, one.relatum, one.towards, in_region(one)) for one in world.constraints])
        key = (pairs, world.bindings, world.aliases, world.absent, world.telling)
        if key in patterns:
            plans.append(patterns[key].filled(world.constraints))
        else:
            patterns[key] = _pattern(graph, world, targets, asked)
            plans.append(patterns[key].plan)
    return tuple(plans)


def _pattern(graph: RelationGraph, world: World, targets: tuple[str, ...], asked: Sequence[Atom]) -> _Pattern:
    helpful = _helpful(world, targets)
    seats = {name: Seat(landmark.name, landmark) for name, landmark in world.bindings}
    regions = stated_regions(helpful)
    used: list[Constraint] = []
    steps: list[Step] = []
    bounds: dict[str, list[Seat]] = defaultdict(list)
    for constraint in _in_order(helpful, seats):
        used.append(constraint)
        places = constraint.referent not in seats
        root = seats[constraint.relatum].root
        referent = seats.setdefault(constraint.referent, Seat(constraint.referent, root))
        if in_region(constraint) and seats[constraint.relatum] in bounds[constraint.referent]:
            continue
        step = _step(graph, constraint, referent, regions, seats, places)
        bounds[constraint.referent] += [step.support.seat] if step.support else []
        steps.append(step)
    landmarks = landmarks_of(graph, world, seats, steps, asked)
    layout = Layout.of(landmarks, [step.referent.block for step in steps if step.places])
    plan = Plan(landmarks, tuple(steps), seats, tuple(used), layout)
    number = {id(constraint): at for at, constraint in enumerate(world.constraints)}
    order = tuple(number[id(constraint)] for constraint in used)
    return _Pattern(plan, order, tuple(number[id(step.constraint)] for step in steps))


def landmarks_of(
    graph: RelationGraph,
    world: World,
    seats: Mapping[str, Seat],
    steps: Sequence[Step],
    asked: Sequence[Atom],
) -> tuple[Landmark, ...]:
    """Return the landmarks that a world is about: those it names, and what bounds its steps and the atoms asked."""
    known = [landmark for _, landmark in world.bindings]
    bounding = filter(None, (asked_step(graph, world, seats, atom) for atom in asked))
    known += [step.support.seat.root for step in (*steps, *bounding) if step.support]
    return tuple({one.name: one for one in known}.values())


def step_of(
    graph: RelationGraph, constraint: Constraint, seats: Mapping[str, Seat], places: bool = True
) -> Step:
    """Return a constraint as a step between things that have seats, none of which is said to be on or in another."""
    return _step(graph, constraint, seats[constraint.referent], {}, seats, places)


def seats_read(*steps: Step) -> tuple[Seat, ...]:
    """Return the things that steps depend on, relata first."""
    read = [step.relatum for step in steps]
    read += [step.second for step in steps if step.second is not None]
    read += [step.support.seat for step in steps if step.support is not None]
    return tuple(dict.fromkeys(read)) if len(read) > 1 else tuple(read)


def asked_step(graph: RelationGraph, world: World, seats: Mapping[str, Seat], atom: Atom) -> Step | None:
    """Return an atom as a step between things that have seats; None where one has none."""
    names = [world.named(argument.text) for argument in atom.arguments]
    if any(name not in seats for name in names):
        return None
    referent, relatum, *towards = names
    related = (AtomicRelation(graph.relations[atom.relation.text].terms[0][1], atom.frame),)
    second = towards[0] if towards else None
    said = Constraint(referent, relatum, related, Statement.at(atom.span), None, second)
    return step_of(graph, said, seats, places=False)


@dataclass(slots=True)
class _Order:
    """Constraints by what they still wait for: regions, which only bound what others tell, come after those."""

    missing: dict[int, int] = field(default_factory=dict)
    ready: deque[Constraint] = field(default_factory=deque)
    regions: deque[Constraint] = field(default_factory=deque)
    waiting: dict[str, list[Constraint]] = field(default_factory=lambda: defaultdict(list))
    open: Counter[str] = field(default_factory=Counter)

    def add(self, constraint: Constraint, seats: Mapping[str, Seat]) -> None:
        """Take in a constraint, ready or not."""
        missing = {name for name in constraint.relata if name not in seats}
        self.missing[id(constraint)] = len(missing)
        for name in missing:
            self.waiting[name].append(constraint)
        if not in_region(constraint):
            self.open[constraint.referent] += 1
        if not missing:
            self._offer(constraint)

    def place(self, name: str) -> None:
        """Make ready what waits for a name alone."""
        for constraint in self.waiting.pop(name, ()):
            self.missing[id(constraint)] -= 1
            if self.missing[id(constraint)] == 0:
                self._offer(constraint)

    def take(self) -> Constraint | None:
        """Return the next constraint; of regions, first one of an object that nothing else is waiting to place."""
        if self.ready:
            constraint = self.ready.popleft()
            self.open[constraint.referent] -= 1
            return constraint
        chosen = next((one for one in self.regions if not self.open[one.referent]), None)
        chosen = chosen or next(iter(self.regions), None)
        if chosen is not None:
            self.regions.remove(chosen)
        return chosen

    def _offer(self, constraint: Constraint) -> None:
        (self.regions if in_region(constraint) else self.ready).append(constraint)


def _in_order(constraints: tuple[Constraint, ...], seats: Mapping[str, Seat]) -> Iterator[Constraint]:
    """Yield the constraints whose relata are placed by then, each as soon as they are."""
    order = _Order()
    placed = set(seats)
    for one in constraints:
        order.add(one, seats)
    while (constraint := order.take()) is not None:
        yield constraint
        if constraint.referent not in placed:
            placed.add(constraint.referent)
            order.place(constraint.referent)


def _step(
    graph: RelationGraph,
    constraint: Constraint,
    referent: Seat,
    regions: Mapping[str, tuple[str, ...]],
    seats: Mapping[str, Seat],
    places: bool,
) -> Step:
    second = None if constraint.towards is None else seats[constraint.towards]
    support = support_of(graph, constraint, regions, seats)
    return Step(constraint, referent, seats[constraint.relatum], second, support, places)


def _helpful(world: World, targets: tuple[str, ...]) -> tuple[Constraint, ...]:
    """Return the constraints that help to place targets, or tell of them, in an order that is always the same."""
    needed = needed_for([*(world.named(target) for target in targets), *world.telling], world.constraints)
    absent = {world.named(name) for name in world.absent}
    known = {name for name, _ in world.bindings} - set(world.telling)
    useful = needed - absent - known
    return tuple(sorted([one for one in world.constraints if one.referent in useful], key=_rank))


def _rank(constraint: Constraint) -> tuple[object, ...]:
    names = tuple([(atom.relation.name, atom.frame.value) for atom in constraint.atoms])
    return (constraint.referent, constraint.relata, in_region(constraint), names, constraint.part)
