"""What learning is worth on desks it has not seen, beside scikit-learn's density estimators, and how fast it is.

python benchmarks/bench_learning.py [pairs] [fusion] [desk] [area] [day] [speed]

Needs the KTH desk table (QSR_DATA, default ../shared/data). A desk is left out, everything is learned from the others
(bandwidths, shares, concentrations, exponents too), and every object on it is scored by its log density [nat]: cut to
the desk and renormalised, 5 % uniform mixed in; desks weigh the same, however often they were scanned.
"""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.mixture import BayesianGaussianMixture, GaussianMixture
from sklearn.neighbors import KernelDensity

import qsrlang as qsr
from qsrlang.learning.cells import cells_of
from qsrlang.learning.experience import experience_of
from qsrlang.learning.fits import written_mixture
from qsrlang.learning.fusion import learn_fusion
from qsrlang.learning.grids import sights_of
from qsrlang.learning.learner import LearnedPair, learn
from qsrlang.learning.observations import NUMBERS, TEXTS, Observations
from qsrlang.learning.placements import placements_of
from qsrlang.learning.reading import read_observations
from qsrlang.learning.rectangles import rectangle_mass
from qsrlang.learning.rhythm import DIRECTIONS, direction_numbers, rhythm_of, shares_by_hour
from qsrlang.learning.specific import PlaceLearner
from qsrlang.learning.sums import PlacementSums, no_sums, sums_of

PAIRS = (
    ("Mouse", "Keyboard"),
    ("Keyboard", "Monitor"),
    ("Mug", "Keyboard"),
    ("Mug", "Monitor"),
    ("Bottle", "Keyboard"),
    ("Lamp", "Monitor"),
    ("Laptop", "Monitor"),
    ("Headphones", "Keyboard"),
    ("Book", "Keyboard"),
    ("Telephone", "Monitor"),
)
TARGETS = sorted({referent for referent, _ in PAIRS})
FLOOR = 0.05
SPACING = 0.03
SCANS = (1, 2, 3, 5, 8, 12)
Fitted = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Cases:
    """All placements of one pair: in the relatum's frame, on the support, and the desks."""

    points: np.ndarray
    low: np.ndarray
    high: np.ndarray
    turns: np.ndarray
    desks: np.ndarray
    scenes: np.ndarray
    rows: np.ndarray

    def take(self, chosen: np.ndarray) -> Cases:
        """Some of the cases."""
        return Cases(*(getattr(self, name)[chosen] for name in self.__dataclass_fields__))

    @property
    def uniform(self) -> np.ndarray:
        """The density anywhere on the desk."""
        return 1.0 / (self.high - self.low).prod(axis=1)

    @property
    def offsets(self) -> np.ndarray:
        """Offsets along the sides of the desk, in which the peers are fitted."""
        cos, sin = np.cos(self.turns), np.sin(self.turns)
        x, y = self.points.T
        return np.column_stack([cos * x - sin * y, sin * x + cos * y])

    def score(self, density: np.ndarray) -> np.ndarray:
        """The log of a density, a share FLOOR uniform."""
        return np.log((1.0 - FLOOR) * density + FLOOR * self.uniform)


def cases_of(seen: Observations, referent: str, relatum: str) -> Cases:
    placed = placements_of(seen)
    words = np.array(seen.words)
    kinds = words[seen.code("kind")]
    own = (kinds[placed.referents] == referent) & (kinds[placed.relata] == relatum)
    rows = placed.referents[own]
    desks, scenes = words[seen.code("place")][rows], words[seen.code("scene")][rows]
    return Cases(
        placed.points[own], placed.low[own], placed.high[own], placed.turns[own], desks, scenes, rows
    )


def gaussian_mixture(peer: Callable[..., object], count: int) -> Callable[[np.ndarray], Fitted]:
    def fit(points: np.ndarray) -> Fitted:
        parts = min(count, len(points))
        model = peer(n_components=parts, random_state=0, max_iter=500).fit(points)
        return model.weights_, model.means_, model.covariances_

    return fit


def kernel_density(bandwidth: float) -> Callable[[np.ndarray], Fitted]:
    """sklearn's KernelDensity as the mixture that it is, with which its score_samples agrees (asserted)."""

    def fit(points: np.ndarray) -> Fitted:
        covariances = np.broadcast_to(bandwidth**2 * np.eye(2), (len(points), 2, 2))
        logs = KernelDensity(bandwidth=bandwidth).fit(points).score_samples(points[:1])
        squares = ((points - points[0]) ** 2).sum(axis=1) / bandwidth**2
        assert np.isclose(np.exp(logs[0]), np.exp(-0.5 * squares).mean() / (2.0 * np.pi * bandwidth**2))
        return np.full(len(points), 1.0 / len(points)), points, covariances

    return fit


PEERS = {
    "GaussianMixture 1": gaussian_mixture(GaussianMixture, 1),
    "GaussianMixture 4": gaussian_mixture(GaussianMixture, 4),
    "BayesianGaussianMixture 12": gaussian_mixture(BayesianGaussianMixture, 12),
    **{f"KernelDensity {h}": kernel_density(h) for h in (0.05, 0.1, 0.15, 0.25)},
}


def peer_density(fitted: Fitted, cases: Cases) -> np.ndarray:
    """The peer's density, cut to the desk in the desk's frame."""
    weights, means, covariances = fitted
    residuals = cases.offsets[:, None] - means
    squares = np.einsum("nmi,mij,nmj->nm", residuals, np.linalg.inv(covariances), residuals)
    heights = np.exp(-0.5 * squares) / (2.0 * np.pi * np.sqrt(np.linalg.det(covariances)))
    masses = rectangle_mass(means[None], covariances[None], cases.low[:, None], cases.high[:, None])
    return (heights @ weights) / np.maximum(masses @ weights, 1e-12)


def by_desk(values: np.ndarray, desks: np.ndarray) -> float:
    return float(np.mean([values[desks == desk].mean() for desk in np.unique(desks)]))


def left_out(seen: Observations) -> Iterator[tuple[str, Observations]]:
    for desk in sorted(set(seen.text("place"))):
        yield desk, seen.among("place", [desk], keep=False)


def pairs(seen: Observations) -> None:
    cases = {pair: cases_of(seen, *pair) for pair in PAIRS}
    scores = {
        name: {pair: np.zeros(len(one.points)) for pair, one in cases.items()} for name in (*PEERS, *OURS)
    }
    for desk, others in left_out(seen):
        learned = learn(sums_of(others))
        for pair, one in cases.items():
            out = one.desks == desk
            if not out.any():
                continue
            test, known = one.take(out), learned.pairs.get(pair)
            for name, fit in PEERS.items():
                scores[name][pair][out] = test.score(peer_density(fit(one.take(~out).offsets), test))
            for name, density in OURS.items():
                scores[name][pair][out] = test.score(density(known, test))
    print_table(cases, scores)


def whole(known: LearnedPair | None, test: Cases) -> np.ndarray:
    """The learned density; of a pair that too few of the other desks have, nothing is known."""
    if known is None:
        return test.uniform
    return known.density.pdf(test.points, test.low, test.high, test.turns)


def as_written(known: LearnedPair | None, test: Cases) -> np.ndarray:
    """What a .qsr file says of it: at most five Gaussians, cut to the desk."""
    if known is None or known.density.mixture is None:
        return test.uniform
    mixture = written_mixture(known.density)
    cos, sin = np.cos(test.turns), np.sin(test.turns)
    turn = np.stack([np.stack([cos, -sin], -1), np.stack([sin, cos], -1)], -2)
    means = np.einsum("nij,mj->nmi", turn, mixture.means)
    covariances = np.einsum("nij,mjk,nlk->nmil", turn, mixture.covariances, turn)
    masses = rectangle_mass(means, covariances, test.low[:, None], test.high[:, None]) @ mixture.weights
    return mixture.pdf(test.points) / masses


OURS = {"ours, one landmark": whole, "ours, as written in .qsr": as_written}


def print_table(
    cases: dict[tuple[str, str], Cases], scores: dict[str, dict[tuple[str, str], np.ndarray]]
) -> None:
    uniform = {pair: by_desk(np.log(one.uniform), one.desks) for pair, one in cases.items()}
    rows = {"uniform": uniform}
    for name, found in scores.items():
        rows[name] = {pair: by_desk(values, cases[pair].desks) for pair, values in found.items()}
    print_rows(rows)
    best = max(np.mean(list(rows[name].values())) for name in PEERS)
    for name in OURS:
        values = np.array(list(rows[name].values()))
        least = float((values - np.array(list(uniform.values()))).min())
        print(
            f"{name}: {values.mean() - best:+.3f} nats on the best single peer; least above uniform {least:+.3f}"
        )


def print_rows(rows: dict[str, dict[tuple[str, str], float]]) -> None:
    print(f"{'log density [nat/object]':28s}" + "".join(f"{a[:5]}|{b[:3]:4s}" for a, b in PAIRS) + "    mean")
    for name, row in rows.items():
        values = [row[pair] for pair in PAIRS]
        print(
            f"{name:28s}" + "".join(f"{value:9.2f}" for value in values) + f"{np.mean(values):9.3f}",
            flush=True,
        )


def fusion(seen: Observations) -> None:
    found: dict[tuple[str, str], list[tuple[str, float]]] = {pair: [] for pair in PAIRS}
    for desk, others in left_out(seen):
        sums = sums_of(others)
        learned = learn(sums, [pair for pair in sums.pairs() if pair[0] in TARGETS])
        fused = learn_fusion(others, learned, TARGETS)
        here = seen.among("place", [desk])
        for target in TARGETS:
            for sight in sights_of(here, target):
                density = np.exp(fused.log_density(sight, SPACING)[-1])
                score = float(np.log((1.0 - FLOOR) * density + FLOOR / sight.area))
                for pair in PAIRS:
                    if pair[0] == target and pair[1] in sight.relata:
                        found[pair].append((desk, score))
    rows = {}
    for pair, scores in found.items():
        rows[pair] = by_desk(np.array([score for _, score in scores]), np.array([desk for desk, _ in scores]))
    print_rows({"ours, all landmarks": rows})


def desk(seen: Observations) -> None:
    """Other desks and the first k scans of a desk, in the order of time, tested on its later scans."""
    gains = desk_gains(seen)
    print_rows({f"above general, {k} scans": {pair: gains[pair][k] for pair in PAIRS} for k in SCANS})


def desk_gains(seen: Observations) -> dict[tuple[str, str], dict[int, float]]:
    """For each pair and number of scans, the gain over general knowledge [nat/object], the mean over desks."""
    gains: dict[tuple[str, str], dict[int, list[float]]] = {pair: {k: [] for k in SCANS} for pair in PAIRS}
    for name, others in left_out(seen):
        here = seen.among("place", [name])
        learner = PlaceLearner.of(sums_of(others), PAIRS)
        order = scan_order(here)
        for pair in PAIRS:
            one = cases_of(here, *pair)
            ranks = np.array([order[scene] for scene in one.scenes])
            for k in SCANS:
                later = one.take(ranks >= k)
                if len(later.points) == 0 or pair not in learner.general.pairs:
                    continue
                first = here.take(np.array([order[scene] < k for scene in here.text("scene")]))
                density = learner.density(pair, sums_of(first))
                own = later.score(density.pdf(later.points, later.low, later.high, later.turns))
                general = later.score(whole(learner.general.pairs[pair], later))
                gains[pair][k].append(float(own.mean() - general.mean()))
    return {pair: {k: float(np.mean(v)) for k, v in found.items()} for pair, found in gains.items()}


def area(seen: Observations) -> None:
    """Part of the desk that is looked at before the object is, from the likeliest place on; desks weigh the same."""
    hand = qsr.load("office/desk")
    hand_names = {"Mug": "Cup"}
    found: dict[str, dict[tuple[str, str], list[float]]] = {}
    for _, others in left_out(seen):
        learned = learn(sums_of(others))
        here = seen.among("place", sorted(set(seen.text("place")) - set(others.text("place"))))
        for pair in PAIRS:
            one = cases_of(here, *pair)
            if len(one.points) == 0:
                continue
            name = hand_names.get(pair[0], pair[0])
            known = name in hand.classes
            by_hand = hand.where(name, wrt=pair[1]).mixture if known else None
            own = learned.pairs.get(pair)
            is_told = own is not None and own.density.mixture is not None
            written = written_mixture(own.density) if is_told else None
            for what, mixture in (("by hand (office/desk)", by_hand), ("learned, as written", written)):
                part = float(searched(mixture, one).mean())
                found.setdefault(what, {}).setdefault(pair, []).append(part)
    print("without knowledge it is 0.5 of the desk for every pair; so it is where a file says nothing of one")
    for what, parts in found.items():
        row = "".join(f"{np.mean(parts[pair]):9.2f}" for pair in PAIRS)
        print(f"{what:28s}{row}{np.mean([np.mean(parts[pair]) for pair in PAIRS]):9.3f}")
    print_paired(found)


def searched(mixture: qsr.GaussianMixture | None, cases: Cases) -> np.ndarray:
    """The part of the desk that is likelier than where the object is: (N,)."""
    if mixture is None:
        return np.full(len(cases.points), 0.5)
    parts = []
    shares = (np.arange(40) + 0.5) / 40
    grid = np.stack(np.meshgrid(shares, shares, indexing="ij"), axis=-1).reshape(-1, 2)
    for n in range(len(cases.points)):
        cos, sin = np.cos(cases.turns[n]), np.sin(cases.turns[n])
        points = (cases.low[n] + grid * (cases.high[n] - cases.low[n])) @ np.array([[cos, -sin], [sin, cos]])
        parts.append(float((mixture.pdf(points) > mixture.pdf(cases.points[n : n + 1])).mean()))
    return np.array(parts)


def print_paired(found: dict[str, dict[tuple[str, str], list[float]]]) -> None:
    by_hand, learned = (np.concatenate([parts[pair] for pair in PAIRS]) for parts in found.values())
    rng = np.random.default_rng(0)
    for what, other in (("by hand", by_hand), ("nothing known", np.full(len(learned), 0.5))):
        gains = other - learned
        drawn = rng.choice(gains, size=(10_000, len(gains))).mean(axis=1)
        low, high = np.quantile(drawn, (0.025, 0.975))
        print(
            f"less than with {what}: {gains.mean():.3f} [{low:.3f}, {high:.3f}] of the desk; {len(gains)} cases"
        )


def scan_order(here: Observations) -> dict[str, int]:
    times = dict(zip(here.text("scene"), here.number("time").tolist(), strict=True))
    return {scene: rank for rank, scene in enumerate(sorted(times, key=lambda scene: (times[scene], scene)))}


def day(seen: Observations) -> None:
    total = {"without": [], "with rhythm": []}
    orders = []
    for name, others in left_out(seen):
        sums, here = sums_of(others), seen.among("place", [name])
        for pair in PAIRS:
            one = cases_of(here, *pair)
            if len(one.points) == 0:
                continue
            rhythm = rhythm_of(cells_of(sums.of_pair(*pair)))
            orders.append(rhythm.order)
            directions = direction_numbers(one.points)
            hours = here.hours[one.rows].astype(int)
            total["with rhythm"].append(float(np.log(rhythm.shares[hours, directions]).mean()))
            flat = shares_by_hour(rhythm_counts(sums, pair), 0)
            total["without"].append(float(np.log(flat[hours, directions]).mean()))
    gain = np.mean(total["with rhythm"]) - np.mean(total["without"])
    used = sum(order > 0 for order in orders)
    print(
        f"KTH, direction by part of the day: {gain:+.4f} nats; a rhythm was taken in {used} of {len(orders)} cases"
    )
    generated_day()


def rhythm_counts(sums: PlacementSums, pair: tuple[str, str]) -> np.ndarray:
    from_cells = cells_of(sums.of_pair(*pair))
    counts = np.zeros((24, len(DIRECTIONS)))
    np.add.at(counts.T, direction_numbers(from_cells.means), from_cells.hours)
    return counts


def generated_day(places: int = 8, days: int = 20) -> None:
    """A mug that is right of the keyboard in the morning and left in the evening: p(right) = 0.5 + 0.4 sin."""
    rng = np.random.default_rng(7)
    hours = np.arange(24)
    truth = 0.5 + 0.4 * np.sin(2.0 * np.pi * (hours - 2.0) / 24.0)
    for what, shares in (("a daily rhythm", truth), ("no rhythm", np.full(24, 0.5))):
        rhythm = rhythm_of(cells_of(sums_of(mug_log(places, days, shares, rng)).of_pair("Mug", "Keyboard")))
        right = rhythm.shares[:, DIRECTIONS.index("right-of")]
        error = float(np.sqrt(np.mean((right - shares) ** 2)))
        print(f"generated log with {what}: order {rhythm.order}, share of right-of off by {error:.3f} (rms)")


def mug_log(places: int, days: int, shares: np.ndarray, rng: np.random.Generator) -> Observations:
    rows = []
    for place in range(places):
        for day_number in range(days):
            for hour in rng.choice(24, size=6, replace=False):
                side = -0.4 if rng.random() < shares[hour] else 0.4
                scene = f"{place}-{day_number}-{hour}"
                mug = (rng.normal(0.0, 0.05), side + rng.normal(0.0, 0.05))
                for kind, (x, y) in (("Keyboard", (0.0, 0.0)), ("Mug", mug)):
                    row = dict.fromkeys(NUMBERS, 0.0) | dict.fromkeys(TEXTS, "")
                    row |= {
                        "time": 86400.0 * day_number + 3600.0 * hour,
                        "place": f"room-{place}",
                        "yaw": np.pi,
                    }
                    rows.append(
                        row
                        | {"scene": scene, "object": kind, "kind": kind, "x": x, "y": y, "confidence": 1.0}
                    )
    return Observations.of(rows)


def speed(seen: Observations) -> None:
    """One million sightings, batch after batch; what is kept does not grow with how much was seen."""
    many = repeated(seen, 1_000_000)
    sums_of(seen)
    start = time.perf_counter()
    online = sums_of(many)
    took = time.perf_counter() - start
    batch = PlacementSums.of(many) + no_sums()
    off = max(np.abs(online.moments - batch.moments).max(), np.abs(online.hours - batch.hours).max())
    scale = np.abs(batch.moments).max()
    size = online.keys.nbytes + online.moments.nbytes + online.hours.nbytes
    print(f"{len(many)} sightings online: {took:.2f} s, {len(many) / took:,.0f} a second")
    print(
        f"kept: {len(online)} cells, {size / 1e6:.1f} MB; after the first {len(seen)}: {len(sums_of(seen))} cells"
    )
    print(f"batch = online: largest difference {off / scale:.1e} of the largest sum")
    start = time.perf_counter()
    experience_of(many)
    print(f"with sizes and supports: {len(many) / (time.perf_counter() - start):,.0f} a second")


def repeated(seen: Observations, count: int) -> Observations:
    """The observations again and again, each time a little elsewhere, so that no two scenes are the same."""
    times = -(-count // len(seen))
    rng = np.random.default_rng(0)
    codes = np.tile(seen.codes, (times, 1))
    numbers = np.tile(seen.numbers, (times, 1))
    columns = [NUMBERS.index("x"), NUMBERS.index("y")]
    numbers[:, columns] += rng.normal(0.0, 0.01, size=(len(numbers), 2))
    return Observations(codes, numbers, seen.words).take(slice(0, count))


PARTS = {"pairs": pairs, "fusion": fusion, "desk": desk, "area": area, "day": day, "speed": speed}


def main() -> None:
    path = Path(os.environ.get("QSR_DATA", "../shared/data")) / "kth3d" / "kth3d_desks.csv"
    if not path.is_file():
        print(f"skipped: {path} is not there; set QSR_DATA to the folder of the data sets")
        return
    seen = read_observations(path).observations
    for name in sys.argv[1:] or PARTS:
        print(f"\n{name}: {PARTS[name].__doc__ or 'each pair from its one landmark, or from all'}")
        start = time.perf_counter()
        PARTS[name](seen)
        print(f"({time.perf_counter() - start:.0f} s)", flush=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore", ConvergenceWarning)
    main()
