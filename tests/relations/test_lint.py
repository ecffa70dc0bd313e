import math

import pytest

from qsrlang.language.codes import CODES
from qsrlang.language.diagnostics import Severity
from qsrlang.language.fixing import edited
from qsrlang.language.parser import parse
from qsrlang.language.source import Source, read_source
from qsrlang.relations.build import build_graph
from qsrlang.relations.graph import Landmark
from qsrlang.relations.imports import find_knowledge, shipped_knowledge
from qsrlang.relations.imports import read_source as read_shipped
from qsrlang.relations.linting.lint import RULES, lint

DECLARED = "dynamic Cup, Plate, Spoon.\nstatic Armchair { front: yes }, Desk.\n"


def findings(text, path=None, viewer=None, landmarks=()):
    source = Source("<text>", text, path)
    built = build_graph(source)
    return lint(built, source, viewer, landmarks)


def found(text, path=None):
    return [(one.code, one.span.text) for one in findings(text, path) if one.code != "Q503"]


def mended(text, path=None):
    """The text with the edits of its only finding made."""
    (finding,) = findings(text, path)
    assert finding.edits
    return edited(text, finding.edits)


def claims(*statements):
    return DECLARED + "\n".join(statements)


def test_every_rule_has_a_documented_code_of_its_own():
    codes = [rule.code for rule in RULES]
    assert codes == sorted(set(codes))
    assert set(codes) <= set(CODES)
    assert all(rule.reason and rule.find.__doc__ for rule in RULES)


WRONG = {
    "Q503": "dynamic Cup, Plate, Spoon.\nobserve left-of(Cup, Plate).",
    "Q504": "dynamic Cup, Plate.\nbelieve 0.6 :: left-of(Cup, Plate) | 0.3 :: right-of(Cup, Plate).",
    "Q505": "dynamic Cup, Plate.\nobserve 0 × left-of(Cup, Plate).",
    "Q506": "dynamic Cup, Plate.\nobserve left-of(Cup, Plate) ∧ right-of(Plate, Cup).",
    "Q507": "dynamic Cup.\nstatic Armchair { front: yes }.\nobserve left-of(Cup, Armchair).",
    "Q508": 'import "office/desk".\ndynamic Pen, Ruler.\nobserve left-of(Pen, Ruler).',
    "Q509": "dynamic Cup, Plate.\nin weekday, weekend { believe left-of(Cup, Plate). }",
    "Q510": "dynamic Cup, Plate.\nobserve left-of(Cup, Plate) ∨ right-of(Cup, Plate).",
    "Q511": "dynamic cup, Plate.\nobserve left-of(cup, Plate).",
}


@pytest.mark.parametrize("code", WRONG)
def test_a_finding_says_what_where_why_and_what_would_help(code):
    (finding,) = findings(WRONG[code])
    assert finding.code == code
    assert finding.severity is Severity.WARNING
    assert finding.message and finding.note and finding.help
    assert finding.render().startswith(f"warning[{code}]: ")


@pytest.mark.parametrize("code", WRONG)
def test_a_comment_silences_a_finding(code):
    (finding,) = findings(WRONG[code])
    lines = WRONG[code].splitlines()
    behind = [*lines]
    behind[finding.span.line - 1] += f"  # allow {code}"
    before = [*lines]
    before.insert(finding.span.line - 1, f"# allow Q101, {code}")
    assert findings("\n".join(behind)) == findings("\n".join(before)) == ()


@pytest.mark.parametrize("code", sorted(set(WRONG) - {"Q503", "Q509"}))
def test_the_edits_mend_what_was_found_and_nothing_else_comes_of_it(code):
    text = mended(WRONG[code])
    assert parse(text).diagnostics == ()
    assert code not in {one.code for one in findings(text)}
    assert not any(one.is_error for one in build_graph(Source("<text>", text)).diagnostics)


MENDED = {
    "Q504": "dynamic Cup, Plate.\nbelieve 0.6 :: left-of(Cup, Plate) | 0.3 :: right-of(Cup, Plate) | elsewhere.",
    "Q505": "dynamic Cup, Plate.\n",
    "Q506": "dynamic Cup, Plate.\nobserve left-of(Cup, Plate).",
    "Q507": "dynamic Cup.\nstatic Armchair { front: yes }.\nobserve left-of(Cup, Armchair) wrt relative.",
    "Q508": "dynamic Pen, Ruler.\nobserve left-of(Pen, Ruler).",
    "Q510": "dynamic Cup, Plate.\nbelieve left-of(Cup, Plate) | right-of(Cup, Plate).",
    "Q511": "dynamic Cup, Plate.\nobserve left-of(Cup, Plate).",
}


@pytest.mark.parametrize("code", MENDED)
def test_what_the_edits_make(code):
    assert mended(WRONG[code]) == MENDED[code]


@pytest.mark.parametrize("name", shipped_knowledge())
def test_shipped_knowledge_is_clean(name):
    source = read_shipped(find_knowledge(name))
    assert [one.render() for one in lint(build_graph(source), source)] == []


def test_findings_come_in_the_order_of_the_text_and_only_of_the_file_itself(tmp_path):
    (tmp_path / "other.qsr").write_text("dynamic saucer.\nobserve 0 × left-of(saucer, Cup).")
    text = 'import "other.qsr".\ndynamic Cup, spoon.\nobserve 0 × on(Cup, saucer).\nobserve on(spoon, Cup).'
    assert [one.code for one in findings(text, tmp_path / "a.qsr")] == ["Q511", "Q505"]


# Q503


def test_a_class_is_placed_by_an_atom_in_any_place_a_landmark_or_a_role():
    declared = "static Desk.\ndynamic A, B, C, D, E.\n"
    text = "landmark a : A at (0 m, 0 m).\nscene(one: B, Desk) ⇔ on(one, Desk).\nin weekday { believe on(C, D). }"
    assert [one.span.text for one in findings(declared + text)] == ["E"]


def test_a_file_that_places_nothing_only_declares_for_others():
    assert findings("dynamic Cup, Plate.\nstatic Desk.") == ()


def test_nothing_seems_to_be_missing_from_a_file_with_errors():
    assert (
        findings('import "office/desk".\ndynamic Cap.\nobserve on(Cap Desk).\nobserve on(Pen, Desk).') == ()
    )


# Q504 and Q505


@pytest.mark.parametrize(
    "believe",
    [
        "believe 0.6 :: on(Cup, Desk) | 0.4 :: on(Cup, Plate).",
        "believe 0.6 :: on(Cup, Desk) | 0.1 :: elsewhere.",
        "believe on(Cup, Desk) | on(Cup, Plate).",
        "believe 10 % :: on(Cup, Desk) | 20 % :: on(Cup, Plate) | 70 % :: on(Cup, Armchair).",
    ],
)
def test_shares_that_sum_to_one_or_name_the_rest_are_complete(believe):
    assert found(claims(believe)) == []


def test_elsewhere_goes_behind_the_last_parenthesis():
    text = "dynamic Cup, Plate.\nbelieve 0.6 :: (on(Cup, Plate) ∧ close-to(Cup, Plate))."
    assert mended(text).endswith("(on(Cup, Plate) ∧ close-to(Cup, Plate)) | elsewhere.")


def test_an_alternative_of_weight_0_goes_with_its_sign():
    believe = "believe {} :: left-of(Cup, Plate) | {} :: right-of(Cup, Plate) | elsewhere."
    for shares, rest in {(0, 1): "1 :: right-of(Cup, Plate)", (1, 0): "1 :: left-of(Cup, Plate)"}.items():
        text = "dynamic Cup, Plate.\n" + believe.format(*shares)
        assert mended(text) == f"dynamic Cup, Plate.\nbelieve {rest} | elsewhere."


def test_a_requirement_of_weight_0_is_a_negation():
    text = "dynamic Cup, Plate.\nrequire 0 :: ¬left-of(Cup, Plate)."
    assert mended(text) == "dynamic Cup, Plate.\nrequire left-of(Cup, Plate)."


def test_no_edit_deletes_a_comment():
    (finding,) = findings("dynamic Cup, Plate.\nobserve 0 × # never\n left-of(Cup, Plate).")
    assert (finding.code, finding.edits) == ("Q505", ())


# Q506


@pytest.mark.parametrize(
    ("formula", "implied"),
    [
        ("on(Cup, Desk) ∧ on(Cup, Desk)", ["on(Cup, Desk)"]),
        ("left-of(Cup, Plate) ∧ right-of(Plate, Cup)", ["right-of(Plate, Cup)"]),
        (
            "left-of(Cup, Plate) wrt absolute ∧ right-of(Plate, Cup) wrt absolute",
            ["right-of(Plate, Cup) wrt absolute"],
        ),
        ("left-of(Cup, Plate) wrt absolute ∧ right-of(Plate, Cup)", []),
        ("left-of(Cup, Plate) ∧ right-of(Cup, Plate)", []),
        ("left-of(Cup, Plate) ∧ left-of(Plate, Cup)", []),
        ("between(Cup, Plate, Desk) ∧ between(Cup, Desk, Plate)", ["between(Cup, Desk, Plate)"]),
        ("between(Cup, Plate, Desk) ∧ between(Plate, Cup, Desk)", []),
        ("near(Cup, Plate) ∧ near(Plate, Cup)", ["near(Plate, Cup)"]),
    ],
)
def test_an_atom_is_implied_by_itself_its_converse_and_by_symmetry(formula, implied):
    near = "relation near(referent, relatum) { distance: uniform(0 cm, 30 cm), symmetric: yes }."
    assert found(claims(near, f"observe {formula}.")) == [("Q506", text) for text in implied]


@pytest.mark.parametrize(
    ("formula", "implied"),
    [
        ("left-of(Cup, Plate) ∧ left-of(Plate, Spoon) ∧ left-of(Cup, Spoon)", ["left-of(Cup, Spoon)"]),
        ("left-of(Cup, Spoon) ∧ left-of(Plate, Spoon) ∧ left-of(Cup, Plate)", ["left-of(Cup, Spoon)"]),
        ("left-of(Cup, Plate) ∧ right-of(Spoon, Plate) ∧ right-of(Spoon, Cup)", ["right-of(Spoon, Cup)"]),
        ("left-of(Cup, Plate) ∧ behind-of(Plate, Spoon) ∧ left-of(Cup, Spoon)", []),
        ("left-of(Cup, Plate) ∧ left-of(Plate, Spoon) ∧ left-of(Cup, Spoon) wrt absolute", []),
        ("left-of(Cup, Plate) ∧ left-of(Plate, Spoon) ∧ left-of(Spoon, Cup)", []),
        ("left-of(Cup, Plate) ∧ left-of(Plate, Spoon) ∧ close-to(Cup, Spoon)", []),
    ],
)
def test_a_direction_is_implied_by_a_chain_of_others_in_its_frame(formula, implied):
    assert found(claims(f"observe {formula}.")) == [("Q506", text) for text in implied]


def test_a_chain_must_lead_there_in_both_orders_and_all_of_it_is_shown():
    square = "left-of(Cup, A) ∧ behind-of(A, Plate) ∧ behind-of(Cup, B) ∧ left-of(B, Plate)"
    declared = "dynamic Cup, Plate, A, B.\n"
    sides = findings(f"{declared}observe {square} ∧ left-of(Cup, Plate).")
    assert [one.span.text for one in sides if one.code == "Q506"] == []
    row = "left-of(Cup, A) ∧ left-of(A, B) ∧ left-of(B, Plate) ∧ left-of(Cup, Plate)"
    (finding,) = findings(f"{declared}observe {row}.")
    assert [label.span.text for label in finding.labels] == row.split(" ∧ ")[:3]
    assert edited(f"{declared}observe {row}.", finding.edits).endswith("left-of(B, Plate).")


def test_an_implied_atom_is_shown_beside_the_other():
    (finding,) = findings("scene(one: Cup, two: Cup) ⇔ left-of(one: Cup, two) ∧ left-of(one, two: Cup).")
    assert [label.span.text for label in finding.labels] == ["left-of(one: Cup, two)"]


def test_an_implied_atom_in_parentheses_goes_with_them_and_else_stays():
    text = "dynamic Cup, Plate.\nobserve on(Cup, Plate) ∧ {}."
    assert mended(text.format("(on(Cup, Plate))")) == text.format("X").replace(" ∧ X", "")
    (finding,) = findings(text.format("(on(Cup, Plate) ∧ close-to(Cup, Plate))"))
    assert finding.edits == ()


# Q507


@pytest.mark.parametrize(
    ("field", "is_ambiguous"),
    [
        ("normal(0 deg, 10 deg)", False),
        ("normal(180 deg, 10 deg)", False),
        ("normal(-180 deg, 10 deg)", False),
        ("normal(90 deg, 10 deg)", True),
        ("normal(3 rad, 10 deg)", True),
        ("uniform(-30 deg, 30 deg)", False),
        ("uniform(150 deg, 210 deg)", False),
        ("uniform(0 deg, 30 deg)", True),
        ("uniform(10 deg, 370 deg)", False),
        ("mix(normal(90 deg, 15 deg), normal(-90 deg, 15 deg))", False),
        ("mix(normal(90 deg, 15 deg), normal(-90 deg, 5 deg))", True),
        ("mix(normal(90 deg, 15 deg), normal(0 deg, 15 deg))", True),
        ("any", False),
    ],
)
def test_a_frame_is_ambiguous_where_left_and_right_are_told_apart(field, is_ambiguous):
    relation = f"relation beside(referent, relatum) {{ angle: {field} }}."
    atom = "beside(Cup, Armchair)"
    assert found(claims(relation, f"observe {atom}.")) == [("Q507", atom)] * is_ambiguous


@pytest.mark.parametrize(
    "atom",
    [
        "left-of(Cup, Desk)",
        "left-of(Armchair, Cup)",
        "left-of(Cup, Armchair) wrt relative",
        "left-of(Cup, Armchair) wrt absolute",
        "behind-of(Cup, Armchair)",
        "close-to(Cup, Armchair)",
        "between(Cup, Armchair, Desk)",
    ],
)
def test_a_frame_is_clear_without_a_front_or_with_wrt(atom):
    assert found(claims(f"observe {atom}.")) == []


def test_a_landmark_and_a_role_have_the_front_of_their_class():
    landmark = "landmark old : Armchair at (0 m, 0 m)."
    scene = "scene(mine: Armchair, Cup) ⇔ right-of(Cup, mine)."
    assert found(claims(landmark, "observe left-of(Cup, old).", scene)) == [
        ("Q507", "left-of(Cup, old)"),
        ("Q507", "right-of(Cup, mine)"),
    ]


# Q514

CHAIR = "landmark old : Armchair at (1 m, 1 m) facing 0 deg.\n"


@pytest.mark.parametrize(
    ("atom", "degrees", "apart"),
    [
        ("behind-of(Cup, Armchair)", 0, None),
        ("behind-of(Cup, Armchair)", 44, None),
        ("behind-of(Cup, Armchair)", 46, 46),
        ("in-front-of(Cup, old)", 180, 180),
        ("left-of(Cup, Armchair)", 0, 180),
        ("left-of(Cup, Armchair)", 180, None),
        ("left-of(Cup, Armchair)", 200, None),
        ("left-of(Cup, Armchair) wrt relative", 0, None),
        ("left-of(Cup, Armchair) wrt intrinsic", 0, None),
        ("left-of(Cup, Desk)", 0, None),
        ("close-to(Cup, Armchair)", 90, None),
        ("beside(Cup, Armchair)", 0, None),
        ("beside(Cup, Armchair)", 90, 90),
    ],
)
def test_a_viewer_who_goes_round_a_thing_sees_other_sides_than_its_own(atom, degrees, apart):
    beside = "relation beside(a, b) { angle: mix(normal(90 deg, 15 deg), normal(-90 deg, 15 deg)) }.\n"
    angle = math.radians(degrees)
    viewer = (1.0 + 2.0 * math.cos(angle), 1.0 + 2.0 * math.sin(angle))
    told = [
        one
        for one in findings(claims(CHAIR, beside, f"observe {atom}."), viewer=viewer)
        if one.code != "Q503"
    ]
    assert [one.code for one in told] == ([] if apart is None else ["Q514"])
    assert all(f"{apart} deg off" in one.message for one in told)


def test_a_side_that_the_viewer_does_not_see_is_told_in_both_readings_with_an_edit():
    text = claims(CHAIR, "observe left-of(Cup, Armchair).")
    (finding,) = (one for one in findings(text, viewer=(4.0, 1.0)) if one.code == "Q514")
    assert finding.note == "for the viewer at -90 deg, by its front at 90 deg on the map"
    assert "'wrt relative'" in finding.help and "'wrt intrinsic'" in finding.help
    assert [label.span.text for label in finding.labels] == ["old"]
    mended_text = edited(text, finding.edits)
    assert {one.code for one in findings(mended_text, viewer=(4.0, 1.0))} == {"Q503"}


def test_without_a_viewer_or_a_heading_the_frame_stays_ambiguous():
    statement = "observe left-of(Cup, Armchair)."
    assert found(claims(CHAIR, statement)) == [("Q507", "left-of(Cup, Armchair)")]
    headless = claims("landmark old : Armchair at (1 m, 1 m).", statement)
    assert "Q507" in [one.code for one in findings(headless, viewer=(4.0, 1.0))]
    further = (Landmark("new", "Armchair", 0.0, 0.0, None, 0.0),)
    codes = [one.code for one in findings(claims(statement), viewer=(4.0, 0.0), landmarks=further)]
    assert "Q514" in codes and "Q507" not in codes


# Q508


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "things.qsr").write_text("dynamic Pen, Ruler.\nscene drawing(Pen, Ruler) ⇔ on(Pen, Ruler).")
    (tmp_path / "more.qsr").write_text('import "things.qsr".\nstatic Easel.')
    (tmp_path / "numbers.qsr").write_text("defaults { reach: 2 m }.")
    (tmp_path / "about.qsr").write_text('import "main.qsr".\nobserve left-of(Cup, Plate).')
    return tmp_path


OWN = "dynamic Cup, Plate.\nobserve on(Cup, Plate).\n"


@pytest.mark.parametrize(
    ("text", "unused"),
    [
        ('import "things.qsr".\nobserve left-of(Pen, Ruler).', []),
        ('import "things.qsr".\nobserve drawing.', []),
        ('import "more.qsr".\nobserve left-of(Pen, Ruler).', []),
        ('import "more.qsr".\n' + OWN, ['import "more.qsr"']),
        ('import "things.qsr" as lab.\nobserve left-of(lab.Pen, lab.Ruler).', []),
        ('import "things.qsr" as lab.\n' + OWN, ['import "things.qsr" as lab']),
        ('import "numbers.qsr".\n' + OWN, []),
        ('import "about.qsr".\n' + OWN, []),
        ('import "main.qsr".\n' + OWN, ['import "main.qsr"']),
        ('language 1.\nimport "things.qsr".\nimport "more.qsr".\ndefaults { reach: 1 m }.', []),
    ],
)
def test_an_import_is_used_where_it_shares_a_name_with_the_file(text, unused, folder):
    path = folder / "main.qsr"
    path.write_text(text)
    source = read_source(path)
    assert [one.span.text for one in lint(build_graph(source), source)] == unused


# Q509


@pytest.mark.parametrize(
    ("conditions", "rivals"),
    [
        ("weekday, weekend", ("weekday", "weekend")),
        ("room a, weekday, room b", ("room a", "room b")),
        ("from 08:00 to 12:00, from 12:00 to 13:00", ("from 08:00 to 12:00", "from 12:00 to 13:00")),
        ("from 22:00 to 06:00, from 05:00 to 07:00", None),
        ("room a, room a, weekday", None),
    ],
)
def test_a_context_never_matches_where_its_conditions_exclude_each_other(conditions, rivals):
    finding = [*findings(f"{DECLARED}in {conditions} {{ believe left-of(Cup, Plate). }}")]
    shown = [(one.labels[0].span.text, one.span.text) for one in finding if one.code == "Q509"]
    assert shown == ([rivals] if rivals else [])


# Q510


@pytest.mark.parametrize(
    ("statement", "count"),
    [
        ("observe left-of(Cup, Plate) ∨ right-of(Cup, Plate) ∧ close-to(Cup, Plate).", 1),
        ("observe (left-of(Cup, Plate) ∨ right-of(Cup, Plate)) ∧ on(Cup, Desk).", 1),
        ("scene(Cup, Plate) ⇔ left-of(Cup, Plate) ∨ right-of(Cup, Plate).", 1),
        ("require left-of(Cup, Plate) ∨ right-of(Cup, Plate).", 0),
        ("require left-of(Cup, Plate) ∨ close-to(Cup, Plate).", 0),
        ("believe left-of(Cup, Plate) ∨ right-of(Cup, Plate).", 0),
        ("observe left-of(Cup, Plate) ∨ on(Cup, Desk).", 0),
        ("observe ¬left-of(Cup, Plate) ∨ close-to(Cup, Plate).", 0),
        ("observe ¬(left-of(Cup, Plate) ∨ right-of(Cup, Plate)).", 0),
    ],
)
def test_a_disjunction_on_one_pair_looks_like_a_belief(statement, count):
    assert [code for code, _ in found(claims(statement))] == ["Q510"] * count


def test_only_a_bare_observation_of_a_disjunction_becomes_a_belief():
    text = (
        "dynamic Cup, Plate.\nobserve {}left-of(Cup, Plate) ∨ (right-of(Cup, Plate) ∧ close-to(Cup, Plate))."
    )
    belief = "believe left-of(Cup, Plate) | right-of(Cup, Plate) ∧ close-to(Cup, Plate)."
    assert mended(text.format("")) == f"dynamic Cup, Plate.\n{belief}"
    (finding,) = findings(text.format("3 × "))
    assert finding.edits == ()


# Q511


def test_scripts_without_capitals_are_left_alone():
    assert findings("dynamic 杯子, كوب, ⴰ, კათხა, _cup, Äpfel.") == ()
    assert [one.span.text for one in findings("dynamic äpfel, чашка, Plate.")] == ["äpfel", "чашка"]


def test_a_class_is_renamed_wherever_it_is_written_unless_the_name_is_taken():
    text = "static desk.\ndynamic Cup { on: table }.\nsurface table.\nlandmark d : desk at (0 m, 0 m)."
    desk, table, *_ = (one for one in findings(text) if one.code == "Q511")
    renamed = text.replace("desk", "Desk").replace("table", "Table")
    assert edited(text, [*desk.edits, *table.edits]) == renamed
    assert findings("dynamic cup, Cup.")[0].edits == ()


def test_a_class_that_no_statement_declares_is_judged_where_a_scene_brings_it_in():
    assert [one.span.text for one in findings("scene(cup, Plate) ⇔ left-of(cup, Plate).")] == ["cup"]
