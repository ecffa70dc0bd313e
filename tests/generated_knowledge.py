"""Knowledge bases of many kinds, by a seed: texts of the language with a question and the events to ask for."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

DIRECTIONS = ("behind-of", "left-of", "in-front-of", "right-of")
DISTANCES = ("close-to", "distant-from", "near")
NEAR = "relation near(referent, relatum) { distance: uniform(2 cm, 40 cm), disjoint: close-to }."


@dataclass(frozen=True)
class Generated:
    """A text, what is sought in it, as seen by whom (x, y, yaw), what is given, and events to ask for."""

    kind: str
    seed: int
    text: str
    target: str
    viewer: tuple | None = None
    given: str | None = None
    events: tuple = ()


def generate(kind, seed):
    """The knowledge base of a kind and a seed."""
    number = list(MAKERS).index(kind)
    base = MAKERS[kind](np.random.default_rng([number, seed]))
    return replace(base, kind=kind, seed=seed)


def _text(*statements):
    return "\n".join([NEAR, *(one for one in statements if one)])


def _pick(rng, *options):
    return options[rng.integers(len(options))]


def _cm(rng, low, high):
    return f"{rng.uniform(low, high):.1f} cm"


def _classes(rng, *names, front=True, sized=True):
    """Dynamic classes, some with a box and a front."""
    said = []
    for name in names:
        size = f"size: {_cm(rng, 4, 30)} × {_cm(rng, 4, 20)}" if sized and rng.random() < 0.7 else ""
        fields = ", ".join(filter(None, [size, "front: yes" if front else ""]))
        said.append(f"dynamic {name} {{ {fields} }}." if fields else f"dynamic {name}.")
    return "\n".join(said)


def _static(rng, name, more=""):
    return f"static {name} {{ size: {_cm(rng, 10, 40)} × {_cm(rng, 10, 20)}, front: yes{more} }}."


def _landmark(rng, name, kind, spread=0.0, turn=0.0, at=None):
    x, y = rng.uniform(-3.0, 3.0, 2) if at is None else at
    facing = rng.uniform(-180.0, 180.0)
    doubt = ""
    if spread or turn:
        doubt = f" ± ({100 * spread:.1f} cm, {100 * spread:.1f} cm, {turn:.1f} deg)"
    return f"landmark {name} : {kind} at ({x:.3f} m, {y:.3f} m) facing {facing:.1f} deg{doubt}."


def _place(rng, referent, relatum, frames=("relative", "intrinsic", "absolute"), distances=DISTANCES):
    """A conjunction that says in which direction, and perhaps how far, a referent is from its relatum."""
    frame = _pick(rng, *frames)
    atom = f"{_pick(rng, *DIRECTIONS)}({referent}, {relatum})" + (
        "" if frame == "relative" else f" wrt {frame}"
    )
    if distances and rng.random() < 0.6:
        return f"{atom} ∧ {_pick(rng, *distances)}({referent}, {relatum})"
    return atom


def _link(rng, referent, relatum, **how):
    """One statement or more on a pair: what holds, counted alternatives, or beliefs that leave some elsewhere."""
    places = [_place(rng, referent, relatum, **how) for _ in range(3)]
    form = rng.integers(3)
    if form == 0 or places[0] == places[1]:
        return f"observe {places[0]}."
    if form == 1:
        counts = rng.integers(1, 20, 2)
        return "\n".join(f"observe {n} × {one}." for n, one in zip(counts, places, strict=False))
    shares = rng.dirichlet([2.0, 2.0, 1.0])
    return f"believe {shares[0]:.3f} :: {places[0]} | {shares[1]:.3f} :: {places[1]}."


def _events(rng, target, *relata):
    """Two events: a direction, and a distance or a compound of both."""
    one = f"{_pick(rng, *DIRECTIONS)}({target}, {_pick(rng, *relata)})"
    other = f"{_pick(rng, 'close-to', 'distant-from')}({target}, {_pick(rng, *relata)})"
    return one, _pick(rng, other, f"¬{one} ∧ {other}", f"{one} ∨ {other}")


def _made(rng, text, target, *relata, **more):
    return Generated("", 0, text, target, events=_events(rng, target, *relata), **more)


def _one_hop(rng):
    text = _text(_classes(rng, "A"), _static(rng, "M"), _landmark(rng, "m", "M"), _link(rng, "A", "M"))
    return _made(rng, text, "A", "M")


def _chain_of(rng, length, frames=("relative", "intrinsic", "absolute")):
    names = ["M", *"ABCD"[:length]]
    links = [_link(rng, one, relatum, frames=frames) for relatum, one in pairwise(names)]
    return names, _text(_classes(rng, *names[1:]), _static(rng, "M"), *links)


def _chain(rng):
    names, text = _chain_of(rng, int(rng.integers(2, 5)))
    text += "\n" + _landmark(rng, "m", "M")
    return _made(rng, text, names[-1], names[-2])


def _distant_pair(rng):
    names, text = _chain_of(rng, int(rng.integers(2, 5)))
    text += "\n" + _landmark(rng, "m", "M")
    return _made(rng, text, names[-1], *names[:-2])


def _seen_by_a_viewer(rng):
    names, text = _chain_of(rng, int(rng.integers(1, 4)))
    text += "\n" + _landmark(rng, "m", "M", 0.02, 2.0, at=(0.0, 0.0))
    away, distance = rng.uniform(-math.pi, math.pi), rng.uniform(1.5, 4.0)
    viewer = (distance * math.cos(away), distance * math.sin(away), 0.0)
    return _made(rng, text, names[-1], names[-2], viewer=viewer)


def _uncertain_place(rng):
    names, text = _chain_of(rng, int(rng.integers(1, 4)))
    text += "\n" + _landmark(rng, "m", "M", rng.uniform(0.01, 0.2))
    return _made(rng, text, names[-1], names[-2])


def _uncertain_heading(rng):
    names, text = _chain_of(rng, int(rng.integers(1, 4)), ("relative", "intrinsic"))
    text += "\n" + _landmark(rng, "m", "M", rng.uniform(0.01, 0.1), rng.uniform(1.0, 12.0))
    return _made(rng, text, names[-1], names[-2])


def _desk(rng, *names, spread=0.0, turn=0.0):
    """A desk with a monitor near its middle; things stand on it."""
    x, y, facing = rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0), rng.uniform(-180.0, 180.0)
    off, across = rng.uniform(-0.08, 0.08), rng.uniform(-0.2, 0.2)
    c, s = math.cos(math.radians(facing)), math.sin(math.radians(facing))
    doubt = f" ± ({100 * spread:.1f} cm, {100 * spread:.1f} cm, {turn:.1f} deg)" if spread else ""
    classes = [f"dynamic {one} {{ size: {_cm(rng, 4, 14)} × {_cm(rng, 4, 10)}, on: Desk }}." for one in names]
    return (
        "surface Desk { size: 160 cm × 90 cm }.",
        "static M { size: 30 cm × 12 cm, front: yes, on: Desk }.",
        *classes,
        f"landmark desk : Desk at ({x:.3f} m, {y:.3f} m) facing {facing:.1f} deg.",
        f"landmark m : M at ({x + c * off - s * across:.3f} m, {y + s * off + c * across:.3f} m)"
        f" facing {facing + rng.uniform(-20.0, 20.0):.1f} deg{doubt}.",
    )


def _on_a_desk(rng):
    text = _text(*_desk(rng, "A"), _link(rng, "A", "M", frames=("relative",)))
    return _made(rng, text, "A", "M")


def _chain_on_a_desk(rng):
    names = ["M", *"ABC"[: rng.integers(2, 4)]]
    how = {"frames": ("relative",), "distances": ("close-to", "near")}
    links = [_link(rng, one, relatum, **how) for relatum, one in pairwise(names)]
    text = _text(*_desk(rng, *names[1:], spread=0.02, turn=3.0), *links)
    return _made(rng, text, names[-1], names[-2], "M")


def _region(rng):
    shares = rng.dirichlet([3.0, 3.0, 1.0])
    text = _text(
        _classes(rng, "A", "B", sized=True),
        f"surface Table {{ size: {_cm(rng, 60, 200)} × {_cm(rng, 40, 100)} }}.",
        "static Bin { size: 40 cm × 30 cm }.",
        _landmark(rng, "table", "Table"),
        _landmark(rng, "bin", "Bin"),
        f"believe {shares[0]:.3f} :: on(A, Table) | {shares[1]:.3f} :: in(A, Bin).",
        _link(rng, "B", "A", frames=("absolute", "intrinsic")),
    )
    base = _made(rng, text, _pick(rng, "A", "B"), "Table", "Bin")
    return replace(base, events=("on(A, Table)", "in(A, Bin) ∧ right-of(B, A) wrt absolute"))


def _between(rng):
    text = _text(
        _classes(rng, "A", "B"),
        _static(rng, "P"),
        _static(rng, "Q"),
        _landmark(rng, "p", "P", at=(0.0, 0.0)),
        _landmark(rng, "q", "Q", at=tuple(rng.uniform(0.8, 2.0, 2))),
        "observe between(A, P, Q).",
        _link(rng, "B", "A", frames=("absolute", "relative")),
    )
    base = _made(rng, text, _pick(rng, "A", "B"), "P", "Q")
    return replace(base, events=("between(A, P, Q)", "close-to(A, P)"))


def _fit(rng, referent, relatum, mean=None):
    mx, my = rng.uniform(-0.4, 0.4, 2) if mean is None else mean
    sx, sy = rng.uniform(0.1, 0.25, 2)
    fit = f"normal(({mx:.4f} m, {my:.4f} m), ({sx:.4f} m, {sy:.4f} m), {rng.uniform(-0.8, 0.8):.2f})"
    return f"observe {rng.integers(1, 9)} × behind-of({referent}, {relatum}) wrt absolute ~ {fit}."


def _fits(rng):
    names = ["M", *"ABC"[: rng.integers(1, 4)]]
    pairs = list(zip(names[1:], names, strict=False))
    fits = [_fit(rng, *pair) for pair in pairs for _ in range(rng.integers(1, 3))]
    text = _text(_classes(rng, *names[1:]), _static(rng, "M"), _landmark(rng, "m", "M", 0.05), *fits)
    return _made(rng, text, names[-1], names[-2])


def _fused_fits(rng):
    """A is told from two landmarks, each by fits in the axes of the map, behind being +y: Gaussians, so exact."""
    place, starts = rng.uniform(-0.5, 0.5, 2), {"M": (0.6, 0.0), "N": (-0.4, 0.5)}
    fits, landmarks = [], []
    for relatum, at in starts.items():
        landmarks += [_static(rng, relatum), _landmark(rng, relatum.lower(), relatum, 0.03, at=at)]
        for _ in range(rng.integers(1, 3)):
            x, y = place - at + 0.08 * rng.standard_normal(2)
            fits.append(_fit(rng, "A", relatum, (y, -x)))
    text = _text(_classes(rng, "A", "B"), *landmarks, *fits, _fit(rng, "B", "A"))
    return _made(rng, text, _pick(rng, "A", "B"), "M", "N")


def _fused(rng):
    """Two landmarks on whose sides A lies, so placed that both can be right."""
    side, other = rng.integers(4, size=2)
    frames = {"frames": ("absolute",), "distances": ()}
    at = {
        name: -rng.uniform(0.25, 0.5) * np.array(_OFFSETS[one]) for name, one in (("M", side), ("N", other))
    }
    landmarks = [
        part for one in at for part in (_static(rng, one), _landmark(rng, one.lower(), one, 0.02, at=at[one]))
    ]
    text = _text(
        _classes(rng, "A", "B", sized=False),
        *landmarks,
        f"observe {DIRECTIONS[side]}(A, M) wrt absolute.",
        f"observe {DIRECTIONS[other]}(A, N) wrt absolute.",
        _link(rng, "B", "A", **frames),
    )
    return _made(rng, text, _pick(rng, "A", "B"), "M", "N")


def _seen_fits(rng):
    """B is seen, and is told from A, which is told from M: Gaussians, so exact."""
    place = rng.uniform(-0.5, 0.5, 2)
    step = rng.uniform(-0.3, 0.3, 2)
    x, y = place + step + 0.1 * rng.standard_normal(2)
    text = _text(
        _classes(rng, "A", "B", "C"),
        _static(rng, "M"),
        _landmark(rng, "m", "M", 0.03, at=(0.0, 0.0)),
        _landmark(rng, "b", "B", 0.02, at=(x, y)),
        *(_fit(rng, "A", "M", (v, -u)) for u, v in (place, place + 0.1 * rng.standard_normal(2))),
        _fit(rng, "B", "A", (step[1], -step[0])),
        _fit(rng, "C", "A"),
    )
    return _made(rng, text, _pick(rng, "A", "C"), "M")


def _seen(rng):
    """B is seen on one side, which tells on which side A is, and where."""
    side = _pick(rng, -1.0, 1.0)
    shares = rng.dirichlet([3.0, 3.0])
    text = _text(
        _classes(rng, "A", "B", "C", sized=False),
        _static(rng, "M"),
        _landmark(rng, "m", "M", at=(0.0, 0.0)),
        _landmark(rng, "b", "B", 0.01, at=(side * rng.uniform(0.25, 0.5), rng.uniform(0.2, 0.4))),
        f"believe {shares[0]:.3f} :: left-of(A, M) wrt absolute | {shares[1]:.3f} :: right-of(A, M) wrt absolute.",
        "observe behind-of(B, A) wrt absolute.",
        _link(rng, "C", "A", frames=("absolute",), distances=()),
    )
    return _made(rng, text, _pick(rng, "A", "C"), "M")


_OFFSETS = ((0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0))


def _several_landmarks(rng):
    text = _text(
        _classes(rng, "A", "B"),
        _static(rng, "M"),
        _static(rng, "N"),
        *(_landmark(rng, f"m{number}", "M") for number in range(rng.integers(2, 4))),
        _landmark(rng, "n", "N"),
        f"believe {rng.uniform(0.2, 0.5):.3f} :: {_place(rng, 'A', 'M')} | 0.4 :: {_place(rng, 'A', 'N')}.",
        _link(rng, "B", "A"),
    )
    return _made(rng, text, _pick(rng, "A", "B"), "N")


def _wide(rng):
    angle = _pick(
        rng,
        f"normal({rng.uniform(0, 360):.0f} deg, {rng.uniform(20, 45):.0f} deg)",
        f"uniform({rng.uniform(0, 90):.0f} deg, {rng.uniform(150, 270):.0f} deg)",
        "any",
    )
    text = _text(
        _classes(rng, "A"),
        _static(rng, "M"),
        _landmark(rng, "m", "M"),
        f"relation roughly(referent, relatum) {{ angle: {angle}, distance: uniform(0 cm, 80 cm) }}.",
        "observe roughly(A, M).",
    )
    return _made(rng, text, "A", "M")


def _given(rng):
    """A side or a half of the way is given, of which what is known leaves several open."""
    sides = rng.permutation(DIRECTIONS)
    shares = rng.dirichlet([3.0, 3.0, 1.0])
    frame = _pick(rng, "", " wrt absolute")
    text = _text(
        _classes(rng, "A", "B"),
        _static(rng, "M"),
        _landmark(rng, "m", "M", _pick(rng, 0.0, 0.02)),
        f"believe {shares[0]:.3f} :: {sides[0]}(A, M){frame} | {shares[1]:.3f} :: {sides[1]}(A, M){frame}.",
        f"observe {_place(rng, 'B', 'A', distances=())}.",
    )
    given = _pick(rng, "close-to(A, M)", "distant-from(A, M)", f"{sides[0]}(A, M){frame}", "close-to(B, A)")
    return _made(rng, text, _pick(rng, "A", "B"), "M", given=given)


def _required(rng):
    shares = rng.dirichlet([3.0, 3.0])
    text = _text(
        _classes(rng, "A", "B"),
        _static(rng, "M"),
        _landmark(rng, "m", "M"),
        f"believe {shares[0]:.3f} :: left-of(A, M) | {shares[1]:.3f} :: right-of(A, M).",
        f"observe {_pick(rng, *DIRECTIONS)}(B, A).",
        _pick(
            rng,
            "require 0.8 :: left-of(A, M).",
            "require close-to(A, M).",
            "require 0.7 :: ¬close-to(B, A).",
            "require ¬right-of(A, M).",
        ),
    )
    return _made(rng, text, _pick(rng, "A", "B"), "M")


MAKERS = {
    "one hop": _one_hop,
    "chain": _chain,
    "uncertain place": _uncertain_place,
    "several landmarks": _several_landmarks,
    "region": _region,
    "between": _between,
    "fits": _fits,
    "fused fits": _fused_fits,
    "seen fits": _seen_fits,
    "on a desk": _on_a_desk,
    "wide": _wide,
    "distant pair": _distant_pair,
    "uncertain heading": _uncertain_heading,
    "seen by a viewer": _seen_by_a_viewer,
    "chain on a desk": _chain_on_a_desk,
    "fused": _fused,
    "seen": _seen,
    "given": _given,
    "required": _required,
}
