"""Problems of extreme numbers end with a status that their residual bears out, and no warning."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from made_problems import random_problem

from lavendersim.engine.contact_problem import SOLVED, ContactProblem
from lavendersim.problems.comparison import compare

# Where formulas turn: the ends of the doubles, of their squares and of their cubes.
TURNS = (5e-324, 1e-308, 1e-200, 1e-162, 1e-108, 1e-16, 0.0, 1e16, 1e103, 1e154, 1e200, 1.7e308)
SOLVERS = ("auto", "interior_point", "projected_gauss_seidel", "semismooth_newton", "jacobi")
SWEEPS = 100
TOLERANCE = 1e-8


def extreme(seed: int) -> ContactProblem:
    """Return a problem with one number, or one of its parts, as small or large as numbers get."""
    draw = np.random.default_rng(seed)
    problem = random_problem(seed, contacts=3)
    name = str(draw.choice(["blocks", "free", "mu", "gamma", "target"]))
    part, turn = getattr(problem, name).copy(), float(draw.choice(TURNS))
    if draw.random() < 0.5:
        part *= turn / max(1.0, np.abs(part).max())  # of any size, and no more than there are
    else:
        part.flat[draw.integers(part.size)] = turn
    return problem._replace(**{name: part})


@pytest.mark.parametrize("seed", range(60))
def test_a_problem_of_extreme_numbers_ends_with_a_status_and_no_warning(seed: int) -> None:
    problem, solver = extreme(seed), SOLVERS[seed % len(SOLVERS)]
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        (found,) = compare([("it", problem)], [solver], TOLERANCE, SWEEPS, referenced=seed % 8 == 0)
    (attempt,) = found.attempts
    assert (attempt.status == SOLVED) == (attempt.residual.scaled <= TOLERANCE)
