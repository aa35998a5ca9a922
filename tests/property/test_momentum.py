"""Contacts between free bodies change neither their momentum nor, about the origin, its moment.

Impulses act on both bodies along one line: at the instant of the solve both sums are exact. Each
step then moves bodies by v dt, which keeps sum(x x p); projection moves them in pairs of opposite
pushes along one line, which keeps sum(m x) and so the momentum's line of action.

Friction acts on each body at its own surface. Surfaces that overlap or gape by phi make its two
impulses a couple: sum(x x p + I omega) changes by phi n x p_t, and by nothing else.
"""

from __future__ import annotations

import numpy as np
from hypothesis import given
from worlds import FEW, clusters, run, vectors


@given(clusters(restitution=True, friction=True))
@FEW
def test_momentum_of_an_isolated_system_is_kept_to_round_off(bodies):
    _, rows = run(bodies, stabilisation_gain=0.02, projection=0.2, slop=0.001)
    momentum = vectors(rows.step, "momentum")
    # 60 steps of 22 sweeps over some 20 rows round each p once: a walk of some 1e-14 relative.
    scale = sum(b["mass"] * (1.0 + np.linalg.norm(b["velocity"])) for b in bodies.values())
    assert np.abs(momentum - momentum[0]).max() < 1e-12 * scale


@given(clusters(restitution=True))
@FEW
def test_angular_momentum_of_an_isolated_system_is_kept_to_round_off(bodies):
    """Without projection, which turns a body at constant omega and so changes its I omega."""
    _, rows = run(bodies, stabilisation_gain=0.02, slop=0.001)
    angular = vectors(rows.step, "angular_momentum")
    scale = sum(b["mass"] * (1.0 + np.linalg.norm(b["velocity"])) for b in bodies.values())
    assert np.abs(angular - angular[0]).max() < 1e-11 * scale


@given(clusters(restitution=True, friction=True))
@FEW
def test_friction_changes_angular_momentum_by_the_couple_of_the_gap_alone(bodies):
    _, rows = run(bodies, stabilisation_gain=0.02, slop=0.001)
    angular = vectors(rows.step, "angular_momentum")
    contacts = rows.contact
    normal = np.column_stack([contacts[f"n{axis}"] for axis in "xyz"])
    one = np.column_stack([contacts[f"t1{axis}"] for axis in "xyz"])
    # n x (t1 p_1 + t2 p_2) = t2 p_1 - t1 p_2
    arm = np.cross(normal, one) * contacts["impulse_t1"][:, None]
    arm -= one * contacts["impulse_t2"][:, None]
    expected = np.repeat(angular[:1], len(angular), axis=0)
    for step, couple in zip(contacts["step"], contacts["separation"][:, None] * arm, strict=True):
        expected[step:] += couple
    scale = sum(b["mass"] * (1.0 + np.linalg.norm(b["velocity"])) for b in bodies.values())
    assert np.abs(angular - expected).max() < 1e-11 * scale
