"""Views asked for in the language, on the map of a scenario."""

import pytest

import qsrlang as qsr

CUPS = qsr.load("kitchen/cups")


@pytest.fixture(scope="module")
def asked():
    return qsr.ask_views(CUPS, "views Cup?", "kitchen")


def test_views_are_ranked_best_first_and_where_the_robot_can_stand(asked):
    assert asked.target == "Cup"
    values = [view.value for view in asked.views]
    assert values == sorted(values, reverse=True)
    assert all(0.0 < view.gain <= 1.0 and view.seconds > 0.0 for view in asked.views)
    assert asked.to_json()["planner"] == "rollout"


def test_what_is_given_and_what_landmarks_say_changes_the_views(asked):
    given = qsr.ask_views(CUPS, "views Cup given left-of(Cup, Sink) ∧ close-to(Cup, Sink)?", "kitchen")
    assert given.views[0].gain > asked.views[0].gain, "all of it is at the sink"
    assert given.views[0].pose.y < 6.5, "the sink is in the south"


def test_other_queries_and_unknown_names_are_refused():
    with pytest.raises(qsr.ValueRangeError, match="expected one such as 'views Cup"):
        qsr.ask_views(CUPS, "where Cup?", "kitchen")
    with pytest.raises(qsr.UnknownNameError, match="did you mean 'Cup'"):
        qsr.ask_views(CUPS, "views Cupp?", "kitchen")
    with pytest.raises(qsr.UnknownNameError, match="scenario"):
        qsr.ask_views(CUPS, "views Cup?", "kitchn")
