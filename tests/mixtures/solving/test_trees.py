"""Truth tables of trees, beside the sum over all worlds that `explain` tells one by one."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.language.parser import parse_formula
from qsrlang.language.syntax import atoms_of
from qsrlang.mixtures.draws.conditions import objects_of
from qsrlang.mixtures.solving.tables import TruthTables
from qsrlang.mixtures.solving.trees import tree_table

NAMES = "ABCD"
RELATIONS = ("left-of", "right-of", "in-front-of", "behind-of", "close-to", "distant-from")
HEAD = "static M. dynamic A, B, C, D, E. landmark m : M at (0 m, 0 m) facing -90 deg.\n"
TREE = (
    HEAD
    + """
believe 0.5 :: left-of(A, M) | 0.3 :: right-of(A, M) | elsewhere.
believe 0.6 :: behind-of(B, A) | 0.4 :: close-to(B, A).
believe 0.9 :: right-of(C, A) | elsewhere.
"""
)


@st.composite
def trees(draw):
    """Statements that place five things, and the pairs they are about."""
    lines, pairs = [], []
    for number, name in enumerate(NAMES):
        relatum = draw(st.sampled_from(["M", *NAMES[:number]]))
        said = draw(st.lists(st.sampled_from(RELATIONS), min_size=1, max_size=3, unique=True))
        weights = [draw(st.integers(1, 3)) for _ in said]
        shares = [f"{0.9 * weight / sum(weights):.3f}" for weight in weights]
        terms = (f"{share} :: {one}({name}, {relatum})" for share, one in zip(shares, said, strict=True))
        lines.append(f"believe {' | '.join(terms)} | elsewhere.")
        pairs.append((name, relatum))
    return "\n".join(lines), pairs


@st.composite
def questions(draw):
    text, pairs = draw(trees())
    atoms = [
        f"{draw(st.sampled_from(RELATIONS))}({', '.join(draw(st.sampled_from(pairs)))})"
        for _ in range(draw(st.integers(1, 3)))
    ]
    formula = f" {draw(st.sampled_from('∧∨'))} ".join(atoms)
    assumed = f"{draw(st.sampled_from(RELATIONS[:4]))}({', '.join(draw(st.sampled_from(pairs)))})"
    return text, formula, draw(st.sampled_from([None, assumed]))


@given(questions())
@settings(max_examples=40)
def test_a_tree_tells_what_the_sum_over_its_worlds_tells(question):
    text, formula, assumed = question
    known = qsr.parse_knowledge(HEAD + text)
    assert table_of(known, formula) is not None
    try:
        summed = known.explain(parse_formula(formula), given=assumed).answer
    except qsr.ImpossibleConditionError:
        with pytest.raises(qsr.ImpossibleConditionError):
            known.prob(formula, given=assumed)
        return
    assert known.prob(formula, given=assumed).value == pytest.approx(summed.value, abs=1e-12)


@pytest.mark.parametrize(
    ("more", "formula", "is_tree"),
    [
        ("", "behind-of(B, A) ∧ left-of(A, M)", True),
        ("believe close-to(B, C).", "behind-of(B, A)", False),
        ("landmark n : M at (2 m, 0 m) facing 0 deg.", "left-of(A, M)", False),
        ("", "left-of(B, M)", False),
        ("", "left-of(A, M) ∧ left-of(B, M)", False),
        ("observe left-of(A, M).", "behind-of(B, A)", True),
    ],
)
def test_what_is_no_tree_is_left_to_the_sum_over_worlds(more, formula, is_tree):
    known = qsr.parse_knowledge(TREE + more)
    assert (table_of(known, formula) is not None) == is_tree
    assert known.prob(formula).value == pytest.approx(
        known.explain(parse_formula(formula)).answer.value, abs=1e-12
    )


@pytest.mark.parametrize(("frame", "is_same"), [("", True), (" wrt absolute", False)])
def test_what_turns_with_a_heading_is_told_exactly_though_that_is_not_certain(frame, is_same):
    shaky = qsr.parse_knowledge(TREE.replace("facing -90 deg", "facing -90 deg ± (1 cm, 1 cm, 20 deg)"))
    formula = f"left-of(C, A){frame} ∧ behind-of(B, A)"
    assert (table_of(shaky, formula) is not None) == is_same
    if is_same:
        firm = qsr.parse_knowledge(TREE)
        assert shaky.prob(formula) == firm.prob(formula)


def test_what_is_elsewhere_in_the_likeliest_world_is_told_without_worlds():
    known = qsr.parse_knowledge(TREE.replace("0.9 :: right-of(C, A)", "0.1 :: right-of(C, A)"))
    assert table_of(known, "right-of(C, A)") is not None
    summed = known.explain(parse_formula("right-of(C, A)")).answer
    assert known.prob("right-of(C, A)").value == pytest.approx(summed.value, abs=1e-12)


def test_a_thousand_choices_are_no_work():
    before = ["M", *(f"X{n}" for n in range(40))]
    links = "".join(
        f"believe 0.5 :: left-of(X{n}, {before[n]}) | 0.4 :: right-of(X{n}, {before[n]}) | elsewhere.\n"
        for n in range(40)
    )
    names = ", ".join(f"X{n}" for n in range(40))
    known = qsr.parse_knowledge(
        f"static M. dynamic {names}. landmark m : M at (0 m, 0 m) facing -90 deg.\n{links}"
    )
    answer = known.prob("left-of(X39, X38)")
    assert answer.dropped == 0.0
    assert answer.value == pytest.approx(0.9**39 * known.prob("left-of(X0, M)").value, rel=1e-6)


def table_of(known, formula):
    node = parse_formula(formula)
    atoms = tuple(atoms_of(node))
    return tree_table(known.graph, objects_of(node), TruthTables(known.graph, atoms, None))


@given(questions(), st.lists(st.sampled_from(RELATIONS[:4]), min_size=1, max_size=2))
@settings(max_examples=30)
def test_several_formulas_are_told_together_as_one_by_one(question, more):
    text, formula, assumed = question
    known = qsr.parse_knowledge(HEAD + text)
    formulas = [formula, *(f"{one}(A, M)" for one in more), f"¬({formula})"]
    try:
        alone = [known.prob(one, assumed) for one in formulas]
    except qsr.ImpossibleConditionError:
        with pytest.raises(qsr.ImpossibleConditionError):
            known.prob_each(formulas, assumed)
        return
    for one, other in zip(known.prob_each(formulas, assumed), alone, strict=True):
        assert (one.formula, one.method, one.assumed) == (other.formula, other.method, other.assumed)
        assert one.value == pytest.approx(other.value, abs=1e-9)


def test_formulas_that_make_no_tree_together_are_told_one_by_one():
    known = qsr.parse_knowledge(TREE + "believe close-to(D, C). observe left-of(D, B).")
    formulas = ["left-of(A, M)", "left-of(D, C)"]
    assert known.prob_each(formulas) == tuple(known.prob(one) for one in formulas)
    assert qsr.parse_knowledge(TREE).prob_each([]) == ()
