"""Answers: a mixture, its frame, and the statements behind each component."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.gaussian import GaussianMixture


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """One Gaussian of an answer: weight, mean (2,) [m], covariance (2, 2) [m^2], and the statements behind it."""

    weight: float
    mean: FloatArray
    covariance: FloatArray
    statements: tuple[str, ...]

    @property
    def ellipse(self) -> tuple[float, float, float]:
        """The one-sigma ellipse: greater and lesser half axis [m], direction of the greater [rad]."""
        values, vectors = np.linalg.eigh(self.covariance)
        direction = math.atan2(vectors[1, 1], vectors[0, 1])
        return float(math.sqrt(values[1])), float(math.sqrt(values[0])), direction % math.pi


@dataclass(frozen=True, slots=True, eq=False)
class Where:
    """Where a target is: p(x) = (1 - elsewhere) x mixture(x) + elsewhere, spread over what no statement names.

    `frame` is "map", or the class the mixture is relative to (x away from the viewer, y to its left).
    Component weights sum to 1 - elsewhere; those of `mixture` to 1. `assumed` are the texts of what was given or
    required; the answer then comes from draws, `draws` of which would be as good if they were independent. `dropped`
    is the prior mass of the combinations of alternatives that were left out, 0 where none were.
    """

    target: str
    frame: str
    mixture: GaussianMixture
    elsewhere: float
    components: tuple[Component, ...]
    assumed: tuple[str, ...] = ()
    draws: float | None = None
    dropped: float = 0.0

    @property
    def weights(self) -> FloatArray:
        """The mixture's weights (M,)."""
        return self.mixture.weights

    @property
    def means(self) -> FloatArray:
        """The mixture's means (M, 2) [m]."""
        return self.mixture.means

    @property
    def covariances(self) -> FloatArray:
        """The mixture's covariances (M, 2, 2) [m^2]."""
        return self.mixture.covariances

    def to_json(self) -> dict[str, object]:
        """Return the answer as plain data, in metres."""
        components = [
            {
                "weight": component.weight,
                "mean": component.mean.tolist(),
                "covariance": component.covariance.tolist(),
                "statements": list(component.statements),
            }
            for component in self.components
        ]
        return {
            "target": self.target,
            "frame": self.frame,
            "elsewhere": self.elsewhere,
            "components": components,
            "assumed": list(self.assumed),
            "effective_draws": self.draws,
            "dropped": self.dropped,
        }

    def __str__(self) -> str:
        rows = [f"{'weight':>7} {'x [m]':>8} {'y [m]':>8} {'sd [m]':>15} {'axis [deg]':>11}"]
        for component in self.components:
            (x, y), (major, minor, angle) = component.mean.round(3) + 0.0, component.ellipse
            spread = f"{major:.3f} x {minor:.3f}"
            rows.append(f"{component.weight:7.3f} {x:8.3f} {y:8.3f} {spread:>15} {math.degrees(angle):11.1f}")
        rest = f", elsewhere {self.elsewhere:.3f}" if self.elsewhere > 0.0 else ""
        rest += f", dropped {self.dropped:.2g}" if self.dropped > 0.0 else ""
        return "\n".join([f"where {self.target}, frame: {self.frame}{rest}", *rows])


def mixture_of(components: Sequence[Component]) -> GaussianMixture:
    """Return components as a mixture, their weights normalised."""
    shares = np.array([component.weight for component in components])
    means = np.array([component.mean for component in components])
    covariances = np.array([component.covariance for component in components])
    return GaussianMixture(shares / shares.sum(), means, covariances)
