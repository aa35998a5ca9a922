"""Steps that cannot be made: nothing has moved, and who was woken is awake when they are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted_steps import Steps
from laboratory import box, plane, resolved, sphere

from lavendersim.engine.records import (
    DIVERGED,
    INACCURATE,
    NOT_FINITE,
    ROWS_FULL,
    RUNNING,
    TURNS_TOO_FAST,
    WOKEN,
)

RADIUS, STEP = 0.1, 0.01
NUMERICS: dict[str, Any] = {"timestep": STEP, "tolerance": 1e-12, "sweeps": 500}


@pytest.mark.parametrize("integrator", ["semi_implicit_euler", "midpoint"])
def test_contacts_without_room_in_the_log_end_the_call_before_the_step(integrator: str) -> None:
    """As many rows are left as the step has contacts, and one less."""
    bodies = {
        "floor": plane(),
        "one": sphere(RADIUS, (0.0, 0.0, RADIUS)),
        "two": sphere(RADIUS, (1.0, 0.0, RADIUS)),
    }
    for left, status in ((2, RUNNING), (1, ROWS_FULL)):
        steps = Steps(resolved(bodies, (0.0, 0.0, -10.0), integrator=integrator, **NUMERICS))
        engine = steps.engine
        engine.counters["contact_rows"] = len(engine.log.contact) - left
        before = engine.bodies.tobytes() + engine.velocities.tobytes()
        assert steps.advance(1) == status
        assert steps.counters.step == int(status == RUNNING)
        if status == ROWS_FULL:
            assert engine.bodies.tobytes() + engine.velocities.tobytes() == before


def test_who_is_hit_wakes_before_the_step_that_is_then_made() -> None:
    bodies = {
        "asleep": sphere(RADIUS, (0.0, 0.0, 0.0)),
        "comes": sphere(RADIUS, (0.2, 0.0, 0.0), velocity=(-1.0, 0.0, 0.0)),
    }
    steps = Steps(resolved(bodies, sleeping=True, **NUMERICS))
    rows = steps.engine.bodies
    rows["asleep"][0], rows["own_inv_m"][0], rows["inv_m"][0] = 1, 1.0, 0.0
    assert steps.advance(1) == WOKEN
    assert (rows["asleep"].tolist(), rows["inv_m"].tolist()) == ([0, 0], [1.0, 1.0])
    assert (steps.counters.step, steps.velocities[1, 0]) == (0, -1.0)
    steps.run(1)
    # A plastic impact of two equal masses.
    np.testing.assert_allclose(steps.velocities[:, 0], -0.5, atol=1e-12)


@pytest.mark.parametrize("cause", [NOT_FINITE, TURNS_TOO_FAST])
def test_the_body_that_is_lost_is_named_with_its_cause_though_the_substep_is_taken_back(
    cause: int,
) -> None:
    """The first of two: a spin whose Newton solve has no end, or a place that is no number."""
    bodies = {"lost": box((0.1, 0.2, 0.4), (0, 0, 0)), "other": sphere(0.1, (5.0, 0, 0))}
    numerics = {"accuracy": 1e-5, "smallest_timestep": 0.01, "integrator": "midpoint_contact"}
    steps = Steps(resolved(bodies, timestep=0.05, impacts="in_order", **numerics))
    if cause == NOT_FINITE:
        steps.engine.velocities["vx"][0] = np.nan
    else:
        for axis, spin in zip("xyz", (1e4, 2e4, 100.0), strict=True):  # radians in the shortest
            steps.engine.velocities[f"w{axis}"][0] = spin
    steps.counters.body, steps.counters.cause = 1, INACCURATE  # of a run before
    assert steps.advance(1) == DIVERGED
    assert (steps.counters.body, steps.counters.cause) == (0, cause)
