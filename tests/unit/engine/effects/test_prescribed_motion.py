"""Bodies whose motion is a function of time stand where it says, at every step: closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from laboratory import Bench, body, config, resolved

from lavendersim.engine.spec import Spec
from lavendersim.scene.events import EventQueue

MOVED = ("kinematic", "pose_log", "prescribed_motion", "rotation", "step_log")
# Contacts meet the mean velocity of the step, or those of its two ends.
SPECS = {
    "mean": Spec(effects=MOVED),
    "ends": Spec(effects=tuple(sorted((*MOVED, "midpoint", "contact_midpoint")))),
}
PLACE = (0.3, -0.2, 1.0)  # [m]
OMEGA = 2.0 * math.pi * 1.5  # [rad/s]
SINE = {"kind": "sine", "frequency": 1.5}
ROUNDING = 2.2e-16


def bench(motion: list[dict[str, Any]], law: str, steps: int = 240, **properties: Any) -> Bench:
    """Return a kinematic ball that moves so, at so many steps a second."""
    shape = {"kind": "sphere", "radius": 0.1}
    moved = body(shape, PLACE, kinematic=True, motion=motion, **properties)
    return Bench(resolved({"one": moved}, timestep=f"1/{steps}"), SPECS[law])


def times(steps: int, seconds: int = 2) -> np.ndarray:
    return np.arange(steps * seconds + 1) / steps


@pytest.fixture(params=SPECS)
def law(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.mark.parametrize("steps", [30, 240])
def test_a_shaken_table_stands_at_its_sine_at_every_step(law: str, steps: int) -> None:
    shakes = [
        {"displacement": [0.02, 0.0, 0.0], "factor": SINE},
        {"displacement": [0.0, 0.01, 0.0], "factor": {**SINE, "phase_degrees": 90.0}},
    ]
    rows = bench(shakes, law, steps).run(2 * steps)
    t = times(steps)
    expected = PLACE + np.column_stack(
        [0.02 * np.sin(OMEGA * t), 0.01 * (np.cos(OMEGA * t) - 1.0), 0.0 * t]
    )
    # One rounding of the place, one of the angle, up to 19 rad.
    np.testing.assert_allclose(rows.pose[:, 0, :3], expected, atol=2 * ROUNDING * 19 * 0.02)


def test_a_drum_stands_at_its_angle_at_every_step(law: str) -> None:
    """Ten turns and more, about an axis off the world's; the first orientation is kept."""
    start = np.array([0.5, 0.5, -0.5, 0.5])
    axis = np.array([0.0, 0.6, 0.8])
    turn = {"turn": [0.0, 0.6, 0.8], "factor": {"kind": "ramp", "rate": 40.0}}
    rows = bench([turn], law, orientation=tuple(start)).run(480)
    half = 0.5 * 40.0 * times(240)
    w, (x, y, z) = np.cos(half), np.sin(half) * axis[:, None]
    a, b, c, d = start
    expected = np.column_stack([
        w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
        w * c + y * a + z * b - x * d, w * d + z * a + x * c - y * b,
    ])  # fmt: skip
    # An angle of 40 rad, rounded.
    np.testing.assert_allclose(rows.pose[:, 0, 3:], expected, atol=4 * ROUNDING * 40)
    np.testing.assert_allclose(rows.pose[:, 0, :3], np.tile(PLACE, (481, 1)), atol=0)


def test_a_pendulum_drive_swings_about_its_pivot_and_is_carried_along(law: str) -> None:
    pivot = np.array([0.3, -0.2, 1.5])  # half a metre above it
    motion = [
        {"displacement": [0.0, 0.4, 0.0], "factor": {"kind": "ramp"}},
        {"turn": [0.0, 0.7, 0.0], "through": list(pivot), "factor": SINE},
    ]
    rows = bench(motion, law).run(480)
    t = times(240)
    angle = 0.7 * np.sin(OMEGA * t)
    # The arm (0, 0, -1/2) turned about y by an angle.
    expected = pivot + np.column_stack([-0.5 * np.sin(angle), 0.4 * t, -0.5 * np.cos(angle)])
    np.testing.assert_allclose(rows.pose[:, 0, :3], expected, atol=40 * ROUNDING)
    np.testing.assert_allclose(rows.pose[:, 0, 5], np.sin(0.5 * angle), atol=40 * ROUNDING)


TABLE = {"kind": "table", "times": [0.1, 0.4033, 0.9, 1.5], "values": [0.5, -1.0, 2.0, 2.0]}


def test_a_table_is_linear_between_its_entries(law: str) -> None:
    rows = bench([{"displacement": [0.1, 0.0, 0.0], "factor": TABLE}], law).run(480)
    expected = 0.3 + 0.1 * (np.interp(times(240), TABLE["times"], TABLE["values"]) - 0.5)
    np.testing.assert_allclose(rows.pose[:, 0, 0], expected, atol=4 * ROUNDING)


def test_a_body_stands_where_it_should_when_the_timestep_changes(law: str) -> None:
    one = bench([{"displacement": [0.02, 0.0, 0.0], "factor": SINE}], law, 100)
    one.cell["events"] = [{"at": 0.2, "timestep": "1/70"}, {"at": 0.5, "timestep": "1/300"}]
    one = Bench(one.cell, SPECS[law])
    queue = EventQueue(one.engine, one.scene, config(one.cell).events)
    for done in range(160):
        queue.apply_due(done)
        one.run(1)
        expected = 0.3 + 0.02 * math.sin(OMEGA * float(one.scene.clock.time(done + 1)))
        assert one.engine.bodies["x"][0] == pytest.approx(expected, abs=4 * ROUNDING)


def test_the_mean_velocity_of_a_step_is_its_displacement() -> None:
    motion = [
        {"displacement": [0.02, 0.01, 0.0], "factor": SINE},
        {"turn": [0.0, 0.0, 0.9], "through": [0.0, 0.0, 0.0], "factor": TABLE},
    ]
    one = bench(motion, "mean")
    for _ in range(240):
        before = one.engine.bodies[0].copy()
        one.run(1)
        after = one.engine.bodies[0]
        moved = [float(after[k] - before[k]) for k in "xyz"]
        np.testing.assert_allclose(one.velocity[0] / 240, moved, atol=4 * ROUNDING)
        # Cayley's map: a turn by an angle is of tan(angle/2), about z here.
        angle = 2.0 * (
            math.atan2(after["qz"], after["qw"]) - math.atan2(before["qz"], before["qw"])
        )
        spin = 2.0 * 240 * math.tan(0.5 * angle)
        assert one.spin[0, 2] == pytest.approx(spin, abs=240 * 40 * ROUNDING)


def test_the_velocities_of_the_ends_of_a_step_lead_through_it_without_a_jump() -> None:
    """Their mean misses the displacement by h^5/120 of the fifth derivative, at the most."""
    sine = {**SINE, "offset": 3.0}
    motion = [
        {"displacement": [0.02, 0.0, 0.0], "factor": SINE},
        {"turn": [0.0, 0.0, 0.9], "through": [0.0, 0.0, 0.0], "factor": sine},
    ]
    for steps in (60, 240):
        one, last = bench(motion, "ends", steps), None
        gaps, angles = [], []
        for step in range(steps):
            before = one.engine.bodies[0].copy()
            one.run(1)
            after, start = one.engine.bodies[0], one.engine.state.motion[0]
            begin = np.array([start[k] for k in ("vx", "vy", "vz", "wz")])
            end = np.array([*one.velocity[0], one.spin[0, 2]])
            if last is not None:
                # Angles of 10 rad, rounded, times accelerations of some 80 m/s^2.
                np.testing.assert_allclose(begin, last, atol=1e-12)
            rate = OMEGA * math.cos(OMEGA * step / steps)
            assert begin[3] == pytest.approx(0.9 * rate, abs=9.0 * OMEGA * (OMEGA / steps) ** 2)
            last, mean = end, 0.5 * (begin + end) / steps
            gaps += [abs(float(after[k] - before[k]) - mean[i]) for i, k in enumerate("xyz")]
            angle = math.atan2(after["qz"], after["qw"]) - math.atan2(before["qz"], before["qw"])
            angles.append(abs(2.0 * math.tan(angle) - mean[3]))
        # x = R (cos, sin)(0.9 sin w t), R = 0.36 m: its fifth derivative is below R times the fifth
        # complete Bell polynomial of rates of at most w^k, which is 52 w^5.
        most = 52.0 * OMEGA**5 / 120.0 / steps**5
        assert 1e-14 < max(gaps) < 0.36 * most + 1e-14
        assert max(angles) < most + 1e-14


def test_what_is_removed_moves_no_more(law: str) -> None:
    one = bench([{"displacement": [0.1, 0.0, 0.0], "factor": {"kind": "ramp"}}], law)
    one.run(24)
    one.engine.remove(0)
    one.run(24)
    assert one.engine.bodies["x"][0] == pytest.approx(0.3 + 0.1 * 0.1, abs=4 * ROUNDING)
