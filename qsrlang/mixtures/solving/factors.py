"""From steps to factors; what several steps say in the same words, of things of the same sizes, is found once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.densities.conditional import Conditional, Turning
from qsrlang.mixtures.densities.stated import Words, make_conditional
from qsrlang.mixtures.solving.linear import Factor
from qsrlang.mixtures.worlds.layout import Layout, compact_anchor
from qsrlang.mixtures.worlds.plans import Step, seats_read
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph


@dataclass(frozen=True, slots=True, eq=False)
class Factors:
    """Makes the factors of steps in plans of one layout; `orientation` [rad] is a direction that turns with them."""

    graph: RelationGraph
    viewer: Pose2 | None
    orientation: float
    layout: Layout
    _said: dict[object, tuple[Conditional, Turning | None]] = field(default_factory=dict)

    def of(self, steps: Sequence[Step]) -> list[Factor]:
        """Return what the same step says in each of several plans; the same constraint gives the same factor."""
        seats = seats_read(steps[0])
        read = [column for seat in seats for column in self.layout.pose(seat)]
        columns, referent = np.array(read), np.array(self.layout.place(steps[0].referent))
        made: dict[int, Factor] = {}
        for step in steps:
            if id(step.constraint) in made:
                continue
            said, turning = self._told(step, seats, read[2])
            if turning is None:
                bends = any(self._is_free(column) for column in read)
            else:
                bends = self._is_free(read[2]) and not turning.fixed
            made[id(step.constraint)] = Factor(referent, columns, said, turning, bends, self.orientation)
        return [made[id(step.constraint)] for step in steps]

    def _is_free(self, column: int) -> bool:
        return bool(self.layout.free.item(column))

    def _told(self, step: Step, seats: tuple[Seat, ...], heading: int) -> tuple[Conditional, Turning | None]:
        """Return what a step says, and that in the frame of its relatum, whose heading is in a column, if it can be."""
        key = Words.of(self.graph, step) or id(step.constraint), step.relatum.root.name
        told = self._said.get(key)
        if told is None:
            said = make_conditional(self.graph, step, partial(compact_anchor, seats), self.viewer)
            told = said, said.turning(float(self.layout.mean[heading]), not self._is_free(heading))
            self._said[key] = told
        return told
