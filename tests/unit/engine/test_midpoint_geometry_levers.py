"""Levers of contacts that do not last, where both bodies move to the middle of the step."""

from __future__ import annotations

from typing import Any

import numpy as np
from drawn_contacts import put_vector
from interpreted import interpreted, records

from lavendersim.engine import midpoint_geometry
from lavendersim.engine.record_layout import allocate_bodies, contact_dtype
from lavendersim.engine.spec import Spec

EFFECTS = ("contact_midpoint", "fast_bodies", "friction", "impact_order", "impact_time", "joint")
SPEC = Spec((*EFFECTS, "rotation"), ("sphere_sphere",))


def vector(row: Any, prefix: str = "") -> np.ndarray:
    return np.array([row[f"{prefix}{axis}"] for axis in "xyz"])


def test_a_contact_that_does_not_last_keeps_the_lever_of_each_body(rng) -> None:
    """They fly past each other, by much more than their sizes; what lasts stays on one body."""
    spec = SPEC
    for apart, lasts, joined in ((True, 1, 0), (False, 0, 0), (False, 1, 0), (True, 1, 1)):
        contacts, bodies = np.zeros(1, contact_dtype(spec)), allocate_bodies(spec, 2)
        contacts["b"], contacts["phi"], bodies["inv_m"] = 1, 5.0 if apart else 0.0, 1.0
        contacts["inv_m_a"], contacts["inv_m_b"], contacts["bilateral"] = 1.0, 1.0, joined
        contacts["lasts"] = lasts
        for prefix in ("", "tangential_"):
            put_vector(contacts[0], prefix, rng.normal(size=3))
        for body in bodies:
            put_vector(body, "", rng.normal(size=3))
        interpreted(midpoint_geometry.make_keep_start(spec))(records(contacts), 1)

        def levers(bodies: Any = bodies, contact: Any = contacts[0]) -> tuple[Any, Any]:
            aside = vector(contact, "tangential_")
            place = vector(contact)
            return place - vector(bodies[0]), place - vector(bodies[1]) - aside

        poses, before = bodies.copy(), levers()
        for body in bodies:
            put_vector(body, "", vector(body) + 10.0 * rng.normal(size=3))
        interpreted(midpoint_geometry.make_stay(spec))(
            records(contacts)[0], records(bodies), records(poses)
        )
        after = levers()
        np.testing.assert_allclose(after[1], before[1], atol=1e-13)
        kept = bool(np.allclose(after[0], before[0], atol=1e-13))
        assert kept == ((apart or not lasts) and not joined)
