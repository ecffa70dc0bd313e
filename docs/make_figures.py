"""Every picture and every table of docs/, made anew: `make docs`, or `make docs ARGS="--trials 20"` for a quick look.

What needs the folder of real maps ($QSR_DATA) is left as it is where that folder is absent.
"""

from __future__ import annotations

import argparse
import math
import os
import re
import runpy
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.image import imsave
from matplotlib.patches import Ellipse, Rectangle
from pygments import highlight
from pygments.formatters.img import ImageFormatter

import qsrlang as qsr
from qsrlang.editor.highlighting import DarkStyle, QSRLexer
from qsrlang.plotting import style
from qsrlang.plotting.canvas import new_figure
from qsrlang.resources import resource_path

DOCS = Path(__file__).parent
IMAGES = DOCS / "images"
RESULTS = DOCS / "explanation" / "results.md"
ARMS = ("random", "planes", "qsr", "belief")
VARIANTS = ("A", "B", "C")
CAMERAS = ("narrow", "wide")
MONITOR = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg"
DESK = "desk-1 : Desk at (0 m, -0.2 m) facing -90 deg"
SIX_PAIRS = (
    ("Mouse", "Keyboard"),
    ("Keyboard", "Monitor"),
    ("Mug", "Monitor"),
    ("Bottle", "Keyboard"),
    ("Lamp", "Monitor"),
    ("Headphones", "Keyboard"),
)
SEED = 1
TWO_RELATA = """
surface Desk { size: 160 cm × 80 cm, height: 75 cm }.
static  Monitor { size: 55 cm × 20 cm, front: yes, on: Desk }.
static  Lamp { size: 15 cm × 15 cm, front: yes, on: Desk }.
dynamic Cup { on: Desk }.
landmark desk-1 : Desk at (0 m, 0 m) facing -90 deg.
landmark monitor-1 : Monitor at (-15 cm, 25 cm) facing -90 deg.
landmark lamp-1 : Lamp at (62 cm, 25 cm) facing -90 deg.
"""
BY_MONITOR = "believe 60 % :: in-front-of(Cup, Monitor) | 40 % :: right-of(Cup, Monitor)."
BY_LAMP = "believe 70 % :: left-of(Cup, Lamp) | 30 % :: in-front-of(Cup, Lamp)."


def draw_mixtures() -> None:
    """Fig. 4: a cup with respect to a monitor and to a keyboard, and on a desk whose pose is known."""
    known = qsr.load("office/desk")
    for name in ("Monitor", "Keyboard"):
        answer = known.ask(f"where Cup wrt {name}?")
        qsr.save_figure(qsr.draw_answer(answer, known), IMAGES / f"cup-wrt-{name.lower()}.png")
    placed = known.with_landmarks(MONITOR, DESK)
    qsr.save_figure(qsr.draw_answer(placed.where("Cup"), placed), IMAGES / "cup-on-desk.png")


def draw_inference() -> None:
    """What each statement says of a cup alone, and the worlds of both with a cloud of true draws."""
    figure = new_figure(9.6, 3.1)
    alone, both = (figure.add_axes((left, 0.14, 0.43, 0.79)) for left in (0.06, 0.56))
    known = qsr.parse_knowledge(TWO_RELATA + BY_MONITOR + BY_LAMP)
    for axes, title in ((alone, "each statement alone"), (both, "both together: weight = share × evidence")):
        draw_desk(axes, known, title)
    for text, colour, places in (
        (BY_MONITOR, style.PARTS[0], ((-0.42, -0.5), (0.5, 0.515))),
        (BY_LAMP, style.PARTS[5], ((-0.42, 0.515), (0.5, -0.5))),
    ):
        parts = qsr.parse_knowledge(TWO_RELATA + text).where("Cup").components
        for part, place in zip(parts, places, strict=True):
            draw_gaussian(alone, part, colour, f"{100 * part.weight:.0f} % {relations_of(part)}", place)
    scenes = known.sample("Cup", 4000, rng=np.random.default_rng(SEED))
    x, y = scenes.positions[:, scenes.names.index("Cup")].T
    both.plot(x, y, ".", color=style.MUTED, ms=1.5, alpha=0.45, mew=0.0, zorder=3.0)
    for proof, part in zip(known.explain("Cup").proofs, known.where("Cup").components, strict=True):
        (x, y), high = part.mean, 2.0 * math.sqrt(part.covariance[1, 1]) + 0.05
        place = 1.07 * x, y + math.copysign(high, y - 0.2)
        draw_gaussian(both, part, style.BELIEF, evidence_of(proof), place)
    qsr.save_figure(figure, IMAGES / "inference.png")


def draw_desk(axes: Axes, known: qsr.KnowledgeBase, title: str) -> None:
    """Draw a desk from above with the boxes and names of what stands on it."""
    axes.set(xlim=(-0.9, 0.9), ylim=(-0.56, 0.56), aspect="equal")
    style.dress(axes)
    style.label_axes(axes, "x on the map [m]", "y on the map [m]")
    style.write_caption(axes, [title])
    for mark in known.landmarks:
        kind = known.graph.classes[mark.kind]
        corner = mark.x - 0.5 * kind.width, mark.y - 0.5 * kind.depth
        face = "none" if kind.is_surface else "#dddddd"
        box = Rectangle(corner, kind.width, kind.depth, facecolor=face, linewidth=1.0, zorder=2.0)
        box.set_edgecolor(style.SUPPORT)
        axes.add_patch(box)
        if not kind.is_surface:
            axes.text(mark.x, mark.y, mark.kind, ha="center", va="center", zorder=7.0, **style.text())


def draw_gaussian(
    axes: Axes, part: qsr.Component, colour: str, text: str, place: tuple[float, float]
) -> None:
    """Draw a component's ellipses of one and two deviations, and a text at a place."""
    (x, y), (major, minor, angle) = part.mean, part.ellipse
    for sigmas, dashes in ((1.0, "solid"), (2.0, (0.0, (4.0, 2.5)))):
        size = 2.0 * sigmas * major, 2.0 * sigmas * minor
        line = Ellipse((x, y), *size, angle=math.degrees(angle), fill=False, linewidth=1.3)
        line.set(edgecolor=colour, linestyle=dashes, zorder=5.0)
        axes.add_patch(line)
    axes.plot(x, y, "+", color=colour, ms=6.0, zorder=6.0)
    label = axes.text(*place, text, ha="center", va="center", color=colour, zorder=8.0, **style.text())
    label.set_path_effects(style.halo())


def evidence_of(proof: qsr.Proof) -> str:
    """Return a world's weight as the product that it is."""
    evidence = f"{proof.evidence:.2f}" if proof.evidence > 0.005 else "0.00"
    return f"{proof.weight:.2f} = {proof.prior:.2f} × {evidence}"


def relations_of(part: qsr.Component) -> str:
    """Return the atoms behind a component, without their lines and shares."""
    return ", ".join(re.findall(r"[\w-]+\([^)]*\)", " ".join(part.statements)))


def draw_code() -> None:
    """The Fig. 2 file as an editor shows it."""
    formatter = ImageFormatter(
        style=DarkStyle,
        font_name=str(Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSansMono.ttf")),
        font_size=20,
        image_pad=18,
        line_pad=4,
        line_number_bg=DarkStyle.background_color,
        line_number_fg=DarkStyle.line_number_color,
        line_number_separator=False,
        line_number_pad=12,
    )
    text = resource_path("knowledge", "office", "desk.qsr").read_text(encoding="utf-8")
    (IMAGES / "highlighting.png").write_bytes(highlight(text, QSRLexer(), formatter))


def draw_room() -> None:
    """The built-in room, from above and aslant."""
    room = qsr.load_room("kitchen")
    picture = qsr.scene_picture(room, (11.5, -4.5, 13.5), (3.9, 5.6, 0.2), (900, 640))
    imsave(IMAGES / "kitchen-room.png", np.asarray(picture))


def draw_search(scenario: str, planner: str, seed: int, name: str) -> None:
    """Figs. 6 to 8: the last step of a search, with all views it weighed."""
    story = qsr.search(scenario, planner=planner, seed=seed)
    qsr.save_figure(qsr.draw_story(story), IMAGES / f"{name}.png")


def draw_supports() -> None:
    """Fig. 5: the OctoMap of the paper's kitchen and its supporting planes."""
    folder = qsr.data_root() / "tum_kitchen"
    voxels = qsr.read_octomap(folder / "tum_kitchen_octomap.bt").voxel_grid()
    occupancy = qsr.read_ros_map(folder / "tum_kitchen.yaml")
    qsr.save_figure(qsr.draw_voxels(voxels, z_max=2.0), IMAGES / "tum-kitchen-octomap.png")
    supports = qsr.find_supports(voxels, min_height=0.0, max_height=1.2, min_part=20)
    qsr.save_figure(qsr.draw_map(occupancy, supports), IMAGES / "tum-kitchen-supports.png")


def draw_learning() -> None:
    """Learned mixtures over where people put things on real desks, and what the first scans of a desk are worth."""
    path = qsr.data_root() / "kth3d" / "kth3d_desks.csv"
    benchmark = runpy.run_path(str(DOCS.parent / "benchmarks" / "bench_learning.py"))
    seen = qsr.read_observations(path).observations
    known = qsr.load("office/desks")
    for referent, relatum in SIX_PAIRS:
        points = benchmark["cases_of"](seen, referent, relatum).points
        choice = next(one for one in known.graph.choices if (referent, relatum) in one.governs)
        graph = replace(known.graph, choices=(choice,))
        mixture = replace(known, graph=graph).where(referent, wrt=relatum).mixture
        title = f"{referent} as seen from {relatum}"
        figure = qsr.draw_mixture(mixture, frame=relatum, title=title, points=points)
        qsr.save_figure(figure, IMAGES / f"learned-{referent.lower()}-{relatum.lower()}.png")
    gains = benchmark["desk_gains"](seen)
    curves = {f"{a.lower()} | {b.lower()}": list(found.values()) for (a, b), found in gains.items()}
    curves["mean"] = np.mean(list(curves.values()), axis=0).tolist()
    lines = {name: (benchmark["SCANS"], values) for name, values in curves.items()}
    least = min(0.0, *(min(values) for values in curves.values()))
    figure = qsr.draw_curves(
        lines, "scans of the desk seen before", "gain [nat/object]", lowest=least, bold="mean"
    )
    qsr.save_figure(figure, IMAGES / "learning-curves.png")


def tell_comparisons(scenario: str, cameras: Sequence[str | None], trials: int, arms: Sequence[str]) -> None:
    """Tables II and III, and the curves of finds over time."""
    for camera in cameras:
        for variant in VARIANTS:
            loaded = qsr.load_scenario(scenario, camera)
            result = qsr.compare(loaded, arms, trials, SEED, variant, processes=os.cpu_count() or 1)
            mark = "-".join(filter(None, (scenario, camera, variant)))
            option = f" --camera {camera}" if camera else ""
            command = f"qsr compare {scenario} --arms {','.join(arms)} --trials {trials} --seed {SEED}"
            replace_table(mark, f"`{command} --variant {variant}{option}`\n\n{markdown(result)}")
            times = {arm: [t.seconds if t.found else math.inf for t in result.of(arm)] for arm in arms}
            qsr.save_figure(
                qsr.draw_found_by_time(times, loaded.arm(arms[0]).limits.seconds),
                IMAGES / f"found-{mark}.png",
            )


def markdown(result: qsr.Comparison) -> str:
    """Return a comparison as a table of this document."""
    lines = [
        "| arm | found | mean s, found only | censored mean s | poses, found only | travel m |",
        "|---|---|---|---|---|---|",
    ]
    for arm, one in result.summaries.items():
        found = f"{one.found:.1%} [{one.found_ci.low:.1%}, {one.found_ci.high:.1%}]"
        censored = f"{one.time_censored:.1f} [{one.time_ci.low:.1f}, {one.time_ci.high:.1f}]"
        means = ["-" if mean is None else f"{mean:.1f}" for mean in (one.time_found, one.poses)]
        lines.append(f"| {arm} | {found} | {means[0]} | {censored} | {means[1]} | {one.travel:.1f} |")
    return "\n".join(lines)


def replace_table(mark: str, text: str) -> None:
    """Put a table between its two marks in results.md."""
    page = RESULTS.read_text(encoding="utf-8")
    pattern = re.compile(rf"(<!-- {mark} -->\n).*?(<!-- end -->)", re.DOTALL)
    if not pattern.search(page):
        raise SystemExit(f"{RESULTS} has no place for {mark}")
    RESULTS.write_text(pattern.sub(lambda found: f"{found[1]}{text}\n{found[2]}", page), encoding="utf-8")


def main() -> None:
    """Make what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--only", choices=("pictures", "learning", "tables"))
    chosen = parser.parse_args()
    IMAGES.mkdir(exist_ok=True)
    has_data = (qsr.data_root() / "tum_kitchen").is_dir()
    if chosen.only == "learning":
        draw_learning()
        return
    if chosen.only != "tables":
        draw_mixtures()
        draw_inference()
        draw_code()
        draw_room()
        draw_search("kitchen", "qsr", 7, "kitchen-search")
        if has_data:
            draw_learning()
            draw_supports()
            draw_search("tum-kitchen", "planes", 2, "tum-kitchen-planes")
            draw_search("tum-kitchen", "qsr", 2, "tum-kitchen-qsr")
    if chosen.only != "pictures":
        tell_comparisons("kitchen", [None], chosen.trials, ARMS)
        if has_data:
            tell_comparisons("tum-kitchen", CAMERAS, chosen.trials, (*ARMS, "relations"))


if __name__ == "__main__":
    main()
