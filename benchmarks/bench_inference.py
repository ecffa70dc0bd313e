"""Questions of the language against their limits, and beside ProbLog and Scenic on the same work, in one run.

python benchmarks/bench_inference.py [--peers PYTHON] [--figure PATH]

PYTHON is an interpreter that has problog and scenic (`pip install problog scenic` in an environment of its own).
The peers' programs are in benchmarks/peers/, each beside ours, and the two sides work in turn, several rounds each.
Medians are given, with the least and the greatest.
"""

from __future__ import annotations

import argparse
import gc
import json
import subprocess
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from timing import Spread

import qsrlang as qsr

PEERS = Path(__file__).parent / "peers"
MONITOR = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 3 deg)"
DESK = "desk-1 : Desk at (0 m, -0.2 m) facing -90 deg"
LEAST_SECONDS, SLOW_SECONDS = 0.2, 3.0
TURNS, ROUNDS = 3, 15
DIRECTIONS = ("right-of", "behind-of", "left-of", "in-front-of")
HEAD = """
static M { front: yes }.
relation short(referent, relatum) { distance: uniform(10 cm, 1 m) }.
relation middling(referent, relatum) { distance: uniform(50 cm, 2 m) }.
"""


def seconds(work: Callable[[], object], repeats: int = 7) -> Spread:
    """Return the times of some calls, warm; quick work is repeated until it can be timed, slow work runs but once."""
    first = _loop(work, 1)
    if first > SLOW_SECONDS:
        return Spread.of([first])
    loops = max(1, int(LEAST_SECONDS / repeats / max(_loop(work, 1), 1e-7)))
    return Spread.of(_loop(work, loops) for _ in range(repeats))


def _loop(work: Callable[[], object], loops: int) -> float:
    start = time.perf_counter()
    for _ in range(loops):
        work()
    return (time.perf_counter() - start) / loops


def show(what: str, value: str, beside: str = "") -> None:
    print(f"{what:52s} {value:38s} {beside}", flush=True)


def within(spread: Spread, limit: float) -> str:
    """Say how a time compares with its limit [s]."""
    share, least = spread.median / limit, spread.least / limit
    return f"limit {1e3 * limit:g} ms: {_verdict(share <= 1.0)}, {share:.2f} of it (at the least {least:.2f})"


def at_least(ratio: float, wanted: float) -> str:
    """Say how a ratio compares with the least that is wanted."""
    return f"{ratio:,.3g} times; at least {wanted:g}: {_verdict(ratio >= wanted)}"


def _verdict(is_met: bool) -> str:
    return "met" if is_met else "NOT met"


class Peer:
    """A peer's driver in its own interpreter: a line in, a round of work, a line of JSON out."""

    def __init__(self, python: str, driver: str, program: str) -> None:
        command = [python, str(PEERS / driver), str(PEERS / program)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def round(self, line: object) -> dict[str, object]:
        """Write a line, wait for what the peer says to it."""
        assert self.process.stdin and self.process.stdout
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def __enter__(self) -> Peer:
        return self

    def __exit__(self, *_: object) -> None:
        assert self.process.stdin
        self.process.stdin.close()
        self.process.wait()


def desk() -> None:
    print("Fig. 2 desk, warm")
    free = qsr.load("office/desk").with_landmarks(MONITOR)
    placed = free.with_landmarks(DESK)
    for name, known in (("", free), (", on the desk", placed)):
        took = seconds(lambda known=known: known.where("Cup"))
        show(f"  where Cup?{name}", took.text(1e3, "ms"), within(took, 2e-3))
        took = seconds(lambda known=known: known.prob("right-of(Cup, Keyboard)"))
        show(f"  prob right-of(Cup, Keyboard)?{name}", took.text(1e3, "ms"), within(took, 1e-3))
    for question in ("where Cup?", "prob right-of(Cup, Keyboard)?"):
        took = Spread.of(_asked_anew(placed, question) for _ in range(7))
        show(f"  {question[:-1]}, where the desk has moved", took.text(1e3, "ms"), "not warm: no limit")


def _asked_anew(known: qsr.KnowledgeBase, question: str) -> float:
    """Return the time of a question to a desk that stands elsewhere each time, so that no earlier answer helps."""
    shifts = np.random.default_rng().uniform(-1.0, 1.0, 20)
    moved = [
        known.with_landmarks(*(replace(one, x=one.x + by, y=one.y - by) for one in known.landmarks))
        for by in shifts
    ]
    start = time.perf_counter()
    for one in moved:
        one.ask(question)
    return (time.perf_counter() - start) / len(moved)


QUERIES = (
    ("left_of(cup,keyboard(m1))", "left-of(first: Cup, first: Keyboard)"),
    ("right_of(cup,keyboard(m1))", "right-of(first: Cup, first: Keyboard)"),
    ("left_of(cup,keyboard(m2))", "left-of(second: Cup, second: Keyboard)"),
    ("right_of(cup,keyboard(m2))", "right-of(second: Cup, second: Keyboard)"),
    (
        "scene(keyboard(m1))",
        "right-of(first: Cup, first: Keyboard) ∧ behind-of(first: Bottle, first: Cup)"
        " ∧ close-to(first: Bottle, first: Cup)",
    ),
)
SEEN = "in-front-of(first: Keyboard, m1)"


def answers(known: qsr.KnowledgeBase) -> dict[str, float]:
    """Answer the five queries of two_rooms.pl, given that the first keyboard is in front of its monitor."""
    found = known.prob_each([ours for _, ours in QUERIES], SEEN)
    return {theirs: one.value for (theirs, _), one in zip(QUERIES, found, strict=True)}


def _one_by_one(known: qsr.KnowledgeBase) -> float:
    """Return the time of the five queries, each asked alone."""
    start = time.perf_counter()
    for _, ours in QUERIES:
        known.prob(ours, SEEN)
    return time.perf_counter() - start


def rooms(python: str | None) -> None:
    print("two rooms, evidence, five queries (two_rooms.qsr, two_rooms.pl)")
    text = (PEERS / "two_rooms.qsr").read_text(encoding="utf-8")
    whole, ours, singly = [], [], []
    rounds = []
    answers(qsr.parse_knowledge(text))
    peer = Peer(python, "rounds_problog.py", "two_rooms.pl") if python else None
    for turn in range(TURNS):
        for number in range(ROUNDS):
            moved = text.replace("m1 : Monitor at (0 m", f"m1 : Monitor at ({ROUNDS * turn + number + 1} mm")
            start = time.perf_counter()
            known = qsr.parse_knowledge(moved)
            read = time.perf_counter()
            found = answers(known)
            ours.append(time.perf_counter() - read)
            whole.append(time.perf_counter() - start)
            singly.append(_one_by_one(replace(known, graph=replace(known.graph))))
        rounds += [peer.round("go") for _ in range(ROUNDS)] if peer else []
    show("  qsrlang, relation graph to answers", Spread.of(ours).text(1e3, "ms"))
    show("  qsrlang, one by one", Spread.of(singly).text(1e3, "ms"))
    show("  qsrlang, text to answers", Spread.of(whole).text(1e3, "ms"))
    if peer is None:
        show("  ProbLog", "not run", "give --peers, with problog installed there")
        return
    peer.__exit__()
    _beside_problog(Spread.of(ours), Spread.of(whole), rounds, found)


def _beside_problog(
    ours: Spread, whole: Spread, rounds: list[dict[str, object]], found: dict[str, float]
) -> None:
    theirs = Spread.of(one["text to answer"] - one["parse"] for one in rounds)
    all_theirs = Spread.of(one["text to answer"] for one in rounds)
    show(
        "  ProbLog, ground to answers",
        theirs.text(1e3, "ms"),
        f"qsrlang is faster {at_least(theirs.median / ours.median, 20.0)}",
    )
    show(
        "  ProbLog, text to answers",
        all_theirs.text(1e3, "ms"),
        f"{all_theirs.median / whole.median:.2g} times",
    )
    gap = max(abs(found[query] - value) for query, value in rounds[0]["answers"].items())
    show("  greatest difference of the five answers", f"{gap:.4f}", "shares alone there, places too here")


def scenes(python: str | None) -> None:
    print("scenes of the Fig. 2 desk without collisions (desk_*.qsr, desk_*.scenic)")
    generative, declarative = (qsr.load(PEERS / f"desk_{name}.qsr") for name in ("generative", "declarative"))
    peer = Peer(python, "rounds_scenic.py", "desk_generative.scenic") if python else None
    ours, required, theirs = [], [], []
    rng = np.random.default_rng(0)
    generative.sample(count=1000, rng=rng)
    declarative.sample(count=100, rng=rng)
    for _ in range(5):
        ours.append(_rate(generative, 100_000, rng))
        required.append(_rate(declarative, 10_000, rng))
        theirs += [peer.round(2.0)["rate"]] if peer else []
    one, other = Spread.of(ours), Spread.of(required)
    show("  qsrlang, one statement per relation", one.text(1.0, "/s"), at_least(one.median / 1e5, 1.0))
    slower = one.median / other.median
    show(
        "  qsrlang, anywhere and one require per relation",
        other.text(1.0, "/s"),
        f"{slower:.3g} times slower; at most 10: {_verdict(slower <= 10.0)}",
    )
    if peer is None:
        show("  Scenic", "not run", "give --peers, with scenic installed there")
        return
    peer.__exit__()
    _beside_scenic(python, one.median, other.median, Spread.of(theirs))


def _beside_scenic(python: str, ours: float, required: float, theirs: Spread) -> None:
    show("  Scenic, generative", theirs.text(1.0, "/s"), f"qsrlang: {ours / theirs.median:,.0f} times")
    with Peer(python, "rounds_scenic.py", "desk_declarative.scenic") as peer:
        found = peer.round(20.0)
    show(
        "  Scenic, declarative, one round",
        f"{found['rate']:.3g} /s, {found['tries']:,.0f} tries each",
        f"{theirs.median / found['rate']:,.0f} times slower; qsrlang: {required / found['rate']:,.0f} times its rate",
    )


def _rate(known: qsr.KnowledgeBase, count: int, rng: np.random.Generator) -> float:
    start = time.perf_counter()
    known.sample(count=count, rng=rng)
    return count / (time.perf_counter() - start)


def qualifying() -> None:
    print("poses to relations")
    points = np.random.default_rng(0).normal(size=(3, 2_000_000, 2))
    rate = 2e6 / seconds(lambda: qsr.qualify(*points), 5).median
    show("  qualify, TPCC", f"{rate / 1e6:.1f} million triples/s", at_least(rate / 5e6, 1.0))
    show("", "", f"{rate / 45_000:,.0f} times the 45,000/s measured of QSRlib (Python 2 only, not run here)")


def chain(length: int) -> qsr.KnowledgeBase:
    """Return a chain of objects, each placed by the one before it."""
    names = [f"C{i}" for i in range(length)]
    links = [
        f"observe {DIRECTIONS[i % 2]}({one}, {relatum}) ∧ short({one}, {relatum})."
        for i, (one, relatum) in enumerate(zip(names, ["M", *names], strict=False))
    ]
    landmark = "landmark m : M at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 1 deg)."
    return qsr.parse_knowledge("\n".join([HEAD, f"dynamic {', '.join(names)}.", landmark, *links]))


def net(objects: int) -> qsr.KnowledgeBase:
    """Return objects in rows of 20, each related to three of those before it, and 20 landmarks along two sides.

    Every object helps to place the last one, over very many ways: loops, and several anchors.
    """
    sides = [(-1, row) for row in range(10)] + [(column, -1) for column in range(0, 20, 2)]
    cells = [*sides, *((i % 20, i // 20) for i in range(objects))]
    names = [*(f"M{i}" for i in range(20)), *(f"C{i}" for i in range(objects))]
    said = [
        f"static {name}. landmark at-{name} : {name} at ({0.5 * column} m, {0.5 * row} m) facing 0 deg"
        " ± (2 cm, 2 cm, 1 deg)."
        for name, (column, row) in zip(names, sides, strict=False)
    ]
    for i in range(20, len(names)):
        offsets = np.array(cells[i]) - np.array(cells[:i])
        nearest = sorted(range(i), key=lambda j, offsets=offsets: (_length(offsets[j]), cells[j] in sides, j))
        said += [_relation(names[i], names[j], offsets[j]) for j in nearest[:3]]
    dynamic = f"dynamic {', '.join(names[20:])}."
    return qsr.parse_knowledge("\n".join([HEAD, dynamic, *said]))


def _length(offset: np.ndarray) -> float:
    """Return how far a cell is, the more the less it lies straight in a row or column."""
    return float(np.abs(offset).sum() + np.abs(offset).min())


def _relation(referent: str, relatum: str, offset: np.ndarray) -> str:
    quarter = round(np.arctan2(offset[1], offset[0]) / (0.5 * np.pi)) % 4
    distance = "short" if np.abs(offset).max() < 2 else "middling"
    pair = f"({referent}, {relatum})"
    return f"observe {DIRECTIONS[quarter]}{pair} wrt absolute ∧ {distance}{pair}."


def choices(count: int) -> qsr.KnowledgeBase:
    """Return a chain in which every link is one of two: 2^count worlds."""
    names = [f"C{i}" for i in range(count)]
    links = [
        f"believe 0.7 :: right-of({one}, {relatum}) | 0.3 :: behind-of({one}, {relatum})."
        for one, relatum in zip(names, ["M", *names], strict=False)
    ]
    landmark = "landmark m : M at (0 m, 0 m) facing -90 deg."
    return qsr.parse_knowledge("\n".join([HEAD, f"dynamic {', '.join(names)}.", landmark, *links]))


Curve = tuple[str, list[int], list[float]]


def scale() -> list[Curve]:
    print("scale: where the last object is")
    curves = [
        _grown("objects in a chain", chain, (10, 30, 100, 300, 1000), 50e-3),
        _grown("objects in loops", net, (40, 80, 120, 200), 100e-3),
    ]
    sizes, times = [], []
    for count in (4, 6, 8, 10, 14):
        known, answers = choices(count), []
        took = seconds(lambda known=known, n=count, kept=answers: kept.append(known.where(f"C{n - 1}")), 3)
        sizes.append(min(2**count, 10_000))
        times.append(took.least)
        dropped = f"dropped mass {answers[0].dropped:.4f}, {len(answers[0].components)} components"
        show(f"  {sizes[-1]:,} of {2**count:,} worlds", took.text(1e3, "ms"), dropped)
    return [*curves, _curve("worlds", sizes, times)]


def _grown(
    what: str, make: Callable[[int], qsr.KnowledgeBase], sizes: tuple[int, ...], limit: float
) -> Curve:
    times = []
    for size in sizes:
        known, target = make(size), f"C{size - 1}"
        first = Spread.of(_first(one, target) for one in _forgetful(known))
        again = seconds(lambda known=known, name=target: known.where(name), 3)
        times.append(first.least)
        show(
            f"  {size} {what}, asked first",
            first.text(1e3, "ms"),
            within(first, limit) if size == sizes[-1] else "",
        )
        show(f"  {size} {what}, asked again", again.text(1e3, "ms"), "")
    return _curve(what, list(sizes), times)


def _first(known: qsr.KnowledgeBase, target: str) -> float:
    """Return the time of a question that is asked first, when the garbage of earlier ones is gone."""
    gc.collect()
    return _loop(lambda: known.where(target), 1)


def _forgetful(known: qsr.KnowledgeBase, count: int = 5) -> list[qsr.KnowledgeBase]:
    """Return copies of knowledge that remember nothing of what was asked before."""
    copies = [replace(known, graph=replace(known.graph)) for _ in range(count + 1)]
    copies.pop().where(next(reversed(known.classes)))
    return copies


def _curve(what: str, sizes: list[int], times: list[float]) -> Curve:
    exponent = np.polyfit(np.log(sizes), np.log(times), 1)[0]
    last = np.polyfit(np.log(sizes[-2:]), np.log(times[-2:]), 1)[0]
    show(f"  time ~ ({what})^n", f"n = {exponent:.2f}", f"{last:.2f} between the last two")
    return what, sizes, times


def draw(curves: list[Curve], path: Path) -> None:
    """Write a picture of time against size."""
    lines = {what: (sizes, [1e3 * one for one in times]) for what, sizes, times in curves}
    qsr.save_figure(qsr.draw_curves(lines, "size", "where, asked first [ms]", log=True), path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--peers", metavar="PYTHON", help="an interpreter that has problog and scenic")
    parser.add_argument("--figure", metavar="PATH", type=Path, help="where to write time against size")
    chosen = parser.parse_args()
    desk()
    rooms(chosen.peers)
    scenes(chosen.peers)
    qualifying()
    curves = scale()
    if chosen.figure:
        draw(curves, chosen.figure)


if __name__ == "__main__":
    main()
