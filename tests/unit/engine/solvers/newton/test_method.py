"""Newton's method in the `adaptive` solver: what sweeps alone do not reach, against closed forms.

In every scene sweeps alone converge so slowly that the solver itself turns to Newton's method; the
numbers come from statics and from rigid bodies that slide as one.
"""

from __future__ import annotations

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, box, plane, planned, resolved

from lavendersim.engine.solvers.newton.response import update_shift

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
    """A scene, with the disc on a plan that all scenes here share: it is compiled once. What it has
    beside what a scene requires is idle there (tests/composition). Without it it is interpreted.
    """
    cell = resolved(
        bodies,
        gravity,
        solver=solver,
        sweeps=50,
        tolerance=TOLERANCE,
        slop=1e-7,
        speculative=True,
        friction_cone=cone,
    )
    spec = planned(cell).spec
    if cone != "disc":
        return interpreted_bench(cell, spec)
    shared = spec.including("broad_phase", "fast_bodies", "gyroscopic")
    return Bench(cell, shared._replace(shape_pairs=("box_box", "box_plane")))


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
    assert rows.step["not_converged"][-1] == 0
    assert int(found.engine.counters["newton_steps"][0]) > 0
    assert rows.step["residual"][-1] <= TOLERANCE
    assert on_floor(rows) == pytest.approx(total * G * DT, abs=4 * total * TOLERANCE)
    # nothing moves faster than what the rows of a whole tower may each be off by
    assert np.abs(found.velocity).max() <= count * TOLERANCE


def test_a_cold_step_that_would_not_converge_has_a_last_call():
    """Fifty flat bricks, four redundant contacts on each: the allowance that the sweeps' promise
    gives Newton's method ends before its rounds do. The last call comes two sweeps before the end,
    and nothing is left to the steps that follow; what a brick may still move at is as above.
    """
    bodies = {"floor": plane(friction=MU)}
    for k in range(50):
        bodies[f"brick_{k}"] = box((0.2, 0.2, 0.1), (0.0, 0.0, 0.1 * k + 0.05), friction=MU)
    found = bench(bodies)
    rows = found.run(1)
    assert rows.step["sweeps"][-1] > 48
    assert rows.step["not_converged"][-1] == 0
    assert on_floor(rows) == pytest.approx(50 * G * DT, abs=4 * 50 * TOLERANCE)
    assert np.abs(found.velocity).max() <= 50 * TOLERANCE


@pytest.mark.parametrize("share", [0.2, 0.5, 0.85])
def test_the_secant_ends_a_shift_that_closes_in_by_a_constant_factor(share):
    """Where slip answers the shift s with 1 + share s, the shift that it confirms is
    1/(1 - share); without the secant a share of the error is left by every round.
    """
    contact = np.zeros(1, np.dtype([(name, "f8") for name in ("shift", "defect", "shift_change")]))
    contact = contact.view(np.recarray)[0]
    end = 1.0 / (1.0 - share)
    for rounds in (1, 2):
        update_shift(contact, 1.0 + share * contact.shift, False)
        assert end - contact.shift == pytest.approx(share**rounds * end, rel=1e-14)
    update_shift(contact, 1.0 + share * contact.shift, True)
    assert contact.shift == pytest.approx(end, rel=1e-13)


def test_a_rod_that_jams_is_solved():
    """Painleve's rod, 20 degrees from upright, slides on mu = 1.5 with its low end ahead: a shift
    changes by more than half of its defect, and rounds alone leave 5e-4 m/s of 4 m/s.
    """
    half = np.radians(-10.0)
    turn = (np.cos(half), 0.0, np.sin(half), 0.0)
    low = 0.1 * np.cos(2 * half) + 0.002 * np.sin(-2 * half)
    rod = box((0.004, 0.1, 0.2), (0, 0, low), orientation=turn, velocity=(-4, 0, 0), friction=1.5)
    found = bench({"floor": plane(friction=1.5), "rod": rod})
    rows = found.run(30)
    assert rows.step["residual"].max() <= 1000 * TOLERANCE


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
        assert (rows.step["not_converged"][1:] == 0).all()
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
