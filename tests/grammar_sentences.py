"""Sentences drawn from the grammar's own rules, as rows of tokens; no meaning is minded."""

from functools import cache

from hypothesis import strategies as st

from qsrlang.language.grammar import reader, spellings

SAMPLES = {
    "NAME": ("Cup", "left-of", "杯", "Tisch-Größe", "lab.Mug", "r133"),
    "NUMBER": ("1", "0.25", "85", "1e-2"),
    "SIGN": ("-", "+"),
    "STRING": ('"office/desk"', '""'),
    "TIME": ("08:30", "9:05"),
}
SEPARATORS = (" ", "\n", "  # not ended. {(\n")
DEEP = 16
LONG = 60


@cache
def expansions():
    """Return the rules by what they define: `{"atom": (expansion, ...)}`, the shallowest first."""
    found = {}
    for rule in reader().lark.rules:
        found.setdefault(rule.origin.name, []).append(tuple(rule.expansion))
    return {origin: tuple(sorted(bodies, key=body_depth)) for origin, bodies in found.items()}


@cache
def depths():
    """Return how deep the shallowest derivation of each nonterminal is."""
    known, before = {}, None
    while known != before:
        before = dict(known)
        for rule in reader().lark.rules:
            inner = [0 if symbol.is_term else before.get(symbol.name, 1000) for symbol in rule.expansion]
            depth = 1 + max(inner, default=0)
            known[rule.origin.name] = min(depth, known.get(rule.origin.name, 1000))
    return known


def body_depth(body):
    """Return how deep the shallowest derivation of an expansion is."""
    return max((0 if symbol.is_term else depths()[symbol.name] for symbol in body), default=0)


def samples_of(terminal):
    """Return texts that a terminal matches."""
    return SAMPLES.get(terminal) or spellings()[terminal]


@st.composite
def sentences(draw, start):
    """Draw the tokens of a sentence as pairs of terminal and text."""
    waiting, tokens = [(start, False, 0)], []
    while waiting:
        name, is_term, depth = waiting.pop()
        if is_term:
            tokens.append((name, draw(st.sampled_from(samples_of(name)))))
            continue
        bodies = expansions()[name]
        if depth + depths()[name] > DEEP or len(tokens) > LONG:
            bodies = bodies[:1]
        body = draw(st.sampled_from(bodies))
        waiting += [(symbol.name, symbol.is_term, depth + 1) for symbol in reversed(body)]
    return tuple(tokens)


def through(start, rule):
    """Return the terminals of a short sentence whose derivation uses a rule, or None where `start` never needs it."""
    path = path_to(start, rule.origin.name)
    if path is None:
        return None
    row = [(symbol.name, symbol.is_term) for symbol in rule.expansion]
    for _, body, at in reversed(path):
        row = [(s.name, s.is_term) for s in body[:at]] + row + [(s.name, s.is_term) for s in body[at + 1 :]]
    terminals = []
    waiting = row[::-1]
    while waiting:
        name, is_term = waiting.pop()
        if is_term:
            terminals.append(name)
        else:
            waiting += [(symbol.name, symbol.is_term) for symbol in reversed(expansions()[name][0])]
    return tuple(terminals)


def path_to(start, goal):
    """Return how a nonterminal comes about from a start: steps of origin, expansion and position."""
    paths, waiting = {start: ()}, [start]
    while waiting:
        name = waiting.pop(0)
        for body in expansions()[name]:
            for at, symbol in enumerate(body):
                if not symbol.is_term and symbol.name not in paths:
                    paths[symbol.name] = (*paths[name], (name, body, at))
                    waiting.append(symbol.name)
    return paths.get(goal)
