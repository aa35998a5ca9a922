"""What resists turning is internal: it keeps momentum and never makes energy.

With e = 0 and a solved step, each contact changes the kinetic energy by lambda . v+ + psi . omega+
less half of what lambda and psi do themselves; v+ and omega+ are opposed or zero, up to the
residual.
"""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from laboratory import sphere
from worlds import FEW, clusters, run, unit, vector, vectors

coefficient = st.sampled_from((0.0, 0.001, 0.02, 0.3))


def rubbing(bodies, mu, torsional, rolling):
    for described in bodies.values():
        described["surface"].update(
            friction=mu, torsional_friction=torsional, rolling_friction=rolling
        )
    return bodies


@given(vector, vector, unit, coefficient, coefficient)
@FEW
def test_two_balls_that_meet_keep_their_momenta(spin_a, spin_b, log_mass, torsional, rolling):
    """Exactly touching, so that both levers end in one point. 0.4 kg m^2/s, 1e-16 relative."""
    bodies = {
        "a": sphere(0.2, (-0.2, 0, 0), velocity=(1, 0.2, 0), angular_velocity=spin_a),
        "b": sphere(
            0.3,
            (0.3, 0, 0),
            mass=10.0**log_mass,
            velocity=(-1, 0, 0.3),
            angular_velocity=spin_b,
        ),
    }
    _, rows = run(rubbing(bodies, 0.4, torsional, rolling), steps=1)
    assert len(rows.contact) == 1
    assert abs(rows.contact["separation"][0]) < 1e-16
    for name in ("momentum", "angular_momentum"):
        before, after = vectors(rows.step, name)
        np.testing.assert_allclose(after, before, atol=1e-14)
    if torsional > 0.0 and abs(spin_a[0] - spin_b[0]) > 0.1:
        assert rows.contact["angular_impulse_n"][0] != 0.0


@given(clusters(), coefficient, coefficient, coefficient)
@FEW
def test_energy_never_rises_and_every_torque_obeys_its_law(bodies, mu, torsional, rolling):
    _, rows = run(rubbing(bodies, mu, torsional, rolling), steps=40, warm_start=False, sweeps=200)
    energy, contacts = rows.step["kinetic_energy"], rows.contact
    size = np.hypot(contacts["angular_impulse_t1"], contacts["angular_impulse_t2"])
    twist = np.abs(contacts["angular_impulse_n"])
    # Torques count as the impulses they are in the residual: over levers of 0.15 m at least, the
    # least half edge there is.
    weight = contacts["impulse_n"] * (1.0 + mu) + (size + twist) / 0.15
    slack = np.bincount(contacts["step"], contacts["residual"] * weight, minlength=len(energy))[1:]
    assert (np.diff(energy) <= slack + 1e-14 * energy[0]).all()
    limit = contacts["impulse_n"]
    assert (twist <= contacts["torsional_friction"] * limit).all()
    assert (size <= contacts["rolling_friction"] * limit * (1.0 + 1e-15)).all()
