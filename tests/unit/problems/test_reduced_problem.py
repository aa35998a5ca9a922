"""From bodies' velocities to contacts alone: the same problem, whatever M is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gauss_seidel import dense
from made_problems import random_bodies
from scipy import sparse

from lavendersim.errors import ProblemError
from lavendersim.problems import reduced_problem
from lavendersim.problems.reduced_problem import reduce_to_contacts

HERE = Path("bodies")


def reduce(bodies, **changes):
    mass, directions, f, w, mu = bodies._replace(**changes)
    return reduce_to_contacts(
        HERE, sparse.coo_matrix(mass), sparse.coo_matrix(directions), f, w, mu
    )


def test_contact_velocities_are_those_of_the_bodies() -> None:
    bodies = random_bodies(11)
    matrix, q = dense(reduce(bodies))
    r = np.random.default_rng(4).normal(size=len(q))
    v = np.linalg.solve(bodies.mass, bodies.directions @ r + bodies.f)
    u = bodies.directions.T @ v + bodies.w
    # n eps cond(M) of two factorisations, n = 24, cond(M) < 100.
    assert np.linalg.cond(bodies.mass) < 100.0
    assert np.abs(matrix @ r + q - u).max() <= 24 * 100 * 2 * np.finfo(float).eps * np.abs(u).max()


def test_a_mass_matrix_that_is_not_symmetric_stays_so() -> None:
    bodies = random_bodies(12)
    skew = bodies.mass + np.triu(0.1 * bodies.mass, 1)
    matrix, q = dense(reduce(bodies, mass=skew))
    expected = bodies.directions.T @ np.linalg.solve(skew, bodies.directions)
    expected_q = bodies.w + bodies.directions.T @ np.linalg.solve(skew, bodies.f)
    assert np.abs(matrix - matrix.T).max() > 0.01 * np.abs(matrix).max()
    # As above; n eps cond(M) of two factorisations.
    bound = 24 * np.linalg.cond(skew) * 2 * np.finfo(float).eps
    assert bound < 1e-11
    assert np.abs(matrix - expected).max() <= bound * np.abs(expected).max()
    assert np.abs(q - expected_q).max() <= bound * np.abs(expected_q).max()


def test_contacts_without_a_common_body_have_no_block() -> None:
    bodies = random_bodies(13, bodies=2, contacts=2)
    apart = bodies.directions.copy()
    apart[6:, :3] = 0.0
    apart[:6, 3:] = 0.0
    apart[6:, 3:] = 1.0
    problem = reduce(bodies, directions=apart)
    assert list(problem.row) == [0, 1]
    assert list(problem.begin) == [0, 1, 2]


def test_the_number_of_columns_at_a_time_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    bodies = random_bodies(14)
    whole = reduce(bodies)
    monkeypatch.setattr(reduced_problem, "BATCH", 4)
    parts = reduce(bodies)
    for one, other in zip(whole, parts, strict=True):
        assert np.allclose(one, other, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"mass": np.zeros((24, 24))}, "singular"),
        ({"mass": np.ones((24, 24))}, "singular"),
        ({"mass": np.eye(24)[:, :20]}, "a square M, it is 24 by 20"),
        ({"directions": np.ones((20, 15))}, "H with 24 rows as M and 15 columns"),
    ],
)
def test_what_cannot_be_reduced_is_refused(changes: dict, sentence: str) -> None:
    with pytest.raises(ProblemError, match=sentence):
        reduce(random_bodies(15), **changes)
