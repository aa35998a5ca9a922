"""The first stop of a step: when the slip of points in contact passes through nothing."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_contacts import drawn, put_vector, views
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.approach import NEVER
from lavendersim.engine.effects.sliding_stops import MOST_ROWS, make_first_stop
from lavendersim.engine.record_layout import allocate_pairs
from lavendersim.engine.records import MOTION, SPHERE, dtype
from lavendersim.engine.spec import Spec

EFFECTS = ("contact_midpoint", "contact_torque", "friction", "impact_order", "rotation")
SPEC = Spec((*EFFECTS, "sliding_stops"))
STOP, LEFT = 0.003, 0.01  # [s]


def vector(row: Any, prefix: str) -> np.ndarray:
    return np.array([row[f"{prefix}{axis}"] for axis in "xyz"])


@pytest.mark.parametrize("rate", [1.0, -1.0])
def test_it_is_where_the_slip_that_its_rate_opposes_has_gone(rate: float, rng) -> None:
    """s = v_B + w_B x r_B - v_A - w_A x r_A across n, and its rate by accelerations likewise."""
    for _ in range(5):
        scene = drawn(SPEC, rng, [(0, 1)], fixed=())
        row, motion = scene.contacts[0], np.zeros(2, dtype(MOTION))
        scene.bodies["shape"], scene.bodies["bound"] = SPHERE, 1.0
        arms = [vector(row, "r" + name) for name in "ab"]
        points, rates = [], []
        for m, v, body, arm in zip(motion, scene.velocities, scene.bodies, arms, strict=True):
            for prefix in ("v", "w"):
                put_vector(m, prefix, vector(v, prefix))
            for prefix in ("a", "spin_a"):
                put_vector(body, prefix, rng.normal(size=3))
            points.append(vector(m, "v") + np.cross(vector(m, "w"), arm))
            rates.append(vector(body, "a") + np.cross(vector(body, "spin_a"), arm))
        across = np.eye(3) - np.outer(vector(row, "n"), vector(row, "n"))
        slip, change = across @ (points[1] - points[0]), across @ (rates[1] - rates[0])
        # B's centre accelerates so that the slip is gone at STOP, or never.
        required = -rate * slip / STOP
        put_vector(scene.bodies[1], "a", vector(scene.bodies[1], "a") + required - change)
        pairs = allocate_pairs(SPEC, 1)
        pairs["friction"] = 0.5
        bodies, _, contacts = views(scene)
        state = SimpleNamespace(
            bodies=bodies, contacts=contacts, motion=records(motion), pairs=records(pairs)
        )
        params = one_row(dt=LEFT, timestep=LEFT, slop=1e-4)
        counters = one_row(spent=0)
        first_stop = interpreted(make_first_stop(SPEC))
        expected = STOP if rate > 0.0 else NEVER
        assert first_stop(state, 1, params, counters) == pytest.approx(expected, rel=1e-9)
        assert counters.spent == (2 if rate > 0.0 else 0)
        assert first_stop(state, MOST_ROWS + 1, params, counters) == NEVER
