"""An atom, or several on one ordered pair, as a polar density: angle about an axis, distance along each direction."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import NoRoomError
from qsrlang.geometry.angles import unit
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.language.syntax import Density, Dimension, Uniform
from qsrlang.mixtures.densities.angles import Bump
from qsrlang.mixtures.densities.stance import Boxes, Stance

MIN_OVERLAP = 1e-12
MIN_ROOM = 1e-3
MIN_WAY = 1e-3
_CHUNK = 4096
_RETRIES = 12
_MARGIN = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Rays:
    """Directions (P, N) [rad], each the middle of a `cell`, with their shares of the mass (P, N), and the way along
    each from `low` to `high` (P, N) [m].
    """

    directions: FloatArray
    weights: FloatArray
    low: FloatArray
    high: FloatArray
    cell: float

    def part(self, number: int, count: int) -> Rays:
        """Return the part of them from number / count to (number + 1) / count of the mass, as a whole."""
        if count == 1:
            return self
        above = np.cumsum(self.weights, axis=1)
        inside = np.minimum(above, (number + 1) / count) - np.maximum(above - self.weights, number / count)
        return replace(self, weights=count * np.maximum(inside, 0.0))


@dataclass(frozen=True, slots=True)
class PolarDensity:
    """p(x | relatum) ~ prod_j a_j(h_j (theta - alpha_j)) U(r; lo(theta), hi(theta)) / r, x = relatum + r u(theta).

    `angles` (J) are the angle factors, `hands` (J) are +1 where angles grow counter-clockwise and -1 where the
    frame mirrors them; `distances` are the distance factors, all of which bound r. Distances run from where the
    boxes touch to where the referent's box meets the edge of the support (given in the support's own frame), or
    over `reach` where no support is known. Directions without room are left out; from a stand where less than
    MIN_ROOM of the angle has room, the boxes touch. NoRoomError where no stand has room.
    Towards a second relatum they run to where the referent's box touches that one, at least MIN_WAY [m] long.
    """

    angles: tuple[Bump, ...]
    hands: tuple[float, ...]
    distances: tuple[Density, ...]
    boxes: Boxes
    support: ConvexPolygon | None
    reach: float
    what: str = field(compare=False)

    def moments(self, stance: Stance, part: tuple[int, int] = (0, 1)) -> tuple[FloatArray, FloatArray]:
        """Return the exact mean (P, 2) and covariance (P, 2, 2) of x at each stand, or of its j-th part of k.

        Quadrature over the angle; closed form in r: E r = (lo + hi) / 2, E r^2 = (lo^2 + lo hi + hi^2) / 3.
        """
        rays = self.rays(stance, strict=True).part(*part)
        x, y = np.cos(rays.directions), np.sin(rays.directions)
        first = rays.weights * 0.5 * (rays.low + rays.high)
        second = rays.weights * (rays.low**2 + rays.low * rays.high + rays.high**2) / 3.0
        mean = np.stack([(first * x).sum(axis=1), (first * y).sum(axis=1)], axis=-1)
        along, across = second * x, second * y
        square = np.empty((len(mean), 2, 2))
        square[:, 0, 0], square[:, 1, 1] = (along * x).sum(axis=1), (across * y).sum(axis=1)
        square[:, 0, 1] = square[:, 1, 0] = (along * y).sum(axis=1)
        return stance.positions + mean, square - mean[:, :, None] * mean[:, None, :]

    def sample(self, stance: Stance, uniforms: FloatArray) -> FloatArray:
        """Return one draw of x from each stand, made of three uniform numbers (P, 3): (P, 2)."""
        if len(self.angles) == 1:
            return self._draw_directly(stance, uniforms)
        return self._draw_by_inversion(stance, uniforms)

    def pdf(self, points: FloatArray, stance: Stance) -> FloatArray:
        """Return p(x | relatum) of points (P, 2), one per stand: (P,) [1/m^2]."""
        offsets = points - stance.positions
        r = np.hypot(offsets[:, 0], offsets[:, 1])
        theta = np.arctan2(offsets[:, 1], offsets[:, 0])[:, None]
        low, high = (bound[:, 0] for bound in self.bounds(stance, theta))
        inside = (r >= low) & (r <= high) & (high > low)
        densities = self._angle_pdf(theta, stance)[:, 0] / self._normaliser(stance)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(inside, densities / ((high - low) * r), 0.0)

    def bounds(self, stance: Stance, directions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the least and the greatest distance along directions (P, N): twice (P, N) [m]."""
        contact, edge = self._way(stance, directions)
        low, high = contact, np.full_like(contact, np.inf)
        for density in self.distances:
            if isinstance(density, Uniform):
                scale = edge - contact if density.low.dimension is Dimension.FRACTION else 1.0
                low = np.maximum(low, contact + density.low.value * scale)
                high = np.minimum(high, contact + density.high.value * scale)
        bounded = self.support is not None or not np.isfinite(high).all()
        return low, np.minimum(high, edge) if bounded else high

    def _way(self, stance: Stance, directions: FloatArray) -> tuple[FloatArray, FloatArray]:
        contact = self.boxes.contact(stance.yaws, directions)
        if stance.ends is not None:
            return self._way_to_second(stance.ends, directions, contact)
        if self.support is not None:
            return contact, self._edge(stance, directions, self.support)
        return contact, contact + self.reach

    def _way_to_second(
        self, ends: FloatArray, directions: FloatArray, contact: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the ends of the way to the second relatum; where the boxes meet, about where two such boxes would."""
        length, yaws = ends[:, [0]], ends[:, 1]
        second = self.boxes.second_contact(yaws, directions)
        both = contact + second
        middle = length * np.divide(contact, both, out=np.full_like(both, 0.5), where=both > 0.0)
        short = length - both < MIN_WAY
        low = np.where(short, np.maximum(middle - 0.5 * MIN_WAY, 0.0), contact)
        return low, np.where(short, low + MIN_WAY, length - second)

    def _edge(self, stance: Stance, directions: FloatArray, support: ConvexPolygon) -> FloatArray:
        assert stance.support_poses is not None
        x, y, yaw = stance.support_poses.T
        turned = unit(-yaw)
        shift = stance.positions - np.stack([x, y], axis=-1)
        local = np.stack(
            [
                turned[:, 0] * shift[:, 0] - turned[:, 1] * shift[:, 1],
                turned[:, 1] * shift[:, 0] + turned[:, 0] * shift[:, 1],
            ],
            axis=-1,
        )
        inside = support.nearest(local)
        turns = stance.yaws - yaw
        margins = support.box_reach(turns[:1] if (turns == turns[0]).all() else turns, *self.boxes.referent)
        return support.ray_lengths(inside[:, None], unit(directions - yaw[:, None]), margins[:, None])

    def _nodes(self, stance: Stance) -> tuple[FloatArray, FloatArray]:
        """Return directions (P, N), those of the narrowest factor, and the products of all factors there (P, N)."""
        narrow = min(range(len(self.angles)), key=lambda j: self.angles[j].spread)
        angles, weights = self.angles[narrow].nodes()
        theta = stance.axes[:, [narrow]] + self.hands[narrow] * angles
        return theta, weights * self._angle_pdf(theta, stance, skip=narrow)

    def _angle_pdf(self, theta: FloatArray, stance: Stance, skip: int | None = None) -> FloatArray:
        """Return the product (P, N) of the angle factors, but for one, at directions (P, N)."""
        product = np.ones_like(theta)
        for j, factor in enumerate(self.angles):
            if j != skip:
                product = product * factor.pdf(self.hands[j] * (theta - stance.axes[:, [j]]))
        return product

    def rays(self, stance: Stance, strict: bool) -> Rays:
        """Return the directions of the quadrature, their shares of the mass, and the way along each."""
        directions, weights = self._nodes(stance)
        weights = weights / self._overlap(weights)
        low, high = self.bounds(stance, directions)
        roomy = np.where(high > low, weights, 0.0)
        room = roomy.sum(axis=1, keepdims=True)
        if strict and (room < MIN_ROOM).all():
            raise NoRoomError(self.what, "the support")
        with np.errstate(invalid="ignore", divide="ignore"):
            weights = np.where(room < MIN_ROOM, weights, roomy / room)
        return Rays(directions, weights, low, np.maximum(low, high), self._narrowest.cell)

    @property
    def _narrowest(self) -> Bump:
        return min(self.angles, key=lambda angle: angle.spread)

    def _overlap(self, weights: FloatArray) -> FloatArray:
        mass = weights.sum(axis=1, keepdims=True)
        if (mass < MIN_OVERLAP).any():
            raise NoRoomError(self.what, "any side of the relatum, for its relations contradict each other")
        return np.asarray(mass)

    def _normaliser(self, stance: Stance) -> FloatArray:
        first, which = stance.distinct()
        parts = []
        for at in range(0, len(first), _CHUNK):
            part = stance.at(first[at : at + _CHUNK])
            directions, weights = self._nodes(part)
            low, high = self.bounds(part, directions)
            parts.append(np.where(high > low, weights, 0.0).sum(axis=1))
        return np.asarray(np.concatenate(parts)[which])

    def _draw_directly(self, stance: Stance, uniforms: FloatArray) -> FloatArray:
        """Invert the angle's own distribution, again and again where that direction has no room, _RETRIES times.

        The few that are left invert the distribution of the directions that have room. Numbers for the retries come
        from a generator that the third of the uniform numbers seeds.
        """
        points, has_room = self._draw_any(stance, uniforms)
        waiting = np.flatnonzero(~has_room)
        rng = np.random.default_rng(uniforms[:8, 2].view(np.uint64))
        for _ in range(_RETRIES):
            if len(waiting) == 0:
                return points
            numbers = rng.random((len(waiting), 2)).clip(_MARGIN, 1.0 - _MARGIN)
            points[waiting], has_room = self._draw_any(stance.at(waiting), numbers)
            waiting = waiting[~has_room]
        numbers = rng.random((len(waiting), 2))
        points[waiting] = self._draw_by_inversion(stance.at(waiting), numbers)
        return points

    def _draw_any(self, stance: Stance, uniforms: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Return draws (P, 2) whose direction may have no room, and whether it has (P,)."""
        theta = stance.axes[:, 0] + self.hands[0] * self.angles[0].quantile(uniforms[:, 0])
        low, high = (bound[:, 0] for bound in self.bounds(stance, theta[:, None]))
        return stance.positions + (low + uniforms[:, 1] * (high - low))[:, None] * unit(theta), high > low

    def _draw_by_inversion(self, stance: Stance, uniforms: FloatArray) -> FloatArray:
        """Invert the distribution of all directions that have room, at the nodes of the quadrature."""
        chunks = [slice(at, at + _CHUNK) for at in range(0, max(len(stance.positions), 1), _CHUNK)]
        return np.concatenate([self._draw_rays(stance.at(chunk), uniforms[chunk]) for chunk in chunks])

    def _draw_rays(self, stance: Stance, uniforms: FloatArray) -> FloatArray:
        rays = self.rays(stance, strict=False)
        cumulative = np.cumsum(rays.weights, axis=1)
        wanted = uniforms[:, [0]] * cumulative[:, -1:]
        chosen = (cumulative < wanted).sum(axis=1).clip(max=cumulative.shape[1] - 1)
        rows = np.arange(len(cumulative))
        inside = (wanted[:, 0] - cumulative[rows, chosen]) / rays.weights[rows, chosen] + 0.5
        theta = rays.directions[rows, chosen] + inside.clip(-0.5, 0.5) * rays.cell
        low, high = (bound[:, 0] for bound in self.bounds(stance, theta[:, None]))
        bent = high <= low
        theta[bent] = rays.directions[rows, chosen][bent]
        low[bent], high[bent] = rays.low[rows, chosen][bent], rays.high[rows, chosen][bent]
        return np.asarray(stance.positions + (low + uniforms[:, 1] * (high - low))[:, None] * unit(theta))
