"""Joint covariances along paths, against the whole system solved."""

import numpy as np
import pytest

from qsrlang.mixtures.loading import parse_knowledge
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.mixtures.solving.factors import Factors
from qsrlang.mixtures.solving.paths import Paths
from qsrlang.mixtures.solving.posterior import equations_ahead
from qsrlang.mixtures.solving.system import DENSE, solve
from qsrlang.mixtures.worlds.planned import planned_worlds

COUNT = 60
RELATIONS = ("right-of", "left-of", "behind-of", "in-front-of")


def grown(seed: int) -> KnowledgeBase:
    """Return things that hang on each other as a random tree does, on two landmarks that are not certain."""
    rng = np.random.default_rng(seed)
    names, roots, said = ["M", "N"], ["M", "N"], []
    for number in range(COUNT):
        at = rng.integers(len(names))
        frames = ["", " wrt intrinsic"] if at < 2 else [""] if roots[at] == "M" else ["", " wrt absolute"]
        said.append(f"observe {rng.choice(RELATIONS)}(C{number}, {names[at]}){rng.choice(frames)}.")
        names.append(f"C{number}")
        roots.append(roots[at])
    return parse_knowledge(
        "\n".join(
            [
                "static M { front: yes }, N { front: yes }.",
                f"dynamic {', '.join(f'{name} {{ size: 8 cm × 5 cm }}' for name in names[2:])}.",
                "landmark m : M at (0 m, 0 m) facing -90 deg ± (2 cm, 3 cm, 4 deg).",
                "landmark n : N at (5 m, 1 m) facing 30 deg.",
                *said,
            ]
        )
    )


@pytest.mark.parametrize("seed", range(5))
def test_paths_agree_with_the_whole_system(seed: int) -> None:
    graph = grown(seed).graph
    names = tuple(f"C{number}" for number in range(COUNT))
    _, (plan,), _ = planned_worlds(graph, names)
    making = Factors(graph, None, 0.3, plan.layout)
    factors = [making.of([step])[0] for step in plan.steps]
    equations = equations_ahead(factors, plan.layout)
    paths = Paths.of(factors, equations, plan.layout)
    whole = solve(plan.layout, factors, equations, plan.layout.mean)
    assert plan.layout.size > DENSE
    np.testing.assert_allclose(paths.mean(), whole.mean, atol=1e-9)
    free = np.flatnonzero(plan.layout.free)
    np.testing.assert_allclose(paths.covariance(free), whole.covariance(free), atol=1e-9)
