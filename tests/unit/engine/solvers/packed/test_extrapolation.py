"""Sweeps that begin from several: Anderson's mixing by an independent least squares, and what it
leaves in a solve.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from packed_scenes import BLOCKS, found, mechanics, natural_maps

from lavendersim.engine.compile import compiling
from lavendersim.engine.effects.anderson_acceleration import PLAIN_SWEEPS
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.solvers.packed import late, packing, sweep
from lavendersim.engine.solvers.packed.extrapolation import (
    NOTHING,
    PAUSE,
    SWEEPS,
    WAIT,
    forget,
    make_extrapolate,
)
from lavendersim.engine.solvers.packed.lane_memory import STRIDE
from lavendersim.engine.solvers.packed.lanes import WIDTH
from lavendersim.engine.solvers.packed.layout import (
    DEPTH,
    HEAD,
    K_N,
    K_T,
    LAMBDA_N,
    allocate_packed,
    stride,
)
from tests.benchmarks.prepared_contacts import Solve

MIXED = BLOCKS._replace(solver="adaptive").including("anderson_acceleration")
GROUPS, BODIES = 3, 7
NUMBERS = 3 * WIDTH * GROUPS  # impulses


@cache
def extrapolate() -> Any:
    return cached(make_extrapolate, MIXED)


class LinearSweeps:
    """A map of impulses in place of sweeps, whose velocities are linear in impulses."""

    def __init__(self, rng: np.random.Generator, eigenvalues: list[float]) -> None:
        """eigenvalues: of the linear part, whose eigenvectors are drawn; all others are 0."""
        self.packed = allocate_packed(MIXED, BODIES, GROUPS * WIDTH, eight=True)
        self.rows = self.packed.rows[: GROUPS * stride(MIXED, True)].reshape(GROUPS, -1, WIDTH)
        self.inverse_masses = rng.uniform(0.1, 10.0, (GROUPS, 3, WIDTH))
        self.inverse_masses[:, 2] = self.inverse_masses[:, 1]  # a disc has one
        self.rows[:, K_N], self.rows[:, K_T] = self.inverse_masses[:, :2].swapaxes(0, 1)
        vectors = np.linalg.qr(rng.normal(size=(NUMBERS, NUMBERS)))[0]
        skew = np.eye(NUMBERS) + 0.2 * vectors  # eigenvectors that are not orthogonal
        values = np.zeros(NUMBERS)
        values[: len(eigenvalues)] = eigenvalues
        self.matrix = skew @ np.diag(values) @ np.linalg.inv(skew)
        self.solution = rng.normal(size=NUMBERS)
        self.to_state = rng.normal(size=(BODIES * STRIDE, NUMBERS))
        self.impulses = rng.normal(size=NUMBERS)
        forget.py_func(self.packed)

    @property
    def impulses(self) -> np.ndarray:
        return self.rows[:, LAMBDA_N : LAMBDA_N + 3].ravel()

    @impulses.setter
    def impulses(self, new: np.ndarray) -> None:
        self.rows[:, LAMBDA_N : LAMBDA_N + 3] = new.reshape(GROUPS, 3, WIDTH)
        self.packed.state[HEAD * STRIDE :] = self.to_state @ new

    @property
    def state(self) -> np.ndarray:
        return self.packed.state[HEAD * STRIDE :]

    def sweep(self) -> tuple[np.ndarray, np.ndarray]:
        """Return impulses before and after."""
        before = self.impulses.copy()
        self.impulses = self.solution + self.matrix @ (before - self.solution)
        return before, self.impulses.copy()

    def mix(self, ends: bool = False) -> None:
        with compiling():
            extrapolate()(self.packed, GROUPS * WIDTH, ends)


def anderson(rounds: list[tuple[np.ndarray, np.ndarray]], weights: np.ndarray) -> np.ndarray:
    """Return sum a_i y_i of the rounds (x_i, y_i) by numpy's least squares."""
    defects = [np.sqrt(weights) * (y - x) for x, y in rounds]
    columns = np.stack([defects[-1] - one for one in defects[:-1]], axis=1)
    shares = np.linalg.lstsq(columns, defects[-1], rcond=None)[0]
    newest = rounds[-1][1]
    mixed: np.ndarray = newest + sum(
        share * (y - newest) for share, (_, y) in zip(shares, rounds[:-1], strict=True)
    )
    return mixed


def test_a_sweep_begins_where_the_least_squares_of_the_last_ones_say(rng) -> None:
    """Products lose half of the digits: the conditions squared are some 1e4, of 1e-16."""
    sweeps = LinearSweeps(rng, list(rng.uniform(-0.9, 0.9, 12)))
    sweeps.mix()  # it only learns where the next sweep begins
    rounds: list[tuple[np.ndarray, np.ndarray]] = []
    for k in range(8):
        rounds.append(sweeps.sweep())
        sweeps.mix()
        expected = rounds[-1][1]
        if k > 0:
            expected = anderson(rounds[-DEPTH:], sweeps.inverse_masses.ravel())
        size = np.abs(expected).max()
        np.testing.assert_allclose(sweeps.impulses, expected, rtol=0, atol=1e-9 * size)
        # velocities stay those of the impulses
        velocities = sweeps.to_state @ sweeps.impulses
        np.testing.assert_allclose(sweeps.state, velocities, rtol=0, atol=1e-9 * size * NUMBERS)


def test_a_linear_map_of_as_many_eigenvalues_as_differences_is_solved(rng) -> None:
    """x + sum s_i (x_i - x) solves it where the defects span the eigenvectors (Krylov)."""
    sweeps = LinearSweeps(rng, [0.98, -0.7, 0.4])
    sweeps.mix()
    for _ in range(DEPTH + 1):
        sweeps.sweep()
        sweeps.mix()
    left = np.abs(sweeps.impulses - sweeps.solution).max()
    assert left < 1e-8  # 0.98^5 without: nine tenths of what was
    plain = LinearSweeps(rng, [0.98, -0.7, 0.4])
    for _ in range(DEPTH + 1):
        plain.sweep()
    assert np.abs(plain.impulses - plain.solution).max() > 1e-2


def test_a_beginning_that_leaves_more_is_taken_back_and_plain_sweeps_follow(rng) -> None:
    sweeps = LinearSweeps(rng, [0.9, 0.5])
    sweeps.mix()
    sweeps.sweep()
    sweeps.mix()
    _, best = sweeps.sweep()
    velocities = sweeps.state.copy()
    sweeps.mix()
    # What contacts that open and stick may do: the map is another one there.
    sweeps.solution = sweeps.solution + 100.0
    sweeps.sweep()
    sweeps.mix()
    np.testing.assert_array_equal(sweeps.impulses, best)
    np.testing.assert_array_equal(sweeps.state, velocities)
    counts = sweeps.packed.kept.counts
    assert (counts[SWEEPS], counts[WAIT]) == (NOTHING, 1)
    for _ in range(2):  # one waits, one says where the next sweep begins
        _, after = sweeps.sweep()
        sweeps.mix()
        np.testing.assert_array_equal(sweeps.impulses, after)
    assert counts[PAUSE] == 2


def test_the_last_sweeps_begin_where_those_before_ended(rng) -> None:
    sweeps = LinearSweeps(rng, [0.9, 0.5])
    sweeps.mix()
    sweeps.sweep()
    sweeps.mix()
    _, after = sweeps.sweep()
    sweeps.mix(ends=True)
    np.testing.assert_array_equal(sweeps.impulses, after)


@cache
def solves() -> tuple[Solve, Solve]:
    """Return the default's sweeps through many towers, plain and mixed."""
    prepared = found("many towers")
    mixed = prepared._replace(spec=prepared.spec.including("anderson_acceleration"))
    return Solve(prepared, "adaptive"), Solve(mixed, "adaptive")


def test_solves_of_no_more_than_the_plain_sweeps_keep_their_bits() -> None:
    plain, mixed = solves()
    for sweeps in (0, 1, 50, PLAIN_SWEEPS):
        plain.run(sweeps)
        mixed.run(sweeps)
        assert plain.contacts.tobytes() == mixed.contacts.tobytes()
        assert plain.velocities.tobytes() == mixed.velocities.tobytes()


def test_long_solves_leave_less_and_obey_mechanics() -> None:
    """M (v - v_0) = J^T of all impulses, and Coulomb's laws, from poses and velocities alone.

    Of three boxes on each other a plain sweep keeps 0.996: after 400 a tenth is left of what was
    there after 64. Digits are lost as in `test_sweep`, a hundred roundings a visit.
    """
    plain, mixed = solves()
    plain.run(400)
    mixed.run(400)
    assert mixed.sweeps == plain.sweeps == 400
    assert mixed.residual < 0.1 * plain.residual
    prepared = found("many towers")
    inverse, rows, velocity = mechanics(prepared)
    initial = np.stack([prepared.contacts[f"lambda_{axis}"] for axis in "n12"], axis=1)
    moved = velocity + inverse @ rows.T @ (mixed.impulses - initial).ravel()
    names = ("vx", "vy", "vz", "wx", "wy", "wz")
    after = np.stack([mixed.velocities[name] for name in names], axis=1).ravel()
    allowed = 2.0**-53 * 100 * 400 * 10  # a turn of 1 rad/s moves surfaces 0.1 m away
    np.testing.assert_allclose(after, moved, rtol=0, atol=allowed * 5.0)
    w = (rows @ after).reshape(-1, 3)
    w[:, 0] += mixed.contacts["target"]
    residual = natural_maps(mixed.contacts, w, mixed.impulses).max()
    assert residual == pytest.approx(mixed.residual, abs=allowed * 5.0)


def test_sweeps_that_are_recorded_leave_what_those_made_together_leave(monkeypatch) -> None:
    """Of large solves a few sweeps together lead to the next beginning, whoever looks at each."""
    for module in (packing, sweep):
        monkeypatch.setattr(module, "RUN", 2)  # groups
    monkeypatch.setattr(late, "MANY", late.FEWEST_CONTACTS)
    prepared = found("many towers")
    parameters = prepared.parameters.copy()
    parameters["residuals_to"] = -1  # of no step: there is room for no row
    spec = prepared.spec.including("anderson_acceleration")
    mixed = prepared._replace(spec=spec, parameters=parameters)
    together = Solve(mixed, "adaptive")
    singly = Solve(mixed._replace(spec=spec.including("residual_log")), "adaptive")
    for sweeps in (PLAIN_SWEEPS + 6, 131):
        together.run(sweeps)
        singly.run(sweeps)
        assert together.sweeps == singly.sweeps == sweeps
        assert together.contacts.tobytes() == singly.contacts.tobytes()
        assert together.velocities.tobytes() == singly.velocities.tobytes()
