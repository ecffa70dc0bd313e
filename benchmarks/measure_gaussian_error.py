"""How far one Gaussian per world, or several per relation, is from the true densities, by kind of knowledge.

python benchmarks/measure_gaussian_error.py [--bases N] [--components K ...]

The truth is the tests' oracle (tests/oracle/): weighted draws of the polar densities of generated knowledge bases.
`mean` is how far the means of components are off, in deviations of the truth; `sd` the greatest ratio of deviations;
`weight` and `prob` the absolute errors of weights and of the probabilities of two events; `energy` the energy distance,
from 0 (equal) to 1; `KL` the Kullback-Leibler divergence [nat]. All are means over the bases of a kind; by chance alone
mean is about 0.02, sd 1.02, prob 0.001 and KL within 0.02 of 0. Parts multiply along a chain: kinds of which most bases
have more than 600 worlds are left out.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

import qsrlang as qsr
from qsrlang.relations.graph import AtomicRelation, Constraint, RelationGraph

sys.path.append(str(Path(__file__).parent.parent / "tests"))
sys.path.append(str(Path(__file__).parent.parent / "tests" / "oracle"))

from comparing_engines import Gap, gap, judge
from generated_knowledge import MAKERS, generate

DRAWS, POINTS, MOST_WORLDS = 10_000, 2_000, 600


def with_components(count: int) -> Callable[[qsr.KnowledgeBase], qsr.KnowledgeBase]:
    """Return a change of knowledge: every relation that has an angle is split into as many Gaussians."""
    return lambda known: replace(known, graph=_split(known.graph, count))


def _split(graph: RelationGraph, count: int) -> RelationGraph:
    choices = tuple(
        replace(
            choice,
            alternatives=tuple(
                replace(one, constraints=tuple(_split_atoms(part, count) for part in one.constraints))
                for one in choice.alternatives
            ),
        )
        for choice in graph.choices
    )
    return replace(graph, choices=choices)


def _split_atoms(constraint: Constraint, count: int) -> Constraint:
    atoms = (
        AtomicRelation(replace(one.relation, components=count), one.frame)
        if one.relation.angle is not None
        else one
        for one in constraint.atoms
    )
    return replace(constraint, atoms=tuple(atoms))


def worlds(graph: RelationGraph, count: int) -> float:
    """Return into how many worlds alternatives and parts split what is known."""
    split = _split(graph, count)
    return math.prod(
        sum(math.prod(one.parts for one in alternative.constraints) for alternative in choice.alternatives)
        for choice in split.choices
    )


def row(kind: str, count: int, gaps: list[Gap]) -> str:
    probabilities = np.hstack([one.prob for one in gaps])
    ratio = np.exp(np.mean([abs(np.log(one.ratio)) for one in gaps]))
    figures = [
        f"{np.mean([one.mean for one in gaps]):.2f}",
        f"{ratio:.2f}",
        f"{np.mean([one.weight for one in gaps]):.3f}",
        f"{probabilities.mean():.3f}",
        f"{probabilities.max():.3f}",
        f"{np.mean([one.energy for one in gaps]):.4f}",
        f"{np.mean([one.kl for one in gaps]):.2f}",
    ]
    return f"| {kind:18s} | {count:10d} | {' | '.join(f'{one:>8s}' for one in figures)} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bases", type=int, default=20, help="generated bases of each kind")
    parser.add_argument("--components", type=int, nargs="+", default=[1, 2, 4, 8])
    chosen = parser.parse_args()
    columns = ("mean", "sd", "weight", "prob", "max prob", "energy", "KL")
    print(f"| {'kind':18s} | components | {' | '.join(f'{one:>8s}' for one in columns)} |")
    print(f"|{'-' * 20}|{'-' * 12}|{'|'.join(['-' * 10] * len(columns))}|")
    for kind in MAKERS:
        bases = [judge(generate(kind, seed), DRAWS, POINTS) for seed in range(chosen.bases)]
        for count in chosen.components:
            small = [one for one in bases if worlds(one.known.graph, count) <= MOST_WORLDS]
            if 2 * len(small) >= len(bases):
                print(row(kind, count, [gap(one, with_components(count)) for one in small]), flush=True)


if __name__ == "__main__":
    main()
