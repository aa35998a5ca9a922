"""What the projection leaves alone: contacts on springs; and how springs carry what they turn."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted
from interpreted_steps import Steps
from laboratory import plane, resolved, sphere
from plain_facts import one_row, vector_fields

from lavendersim.engine.effects.projection import make_mean_velocity
from lavendersim.engine.integrate import ALWAYS, LASTING
from lavendersim.engine.spec import Spec

RADIUS, DEPTH, SLOP, SHARE = 0.1, 1e-3, 1e-4, 0.2


def test_what_rests_where_its_spring_holds_it_is_not_moved_out() -> None:
    """Beside it a ball of the same depth is, by its share; nothing pulls, and nothing moves."""
    floor = {"floor": plane()}
    balls = {
        name: sphere(RADIUS, (x, 0.0, RADIUS - DEPTH), **surface)
        for name, x, surface in (("hard", 0.0, {}), ("soft", 1.0, {"compliance": 1e-2}))
    }
    numerics = {"integrator": "midpoint_contact", "timestep": 0.01, "projection": SHARE}
    numerics["compliance_law"] = "spring"
    steps = Steps(resolved(floor | balls, slop=SLOP, projection_sweeps=50, **numerics))
    assert steps.spec.has("contact_spring")
    speed = steps.velocities
    steps.run(1)
    moved = steps.places[1:, 2] - (RADIUS - DEPTH)
    assert not speed.any()
    assert moved[0] == pytest.approx(SHARE * (DEPTH - SLOP), rel=1e-9)
    # The spring throws its ball out at the speed that it then has, and by no more.
    assert moved[1] == pytest.approx(0.5 * 0.01 * steps.velocities[2, 2], rel=1e-9)


@pytest.mark.parametrize(("carried", "late"), [(0, 0.5), (LASTING, 0.5), (ALWAYS, 1.0)])
@pytest.mark.parametrize("sprung", [0, 1])
def test_a_body_is_carried_by_the_mean_or_by_its_new_velocity(carried, late, sprung, rng) -> None:
    """What flies and is turned by springs goes by the mean spin that they found."""
    spec = Spec(("contact_torque", "rotation", "midpoint", "spring"))
    old, new, turn = rng.normal(size=(3, 2, 3))
    body = one_row(sprung=sprung, **vector_fields("turn_", turn[1]))
    rows = [one_row(**vector_fields("v", u), **vector_fields("w", w)) for u, w in (new, old)]
    motion = one_row(carried=carried, **vector_fields("v", old[0]), **vector_fields("w", old[1]))
    out = one_row(**vector_fields("v", np.zeros(3)), **vector_fields("w", np.zeros(3)))
    interpreted(make_mean_velocity(spec))(body, rows[0], motion, out)
    found = [[out[f"{name}{axis}"] for axis in "xyz"] for name in "vw"]
    expected = old + late * (new - old)
    if sprung and carried == 0:
        expected[1] = turn[1]
    np.testing.assert_allclose(found, expected, atol=1e-15)
