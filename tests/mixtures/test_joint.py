import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from qsrlang.mixtures.joint import JointGaussian, semidefinite_root


@given(arrays(np.float64, (5, 3), elements=st.floats(-2.0, 2.0)))
def test_the_root_of_a_singular_matrix_squares_to_it(factor):
    matrix = factor @ factor.T
    root = semidefinite_root(matrix)
    np.testing.assert_allclose(root @ root.T, matrix, atol=1e-5)


def test_a_linear_conditional_is_propagated_exactly():
    slope = np.array([[0.5, 0.2, 0.0], [0.0, 1.0, -0.3]])
    start = np.diag([0.04, 0.09, 0.01])
    joint = JointGaussian.empty(0.3).with_block("m", np.array([1.0, 2.0, 0.5]), start)
    joint = joint.with_conditional(
        "x", lambda states: (states @ slope.T, np.tile(0.1 * np.eye(2), (len(states), 1, 1)))
    )
    mean, covariance = joint.marginal("x")
    np.testing.assert_allclose(mean, slope @ [1.0, 2.0, 0.5])
    np.testing.assert_allclose(covariance, slope @ start @ slope.T + 0.1 * np.eye(2), atol=1e-12)


def test_a_second_source_is_fused_as_two_measurements_are():
    joint = JointGaussian.empty(0.0).with_block("m", np.zeros(3), np.zeros((3, 3)))

    def says(x, variance):
        return lambda states: (
            np.tile(x, (len(states), 1)),
            np.tile(variance * np.eye(2), (len(states), 1, 1)),
        )

    joint = joint.with_conditional("x", says([0.0, 0.0], 1.0))
    joint, evidence = joint.observed("x", says([3.0, 0.0], 0.5))
    mean, covariance = joint.marginal("x")
    np.testing.assert_allclose(mean, [2.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(covariance, np.eye(2) / 3.0, atol=1e-12)
    assert evidence == pytest.approx(-0.5 * 9.0 / 1.5 - np.log(2.0 * np.pi * 1.5))
