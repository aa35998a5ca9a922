"""The loop of all solvers, on a method whose error is known: it halves with every sweep.

One contact with W = 1 and q = -1 has the impulse 1; its residual is |r - 1|, 2^-k after k sweeps.
"""

from __future__ import annotations

from math import inf, nan
from typing import Any, NamedTuple

import numpy as np
import pytest

from lavendersim.engine.compile import compiling, kernel
from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.engine.effects import row_fields
from lavendersim.engine.matrix_problem import contacts_of, coupling_of, system_of
from lavendersim.engine.records import COUNTERS, PARAMETERS, dtype
from lavendersim.engine.solvers.iteration import Iteration, make_solve
from lavendersim.engine.spec import Spec

SWEEPS = 10
PROBLEM = ContactProblem(
    begin=np.array([0, 1]),
    row=np.array([0]),
    blocks=np.eye(3)[None],
    free=np.array([[-1.0, 0.0, 0.0]]),
    mu=np.array([0.5]),
    gamma=np.zeros(1),
    target=np.zeros(1),
)


class Ended(NamedTuple):
    """What a solve leaves."""

    sweeps: int
    residual: float
    history: list[float]
    proceeded: int
    not_converged: int


def halving(spec: Spec, said: float | None) -> Any:
    """Return the sweep; said: the change that it reports, None for its own."""
    honest = said is None
    other = 0.0 if said is None else said

    def halve(system, workspace, params, counters, carry):
        contact = system.contacts[0]
        change = 0.5 * (1.0 - contact.lambda_n)
        contact.lambda_n += change
        contact.w_n += change
        return (change if honest else other), carry

    return kernel(halve, spec)


def counting(spec: Spec) -> Any:
    def count_calls(system, workspace, params, counters, carry):
        counters.newton_steps += 1
        return carry

    return kernel(count_calls, spec)


def solve(
    tolerance: float, make: Any, start: float = 0.0, record: bool = False, workspace: Any = ()
) -> Ended:
    effects = ("compliance", "friction", *(("residual_log",) if record else ()))
    spec = Spec(effects, (), "jacobi", True, "disc", "matrix")
    params, counters = np.zeros(1, dtype(PARAMETERS)), np.zeros(1, dtype(COUNTERS))
    params["tolerance"], params["sweeps"] = tolerance, SWEEPS
    params["residuals_from"] = params["residuals_to"] = 1
    rows = np.zeros(SWEEPS + 1 if record else 0, dtype(row_fields(spec, "residual")))
    contacts = contacts_of(PROBLEM, spec, np.array([[start, 0.0, 0.0]]))
    system = system_of(contacts, coupling_of(PROBLEM))
    with compiling():
        make_solve(spec, "made_up", make(spec))(system, workspace, params[0], counters[0], rows)
    left = counters[0]
    history = rows["residual"][: left["residual_rows"]].tolist()
    return Ended(
        int(left["sweeps"]), float(left["residual"]), history, int(left["newton_steps"]),
        int(left["not_converged"]),
    )  # fmt: skip


@pytest.mark.parametrize("record", [False, True])
def test_it_ends_at_the_first_sweep_whose_residual_is_at_the_tolerance(record: bool) -> None:
    # A change is what it leaves: 2^-k <= 0.1 from k = 4 on.
    ended = solve(0.1, lambda spec: Iteration(halving(spec, None)), record=record)
    assert (ended.sweeps, ended.residual, ended.not_converged) == (4, 2.0**-4, 0)
    assert ended.history == ([2.0**-k for k in range(5)] if record else [])


@pytest.mark.parametrize("record", [False, True])
def test_without_a_tolerance_it_takes_all_its_sweeps(record: bool) -> None:
    ended = solve(-1.0, lambda spec: Iteration(halving(spec, None)), record=record)
    assert (ended.sweeps, ended.residual) == (SWEEPS, 2.0**-SWEEPS)
    assert len(ended.history) == (SWEEPS + 1 if record else 0)


@pytest.mark.parametrize("said", [0.0, nan])
def test_a_sweep_that_changes_nothing_or_ends_in_a_nan_is_the_last(said: float) -> None:
    ended = solve(1e-9, lambda spec: Iteration(halving(spec, said)))
    assert (ended.sweeps, ended.residual, ended.not_converged) == (1, 0.5, 1)


def test_what_counts_as_no_change_is_a_speed_and_no_impulse() -> None:
    """An impulse that sweeps shrink for ever ends at as many of them in any unit of mass.

    Of 1e-9 kg the least of all numbers, 5e-324 N s, is 5e-315 m/s, of 256 times that another.
    """
    for said, sweeps in ((5e-315, 1), (5e-315 / 256, 1), (1e-149, SWEEPS)):
        assert solve(-1.0, lambda spec, said=said: Iteration(halving(spec, said))).sweeps == sweeps


def test_a_method_that_says_nothing_of_its_changes_goes_on() -> None:
    assert solve(0.1, lambda spec: Iteration(halving(spec, inf))).sweeps == SWEEPS


def test_a_method_that_looks_every_four_sweeps_ends_at_one_of_them() -> None:
    # 2^-4 is above the tolerance, 2^-5 is not but nobody looks, 2^-8 is looked at.
    ended = solve(2.0**-5, lambda spec: Iteration(halving(spec, inf), residual_every=4))
    assert (ended.sweeps, ended.residual) == (8, 2.0**-8)
    # What is solved is not swept; its residual is measured all the same.
    solved = solve(0.1, lambda spec: Iteration(halving(spec, inf), residual_every=4), start=1.0)
    assert (solved.sweeps, solved.residual) == (0, 0.0)


def test_what_lies_between_sweeps_follows_each_that_did_not_end_the_solve() -> None:
    def make(spec: Spec) -> Iteration:
        return Iteration(halving(spec, None), proceed=counting(spec))

    assert solve(0.1, make).proceeded == 3
    assert solve(-1.0, make).proceeded == SWEEPS


def test_impulses_are_back_in_their_records_before_the_residual_is_measured() -> None:
    def make(spec: Spec) -> Iteration:
        def halve_aside(system, workspace, params, counters, carry):
            change = 0.5 * (1.0 - workspace[0])
            workspace[0] += change
            return change, carry

        def bring_back(system, workspace, carry):
            contact = system.contacts[0]
            contact.w_n += workspace[0] - contact.lambda_n
            contact.lambda_n = workspace[0]

        return Iteration(kernel(halve_aside, spec), finish=kernel(bring_back, spec))

    for tolerance, sweeps in ((0.1, 4), (-1.0, SWEEPS)):
        ended = solve(tolerance, make, workspace=np.zeros(1))
        assert (ended.sweeps, ended.residual) == (sweeps, 2.0**-sweeps)
