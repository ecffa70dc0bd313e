"""Nodes of the whole language that hypothesis draws: `documents`, `statements`, `formulas` and `queries`.

Every node drawn is one that some text means; its places are those of an empty source, which take no part in comparison.
"""

from functools import partial

from hypothesis import strategies as st

from qsrlang.language import questions as q
from qsrlang.language import statements as t
from qsrlang.language import syntax as s
from qsrlang.language.grammar import keywords
from qsrlang.language.nodes.questions import MAX_SCENES
from qsrlang.language.quantities import to_si
from qsrlang.language.source import Source, Span

NOWHERE = Span(Source("<drawn>", ""), 0, 0)
FAMILIAR = ("Cup", "Keyboard", "Desktop-PC", "desk-1", "left-of", "Tisch-Größe", "杯子", "not-placed")
ODD = ("x1", "_", "²", "Å_٣", "ª-3-ß", "e5", "AND")


def maybe(strategy):
    return st.none() | strategy


def node(kind, *strategies, **named):
    return st.builds(partial(kind, NOWHERE), *strategies, **named)


# Names: familiar ones, odd ones, every reserved word, and each with a prefix.
words = (*FAMILIAR, *ODD, *sorted(keywords()))
plain_names = node(s.Name, st.sampled_from(words))
any_words = st.sampled_from((*words, *words, *(f"{word}.Cup" for word in words), "lab.not", "a.b-c.d"))
names = node(s.Name, any_words)


def names_but(*refused):
    """Names that do not begin with a word the lexer would take for another where they stand."""
    return node(s.Name, any_words.filter(lambda word: word.split(".")[0] not in refused))


roles = node(s.Role, names, names)
arguments = names | roles

# Numbers as people type them, and any other; negative zero too.
tidy = st.integers(0, 100_000).map(lambda thousandths: thousandths / 1000)
positive_tidy = st.integers(1, 100_000).map(lambda thousandths: thousandths / 1000)
counts = st.integers(0, 1_000_000).map(float) | st.floats(0.0, allow_infinity=False)
shares = st.sampled_from([0.0, 1.0, 0.15, 0.7, 0.333]) | st.floats(0.0, 1.0)


def si(number, *units):
    return st.builds(lambda value, unit: to_si(value, unit)[0], number, st.sampled_from(units))


def finite(**bounds):
    return st.floats(allow_nan=False, allow_infinity=False, **bounds)


positive_lengths = si(positive_tidy, "m", "cm", "mm") | finite(min_value=0.0, exclude_min=True)
lengths_from_zero = si(tidy, "m", "cm", "mm") | finite(min_value=0.0)
lengths = lengths_from_zero | lengths_from_zero.map(lambda value: -value)
angles_from_zero = si(tidy, "deg", "rad") | finite(min_value=0.0)
positive_angles = si(positive_tidy, "deg", "rad") | finite(min_value=0.0, exclude_min=True)
angles = angles_from_zero | angles_from_zero.map(lambda value: -value)
percentages = si(st.integers(0, 100) | st.floats(0.0, 100.0), "%")


def quantities(values, dimension):
    return node(s.Quantity, values, st.just(dimension))


def rising(values, dimension):
    bounds = st.tuples(values, values).filter(lambda pair: pair[0] != pair[1]).map(sorted)
    return bounds.map(lambda pair: s.Uniform(NOWHERE, *(s.Quantity(NOWHERE, one, dimension) for one in pair)))


any_quantities = st.one_of(
    quantities(lengths, s.Dimension.LENGTH),
    quantities(angles, s.Dimension.ANGLE),
    quantities(si(tidy, "s", "h"), s.Dimension.DURATION),
    quantities(si(tidy, "%"), s.Dimension.FRACTION),
    quantities(tidy | finite(), s.Dimension.NUMBER),
)

# Formulas: conjunctions and disjunctions are n-ary, never nested in their own kind; a double negation is none.
atoms = node(
    s.Atom,
    names_but("not"),
    st.lists(arguments, min_size=1, max_size=3).map(tuple),
    st.sampled_from(s.Frame),
)


def negated(formula):
    return formula.part if isinstance(formula, s.Not) else s.Not(NOWHERE, formula)


def joined(kind):
    def join(parts):
        flat = [one for part in parts for one in (part.parts if isinstance(part, kind) else (part,))]
        return kind(NOWHERE, tuple(flat))

    return join


def _larger(formula):
    parts = st.lists(formula, min_size=2, max_size=3)
    return formula.map(negated) | parts.map(joined(s.And)) | parts.map(joined(s.Or))


formulas = st.recursive(atoms, _larger, max_leaves=5)
fits = node(
    s.Fit,
    st.tuples(lengths, lengths),
    st.tuples(positive_lengths, positive_lengths),
    st.floats(-1.0, 1.0, exclude_min=True, exclude_max=True),
)

# Relations.
bell_angles = node(
    s.Normal, quantities(angles, s.Dimension.ANGLE), quantities(positive_angles, s.Dimension.ANGLE)
)
anywhere = node(s.Anywhere)
angle_densities = st.recursive(
    bell_angles | rising(angles, s.Dimension.ANGLE) | anywhere,
    lambda part: node(s.Mix, st.lists(part, min_size=1, max_size=3).map(tuple)),
    max_leaves=4,
)
distance_densities = (
    rising(lengths_from_zero, s.Dimension.LENGTH) | rising(percentages, s.Dimension.FRACTION) | anywhere
)

# Doc comments: lines without blanks at their ends; one empty line is none.
doc_lines = st.text(st.characters(exclude_categories=("Cc", "Cs", "Zl", "Zp")), max_size=8).map(str.strip)
docs = st.one_of(*[st.just("")] * 3, st.lists(doc_lines, max_size=3).map("\n".join))


def stated(kind, *strategies, **named):
    return node(kind, *strategies, doc=docs, **named)


languages = stated(t.Language, st.integers(0, 10**9))
imports = stated(
    t.Import,
    st.text(st.characters(exclude_categories=("Cs",), exclude_characters='"\n'), max_size=8),
    maybe(plain_names),
)
defaults = stated(t.Defaults, st.lists(st.tuples(names, any_quantities), min_size=1, max_size=3).map(tuple))
sizes = st.lists(positive_lengths, min_size=2, max_size=3).map(tuple)
declared = node(t.DeclaredClass, names, maybe(sizes), maybe(positive_lengths), st.booleans(), maybe(names))
declarations = stated(
    t.Declaration,
    st.sampled_from(["surface", "static", "dynamic"]),
    st.lists(declared, min_size=1, max_size=3).map(tuple),
)
deviations = st.just(()) | st.one_of(
    st.tuples(lengths_from_zero, lengths_from_zero),
    st.tuples(lengths_from_zero, lengths_from_zero, angles_from_zero),
)
positions = st.lists(lengths, min_size=2, max_size=3).map(tuple)
landmarks = stated(t.Landmark, names, names, positions, maybe(angles), deviations)
relations = stated(
    t.Relation,
    names,
    st.lists(names, min_size=1, max_size=3).map(tuple),
    angle=maybe(angle_densities),
    distance=maybe(distance_densities),
    region=maybe(st.sampled_from(["top", "inside"])),
    converse=maybe(names),
    disjoint=st.lists(names, max_size=3).map(tuple),
    symmetric=st.booleans(),
)
scenes = stated(t.Scene, maybe(names), st.lists(arguments, min_size=1, max_size=4).map(tuple), formulas)
alternatives = node(t.Alternative, maybe(shares), formulas, maybe(fits)) | node(
    t.Alternative, maybe(shares), node(t.Elsewhere)
)
believes = stated(t.Believe, st.lists(alternatives, min_size=1, max_size=3).map(tuple))
observes = stated(t.Observe, counts, formulas, maybe(fits))
scene_observes = stated(t.ObserveScene, counts, names_but("not"))
requires = stated(t.Require, maybe(shares), formulas)

minutes = st.integers(0, 24 * 60 - 1)
periods = st.tuples(minutes, st.integers(0, 24 * 60)).filter(lambda pair: pair[0] != pair[1])
days = st.sampled_from(["weekday", "weekend"])
conditions = st.one_of(
    node(t.Room, names), periods.map(lambda pair: t.Period(NOWHERE, *pair)), node(t.Days, days)
)
contextual = st.one_of(scenes, believes, observes, scene_observes, requires)
contexts = stated(
    t.Context,
    st.lists(conditions, min_size=1, max_size=3).map(tuple),
    st.lists(contextual, max_size=3).map(tuple),
)
statements = st.one_of(languages, imports, defaults, declarations, landmarks, relations, contextual, contexts)
documents = st.lists(statements, max_size=4).map(tuple).map(t.Document)

# Queries.
circumstances = (
    st.tuples(maybe(names), maybe(days), maybe(minutes))
    .filter(lambda drawn: drawn != (None, None, None))
    .map(lambda drawn: q.Circumstances(NOWHERE, *drawn))
)
assumed = {"given": maybe(formulas), "circumstances": maybe(circumstances)}
queries = st.one_of(
    node(q.Where, arguments, maybe(names), **assumed),
    node(q.Prob, formulas, **assumed),
    node(q.Explain, arguments, maybe(names), **assumed),
    node(q.Explain, atoms, **assumed),
    node(q.Views, arguments, **assumed),
    node(q.Landmarks, arguments, **assumed),
    node(q.Sample, maybe(names_but("given", "in", "at")), st.integers(1, MAX_SCENES), **assumed),
    node(q.Check),
)
