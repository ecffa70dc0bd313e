"""What was learned as text of the language: classes, counts with metric fits, shares of supports, and where from."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from qsrlang.language.printing.formatter import format_source
from qsrlang.language.source import Source
from qsrlang.learning.experience import Experience, ObjectSums
from qsrlang.learning.fits import FittedCount, general_fits, place_fits, written_mixture
from qsrlang.learning.learner import MIN_PLACES, LearnedPair, learn
from qsrlang.learning.rhythm import DIRECTIONS, Rhythm, rhythm_of
from qsrlang.learning.selection import roots, selected
from qsrlang.learning.supports import SupportShares, support_shares

DAY_PARTS = ((0, 6), (6, 12), (12, 18), (18, 24))
_MIN_SIDE = 0.005


@dataclass(frozen=True, slots=True)
class Contexts:
    """What knowledge is told apart by, besides what holds in general."""

    room: bool = False
    time: bool = False


GENERAL = Contexts()


def learned_text(experience: Experience, declared: Collection[str], by: Contexts) -> str:
    """Return what an experience teaches as statements in canonical form; classes `declared` elsewhere are not again.

    Every pair is told by its most telling neighbours (see `selected`), with how much it was seen, at how many places,
    and what it gains in nats an object over knowing nothing, at places held out.
    """
    shares = support_shares(experience.objects)
    kept = selected(learn(experience.placements), shares, experience.objects)
    lines = [*_classes(experience.objects, kept, shares, declared)]
    for one in kept:
        lines += ["", *_pair(one)]
    lines += [line for share in shares for line in ("", *_supports(share))]
    lines += [line for one in kept for line in _in_contexts(one, by)]
    return format_source(Source("<learned>", "\n".join(lines) + "\n")).strip("\n")


def _classes(
    objects: ObjectSums,
    kept: Sequence[LearnedPair],
    shares: Sequence[SupportShares],
    declared: Collection[str],
) -> Iterator[str]:
    carried = {share.kind: share.supports[0] for share in shares if len(share.supports) == 1}
    start = roots(kept)
    told = [share for share in shares if len(share.supports) > 1]
    named = {name for one in kept for name in one.pair} | {share.kind for share in told}
    surfaces = {one for share in told for one in _carriers(share)} | {
        carried[n] for n in named & carried.keys()
    }
    named |= {one for share in told for one in share.supports}
    dynamic = sorted(named - start - set(surfaces))
    for kind, names in (
        ("surface", surfaces),
        ("static", sorted(start - set(surfaces))),
        ("dynamic", dynamic),
    ):
        for name in names:
            if name not in declared:
                fields = ", ".join(_fields(objects, name, kind, carried.get(name)))
                yield f"{kind} {name}" + (f" {{ {fields} }}." if fields else ".")


def _carriers(share: SupportShares) -> list[str]:
    return [name for relation, name in zip(share.relations, share.supports, strict=True) if relation == "on"]


def _fields(objects: ObjectSums, name: str, kind: str, carrier: str | None) -> Iterator[str]:
    size = objects.size(name)
    if size is not None:
        length, width, height = size
        sides = (width, length) if kind == "surface" else (width, length, height)
        if min(sides) >= _MIN_SIDE:
            yield f"size: {' × '.join(f'{100 * side:.0f} cm' for side in sides)}"
    if carrier is not None and carrier != name:
        yield f"on: {carrier}"


def _pair(one: LearnedPair) -> Iterator[str]:
    referent, relatum = one.pair
    seen, places = one.cells.counts.sum(), one.cells.place_count
    yield f"## {referent} as seen from {relatum}: {seen:.0f} seen at {places} places, which weigh the same;"
    where = "at places held out" if places >= MIN_PLACES else "from one sighting there to the next"
    yield f"## {one.stack.gain:+.2f} nats an object {where}, above anywhere on the support."
    yield from _observed(one, general_fits(one))


def _observed(one: LearnedPair, fits: Sequence[FittedCount]) -> Iterator[str]:
    referent, relatum = one.pair
    for fit in fits:
        normal = f"normal({_lengths(fit.mean)}, {_lengths(fit.deviation)}, {round(fit.correlation, 1) + 0.0})"
        yield f"observe {_count(fit.count)} × {fit.relation}({referent}, {relatum}) ~ {normal}."


def _count(value: float) -> str:
    return f"{value:.2g}" if value < 10.0 else f"{value:.0f}"


def _lengths(values: tuple[float, float]) -> str:
    return "(" + ", ".join(f"{round(100.0 * value)} cm" for value in values) + ")"


def _supports(share: SupportShares) -> Iterator[str]:
    if len(share.supports) == 1:
        return
    yield f"## {share.kind}: seen at {share.places} places, which weigh the same; shrunk to all classes by a Dirichlet"
    yield f"## prior worth {share.concentration:.2g} places."
    alternatives = [
        f"{value:.3f} :: {relation}({share.kind}, {support})"
        for relation, support, value in zip(share.relations, share.supports, share.shares, strict=True)
    ]
    yield f"believe {' | '.join(alternatives)} | {1.0 - sum(round(v, 3) for v in share.shares):.3f} :: elsewhere."


def _in_contexts(one: LearnedPair, by: Contexts) -> Iterator[str]:
    """Yield contexts; where room and hour both matter, each room is told for each part of the day as well."""
    rooms = _fits_by_room(one) if by.room else {}
    rhythm = rhythm_of(one.cells) if by.time else None
    for room, fits in rooms.items():
        yield from _context(one, f"room {room}", fits)
    if rhythm is None or rhythm.order == 0:
        return
    yield f"## The day of {one.pair[0]} about {one.pair[1]}: Fourier terms up to order {rhythm.order}."
    for part in DAY_PARTS:
        hours = f"from {part[0]:02d}:00 to {part[1] % 24:02d}:00"
        yield from _context(one, hours, _at_hours(general_fits(one), rhythm, part))
        for room, fits in rooms.items():
            yield from _context(one, f"room {room}, {hours}", _at_hours(fits, rhythm, part))


def _context(one: LearnedPair, conditions: str, fits: Sequence[FittedCount]) -> Iterator[str]:
    yield f"in {conditions} {{"
    yield from _observed(one, fits)
    yield "}"


def _fits_by_room(one: LearnedPair) -> dict[str, list[FittedCount]]:
    general = written_mixture(one.density)
    rooms = sorted((one.cells.words[number], number) for number in {*one.cells.places.tolist()})
    rooms = [(room, number) for room, number in rooms if room]
    cells = {room: one.cells.take(one.cells.places == number) for room, number in rooms}
    return {room: place_fits(own, general) for room, own in cells.items()}


def _at_hours(fits: Sequence[FittedCount], rhythm: Rhythm, part: tuple[int, int]) -> list[FittedCount]:
    """Return counts as they are in a part of the day: each direction's times what the hour makes of its share."""
    ratios = rhythm.shares[part[0] : part[1]].mean(axis=0) / rhythm.shares.mean(axis=0)
    factors = dict(zip(DIRECTIONS, ratios.tolist(), strict=True))
    return [fit.scaled(factors[fit.relation]) for fit in fits]
