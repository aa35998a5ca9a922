"""Order and over-relaxation of sweeps, against the same sweeps in numpy."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from idle_scenes import SCENES
from laboratory import Bench, plane, planned, resolved, sphere

from lavendersim.engine import ordering
from lavendersim.engine.contact_problem import SOLVED, ContactProblem
from lavendersim.engine.spec import Spec
from lavendersim.problems.by_kernel import solve_by_kernel

BALLS, SWEEPS = 10, 12


def tower(**numerics: Any) -> dict[str, Any]:
    """Balls on each other; none but the lowest is as heavy as its neighbours."""
    bodies = {"floor": plane()}
    for k in range(BALLS):
        bodies[f"ball_{k}"] = sphere(0.1, (0.0, 0.0, 0.1 + 0.2 * k), mass=1.0 + 0.3 * k)
    cell = resolved(bodies, (0.0, 0.0, -9.81), sweeps=SWEEPS, warm_start=False, **numerics)
    cell["record"]["problems"] = "every 1"
    return cell


def visits(order: str) -> Iterator[list[int]]:
    """Yield the contacts in the order of each sweep."""
    there = list(range(BALLS))
    back = there[::-1]
    while True:
        yield back if order == "backward" else there
        yield back if order in ("backward", "symmetric") else there


def residuals(w: np.ndarray, free: np.ndarray, order: str, factor: float) -> list[float]:
    """Return the largest natural map [m/s] before the first sweep and after each."""
    impulses = np.zeros(len(free))

    def missed() -> float:
        return float(np.abs(np.minimum(np.diag(w) * impulses, w @ impulses + free)).max())

    found = [missed()]
    for _, visited in zip(range(SWEEPS), visits(order), strict=False):
        for c in visited:
            away = w[c] @ impulses + free[c]
            impulses[c] = max(0.0, impulses[c] - factor * away / w[c, c])
        found.append(missed())
    return found


@pytest.mark.parametrize(("order", "factor"), [("backward", 1.0), ("symmetric", 1.3)])
def test_sweeps_go_as_numpy_goes(order: str, factor: float) -> None:
    cell = tower(order=order, over_relaxation=factor)
    spec = planned(cell).spec
    assert (spec.order, spec.over_relaxation) == (order, factor != 1.0)
    bench = Bench(cell, spec)
    rows = bench.run(1)
    found = bench.engine.problem()
    assert found is not None
    problem = found.problem
    w = np.zeros((BALLS, BALLS))
    for column in range(BALLS):
        at = slice(problem.begin[column], problem.begin[column + 1])
        w[problem.row[at], column] = problem.blocks[at, 0, 0]
    expected = residuals(w, problem.free[:, 0], order, factor)
    # rounding of a few products per visit, 0.04 m/s large
    np.testing.assert_allclose(rows.residual["residual"], expected, atol=1e-15 * SWEEPS)
    # and would not, were the order or the factor another one
    plain = np.array(residuals(w, problem.free[:, 0], "forward", 1.0))
    assert np.abs(plain - expected)[1:].min() > 1e-4


def test_a_problem_by_itself_is_solved_in_fewer_sweeps() -> None:
    """All contacts of the tower carry, so impulses solve W r + free = 0; sweeps crawl along it."""
    matrix = np.eye(BALLS) * 2.0 - np.eye(BALLS, k=1) - np.eye(BALLS, k=-1)
    matrix[0, 0] = 1.0  # balls of 1 kg
    row, column = np.nonzero(matrix)
    blocks = matrix[row, column][:, None, None] * np.eye(3)
    free = np.zeros((BALLS, 3))
    free[0, 0] = -0.04  # relative velocities: the lowest falls, and all with it
    zero = np.zeros(BALLS)
    begin = np.searchsorted(np.sort(column), np.arange(BALLS + 1))
    by_column = np.argsort(column, kind="stable")
    problem = ContactProblem(begin, row[by_column], blocks[by_column], free, zero, zero, zero)
    plain, over = (
        solve_by_kernel("projected_gauss_seidel", problem, 1e-11, over_relaxation=factor)
        for factor in (1.0, 1.6)
    )
    assert plain.status == over.status == SOLVED
    assert over.sweeps < plain.sweeps / 3
    for made in (plain, over):
        expected = np.linalg.solve(matrix, -free[:, 0])
        np.testing.assert_allclose(made.impulses[:, 0], expected, rtol=1e-8)


def test_a_factor_of_one_gives_the_bits_of_none() -> None:
    """As in a sweep of configs over the factor, whose cells share an engine."""
    cell = SCENES["frictional balls"]()
    spec = planned(cell).spec
    assert not spec.over_relaxation
    one = Bench(cell, spec).run(144)
    other = Bench(cell, spec._replace(over_relaxation=True)).run(144)
    for rows in ("step", "contact", "pose"):
        assert getattr(one, rows).tobytes() == getattr(other, rows).tobytes()


SHUFFLE = ordering.make_shuffle(Spec(order="random"))


def shuffled(count: int, step: int) -> list[int]:
    order = np.arange(count)
    SHUFFLE(order, count, step)
    return [int(c) for c in order]


def test_a_random_order_visits_every_contact_once() -> None:
    for count in (0, 1, 2, 7, 500):
        assert sorted(shuffled(count, 3)) == list(range(count))


def test_a_random_order_is_the_steps_own() -> None:
    assert shuffled(50, 7) == shuffled(50, 7)
    assert len({tuple(shuffled(50, step)) for step in range(200)}) == 200


def test_every_contact_comes_first_as_often_as_any_other() -> None:
    """Of 6000 steps each of ten contacts leads 600, give or take five deviations of sqrt(540)."""
    first = [shuffled(10, step)[0] for step in range(6000)]
    last = [shuffled(10, step)[-1] for step in range(6000)]
    for places in (first, last):
        assert np.abs(np.bincount(places, minlength=10) - 600).max() < 5 * 540**0.5
