"""Newton's method in the `adaptive` solver: what sweeps alone do not reach, against closed forms.

In every scene sweeps alone converge so slowly that the solver itself turns to Newton's method; the
numbers come from statics and from rigid bodies that slide as one.
"""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, resolved

G, DT, MU = 9.81, 1.0 / 240.0, 0.5
TOLERANCE = 1e-9
EDGE = 0.2


def tower(count, heavy=1.0, **top):
    """Cubes on each other; the highest has the mass `heavy`."""
    bodies = {"floor": plane(friction=MU)}
    for k in range(count):
        place = (0.0, 0.0, EDGE * (k + 0.5))
        mass = heavy if k == count - 1 else 1.0
        bodies[f"cube_{k}"] = box((EDGE,) * 3, place, mass=mass, friction=MU, **top)
    return bodies


def bench(bodies, gravity=(0.0, 0.0, -G), solver="adaptive", cone="disc"):
    return Bench(
        resolved(
            bodies,
            gravity,
            solver=solver,
            sweeps=50,
            tolerance=TOLERANCE,
            slop=1e-7,
            speculative=True,
            friction_cone=cone,
        ),
        spec=None,
    )


def on_floor(rows):
    """Sum of the floor's impulses [N s]."""
    contacts = rows.contact
    return float(contacts["impulse_n"][np.abs(contacts["z"]) < 1e-6].sum())


@pytest.mark.parametrize(("count", "heavy"), [(40, 1.0), (100, 1.0), (2, 1e4), (5, 1e4)])
def test_the_first_step_carries_the_whole_weight(count, heavy):
    """The floor's impulse stops the whole weight's fall of one step, m g dt. Each of the floor's
    four contacts may miss by the tolerance, and the mass above answers all of it.
    """
    found = bench(tower(count, heavy))
    rows = found.run(1)
    total = count - 1 + heavy
    assert rows.step["unsolved"][-1] == 0
    assert int(found.engine.counters["newton_steps"][0]) > 0
    assert rows.step["residual"][-1] <= TOLERANCE
    assert on_floor(rows) == pytest.approx(total * G * DT, abs=4 * total * TOLERANCE)
    # nothing moves faster than what the rows of a whole tower may each be off by
    assert np.abs(found.velocity).max() <= count * TOLERANCE


def test_what_slides_under_a_heavy_load_is_not_lifted():
    """Ten thousand times its mass on it, a plate slides with it: both lose mu g dt, and stay down.
    A convex cone alone, without De Saxce's shift, would lift them at mu |v_t|. Velocities are right
    to what the step says of itself, over some ten rows.
    """
    size, speed = (0.6, 0.6, 0.1), {"velocity": (1.0, 0.0, 0.0), "friction": MU}
    bodies = {
        "floor": plane(friction=MU),
        "low": box(size, (0, 0, 0.05), **speed),
        "high": box(size, (0, 0, 0.15), mass=1e4, **speed),
    }
    found = bench(bodies)
    rows = found.run(1)
    assert int(found.engine.counters["newton_steps"][0]) > 0
    assert rows.step["residual"][-1] <= 10 * TOLERANCE
    allowed = 10 * rows.step["residual"][-1]
    np.testing.assert_allclose(found.velocity[1:, 0], 1.0 - MU * G * DT, atol=allowed)
    np.testing.assert_allclose(found.velocity[1:, 2], 0.0, atol=allowed)


@pytest.mark.parametrize("azimuth", [0.0, 0.3, 1.1])
def test_a_slope_shares_the_load_between_stick_and_slide(azimuth):
    """A heavy cube on a light one on a slope of 0.4 < mu stays, on one of 0.6 it slides down with
    (sin - mu cos) g, whatever the direction; low cubes do not tip.
    """
    for slope, slides in ((0.4, False), (0.6, True)):
        angle = np.arctan(slope)
        down = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        gravity = G * (np.sin(angle) * down - np.cos(angle) * np.array([0.0, 0.0, 1.0]))
        bodies = {
            "floor": plane(friction=MU),
            "low": box((0.6, 0.6, 0.1), (0, 0, 0.05), friction=MU),
            "high": box((0.6, 0.6, 0.1), (0, 0, 0.15), mass=1e4, friction=10.0),
        }
        found = bench(bodies, gravity)
        rows = found.run(3)
        assert (rows.step["unsolved"][1:] == 0).all()
        gained = 3 * DT * G * (np.sin(angle) - MU * np.cos(angle)) if slides else 0.0
        np.testing.assert_allclose(found.velocity[1:], gained * np.array([down] * 2), atol=1e-7)


def test_the_pyramid_for_study_is_left_to_sweeps():
    found = bench(tower(10), cone="pyramid")
    found.run(1)
    assert int(found.engine.counters["newton_steps"][0]) == 0


def test_equal_runs_take_equal_steps():
    """Costs are counted in operations, never in time."""
    one, two = bench(tower(30)), bench(tower(30))
    a, b = one.run(20), two.run(20)
    assert a.step["state_hash"].tolist() == b.step["state_hash"].tolist()
    assert one.engine.counters["newton_steps"] == two.engine.counters["newton_steps"]
