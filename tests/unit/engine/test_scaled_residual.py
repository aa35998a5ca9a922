"""The residual without units is zero where Coulomb's law holds and only there, in any units."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records
from problems_in_blocks import random_problem

from lavendersim.engine.matrix_problem import contacts_of, coupling_of
from lavendersim.engine.scaled_residual import make_scaled_residual
from lavendersim.engine.spec import Spec

MATRIX = Spec(solver="jacobi", operator="matrix", effects=("friction",))


def residual(problem, impulses, spec=MATRIX):
    contacts = contacts_of(problem, spec, np.asarray(impulses, float))
    kernel = interpreted(make_scaled_residual(spec))
    return kernel(records(contacts), len(contacts), coupling_of(problem))


def one_contact(rng, w, impulse, mu: float):
    """Return the problem of one contact whose velocity at an impulse is w."""
    problem = random_problem(rng, 1)
    free = np.array([w]) - (problem.blocks[0] @ impulse)[None]
    return problem._replace(free=free, target=np.zeros(1), gamma=np.zeros(1), mu=np.array([mu]))


@pytest.mark.parametrize(
    ("w", "impulse"),
    [
        ((0.7, 0.2, -0.1), (0.0, 0.0, 0.0)),  # it parts
        ((0.0, 0.0, 0.0), (2.0, 0.6, -0.5)),  # it sticks, within 0.5 of the normal
        ((0.0, 0.3, -0.4), (2.0, -0.6, 0.8)),  # it slides against its friction
    ],
)
def test_a_contact_that_has_its_law_has_no_residual(w, impulse, rng) -> None:
    problem = one_contact(rng, np.array(w), np.array(impulse), 0.5)
    assert residual(problem, [impulse])[0] == pytest.approx(0.0, abs=1e-14)
    for k in range(3):
        off = np.array(impulse)
        off[k] += 0.1
        assert residual(problem, [off])[0] > 1e-3


def test_the_convex_relaxation_asks_another_velocity_of_what_slides(rng) -> None:
    """It is lifted by mu |w_t|: so the residual is zero at w_n = mu |w_t|, and not at 0."""
    impulse, convex = np.array([2.0, -0.6, 0.8]), MATRIX._replace(friction_cone="convex")
    for w_n, solved in ((0.25, True), (0.0, False)):
        problem = one_contact(rng, np.array([w_n, 0.3, -0.4]), impulse, 0.5)
        assert (residual(problem, [impulse], convex)[0] < 1e-14) is solved


def test_units_do_not_count_and_the_worst_contact_is_named(rng) -> None:
    """Impulses in other units: W by s, velocities by t, r by t/s."""
    problem, impulses = random_problem(rng, 5), rng.normal(size=(5, 3))
    first = residual(problem, impulses)
    s, t = 1e3, 1e-4
    other = problem._replace(
        blocks=problem.blocks * s, gamma=problem.gamma * s, free=problem.free * t,
        target=problem.target * t,
    )  # fmt: skip
    assert residual(other, impulses * t / s)[0] == pytest.approx(first[0], rel=1e-12)
    impulses[3, 0] = 1e3
    assert residual(problem, impulses)[1] == 3
    impulses[1, 0] = np.nan
    value, worst = residual(problem, impulses)
    assert np.isnan(value)
    assert worst in (0, 1, 2)  # the first that the NaN reaches
