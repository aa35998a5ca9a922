"""A contact inside a cavity lasts though it parts slowly: its wall turns towards it in the step."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import drawn
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.midpoint_rows import CALM, FORCED, make_lasting
from lavendersim.engine.records import MOTION, PAIR, dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(
    ("contact_midpoint", "friction", "impact_order", "impact_time", "rotation"),
    ("sphere_bowl", "sphere_plane"),
)
LASTING = interpreted(make_lasting(SPEC))
PULL = 1.0  # what forces change of v_n in a step [m/s]


@pytest.mark.parametrize(("pair", "opens"), [("sphere_bowl", FORCED * PULL), ("sphere_plane", 0.0)])
def test_what_forces_turn_back_within_the_step_lasts(pair: str, opens: float) -> None:
    scene = drawn(SPEC, np.random.default_rng(1), [(0, 1)], fixed=())
    contact, lead = records(scene.contacts)[0], records(scene.velocities)
    kind, motion = np.zeros(1, dtype(PAIR)), records(np.zeros(2, dtype(MOTION)))
    kind["kind"] = SHAPE_PAIRS[pair].kind
    for i in range(2):
        motion[i].wx, motion[i].wy, motion[i].wz = lead[i].wx, lead[i].wy, lead[i].wz
    for share in (1.0 - 1e-6, 1.0 + 1e-6):
        contact.phi, contact.dv_n = 0.0, -PULL
        contact.v_n_pre = share * (opens + CALM) - PULL
        params = one_row(dt=0.02, timestep=0.02, slop=1e-5)
        LASTING(contact, records(kind)[0], lead, motion, params)
        assert bool(contact.lasts) == (share < 1.0)
