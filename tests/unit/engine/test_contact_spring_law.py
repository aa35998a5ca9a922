"""A step's impulse by a spring's law: the mean of its force over the way, tangent and energy."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.contact_spring_law import (
    FLATTEST,
    make_hertz_push,
    make_linear_push,
    make_linearise,
    make_push,
    make_solve_by_tangents,
    make_stored,
    make_touch,
    mean_depth,
    mean_force,
)
from lavendersim.engine.record_layout import allocate_velocities, contact_dtype
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

EULER = Spec(effects=("compliance", "contact_spring", "hertz_contact"))
MEAN = EULER.including("contact_midpoint")
SPECS = pytest.mark.parametrize("spec", [EULER, MEAN], ids=["Euler", "mean"])
K, A, MASS, DT = 3e5, 0.7, 2.0, 0.002
C, ZETA = 4e-6, 0.3  # of the linear law: dt^2/(m c) = 0.5
# Both ends of a step inside, outside, on the surface, or on either side of it.
WAYS = [(0.003, 0.005), (0.005, 0.003), (0.002, 0.002), (0.0, 0.004), (0.004, 0.0)]
WAYS += [(-0.001, 0.004), (0.004, -0.001), (-0.003, -0.001), (0.0, 0.0), (-0.002, 0.0)]
DRAWN = np.random.default_rng(5)


def row(depth: float = 0.003, v: float = -0.4, a: float = A, impulse: float = 0.0):
    return one_row(
        hertz_stiffness=K, dissipation=a, spring_v=v, phi=-depth, k_n=1.0 / MASS, gamma=0.0,
        target=0.0, inv_k=0.0, lambda_n=impulse, spring_compliance=1.0 / K, damping_ratio=0.0,
    )  # fmt: skip


def linear_row(depth: float = 0.003, v: float = -0.4, ratio: float = ZETA, c: float = C):
    return one_row(
        hertz_stiffness=0.0, spring_compliance=c, damping_ratio=ratio, spring_v=v, phi=-depth,
        k_n=1.0 / MASS, gamma=0.0, target=0.0, inv_k=0.0, lambda_n=0.0,
    )  # fmt: skip


def energy(depth: float) -> float:
    return 0.4 * max(depth, 0.0) ** 2.5


def linear_energy(depth: float) -> float:
    return 0.5 * max(depth, 0.0) ** 2


MEANS = [(mean_force, 1.5, energy), (mean_depth, 1.0, linear_energy)]
LAWS = pytest.mark.parametrize(("law", "power", "energy"), MEANS, ids=["Hertz", "linear"])


@LAWS
@pytest.mark.parametrize(("begin", "end"), WAYS)
def test_its_force_is_the_mean_along_the_way(law, power, energy, begin: float, end: float) -> None:
    """By Gauss's quadrature of d^power between the parts where it is smooth."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    low, high = min(begin, end), max(begin, end)
    inside = max(high, 0.0) - max(low, 0.0)
    # With d = x^2 the integrand is a polynomial of x, of degree 4 or 3.
    first, last = sqrt(max(low, 0.0)), sqrt(max(high, 0.0))
    x = 0.5 * (first + last) + 0.5 * (last - first) * nodes
    area = float(np.sum(weights * x ** (2.0 * power) * 2.0 * x)) * 0.5 * (last - first)
    expected = area / (high - low) if high > low else max(low, 0.0) ** power
    assert inside >= 0.0
    found, _ = interpreted(law)(begin, end)
    assert found == pytest.approx(expected, rel=1e-13, abs=1e-18)


@LAWS
@pytest.mark.parametrize(("begin", "end"), WAYS)
def test_its_work_is_the_change_of_its_energy(law, power, energy, begin: float, end: float) -> None:
    found, _ = interpreted(law)(begin, end)
    missed = found * (end - begin) - (energy(end) - energy(begin))
    assert abs(missed) < 1e-15 * max(energy(end), energy(begin), 1e-300)


@LAWS
@pytest.mark.parametrize(("begin", "end"), [way for way in WAYS if max(way) > 0.0])
def test_its_slope_is_that_of_differences(law, power, energy, begin: float, end: float) -> None:
    h = 1e-7
    mean = interpreted(law)
    (below, _), (above, _), (_, slope) = (
        mean(begin, end - h),
        mean(begin, end + h),
        mean(begin, end),
    )
    # h^2 of the third derivative, some d^(-3/2); where it has a corner h^(1/2) of the second.
    assert slope == pytest.approx((above - below) / (2.0 * h), rel=1e-3)


@SPECS
@pytest.mark.parametrize("a", [0.0, A, 10.0])
def test_its_impulse_falls_and_is_convex(spec: Spec, a: float) -> None:
    """So that tangents lie below it and Newton's method finds it from anywhere."""
    push, params = interpreted(make_push(spec)), one_row(dt=DT)
    for k in range(80):
        depth, v = DRAWN.uniform(-0.002, 0.004), DRAWN.uniform(-2.0, 2.0)
        contact = row(depth, v, a) if k % 2 == 0 else linear_row(depth, v, a)
        at, other = DRAWN.uniform(-3.0, 3.0, 2)
        (impulse, slope), (there, _) = push(contact, at, params), push(contact, other, params)
        assert impulse >= 0.0
        assert slope >= 0.0
        assert there >= impulse - slope * (other - at) - 1e-12 * max(impulse, there)


@SPECS
def test_its_impulse_is_that_of_the_rule(spec: Spec) -> None:
    push, contact = interpreted(make_hertz_push(spec)), row()
    for v in (-0.3, 0.1, 0.5):
        rate = -0.5 * (v - 0.4) if spec is MEAN else -v
        end = 0.003 + DT * rate
        force = (energy(end) - energy(0.003)) / (end - 0.003) if spec is MEAN else end**1.5
        found, _ = push(contact, v, one_row(dt=DT))
        # The difference of energies loses digits, up to energy/change of them.
        assert found == pytest.approx(DT * K * force * (1.0 + A * rate), rel=1e-11)


@SPECS
@pytest.mark.parametrize("begin", [0.003, -0.0005])
def test_the_linear_impulse_is_that_of_the_rule(spec: Spec, begin: float) -> None:
    """A damper acts where it is pressed; what would pull is 0."""
    push, contact = interpreted(make_linear_push(spec)), linear_row(begin)
    damper, signs = 2.0 * ZETA * sqrt(MASS / C), set()
    for v in (-3.0, -0.3, 0.1, 0.5, 3.0, 8.0):
        rate = -0.5 * (v - 0.4) if spec is MEAN else -v
        end = begin + DT * rate
        force = (linear_energy(end) - linear_energy(begin)) / (end - begin)
        if spec is EULER:
            force = max(end, 0.0)
        pressed = max(end, 0.0) - max(begin, 0.0)
        expected = max(DT * force / C + damper * pressed, 0.0)
        found, _ = push(contact, v, one_row(dt=DT))
        assert found == pytest.approx(expected, rel=1e-11, abs=1e-13)
        signs.add((end > 0.0, expected > 0.0))
    assert len(signs) >= 2


@pytest.mark.parametrize("ratio", [0.0, 0.2, 1.0, 30.0])
@pytest.mark.parametrize("c", [1e-3, 1e-6, 1e-12])
def test_no_step_of_a_linear_spring_gains_energy(ratio: float, c: float) -> None:
    """Whatever impulse the bodies' masses let it have: work on the mean of both velocities."""
    push, stored = interpreted(make_push(MEAN)), interpreted(make_stored(MEAN))
    for _ in range(200):
        begin, v_0, v_1 = DRAWN.uniform(-2e-3, 2e-3), *DRAWN.uniform(-2.0, 2.0, 2)
        contact = linear_row(begin, v_0, ratio, c)
        impulse, _ = push(contact, v_1, one_row(dt=DT))
        end = begin - 0.5 * DT * (v_0 + v_1)
        work, before = 0.5 * impulse * (v_0 + v_1), stored(contact, begin)
        gain = work + stored(contact, end) - before
        # Round-off of the depths, by the force; a difference that cancels.
        rounded = 1e-14 * max(abs(work), stored(contact, end), before)
        assert gain <= rounded
        if ratio == 0.0:
            assert gain >= -rounded


@SPECS
def test_nothing_pulls_however_fast_it_leaves(spec: Spec) -> None:
    assert interpreted(make_hertz_push(spec))(row(v=4.0), 4.0, one_row(dt=DT))[0] == 0.0


@SPECS
def test_its_row_is_the_tangent(spec: Spec) -> None:
    """v + target + gamma lambda = 0 at the law's impulse, with its slope."""
    push, touch, params = (
        interpreted(make_hertz_push(spec)),
        interpreted(make_touch(spec)),
        one_row(dt=DT),
    )
    for v in (-0.5, 0.2):
        contact = row()
        impulse, slope = push(contact, v, params)
        missed = touch(contact, v, params)
        assert contact.gamma == pytest.approx(1.0 / slope, rel=1e-15)
        assert v + contact.target + contact.gamma * impulse == pytest.approx(0.0, abs=1e-14)
        # What an impulse of 0 is off, as the change of velocity that its row would answer with.
        expected = impulse * contact.gamma / MASS / (1.0 / MASS + contact.gamma)
        assert missed == pytest.approx(expected, rel=1e-12)
    flat = row(depth=-1.0)
    touch(flat, 0.0, params)
    assert flat.gamma == 1.0 / MASS / FLATTEST


def test_a_soft_linear_row_is_as_flat_as_its_law() -> None:
    """So that one solve finds it: across a gap as inside."""
    touch, params = interpreted(make_touch(MEAN)), one_row(dt=DT)
    for depth in (0.01, -0.01):
        soft = linear_row(depth, 0.0, 0.0, 10.0)
        touch(soft, 0.0, params)
        assert soft.gamma == pytest.approx(4.0 * 10.0 / DT**2, rel=1e-14)


def test_it_stores_two_fifths_or_a_half() -> None:
    stored = interpreted(make_stored(MEAN))
    assert stored(linear_row(), 0.004) == pytest.approx(0.5 * 0.004**2 / C, rel=1e-14)
    assert stored(linear_row(), -0.004) == 0.0
    assert stored(row(), 0.004) == pytest.approx(K * energy(0.004), rel=1e-14)
    assert stored(row(), -0.004) == 0.0


def linear_solve(system, workspace, params, counters, rows) -> None:
    """One row of a ball on what does not move, from where it is: exact."""
    contact, v = system.contacts[0], system.velocities[1]
    w = v.vz + contact.target + contact.gamma * contact.lambda_n
    impulse = max(contact.lambda_n - w / (1.0 / MASS + contact.gamma), 0.0)
    v.vz += (impulse - contact.lambda_n) / MASS
    contact.lambda_n = impulse
    counters.sweeps = 1


@SPECS
@pytest.mark.parametrize("stiffness", [1e2, 1e6, 1e10, 1e14])
@pytest.mark.parametrize("v", [-3.0, 0.0, 3.0])
def test_solves_with_new_tangents_find_the_law(spec: Spec, stiffness: float, v: float) -> None:
    contacts, velocities = np.zeros(1, contact_dtype(spec)), allocate_velocities(spec, 2)
    contacts["b"], contacts["nz"], contacts["k_n"] = 1, 1.0, 1.0 / MASS
    contacts["hertz_stiffness"], contacts["dissipation"] = stiffness, A
    contacts["spring_compliance"] = 1.0 / stiffness
    contacts["phi"], contacts["spring_v"], velocities["vz"][1] = -1e-4, v, v
    system = ContactSystem(records(contacts), np.zeros(1, int), 1, None, records(velocities))
    params = one_row(dt=DT, tolerance=1e-9)
    counters = one_row(sweeps=0, not_converged=0)
    interpreted(make_solve_by_tangents(spec, linear_solve))(system, None, params, counters, None)
    row, v = records(contacts)[0], velocities["vz"][1]
    impulse, slope = interpreted(make_hertz_push(spec))(row, v, one_row(dt=DT))
    assert counters.not_converged == 0
    # Far too deep, F of d^(3/2) has a tangent through d/3: 6 mm to 10 nm are 12, then it squares.
    assert 1 <= counters.sweeps <= 18
    # A thousandth of the tolerance as a velocity, and the round-off of the depth by the slope.
    missed = 1e-12 + 1e-15 * (3.0 + 1e-4 / DT)
    assert row.lambda_n == pytest.approx(impulse, rel=1e-12, abs=missed * (slope + MASS))


def test_tangents_leave_rigid_rows_alone_and_a_nan_shows() -> None:
    contacts, velocities = np.zeros(2, contact_dtype(MEAN)), allocate_velocities(MEAN, 2)
    contacts["b"], contacts["nz"], contacts["k_n"], contacts["gamma"] = 1, 1.0, 1.0, 0.3
    linearise = interpreted(make_linearise(MEAN))
    params = one_row(dt=DT)
    assert linearise(records(contacts), 2, records(velocities), params) == (0.0, 0.0)
    assert contacts["gamma"].tolist() == [0.3, 0.3]
    contacts["hertz_stiffness"], velocities["vz"][1] = [K, 0.0], np.nan
    contacts["spring_compliance"] = [1.0 / K, 0.0]
    missed, _ = linearise(records(contacts), 2, records(velocities), params)
    assert np.isnan(missed)


@pytest.mark.parametrize("handed", [1e-160, 5e-324, 1e-140])
def test_an_impulse_that_no_velocity_has_a_digit_of_is_none(handed: float) -> None:
    """It would carry its bodies; a heavier one stays what the solver left, by k_n lambda."""
    spec = MEAN.including("friction", "rolling_friction", "torsional_friction", "rotation")
    contacts, velocities = np.zeros(2, contact_dtype(spec)), allocate_velocities(spec, 2)
    contacts["b"], contacts["nz"], contacts["k_n"] = 1, 1.0, 1e-5
    contacts["phi"], contacts["spring_compliance"] = 1.0, C
    names = ["lambda_n", "lambda_1", "lambda_2", "psi_n", "psi_1", "psi_2"]
    for name in names:
        contacts[name] = handed, 0.0

    def solve(system, workspace, params, counters, rows):
        counters.sweeps, counters.not_converged = 1, 0

    system = ContactSystem(records(contacts), np.zeros(2, int), 2, None, records(velocities))
    counters, params = one_row(sweeps=0, not_converged=0), one_row(dt=DT, tolerance=1e-9)
    interpreted(make_solve_by_tangents(spec, solve))(system, None, params, counters, None)
    left = handed if handed > 1e-150 else 0.0
    assert [contacts[name][0] for name in names] == [left] * 6
