"""A contact's spring obeys its rule in every step, keeps its energy, and never gains any."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest
from interpreted import interpreted, records
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.contact_spring import (
    EFFECT,
    make,
    make_contact_row,
    make_energy,
    make_row,
    make_step_row,
)
from lavendersim.engine.record_layout import allocate_velocities, contact_dtype
from lavendersim.engine.spec import Spec

EULER = Spec(effects=("compliance", "contact_spring"))
MEAN = EULER.including("contact_midpoint")
MASS, C = 2.0, 1e-3  # omega = 1/sqrt(m c) = 22.4 rad/s


def row_of(spec: Spec, depth: float, v: float, dt: float, ratio: float = 0.0):
    contact = one_row(
        spring_compliance=C, damping_ratio=ratio, k_n=1.0 / MASS, phi=-depth, gamma=0.0,
        target=0.0, spring_v=0.0, inv_k=0.0, lambda_n=0.0,
    )  # fmt: skip
    interpreted(make_row(spec))(contact, v, one_row(dt=dt))
    return contact


def stepped(spec: Spec, depth: float, v: float, dt: float, ratio: float = 0.0):
    """Return the depth, the velocity and the impulse of one step: v_1 + target + gamma P = 0."""
    contact = row_of(spec, depth, v, dt, ratio)
    impulse = max(-(v + contact.target) / (1.0 / MASS + contact.gamma), 0.0)
    after = v + impulse / MASS
    moved = 0.5 * (v + after) if spec is MEAN else after
    return depth - dt * moved, after, impulse


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0])
def test_the_impulse_is_that_of_the_rule(ratio: float) -> None:
    """By the trapezoidal rule dt (d_0 + d_1)/(2 c) + k_d (d_1 - d_0); by Euler's dt d_1/c - ..."""
    dt, depth, v = 0.004, 0.01, -0.05
    k_d = 2.0 * ratio * sqrt(MASS / C)
    end, after, impulse = stepped(MEAN, depth, v, dt, ratio)
    assert impulse == pytest.approx(dt * (depth + end) / (2.0 * C) + k_d * (end - depth), rel=1e-12)
    end, after, impulse = stepped(EULER, depth, v, dt, ratio)
    assert impulse == pytest.approx(dt * end / C - dt * k_d * after, rel=1e-12)


def test_the_mean_rule_keeps_the_energy_and_the_period() -> None:
    """A quarter of 2 pi sqrt(m c), of order 2: from the deepest point to the surface."""
    errors = []
    for steps in (50, 100):
        dt = 0.5 * pi * sqrt(MASS * C) / steps
        depth, v = 0.01, 0.0
        energy = 0.5 * depth**2 / C
        for _ in range(steps - 1):
            depth, v, _ = stepped(MEAN, depth, v, dt)
            assert 0.5 * MASS * v**2 + 0.5 * depth**2 / C == pytest.approx(energy, rel=1e-12)
        exact = 0.01 * np.cos((steps - 1) * dt / sqrt(MASS * C))
        errors.append(abs(depth - exact))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("spec", [EULER, MEAN], ids=["Euler", "mean"])
@pytest.mark.parametrize("ratio", [0.1, 1.0, 5.0])
@pytest.mark.parametrize("stiff", [0.1, 10.0, 1e4])
def test_no_timestep_lets_a_damped_spring_swing_up(spec: Spec, ratio: float, stiff: float) -> None:
    """x^2 = dt^2/(m c). The step is linear about what is deep: its eigenvalues are within 1.

    Of the mean rule their product is (1 + x^2/4 - zeta x)/(1 + x^2/4 + zeta x), written out from
    F = (d_0 + d_1)/2 - 2 zeta (v_0 + v_1)/2, m = c = 1.
    """
    dt, columns = sqrt(stiff * MASS * C), []
    deep, rising, _ = stepped(spec, 1.0, 0.0, dt, ratio)
    for depth, v in ((0.01, 0.0), (0.0, 0.01 / dt)):
        end, after, pushed = stepped(spec, 1.0 + depth, v, dt, ratio)
        assert pushed > 0.0
        columns.append([(end - deep) / 0.01, (after - rising) * dt / 0.01])
    step, x = np.array(columns).T, sqrt(stiff)
    assert np.abs(np.linalg.eigvals(step)).max() < 1.0
    if spec is MEAN:
        product = (1.0 + 0.25 * x**2 - ratio * x) / (1.0 + 0.25 * x**2 + ratio * x)
        assert np.linalg.det(step) == pytest.approx(product, rel=1e-11)


@pytest.mark.parametrize("spec", [EULER, MEAN], ids=["Euler", "mean"])
def test_a_row_takes_the_velocity_of_the_start_and_rigid_pairs_none(spec: Spec) -> None:
    contact = np.zeros(1, contact_dtype(spec))
    contact["k_n"], contact["phi"], contact["v_n_pre"] = 1.0 / MASS, -0.01, -0.5
    if spec is MEAN:
        contact["dv_n"] = -0.1  # by forces
    row, kernel = records(contact)[0], interpreted(make(spec))
    kernel(row, one_row(compliance=0.0, damping_ratio=0.2), one_row(dt=0.004))
    assert (row.target, row.gamma, row.spring_compliance) == (0.0, 0.0, 0.0)
    kernel(row, one_row(compliance=C, damping_ratio=0.2), one_row(dt=0.004))
    expected = row_of(spec, 0.01, -0.4 if spec is MEAN else -0.5, 0.004, 0.2)
    assert (row.target, row.gamma) == (expected.target, expected.gamma)
    assert row.damping_ratio == 0.2


@pytest.mark.parametrize("spec", [EULER, MEAN], ids=["Euler", "mean"])
def test_what_is_stored_is_that_of_the_depth_at_the_end(spec: Spec) -> None:
    dt, contacts = 0.004, np.zeros(3, contact_dtype(spec))
    velocities = allocate_velocities(spec, 2)
    contacts["b"], contacts["nz"] = 1, 1.0
    contacts["phi"], contacts["spring_compliance"] = [-0.01, 0.02, -0.01], [C, C, 0.0]
    contacts["spring_v"], velocities["vz"][1] = -0.3, 0.5
    contacts["k_n"], velocities["released"] = 1.0 / MASS, 7.0
    moved = 0.5 * (0.5 - 0.3) if spec is MEAN else 0.5
    kernel, params = interpreted(make_energy(spec)), one_row(dt=dt, timestep=dt)
    found = kernel(records(contacts), 3, records(velocities), params)
    depth = 0.01 - dt * moved
    assert found == pytest.approx(0.5 * depth**2 / C, rel=1e-13)
    # What it may give to its bodies in a step: by its force, here less than by its energy.
    force = depth / C
    assert np.all(velocities["released"] >= dt * force / MASS)
    assert np.all(velocities["released"] <= sqrt(2.0 * found / MASS))
    kernel(records(contacts), 0, records(velocities), params)
    assert np.all(velocities["released"] == 0.0)


def test_it_logs_gamma_and_the_energy() -> None:
    out, row = one_row(gamma=0.0), one_row(contact_energy=0.0)
    interpreted(make_contact_row(EULER))(out, one_row(gamma=0.7), None, None)
    interpreted(make_step_row(EULER))(row, None, one_row(contact_energy=1.5))
    assert (out.gamma, row.contact_energy) == (0.7, 1.5)


def test_it_is_on_where_a_pair_is_compliant_and_its_law_the_spring() -> None:
    soft = (pair_facts("floor", "box", compliance=C),)
    assert EFFECT.decide(facts(pairs=soft, compliance_law="spring")).on
    assert not EFFECT.decide(facts(pairs=soft)).on
    rigid = (pair_facts("floor", "box"),)
    assert not EFFECT.decide(facts(pairs=rigid, compliance_law="spring")).on
    pushed = facts(pairs=soft, compliance_law="spring", stabilisation_gain=0.1)
    assert not EFFECT.decide(pushed).on
    assert [key.mix(0.1, 0.4) for key in EFFECT.surface_keys] == [0.4]
