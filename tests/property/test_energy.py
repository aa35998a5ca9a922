"""Contacts make no energy without a source: gain and projection are off here.

Impulses lambda change the kinetic energy by 1/2 sum lambda (v_n+ + v_n-). With e = 0 every update
of a row lowers it, converged or not. A pushing row that approached ends at v_n+ = -e v_n- and adds
(1 - e) lambda v_n- / 2 <= 0; one that separated ends at 0 and adds lambda v_n- / 2: the gain that
Newton's law is known for in impacts with several contacts.
"""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from laboratory import sphere
from worlds import FEW, clusters, run, unit, vector


@given(clusters())
@FEW
def test_inelastic_contacts_never_raise_the_kinetic_energy(bodies):
    """Cold starts: a warm one begins with energy that belongs to the step before."""
    _, rows = run(bodies, warm_start=False)
    energy = rows.step["kinetic_energy"]
    assert (np.diff(energy) <= 1e-14 * energy[:-1]).all()


@given(clusters(friction=True))
@FEW
def test_rough_inelastic_contacts_never_raise_the_kinetic_energy(bodies):
    """With e = 0 work is p . v+ - p K p / 2, and p . v+ <= 0 but for what sweeps left unsolved."""
    _, rows = run(bodies, warm_start=False, sweeps=300)
    energy, contacts = rows.step["kinetic_energy"], rows.contact
    parts = (contacts[f"impulse_{part}"] for part in ("n", "t1", "t2"))
    unsolved = np.sqrt(sum(part**2 for part in parts)) * contacts["residual"]
    slack = np.bincount(contacts["step"], weights=unsolved, minlength=len(energy))[1:]
    assert (np.diff(energy) <= 2.0 * slack + 1e-13 * energy[:-1]).all()


@given(st.floats(0.0, 1.0, width=32), vector, unit, unit)
@FEW
def test_one_bounce_keeps_e_squared_of_the_energy_of_approach(e, aside, log_a, log_b):
    offset = np.array([0.35, 0.1 * aside[0], 0.1 * aside[1]])
    bodies = {
        "a": sphere(0.2, (0.0, 0.0, 0.0), mass=10.0**log_a, velocity=(1.0, 0.0, 0.0)),
        "b": sphere(0.2, offset, mass=10.0**log_b, velocity=(-1.0, aside[2], 0.0), restitution=e),
    }
    _, rows = run(bodies, steps=1)
    contact = rows.contact[0]
    reduced = 1.0 / contact["inverse_effective_mass"]
    lost = 0.5 * reduced * (1.0 - float(e) ** 2) * contact["approach_velocity"] ** 2
    energy = rows.step["kinetic_energy"]
    assert abs(energy[0] - energy[1] - lost) <= 1e-13 * energy[0]
    assert energy[1] <= energy[0] * (1.0 + 1e-15)


@given(clusters(boxes=False), st.floats(0.0, 1.0, width=32))
@FEW
def test_impacts_with_one_coefficient_gain_nothing_but_newtons_error(bodies, e):
    """dE <= 1/2 sum over separating rows of lambda v_n-, plus what the sweeps left unsolved."""
    for described in bodies.values():
        described["surface"]["restitution"] = e
    _, rows = run(bodies, warm_start=False, sweeps=300)
    energy = rows.step["kinetic_energy"]
    for step in range(1, len(energy)):
        contacts = rows.contact[rows.contact["step"] == step]
        impulse, approach = contacts["impulse_n"], contacts["approach_velocity"]
        newton = 0.5 * np.sum(impulse * np.maximum(approach, 0.0))
        unsolved = 0.5 * np.sum(impulse * contacts["residual"])
        assert energy[step] - energy[step - 1] <= newton + unsolved + 1e-14 * energy[0]


@given(clusters(restitution=True))
@FEW
def test_energy_of_a_step_changes_by_the_work_of_the_logged_impulses(bodies):
    """1/2 sum lambda (v_n+ + v_n-), and turning keeps the energy of every shape."""
    _, rows = run(bodies, warm_start=False)
    energy = rows.step["kinetic_energy"]
    contacts = rows.contact
    work = (
        0.5 * contacts["impulse_n"] * (contacts["approach_velocity"] + contacts["normal_velocity"])
    )
    total = np.bincount(contacts["step"], weights=work, minlength=len(energy))[1:]
    np.testing.assert_allclose(np.diff(energy), total, atol=1e-13 * float(energy.max()))
