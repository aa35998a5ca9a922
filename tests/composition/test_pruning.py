"""An engine without an effect equals one with it at coefficient zero; its columns are gone."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import EVERYTHING, Bench, box, plane, planned, resolved, sphere

GRAVITY = (0.0, 0.0, -9.81)
STEPS = 48  # 0.2 s: what falls has landed
# Effects that a coefficient of zero must switch off without a trace.
COEFFICIENTS = ("compliance", "restitution", "stabilisation", "projection")


def spheres():
    bodies = {
        "floor": plane(),
        "low": sphere(0.1, (0.0, 0.0, 0.1)),
        "high": sphere(0.1, (0.02, 0.01, 0.4), velocity=(0.0, 0.0, -1.0)),
    }
    return resolved(bodies, GRAVITY)


def boxes():
    bodies = {
        "floor": plane(),
        "low": box((0.5, 0.4, 0.3), (0.0, 0.0, 0.15), orientation=(1.0, 0.001, 0.002, 0.1)),
        "high": box((0.3, 0.4, 0.3), (0.05, 0.02, 0.5), velocity=(0.0, 0.1, -1.0)),
    }
    return resolved(bodies, GRAVITY)


def test_frictionless_spheres_have_no_rotation_at_all():
    bench = Bench(spheres(), spec=None)
    assert bench.spec.effects == (
        *("contact_log", "frictionless_contact", "gravity", "pose_log", "residual_log", "step_log"),
        "warm_start",
    )
    assert bench.engine.velocities.dtype.names == ("vx", "vy", "vz")
    assert not {"qw", "inv_ix", "r00"} & set(bench.engine.bodies.dtype.names)
    assert not {"lever_ax", "turn_ax", "gamma", "push"} & set(bench.engine.contacts.dtype.names)


@pytest.mark.parametrize("scene", [spheres, boxes])
def test_coefficients_of_zero_change_no_bit(scene):
    """The plan's own effects against the same plus four whose coefficients are all zero."""
    cell = scene()
    lean = planned(cell).spec.including("residual_log")._replace(tolerance=True)
    full = lean._replace(effects=tuple(sorted({*lean.effects, *COEFFICIENTS})))
    assert not set(lean.effects) & set(COEFFICIENTS)
    one, other = (interpreted_bench(cell, spec).run(STEPS) for spec in (lean, full))
    assert one.contact.tobytes() == other.contact.tobytes()
    assert one.pose.tobytes() == other.pose.tobytes()
    assert one.residual.tobytes() == other.residual.tobytes()
    for name in one.step.dtype.names:
        np.testing.assert_array_equal(one.step[name], other.step[name])


def test_rotation_that_nothing_excites_is_none():
    """Every normal of a ball passes through its centre, so nothing turns it, to the bit."""
    cell = spheres()
    lean, full = interpreted_bench(cell), interpreted_bench(cell, EVERYTHING)
    one, other = lean.run(STEPS), full.run(STEPS)
    assert len(one.contact) > STEPS
    np.testing.assert_array_equal(one.pose, other.pose)
    np.testing.assert_array_equal(one.step["state_hash"], other.step["state_hash"])
    assert (full.spin == 0.0).all()


def test_every_effect_has_a_reason_in_the_scenes_own_words():
    for cell in (spheres(), boxes()):
        decisions = planned(cell).decisions
        assert all(decision.reason for decision in decisions.values())
        assert "0" in decisions["compliance"].reason
