"""What an accepted program of the corpus states of itself, in lines `#= subject = value` at its end.

Subjects: statements, classes, landmarks, relations, roles, pairs, requirements, defaults, `class Desk`,
`landmark desk-1`, `relation beside`, `choice Cup/Keyboard`, `where Cup`, `doc 2` (of the second statement),
`same other_program`, and `warns` (every warning and information with its place; without one there are none).
Requirements, choices and places may be asked for circumstances: `choice Cup/Plate in room kitchen at 09:30`.
Lengths are in metres, angles in degrees; built-in names are left out.
"""

import math
import re
from pathlib import Path

from qsrlang.language import syntax as s
from qsrlang.language.parser import parse_place, parse_query, parse_source
from qsrlang.language.source import Source, read_source
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.relations.build import build_graph
from qsrlang.relations.contexts import Circumstances
from qsrlang.relations.graph import pair_of
from qsrlang.relations.linting.lint import lint

STATED = re.compile(r"^#= (\w+)(?: ([^=\n]+?))? = ?(.*)$", re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.-])-?\d+\.\d+")
CORE = build_graph(Source("", ""))


class Program:
    """An accepted program, read once; paths are taken from the present folder."""

    def __init__(self, path):
        self.source = read_source(Path(path))
        self.built = build_graph(self.source)
        self.graph, self.symbols = self.built.graph, self.built.symbols
        self.document = parse_source(self.source).document

    def findings(self):
        """Return what is found in the program itself, not in what it imports."""
        viewer = next((place for key, _, place in self.stated() if key == "viewer"), None)
        found = (*self.built.diagnostics, *lint(self.built, self.source, viewer and parse_place(viewer)))
        return [one for one in found if one.span.source.name == self.source.name]

    def stated(self):
        """Return what the program states of itself."""
        return STATED.findall(self.source.text)

    def value(self, key, rest):
        """Return the true value of a subject."""
        return getattr(self, f"_{key}")(rest)

    def under(self, rest):
        """Return the graph in the circumstances named after a subject, and the subject alone."""
        subject, *suffix = re.split(r" ?\b(?=(?:in|at) )", rest, maxsplit=1)
        asked = parse_query(f"where Cup {suffix[0]}?").circumstances if suffix else None
        return subject, self.built.under(Circumstances.of(asked))

    def _statements(self, rest):
        return str(len(self.document.statements))

    def _classes(self, rest):
        return ", ".join(self.graph.classes)

    def _landmarks(self, rest):
        return ", ".join(one.name for one in self.graph.landmarks)

    def _relations(self, rest):
        return ", ".join(name for name in self.graph.relations if name not in CORE.graph.relations)

    def _roles(self, rest):
        return ", ".join(self.graph.roles)

    def _pairs(self, rest):
        _, graph = self.under(rest)
        pairs = {pair: None for choice in graph.choices for pair in sorted(choice.governs)}
        return ", ".join("/".join(pair) for pair in pairs)

    def _requirements(self, rest):
        _, graph = self.under(rest)
        return " | ".join(
            f"{'always' if one.share is None else format(one.share, '.2f')} {bare(one.statement.text)}"
            for one in graph.requirements
        )

    def _defaults(self, rest):
        return ", ".join(f"{name} {value:.2f}" for name, value in self.symbols.defaults.items())

    def _class(self, rest):
        one = self.graph.classes[rest]
        sides = f" {one.width:.3f} × {one.depth:.3f} × {one.height:.3f}"
        return f"{one.kind}{sides}{', front' if one.front else ''}{f', on {one.on}' if one.on else ''}"

    def _landmark(self, rest):
        (one,) = [one for one in self.graph.landmarks if one.name == rest]
        position = ", ".join(f"{value:.2f}" for value in (one.x, one.y, one.z) if value is not None)
        x, y, heading = one.deviation
        facing = "" if one.heading is None else f" facing {math.degrees(one.heading):.2f}"
        spread = f" ± ({x:.2f}, {y:.2f}, {math.degrees(heading):.2f})" if any(one.deviation) else ""
        return f"{one.kind} at ({position}){facing}{spread}"

    def _relation(self, rest):
        one = self.graph.relations[rest]
        parts = [f"arity {one.arity}", f"angle {density(one.angle)}", f"distance {density(one.distance)}"]
        parts += [f"region {one.region}"] if one.region else []
        parts += [f"converse {one.converse}"] if one.converse else []
        parts += [f"components {one.components}"] if one.components > 1 else []
        parts += [f"disjoint {', '.join(one.disjoint)}"] if one.disjoint else []
        return "; ".join([*parts, *(["symmetric"] if one.symmetric else [])])

    def _choice(self, rest):
        subject, graph = self.under(rest)
        pair = tuple(subject.split("/"))
        choices = [choice for choice in graph.choices if pair in choice.governs]
        return " and ".join(" | ".join(self._alternatives(choice, pair)) for choice in choices) or "open"

    def _alternatives(self, choice, pair):
        for one in choice.alternatives:
            said = [each for each in one.constraints if pair_of(each, self.symbols.class_of) == pair]
            relations = " & ".join(said_by(constraint) for constraint in said)
            yield f"{one.share:.2f} {relations or 'of another pair'}"
        rest = 1.0 - sum(one.share for one in choice.alternatives)
        if rest > 1e-9:
            yield f"{rest:.2f} elsewhere"

    def _where(self, rest):
        answer = KnowledgeBase(self.graph, built=self.built).ask(f"where {rest}?")
        parts = [
            f"{one.weight:.2f} at ({one.mean[0]:.2f}, {one.mean[1]:.2f})".replace("-0.00", "0.00")
            for one in answer.components
        ]
        return " | ".join(
            [*parts, *([f"{answer.elsewhere:.2f} elsewhere"] if answer.elsewhere > 1e-9 else [])]
        )

    def _doc(self, rest):
        return self.document.statements[int(rest) - 1].doc.replace("\n", " / ")

    def _same(self, rest):
        other = parse_source(read_source(Path(f"{rest}.qsr"))).document
        return "yes" if self.document == other else "no"

    def _viewer(self, rest):
        """Return where the viewer stands for whom the program is linted: as it is stated."""
        return next(place for key, _, place in self.stated() if key == "viewer")

    def _warns(self, rest):
        return ", ".join(f"{one.code} {one.span.line}:{one.span.column}" for one in self.findings())


def bare(text):
    """Return the formula of a requirement."""
    return text.removeprefix("require ").split(" :: ")[-1]


def said_by(constraint):
    """Return what a constraint says, without its pair."""
    atoms = " & ".join(
        one.relation.name + ("" if one.frame is s.Frame.RELATIVE else f" wrt {one.frame.value}")
        for one in constraint.atoms
    )
    towards = f" towards {constraint.towards}" if constraint.towards else ""
    return atoms + towards + (" with a fit" if constraint.fit else "")


def density(node):
    """Return a density on one line, angles in degrees and lengths in metres or percent."""
    match node:
        case s.Normal(mean=first, deviation=second):
            return f"normal({quantity(first)}, {quantity(second)})"
        case s.Uniform(low=first, high=second):
            return f"uniform({quantity(first)}, {quantity(second)})"
        case s.Mix(parts=parts):
            return f"mix({', '.join(density(part) for part in parts)})"
        case s.Anywhere():
            return "any"
    return "open"


def quantity(node):
    """Return a quantity in degrees, percent or metres."""
    if node.dimension is s.Dimension.ANGLE:
        return f"{math.degrees(node.value):.2f}"
    return f"{100 * node.value:.2f} %" if node.dimension is s.Dimension.FRACTION else f"{node.value:.2f}"


def agree(stated, true, tolerance=0.0101):
    """Return whether two values are the same but for their last decimal."""
    one, other = NUMBER.findall(stated), NUMBER.findall(true)
    words = NUMBER.sub("#", stated) == NUMBER.sub("#", true)
    return words and all(
        math.isclose(float(a), float(b), abs_tol=tolerance) for a, b in zip(one, other, strict=True)
    )
