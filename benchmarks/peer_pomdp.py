"""pomdp-py's POUCT and our rollout in pomdp-py's own domain, multi-object search on a grid.

The worlds and the belief update are the same for both.

Run by `make bench-search` in an environment that holds pomdp-py and qsrlang (`make peers`). A step is a move to a
neighbouring cell, a look, or a "find", which is right where the objects in range are declared. Intervals are 95 %
bootstrap intervals of the paired difference.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import math
import random
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pomdp_py
from pomdp_py.problems.multi_object_search.domain.action import Find, Look, MotionAction
from pomdp_py.problems.multi_object_search.env.env import make_proximity_sensor
from pomdp_py.problems.multi_object_search.example_worlds import random_world
from pomdp_py.problems.multi_object_search.problem import MosOOPOMDP, belief_update
from scipy.sparse import csr_array
from scipy.sparse.csgraph import shortest_path

from qsrlang.planning.instances import ONE
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.rollout import Rollout
from qsrlang.planning.threads import use_threads
from qsrlang.planning.views import Views, beside

SIDE, OBJECTS, RADIUS, RATE, MOST_STEPS = 10, 1, 4, 0.95, 200
SURE, SPREAD = 0.8, 1.5
SIMULATIONS = (500, 2_000)
STRATEGY = Rollout()


class Untold:
    """Takes the place of a planner where a belief update wants one."""

    def update(self, *arguments: object) -> None:
        """Do nothing."""


def world(seed: int, prior: str) -> MosOOPOMDP:
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002 - pomdp-py draws from numpy's global state
    grid, robot = random_world(SIDE, SIDE, OBJECTS, SIDE * SIDE // 10)
    sensors = {robot: make_proximity_sensor(RADIUS, False)}
    kwargs = {"sigma": 0.05, "epsilon": RATE, "agent_has_map": True}
    problem = MosOOPOMDP(robot, grid_map=grid, sensors=sensors, prior="uniform", **kwargs)
    if prior == "uniform":
        return problem
    return MosOOPOMDP(robot, env=problem.env, prior=landmark_prior(problem), **kwargs)


def landmark_prior(problem: MosOOPOMDP) -> dict[int, dict[tuple[int, int], float]]:
    """Return a Gaussian prior about a landmark near each object."""
    prior = {}
    for thing in problem.env.target_objects:
        x, y = problem.env.state.pose(thing)
        cx, cy = x + random.gauss(0.0, SPREAD), y + random.gauss(0.0, SPREAD)
        prior[thing] = {
            (i, j): 1e-3 / SIDE**2 + math.exp(-((i - cx) ** 2 + (j - cy) ** 2) / (2 * SPREAD**2))
            for i in range(SIDE)
            for j in range(SIDE)
        }
    return prior


@dataclass
class Episode:
    """A run in one world: acts, counts the steps, and adds up the processor time spent planning [s]."""

    problem: MosOOPOMDP
    planner: object
    steps: int = 0
    planning: float = 0.0
    decisions: int = 0

    @property
    def robot(self) -> int:
        return self.problem.agent.robot_id

    @property
    def found(self) -> set[int]:
        return set(self.problem.env.state.object_states[self.robot].objects_found)

    @property
    def is_over(self) -> bool:
        return self.found == self.problem.env.target_objects or self.steps >= MOST_STEPS

    def act(self, action: object) -> None:
        env, agent = self.problem.env, self.problem.agent
        env.state_transition(action, execute=True, robot_id=self.robot)
        observation = env.provide_observation(agent.observation_model, action)
        agent.clear_history()
        agent.update_history(action, observation)
        belief_update(agent, action, observation, env.state.object_states[self.robot], self.planner)
        self.steps += 1

    def timed(self, choose):
        begin = time.process_time()
        choice = choose()
        self.planning += time.process_time() - begin
        self.decisions += 1
        return choice


def play_pouct(problem: MosOOPOMDP, simulations: int, heuristic: bool) -> Episode:
    policy = problem.agent.policy_model
    if heuristic:
        policy = Eager(problem)
    planner = pomdp_py.POUCT(
        max_depth=10,
        discount_factor=0.99,
        exploration_const=1000,
        num_sims=simulations,
        rollout_policy=policy,
    )
    episode = Episode(problem, planner)
    while not episode.is_over:
        episode.act(episode.timed(lambda: planner.plan(problem.agent)))
    return episode


class Eager(pomdp_py.RolloutPolicy):
    """A heuristic for POUCT's rollouts: find what is in range, else move towards the nearest object not yet found."""

    def __init__(self, problem: MosOOPOMDP) -> None:
        self._problem = problem
        self._motions = [
            action
            for action in problem.agent.policy_model.get_all_actions()
            if isinstance(action, MotionAction)
        ]

    def rollout(self, state, history=None):
        robot = self._problem.agent.robot_id
        here, found = state.pose(robot)[:2], state.object_states[robot].objects_found
        left = [state.pose(thing) for thing in self._problem.env.target_objects if thing not in found]
        if not left:
            return Find
        goal = min(left, key=lambda place: math.dist(place, here))
        if math.dist(goal, here) <= RADIUS:
            return Find if random.random() < 0.5 else Look
        return min(
            self._motions, key=lambda a: math.dist((here[0] + a.motion[0], here[1] + a.motion[1]), goal)
        )


def play_ours(problem: MosOOPOMDP) -> Episode:
    episode = Episode(problem, Untold())
    ground = episode.timed(lambda: Ground.of(problem))
    while not episode.is_over:
        for action in episode.timed(lambda: plan(episode, ground)):
            episode.act(action)
            if episode.is_over:
                break
        if not episode.is_over and surest(episode) > SURE:
            episode.act(Find)
    return episode


@dataclass(frozen=True)
class Ground:
    """The free cells of a world (N, 2), the steps between them (N, N), and what is in range of each: made once.

    `before` (N, N) holds the cell before each cell on the way from each; `motions` the actions by their steps.
    """

    cells: np.ndarray
    steps: np.ndarray
    before: np.ndarray
    motions: dict[tuple[int, int], object]
    views: Views

    @classmethod
    def of(cls, problem: MosOOPOMDP) -> Ground:
        blocked = {problem.env.state.pose(thing)[:2] for thing in problem.env.obstacles}
        actions = problem.agent.policy_model.get_all_actions()
        motions = {tuple(one.motion[:2]): one for one in actions if isinstance(one, MotionAction)}
        cells = np.array([(x, y) for x in range(SIDE) for y in range(SIDE) if (x, y) not in blocked])
        moves = cells[None] - cells[:, None] + SIDE
        allowed = np.zeros((2 * SIDE + 1, 2 * SIDE + 1), dtype=bool)
        allowed[tuple(np.array(list(motions)).T + SIDE)] = True
        steps, before = shortest_path(
            csr_array(allowed[moves[..., 0], moves[..., 1]]), unweighted=True, return_predecessors=True
        )
        columns, rows = np.indices((SIDE, SIDE))
        grid = np.column_stack([columns.ravel(), rows.ravel()])
        inside = np.hypot(*(grid[None] - cells[:, None]).transpose(2, 0, 1)) <= RADIUS
        poses = np.column_stack([cells, np.zeros(len(cells))])
        return cls(cells, steps, before, motions, Views.of_rates(poses, RATE * inside))

    def index(self, cell: tuple[int, int]) -> int:
        return int(np.flatnonzero((self.cells == cell).all(axis=1))[0])

    def way(self, start: int, goal: int) -> list[object]:
        actions = []
        while goal != start:
            last = int(self.before[start, goal])
            actions.append(self.motions[tuple((self.cells[goal] - self.cells[last]).tolist())])
            goal = last
        return actions[::-1]


def beliefs(episode: Episode) -> list[np.ndarray]:
    """Return what is believed of each object not yet found, a (W, H) table of sum 1."""
    tables = []
    for thing in sorted(episode.problem.env.target_objects - episode.found):
        told = episode.problem.agent.cur_belief.object_belief(thing)
        table = np.zeros((SIDE, SIDE))
        for state in told:
            table[state.pose[0], state.pose[1]] += told[state]
        tables.append(table / table.sum())
    return tables


def surest(episode: Episode) -> float:
    x, y = episode.problem.env.state.pose(episode.robot)[:2]
    columns, rows = np.indices((SIDE, SIDE))
    near = np.hypot(columns - x, rows - y) <= RADIUS
    return max(float(table[near].sum()) for table in beliefs(episode))


def plan(episode: Episode, ground: Ground) -> list[object]:
    """Return the moves to the view our rollout ranks first, and the look there."""
    here = ground.index(tuple(episode.problem.env.state.pose(episode.robot)[:2]))
    tables = beliefs(episode)
    problem = ViewProblem(
        views=beside([ground.views] * len(tables)),
        mass=np.concatenate([table.ravel() for table in tables]),
        first=ground.steps[here] + 1.0,
        between=ground.steps + 1.0,
        seconds=float(MOST_STEPS),
        goal_of=np.repeat(np.arange(len(tables)), SIDE * SIDE),
        absent=np.zeros(len(tables)),
        instances=(ONE,) * len(tables),
    )
    values = STRATEGY.rank(problem, np.random.default_rng(0)).values
    return [*ground.way(here, int(np.argmax(values))), Look]


@dataclass(frozen=True)
class Run:
    """What became of an episode: its steps, its decisions, and the processor time they took [s]."""

    steps: int
    planning: float
    decisions: int

    @classmethod
    def of(cls, episode: Episode) -> Run:
        return cls(episode.steps, episode.planning, episode.decisions)


@dataclass(frozen=True)
class Setting:
    """How POUCT is run: by which prior, with how many simulations, and what its rollouts follow."""

    prior: str
    simulations: int
    rollouts: str

    def __str__(self) -> str:
        return f"POUCT, {self.simulations} simulations, {self.rollouts} rollouts"

    def play(self, seed: int) -> Run:
        with contextlib.redirect_stdout(io.StringIO()):
            return Run.of(play_pouct(world(seed, self.prior), self.simulations, self.rollouts == "heuristic"))


class Kept:
    """The runs of POUCT in a file of one JSON object a line, so that a run that was stopped goes on where it was."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        lines = path.read_text().splitlines() if path is not None and path.is_file() else []
        told = [json.loads(line) for line in lines]
        self._runs = {(Setting(**one["setting"]), one["seed"]): Run(**one["run"]) for one in told}

    def played(self, setting: Setting, seed: int) -> Run:
        if (setting, seed) not in self._runs:
            run = self._runs[setting, seed] = setting.play(seed)
            self._write({"setting": asdict(setting), "seed": seed, "run": asdict(run)})
        return self._runs[setting, seed]

    def _write(self, line: dict[str, object]) -> None:
        if self._path is not None:
            with self._path.open("a") as out:
                out.write(json.dumps(line) + "\n")


def play_prior(prior: str, seeds: int) -> list[Run]:
    """Return our runs, after one that compiles the kernels."""
    with contextlib.redirect_stdout(io.StringIO()):
        play_ours(world(0, prior))
        return [Run.of(play_ours(world(seed, prior))) for seed in range(seeds)]


def steps_of(runs: list[Run]) -> np.ndarray:
    return np.array([run.steps for run in runs], dtype=float)


def milliseconds(runs: list[Run]) -> float:
    return 1e3 * sum(run.planning for run in runs) / sum(run.decisions for run in runs)


def tell_ours(prior: str, ours: list[Run]) -> None:
    print(f"  {prior} prior, {SIDE} x {SIDE}, {OBJECTS} object, {len(ours)} seeds; processor time")
    print(
        f"    ours: rollout                                {steps_of(ours).mean():6.2f} steps  "
        f"{milliseconds(ours):8.2f} ms a decision",
        flush=True,
    )


def tell_theirs(setting: Setting, theirs: list[Run], ours: list[Run]) -> None:
    less = steps_of(ours) - steps_of(theirs)
    low, high = interval(less)
    share = sum(run.planning for run in ours) / sum(run.planning for run in theirs)
    print(
        f"    {setting!s:44s} {steps_of(theirs).mean():6.2f} steps  {milliseconds(theirs):8.1f} ms a decision; "
        f"ours less theirs {less.mean():+.2f} [{low:+.2f}, {high:+.2f}] steps, our planning {share:.4f} of theirs",
        flush=True,
    )


def interval(differences: np.ndarray) -> tuple[float, float]:
    draws = np.random.default_rng(0).choice(differences, (10_000, len(differences))).mean(axis=1)
    return float(np.quantile(draws, 0.025)), float(np.quantile(draws, 0.975))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--simulations", type=int, nargs="+", default=SIMULATIONS)
    parser.add_argument("--priors", nargs="+", default=("uniform", "landmark"))
    parser.add_argument("--rollouts", nargs="+", default=("random", "heuristic"))
    parser.add_argument("--kept", type=Path, help="a file of POUCT's finished runs: read first, and added to")
    options = parser.parse_args()
    use_threads(1)
    kept = Kept(options.kept)
    ours = {prior: play_prior(prior, options.seeds) for prior in options.priors}
    for prior, runs in ours.items():
        tell_ours(prior, runs)
    for simulations in options.simulations:
        for rollouts in options.rollouts:
            for prior, runs in ours.items():
                setting = Setting(prior, simulations, rollouts)
                tell_theirs(setting, [kept.played(setting, seed) for seed in range(options.seeds)], runs)


if __name__ == "__main__":
    main()
