"""How much the place of a landmark tells of a target."""

import math

import pytest

import qsrlang as qsr

TEXT = """
static Monitor {{ front: yes }}. dynamic Keyboard, Cup.
landmark m : Monitor at (0 m, 0 m) facing -90 deg.
believe {share} :: in-front-of(Keyboard, Monitor).
believe {other} :: right-of(Cup, Keyboard).
"""


def told(share=1, other=1, target="Cup"):
    ranking = qsr.parse_knowledge(TEXT.format(share=share, other=other)).rank_landmarks(target)
    return {one.name: one for one in ranking.landmarks}


@pytest.mark.parametrize("share", [1, 0.7])
def test_a_landmark_whose_place_is_certain_tells_nothing_more(share):
    """Also where the target may be elsewhere."""
    for target in ("Cup", "Keyboard"):
        monitor = told(share, share, target)["Monitor"]
        assert monitor.information == pytest.approx(0.0, abs=1e-9)
        assert monitor.standard_error == pytest.approx(0.0, abs=1e-9)


def test_what_is_elsewhere_takes_its_share_of_what_is_told():
    """I(L; O) = P(there) I(L; O | there), where whether the target is there does not depend on the landmark."""
    whole, some = told()["Keyboard"], told(other=0.7)["Keyboard"]
    error = math.hypot(0.7 * whole.standard_error, some.standard_error)
    assert some.information == pytest.approx(0.7 * whole.information, abs=5.0 * error)
    assert some.information > 0.3


def test_that_the_landmark_is_elsewhere_tells_that_the_target_is():
    """Whether both are there is H(0.7) bits, and where they are is told in 0.7 of the worlds."""
    whole, some = told()["Keyboard"], told(share=0.7)["Keyboard"]
    choice = -0.7 * math.log2(0.7) - 0.3 * math.log2(0.3)
    error = math.hypot(0.7 * whole.standard_error, some.standard_error)
    assert some.information == pytest.approx(choice + 0.7 * whole.information, abs=5.0 * error)
