"""From text to relation graph, and to findings: times and rates in one run, beside bare lark.

python benchmarks/bench_language.py
"""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from lark import Lark
from timing import best_of

import qsrlang as qsr
from qsrlang.language.grammar import grammar_text
from qsrlang.language.source import Source
from qsrlang.relations.build import build_graph

CLASSES = "dynamic Keyboard, Laptop, Cup, Bottle. static Monitor { front: yes }.\n"
FIGURE_2 = """scene(Monitor, Keyboard, Laptop, Cup, Bottle) ⇔
    in-front-of(Keyboard, Monitor) ∧ left-of(Laptop, Keyboard) ∧ right-of(Cup, Keyboard) ∧
    behind-of(Bottle, Cup) ∧ close-to(Bottle, Cup).
"""
RIGHT = "observe 3 × left-of(Cup, Plate) ∧ close-to(Cup, Plate).\n"
WRONG = "observe 3 × left-of(Cup Plate) ∧ close-to(Cup, Plate).\n"
MEGABYTE = 1_000_000


def show(what: str, took: float, beside: str = "") -> None:
    print(f"{what:58s} {1e3 * took:10.2f} ms   {beside}")


def repeated(text: str, size: int) -> str:
    return text * (size // len(text.encode()))


def small_file() -> None:
    text = CLASSES + FIGURE_2
    build_graph(Source("figure-2.qsr", text))
    show("Fig. 2 file, text to relation graph, warm", best_of(lambda: build_graph(Source("f", text)), 50))
    show("office/desk, text to relation graph, warm", best_of(lambda: qsr.load("office/desk"), 20))


def rate() -> None:
    text = repeated(FIGURE_2, MEGABYTE)
    bare = Lark(
        grammar_text(),
        parser="lalr",
        lexer="contextual",
        start="document",
        propagate_positions=True,
        maybe_placeholders=False,
    )
    limit = best_of(lambda: bare.parse(text), 3)
    took = best_of(lambda: qsr.parse(text), 3)
    kilobytes = len(text.encode()) / 1e3
    beside = f"{kilobytes / took:.0f} KB/s; bare lark to trees {kilobytes / limit:.0f} KB/s, ratio {limit / took:.2f}"
    show("1 MB of formulas to nodes, positions and recovery", took, beside)


def growth(what: str, text: str) -> None:
    sizes = [MEGABYTE // 8, MEGABYTE // 4, MEGABYTE // 2, MEGABYTE]
    texts = [repeated(text, size) for size in sizes]
    times = [best_of(lambda text=text: qsr.parse(text), 2) for text in texts]
    exponent = np.polyfit(np.log(sizes), np.log(times), 1)[0]
    show(what, times[-1], f"{sizes[-1] / 1e3 / times[-1]:.0f} KB/s; time grows as size^{exponent:.2f}")


def cold_start() -> None:
    command = [sys.executable, "-c", "from qsrlang.cli.main import main; main()", "check", "office/desk"]
    took = best_of(lambda: subprocess.run(command, check=True, capture_output=True), 7)
    show("qsr check office/desk, a new process", took)


if __name__ == "__main__":
    small_file()
    rate()
    growth("1 MB of statements, all right", RIGHT)
    growth("1 MB of statements, an error in every tenth", RIGHT * 9 + WRONG)
    cold_start()
