"""Contacts between free bodies change neither their momentum nor, about the origin, its moment.

Impulses act on both bodies along one line: at the instant of the solve both sums are exact. Each
step then moves bodies by v dt, which keeps sum(x x p); projection moves them in pairs of opposite
pushes along one line, which keeps sum(m x) and so the momentum's line of action.
"""

from __future__ import annotations

import numpy as np
from hypothesis import given
from worlds import FEW, clusters, run, vectors


@given(clusters(restitution=True))
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
