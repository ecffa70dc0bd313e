"""The strategies by the names of the planners that use them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from qsrlang.errors import UnknownNameError
from qsrlang.planning.strategies.exact import Exact
from qsrlang.planning.strategies.gain import Gain
from qsrlang.planning.strategies.index import Index
from qsrlang.planning.strategies.nearest import Nearest
from qsrlang.planning.strategies.rollout import Rollout
from qsrlang.planning.strategies.strategy import Strategy
from qsrlang.planning.strategies.tour import Tour

STRATEGIES: Mapping[str, Strategy] = MappingProxyType(
    {
        "belief": Gain(),
        "nearest": Nearest(),
        "index": Index(),
        "rollout": Rollout(),
        "tour": Tour(),
        "exact": Exact(),
    }
)


def strategy_named(name: str) -> Strategy:
    """Return a strategy by the name of its planner; raises UnknownNameError."""
    if name not in STRATEGIES:
        raise UnknownNameError("planner with a belief", name, STRATEGIES)
    return STRATEGIES[name]
