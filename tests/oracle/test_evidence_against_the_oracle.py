"""What is seen tells of what it was placed by: fits in the axes of the map, so that every answer is exact.

A limit of 6 standard errors lets a right program fail with probability 2e-9 per normal figure; seeds are fixed.
"""

import numpy as np
import pytest
from oracle import consult

import qsrlang as qsr

HEAD = """
static M. dynamic A, B, C, P. landmark m : M at (0 m, 0 m) facing -90 deg.
observe behind-of(A, M) wrt absolute ~ normal((50 cm, 0 cm), (15 cm, 15 cm), 0).
"""
B_BY_A = "observe behind-of(B, A) wrt absolute ~ normal((0 cm, -30 cm), (10 cm, 12 cm), 0.2)."
C_BY_A = "observe behind-of(C, A) wrt absolute ~ normal((20 cm, 0 cm), (10 cm, 10 cm), 0)."
B_SEEN = "landmark b : B at (0.5 m, 0.6 m) facing 0 deg ± (1 cm, 1 cm, 1 deg)."
CASES = {
    "one thing seen": (B_BY_A + B_SEEN, "A"),
    "two things seen": (B_BY_A + B_SEEN + C_BY_A + "landmark c : C at (0 m, 0.6 m) facing 0 deg.", "A"),
    "one of two instances": (B_BY_A + B_SEEN + "landmark b2 : B at (0.3 m, 0.4 m) facing 0 deg.", "A"),
    "perhaps elsewhere": (
        "believe 0.7 :: behind-of(B, A) wrt absolute ~ normal((0 cm, -30 cm), (10 cm, 12 cm), 0.2) | elsewhere."
        + B_SEEN,
        "A",
    ),
    "seen roughly": (B_BY_A + "landmark b : B at (0.5 m, 0.6 m) facing 0 deg ± (20 cm, 20 cm, 1 deg).", "B"),
    "what is placed by what is seen": (
        B_BY_A + B_SEEN + "observe behind-of(P, B) wrt absolute ~ normal((0 cm, -30 cm), (10 cm, 12 cm), 0).",
        "P",
    ),
    "a loop": (
        B_BY_A + "observe behind-of(B, M) wrt absolute ~ normal((60 cm, -20 cm), (15 cm, 15 cm), 0)."
        "observe behind-of(A, B) wrt absolute ~ normal((0 cm, 30 cm), (10 cm, 12 cm), 0.2).",
        "A",
    ),
    "seen by its own name": (B_BY_A.replace("(B,", "(b,") + B_SEEN, "A"),
    "two hops away": (
        C_BY_A
        + "observe behind-of(B, C) wrt absolute ~ normal((0 cm, -30 cm), (10 cm, 12 cm), 0.2)."
        + B_SEEN,
        "A",
    ),
    "of what matters in one world alone": (
        B_BY_A + B_SEEN + "believe 0.5 :: behind-of(P, A) wrt absolute | 0.5 :: left-of(P, M) wrt absolute.",
        "P",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_seen_tells_of_what_it_was_placed_by(name):
    text, target = CASES[name]
    known = qsr.parse_knowledge(HEAD + text)
    true = consult(known.graph, target, count=20_000, rng=np.random.default_rng(4), points=10)
    mean, covariance = known.where(target).mixture.moments()
    weights, means = true.weights.value, true.means.value
    error = 6.0 * np.hypot(weights @ true.means.error, true.weights.error @ np.abs(means)) + 1e-3
    assert (np.abs(mean - weights @ means) <= error).all()
    spread = means - weights @ means
    xx, xy, yy = (
        weights @ true.covariances.value
        + weights @ np.array([spread[:, 0] ** 2, spread[:, 0] * spread[:, 1], spread[:, 1] ** 2]).T
    )
    np.testing.assert_allclose(covariance, [[xx, xy], [xy, yy]], rtol=0.1, atol=2e-3)
