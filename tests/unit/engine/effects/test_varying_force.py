"""Forces over time, at points and in the body's frame, on free bodies: closed forms and orders."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from laboratory import Bench, body, config, resolved

from lavendersim.engine.spec import Spec
from lavendersim.scene.events import EventQueue

FREE = ("gyroscopic", "midpoint", "pose_log", "rotation", "step_log", "varying_force")
SPEC = Spec(effects=FREE)
BALL = {"kind": "sphere", "radius": 0.1}
BRICK = {"kind": "box", "size": [0.2, 0.3, 0.5]}
MASS = 2.0
ROUNDING = 2.2e-16


def force(**given: Any) -> dict[str, Any]:
    zero = [0.0, 0.0, 0.0]
    return {"body": "one", "from": 0.0, "to": 9.0, "force": zero, "torque": zero, **given}


def bench(
    forces: list[dict[str, Any]], steps: int = 240, shape: Any = BALL, **properties: Any
) -> Bench:
    """Return a body of 2 kg in free flight, at so many steps a second."""
    made = resolved({"one": body(shape, mass=MASS, **properties)}, timestep=f"1/{steps}")
    made["scene"]["forces"] = forces
    made["duration"] = 9.0
    return Bench(made, SPEC)


def orders(errors: list[float]) -> list[float]:
    return [math.log2(one / other) for one, other in itertools.pairwise(errors)]


# What a force of 3 N along x leaves of speed after t, over its acceleration of 1.5 m/s^2 [s]:
# the integrals of its factor.
OMEGA = 2.0 * math.pi * 0.7
FUNCTIONS = {
    "sine": (
        {"kind": "sine", "frequency": 0.7, "phase_degrees": 30.0, "amplitude": 2.0, "offset": 0.5},
        lambda t: (
            2.0 * (math.cos(math.pi / 6.0) - math.cos(OMEGA * t + math.pi / 6.0)) / OMEGA + 0.5 * t
        ),
    ),
    "ramp": (
        {"kind": "ramp", "rate": 4.0, "from": 0.111, "to": 0.777},
        lambda t: 2.0 * max(min(t, 0.777) - 0.111, 0.0) ** 2 + 4.0 * 0.666 * max(t - 0.777, 0.0),
    ),
    "ramp without an end": (
        {"kind": "ramp", "from": 0.25},
        lambda t: 0.5 * max(t - 0.25, 0.0) ** 2,
    ),
    "pulse": ({"kind": "pulse", "from": 0.1, "to": 0.6}, lambda t: min(max(t - 0.1, 0.0), 0.5)),
    "pulse of a tenth of a step": (
        {"kind": "pulse", "from": 0.5012, "to": 0.5016},
        lambda t: min(max(t - 0.5012, 0.0), 0.0004),
    ),
    "table": (
        {"kind": "table", "times": [0.2, 0.2013, 0.9], "values": [-1.0, 3.0, 1.0]},
        # A trapezoid before each entry, and its first and last value beyond them.
        lambda t: (
            -min(t, 0.2)
            + trapezoid(-1.0, 3.0, 0.2, 0.2013, t)
            + trapezoid(3.0, 1.0, 0.2013, 0.9, t)
            + max(t - 0.9, 0.0)
        ),
    ),
}


def trapezoid(one: float, other: float, begin: float, end: float, t: float) -> float:
    share = min(max((t - begin) / (end - begin), 0.0), 1.0)
    return (end - begin) * share * (one + 0.5 * share * (other - one))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_impulses_are_integrals_of_the_force_at_every_step(name: str) -> None:
    """At any timestep, and whatever lies within a step."""
    factor, integral = FUNCTIONS[name]
    for steps in (40, 240):
        one = bench([force(force=[3.0, 0.0, 0.0], factor=factor)], steps)
        rows = one.run(steps)
        times = np.arange(1, steps + 1) / steps
        expected = 3.0 * np.array([integral(t) for t in times])
        # A rounding of each sum and of each mean, of impulses of at most 4 N s.
        np.testing.assert_allclose(rows.step["momentum_x"][1:], expected, atol=steps * 2e-15)
        assert rows.step["force_impulse_x"].sum() == pytest.approx(expected[-1], abs=1e-12)
        assert not rows.step["momentum_y"].any()


def test_impulses_of_a_late_step_keep_their_digits() -> None:
    """Times are counted in steps: 0.1 s after 1,000 s is no sum of 24,024 roundings."""
    factor = {"kind": "pulse", "from": 1000.0, "to": 1000.5}
    one = bench([force(force=[3.0, 0.0, 0.0], factor=factor, to=2000.0)])
    one.engine.counters["step"] = 240_000
    one.run(24)
    # The begin of a step is known to half an ulp of 1,000 s.
    assert one.velocity[0, 0] == pytest.approx(1.5 * 0.1, abs=24 * 1.2e-13)


def test_what_is_from_and_to_acts_in_whole_steps() -> None:
    """As constant forces do: from the first step that starts then."""
    one = bench([force(force=[3.0, 0, 0], point=[0, 0, 0.05], **{"from": 0.11, "to": 0.29})], 10)
    rows = one.run(10)
    pushes = rows.step["force_impulse_x"][1:] > 0.0
    assert [k for k in range(10) if pushes[k]] == [2]


def test_a_timestep_may_change_while_a_force_varies() -> None:
    factor, integral = FUNCTIONS["sine"]
    one = bench([force(force=[3.0, 0, 0], factor=factor)], 100)
    cell = one.cell
    cell["events"] = [{"at": 0.2, "timestep": "1/70"}, {"at": 0.5, "timestep": "1/300"}]
    one = Bench(cell, SPEC)
    clock = one.scene.clock
    queue = EventQueue(one.engine, one.scene, config(cell).events)
    for done in range(160):
        queue.apply_due(done)
        one.run(1)
        expected = 1.5 * integral(float(clock.time(done + 1)))
        assert one.velocity[0, 0] == pytest.approx(expected, abs=160 * 1e-15)


def test_places_are_of_second_order() -> None:
    """x of F sin(w t)/m from rest: F/(m w) (t - sin(w t)/w)."""
    w = 2.0 * math.pi
    exact = 1.5 / w  # at 1 s
    errors = []
    for steps in (20, 40, 80, 160):
        given = force(force=[3.0, 0, 0], factor={"kind": "sine", "frequency": 1.0})
        one = bench([given, force(force=[0, 3.0, 0], factor={"kind": "ramp"})], steps)
        one.run(steps)
        # Of the sine the error over a whole period cancels; a ramp of 1/s has t^3/6.
        assert one.engine.bodies["x"][0] == pytest.approx(exact, rel=0.1)
        errors.append(abs(one.engine.bodies["y"][0] - 1.5 / 6.0))
    assert orders(errors) == pytest.approx([2.0, 2.0, 2.0], abs=0.02)


def test_a_force_of_the_body_turns_with_it_at_second_order() -> None:
    """F R(w t) x / m: v = F/(m w) (sin w t, 1 - cos w t, 0)."""
    w, errors = 3.0, []
    exact = 1.5 / w * np.array([math.sin(w), 1.0 - math.cos(w), 0.0])
    for steps in (20, 40, 80, 160):
        given = force(force=[3.0, 0, 0], frame="body")
        one = bench([given], steps, angular_velocity=(0, 0, w))
        one.run(steps)
        errors.append(float(np.abs(one.velocity[0] - exact).max()))
    # Cayley's map turns by 2 atan(w h/2): the next term is of size (w h)^2 = 0.02 at the coarsest.
    assert orders(errors) == pytest.approx([2.0, 2.0, 2.0], abs=0.03)


def test_a_thruster_turns_a_body_about_its_axis_exactly() -> None:
    """Lever 0.1 m, 2 N across: 0.2 N m at all times, spin T t/I to round-off."""
    given = force(force=[0, 2.0, 0], point=[0.1, 0, 0], frame="body")
    one = bench([given], shape=BRICK)
    one.run(240)
    moment = one.cell["scene"]["bodies"]["one"]["inertia"][2]
    # The force is taken where the body is half way by its spin before the step, in whatever
    # direction: lever and force turn alike, and so their product does not.
    assert one.spin[0, 2] == pytest.approx(0.2 / moment, rel=240 * 4 * ROUNDING)


def tumbling(steps: int) -> Bench:
    """A brick tumbles while a force of its own, another of the world and a torque act on it."""
    forces = [
        force(force=[0.7, -0.3, 0.4], point=[0.05, 0.1, -0.2], frame="body"),
        force(force=[1.0, 2.0, -0.5], point=[-0.1, 0.05, 0.2]),
        force(torque=[0.02, 0.0, 0.05], factor={"kind": "sine", "frequency": 1.3}),
        force(torque=[0.0, 0.03, 0.01], frame="body", factor={"kind": "ramp", "rate": 2.0}),
    ]
    one = bench(forces, steps, BRICK, angular_velocity=(1.0, 2.0, -1.5), velocity=(0.1, 0, 0))
    one.run(steps)
    return one


def test_a_brick_tumbles_at_second_order() -> None:
    """By the differences between halved steps: a limit is approached, at a quarter each time."""
    ends = []
    for steps in (80, 160, 320, 640):
        one = tumbling(steps)
        state = [*one.velocity[0], *one.spin[0]]
        ends.append(np.array(state + [float(one.engine.bodies[0][k]) for k in ("x", "qw", "qx")]))
    changes = [one - other for one, other in itertools.pairwise(ends)]
    found = orders([float(np.linalg.norm(change)) for change in changes])
    assert found == pytest.approx([2.0, 2.0], abs=0.15)


def test_work_is_what_the_kinetic_energy_gains() -> None:
    """Of a round body to round-off, with a lever and a torque, whatever the timestep."""
    forces = [
        force(force=[3.0, 1.0, 0.0], point=[0.0, 0.02, 0.08], factor=FUNCTIONS["sine"][0]),
        force(torque=[0.0, 0.01, 0.02], frame="body"),
    ]
    for steps in (20, 240):
        one = bench(forces, steps, angular_velocity=(3.0, -2.0, 1.0), velocity=(1.0, 0, 0))
        rows = one.run(steps)
        gained = np.diff(rows.step["kinetic_energy"])
        # Products of a speed, 3 m/s, and of an impulse, each a few roundings of some 10 J.
        np.testing.assert_allclose(rows.step["force_work"][1:], gained, atol=10.0 * 20 * ROUNDING)
        assert np.abs(gained).max() > 1e-3


def test_a_weight_at_a_point_keeps_the_energy_of_its_pendulum() -> None:
    """A constant force on a point has a potential, -F . (x + r): at second order in the step."""
    drifts = []
    for steps in (60, 120, 240):
        given = force(force=[0, 0, -4.0], point=[0.1, 0, 0.05])
        one = bench([given], steps, BRICK, angular_velocity=(0, 1.0, 0))
        rows = one.run(2 * steps)
        work = np.cumsum(rows.step["force_work"])
        q, place = rows.pose[:, 0, 3:], rows.pose[:, 0, 2]
        lever = np.array([2.0 * (q[:, 1] * q[:, 3] - q[:, 0] * q[:, 2]),
                          1.0 - 2.0 * (q[:, 1] ** 2 + q[:, 2] ** 2)])  # fmt: skip
        height = place + lever.T @ np.array([0.1, 0.05])
        energy = rows.step["kinetic_energy"] + 4.0 * height
        drifts.append(float(np.abs(energy - energy[0]).max()))
        # What the log calls work is what the energy gained, to the same order.
        missed = np.abs(rows.step["kinetic_energy"] - rows.step["kinetic_energy"][0] - work)
        assert missed.max() <= 2.0 * drifts[-1]
    assert orders(drifts) == pytest.approx([2.0, 2.0], abs=0.2)
