"""The residual says the same of one problem however it is written down.

Contacts numbered otherwise, tangents turned about their normals, other units of length, mass and
time: the same contacts, so the same residual but for round-off. One row of c r - P_K(c r - uh) is
made of sums of at most 3 n terms; turning tangents adds three products on either side of W. Hence
    | change |  <=  (3 n + 12) eps * |c r| + |abs(W) abs(r)| + |q|,   over |q|
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gauss_seidel import dense
from made_problems import outside, random_problem
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.problems.matrices import matrix_of, problem_of
from lavendersim.problems.read import read_problem
from lavendersim.problems.residual import own_scales, residual

EPS = np.finfo(float).eps
Pair = tuple[ContactProblem, np.ndarray]


def some_impulses(problem: ContactProblem) -> np.ndarray:
    """Return impulses of the problem's own size, in, on and outside of their cones."""
    rng = np.random.default_rng(31)
    scale = np.linalg.norm(problem.free, axis=1).mean() / own_scales(problem).mean()
    impulses: np.ndarray = scale * rng.normal(size=(problem.contacts, 3))
    impulses[::3, 0] = np.abs(impulses[::3, 0])
    impulses[1::5] = 0.0
    return impulses


def transformed(problem: ContactProblem, impulses: np.ndarray, turn: np.ndarray) -> Pair:
    """Return T W T', T q, T r for an orthogonal T whose contacts are permuted or turned."""
    matrix = sparse.csc_matrix(turn) @ matrix_of(problem) @ sparse.csc_matrix(turn).T
    q = turn @ problem.q.ravel()
    # Which old contact a new one is, seen by its normal row.
    old = np.argmax(np.abs(turn[::3, ::3]), axis=1)
    copy = problem_of(matrix, q, problem.mu[old])
    return copy, (turn @ impulses.ravel()).reshape(-1, 3)


def permuted(problem: ContactProblem, impulses: np.ndarray) -> Pair:
    order = np.random.default_rng(32).permutation(problem.contacts)
    return transformed(problem, impulses, np.kron(np.eye(problem.contacts)[order], np.eye(3)))


def turned(problem: ContactProblem, impulses: np.ndarray) -> Pair:
    angles = np.random.default_rng(33).uniform(0.0, 2.0 * np.pi, problem.contacts)
    turn = np.eye(3 * problem.contacts)
    for contact, angle in enumerate(angles):
        c, s = np.cos(angle), np.sin(angle)
        rows = slice(3 * contact + 1, 3 * contact + 3)
        turn[rows, rows] = [[c, s], [s, -c]] if contact % 2 else [[c, -s], [s, c]]
    return transformed(problem, impulses, turn)


def in_other_units(length: float, mass: float, time: float):
    """W [1/kg], velocities [m/s] and impulses [kg m/s] of the same contacts."""

    def change(problem: ContactProblem, impulses: np.ndarray) -> Pair:
        speed = length / time
        copy = problem._replace(
            blocks=problem.blocks / mass,
            gamma=problem.gamma / mass,
            free=problem.free * speed,
            target=problem.target * speed,
        )
        return copy, impulses * mass * speed

    return change


CHANGES = {
    "permuted": permuted,
    "tangents turned": turned,
    "millimetres": in_other_units(1e3, 1.0, 1.0),
    "tonnes": in_other_units(1.0, 1e-3, 1.0),
    "hours": in_other_units(1.0, 1.0, 1.0 / 3600.0),
    "atoms": in_other_units(1e10, 6.02e26, 1e15),
}


def check(problem: ContactProblem, change) -> None:
    for impulses in (some_impulses(problem), np.zeros((problem.contacts, 3))):
        before = residual(problem, impulses)
        after = residual(*change(problem, impulses))
        matrix, q = dense(problem)
        r = impulses.ravel()
        c = np.abs(np.diag(matrix)).max()
        size = c * np.linalg.norm(r) + np.linalg.norm(np.abs(matrix) @ np.abs(r))
        size += np.linalg.norm(q)
        bound = (3 * problem.contacts + 12) * EPS * size / np.linalg.norm(q)
        assert before.scaled > 0.0
        assert abs(after.scaled - before.scaled) <= bound
        assert abs(after.local - before.local) <= bound
        assert bound < 1e-8 * max(1.0, before.scaled)  # a bound that can fail


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
@pytest.mark.parametrize("seed", [41, 42])
def test_a_problem_written_otherwise_has_the_same_residual(change, seed: int) -> None:
    check(random_problem(seed, contacts=9), change)


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
@outside
def test_a_problem_of_others_written_otherwise_has_the_same_residual(file: Path, change) -> None:
    check(read_problem(file), change)


def test_units_in_powers_of_two_change_no_bit() -> None:
    problem = random_problem(43)
    impulses = some_impulses(problem)
    changed = in_other_units(2.0**40, 2.0**-30, 2.0**7)(problem, impulses)
    assert residual(*changed)[:2] == residual(problem, impulses)[:2]
