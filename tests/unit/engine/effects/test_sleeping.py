"""Islands at rest are left out, to the bit, until something disturbs them.

A stack of three boxes beside a lone one, 0.1 s at rest before sleep. Every step is solved to
1e-10 m/s: boxes that start at rest are at rest from the first step on.
"""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, planned, resolved, sphere

from lavendersim.cell import CellEvent, CellGravity
from lavendersim.scene.events import BodyEvents, EventQueue

G, DT = 9.81, 1.0 / 240.0
SLEEP_TIME = 0.1
LOW, MIDDLE, HIGH, LONE, BALL, LIFT = range(1, 7)
EVENT = CellEvent(
    at=0.0, body="low", scale_mass=None, velocity=None, angular_velocity=None, teleport=None,
    contact_cache="keep", remove=False,
)  # fmt: skip


def happens(**changes) -> CellEvent:
    return EVENT.model_copy(update=changes)


def apply(bench: Bench, event: CellEvent) -> None:
    BodyEvents(bench.engine, bench.scene).apply(event)


def stack(ball=(50.0, 0.0, 50.0), velocity=(0.0, 0.0, 0.0), sleeping=True, **numerics) -> Bench:
    """Three boxes on the floor, a lone one 3 m off, a ball in flight and a kinematic lift."""
    size = (0.2, 0.2, 0.2)
    bodies = {
        "floor": plane(friction=0.5),
        "low": box(size, (0.0, 0.0, 0.1), friction=0.5),
        "middle": box(size, (0.0, 0.0, 0.3), friction=0.5),
        "high": box(size, (0.0, 0.0, 0.5), friction=0.5),
        "lone": box(size, (3.0, 0.0, 0.1), friction=0.5),
        "ball": sphere(0.1, ball, velocity=velocity, friction=0.5),
        "lift": box(size, (6.0, 0.0, 1.0), kinematic=True, friction=0.5),
    }
    numerics = {"sweeps": 2000, "tolerance": 1e-10, "sleep_time": SLEEP_TIME, **numerics}
    cell = resolved(bodies, (0.0, 0.0, -G), sleeping=sleeping, **numerics)
    # Every test pushes or not on one engine: the effect of forces is there, its forces are zero.
    spec = planned(cell).spec
    spec = spec._replace(effects=tuple(sorted({*spec.effects, "external_force"})))
    return Bench(cell, spec=spec)


def asleep(bench: Bench) -> list[int]:
    return np.flatnonzero(bench.engine.bodies["asleep"]).tolist()


def state(bench: Bench, rows: list[int]) -> bytes:
    names = ["x", "y", "z", "qw", "qx", "qy", "qz"]
    return bench.engine.bodies[rows][names].tobytes() + bench.engine.velocities[rows].tobytes()


def slept(**options) -> Bench:
    """Return a bench whose four boxes have just fallen asleep."""
    bench = stack(**options)
    bench.run(40)
    assert asleep(bench) == [LOW, MIDDLE, HIGH, LONE]
    return bench


def test_a_stack_sleeps_after_its_time_and_stays_equal_to_the_bit() -> None:
    bench = stack()
    # Rest counts from the first step: 24 steps of 1/240 s, and one for the rounding of their sum.
    rows = bench.run(30)
    awake = rows.step["awake"]
    assert awake[0] == 5  # four boxes and a ball
    first = int(np.argmax(awake < 5))
    assert first in (24, 25)
    assert (awake[first:] == 1).all()
    before = state(bench, [LOW, MIDDLE, HIGH, LONE])
    bench.run(200)
    assert state(bench, [LOW, MIDDLE, HIGH, LONE]) == before
    assert (bench.velocity[1:5] == 0.0).all()


def test_no_contact_of_sleepers_is_solved() -> None:
    rows = stack().run(60)
    counts, awake = rows.step["contact_count"], rows.step["awake"]
    assert (counts[1:10] == 16).all()  # four corners under each box
    asleep_before = np.flatnonzero(awake == 1)[1:]
    assert (counts[asleep_before] == 0).all()
    assert (rows.step["sweeps"][asleep_before] <= 1).all()


def test_falling_asleep_costs_no_potential_energy() -> None:
    """What sleeps still weighs; kinetic energy is lost, at most m (5 mm/s)^2 / 2 of each box."""
    bench = stack(ball=(50.0, 0.0, 0.1))  # a ball at rest too: nothing falls
    energy = bench.run(60).step["potential_energy"]
    np.testing.assert_allclose(energy, G * (0.1 + 0.3 + 0.5 + 0.1 + 0.1 + 0.0), rtol=1e-9)


@pytest.mark.parametrize("axis", range(3))
def test_who_wakes_turns_by_its_own_moment_about_each_axis(axis: int) -> None:
    """Lifted off the floor with a torque about one of its axes: w = tau t/I of its solid."""
    size = (0.1, 0.2, 0.3)  # [m], three moments of inertia
    bodies = {"floor": plane(), "block": box(size, (0.0, 0.0, 0.15))}
    cell = resolved(bodies, (0.0, 0.0, -G), sleeping=True, sleep_time=SLEEP_TIME)
    bench = Bench(cell, spec=stack().spec)
    bench.run(40)
    assert asleep(bench) == [1]
    block = bench.engine.bodies[1]
    moment = sum(edge**2 for i, edge in enumerate(size) if i != axis) / 12.0  # of 1 kg
    # 4 g up; corners, 0.19 m off the axis at most, go down by less: its contacts push no more.
    torque, steps = moment * G / 0.19, 10
    block["fz"], block["t" + "xyz"[axis]] = 5.0 * G, torque
    bench.run(steps)
    expected = np.zeros(3)
    expected[axis] = torque * steps * DT / moment
    # Ten sums, turned to the body's axes and back; the other moments differ from it by 0.3.
    np.testing.assert_allclose(bench.spin[1], expected, atol=1e-12 * expected[axis])


def test_a_ball_wakes_the_island_it_hits_and_no_other() -> None:
    # 40 steps to fall asleep, then 2 m at 10 m/s: it arrives after 48 steps.
    bench = slept(ball=(-2.5, 0.0, 0.9), velocity=(10.0, 0.0, 0.0))
    seen = set()
    for _ in range(40):
        bench.run(1)
        seen.add(tuple(asleep(bench)))
    assert seen == {(LOW, MIDDLE, HIGH, LONE), (LONE,)}
    assert np.abs(bench.velocity[HIGH]).max() > 0.1


def test_an_island_at_rest_again_sleeps_again() -> None:
    bench = slept()
    bench.engine.wake(MIDDLE)
    assert asleep(bench) == [LONE]
    bench.run(40)
    assert asleep(bench) == [LOW, MIDDLE, HIGH, LONE]


def test_what_stood_on_a_body_taken_away_falls() -> None:
    bench = slept()
    apply(bench, happens(body="low", teleport=(9.0, 0.0, 0.1)))
    bench.run(24)
    # 0.1 s of free fall: g t^2 / 2 = 0.049 m, less a step of it at most
    assert bench.engine.bodies["z"][HIGH] < 0.5 - 0.5 * G * (23 * DT) ** 2
    assert LONE in asleep(bench)


@pytest.mark.parametrize("change", [{"remove": True}, {"teleport": (9.0, 0.0, 0.1)}])
def test_what_was_about_to_fall_asleep_falls_with_its_support(change: dict) -> None:
    """Whenever its support goes, before, as or after it falls asleep, a box falls from then on."""
    for steps in range(20, 30):
        bench = stack()
        bench.run(steps)
        apply(bench, happens(body="low", **change))
        bench.run(24)
        # the free fall of 24 steps, exact under constant gravity but for what creeps before
        assert bench.engine.bodies["z"][HIGH] < 0.5 - 0.5 * G * (23 * DT) ** 2, steps


def test_gravity_that_turns_wakes_everybody_and_keeps_nobody_at_rest() -> None:
    """At any time before, as or after they fall asleep: upwards, all fly."""
    for steps in (20, 23, 24, 25, 40):
        bench = stack()
        bench.run(steps)
        queue = EventQueue(bench.engine, bench.scene, [CellGravity(at=0.0, gravity=(0, 0, 5.0))])
        queue.apply_due(0)
        bench.run(24)
        risen = bench.engine.bodies["z"][LOW : LONE + 1] - [0.1, 0.3, 0.5, 0.1]
        assert risen.min() > 0.5 * 5.0 * (23 * DT) ** 2, steps


@pytest.mark.parametrize(
    ("removed", "left"), [("low", [LONE]), ("high", [LONE]), ("floor", []), ("lift", [])]
)
def test_whoever_slept_beside_a_removed_body_wakes(removed, left) -> None:
    """The floor and the lift bore whom nobody knows: all wake."""
    bench = slept()
    row = bench.scene.names.index(removed)
    place = bench.engine.bodies[["x", "y", "z"]][row].item()
    apply(bench, happens(body=removed, remove=True))
    assert asleep(bench) == left
    bodies, velocities = bench.engine.bodies, bench.engine.velocities
    assert (bodies["inv_m"][row], bodies["own_inv_m"][row], bodies["kinematic"][row]) == (0, 0, 0)
    bench.run(24)
    assert bodies[["x", "y", "z"]][row].item() == place
    assert not any(velocities[row].item())
    fallen = {"low": [MIDDLE, HIGH], "high": [], "floor": [LOW, MIDDLE, HIGH, LONE], "lift": []}
    for other in (LOW, MIDDLE, HIGH, LONE):
        if other != row:
            height = 0.1 if other == LONE else 0.2 * other - 0.1
            # 0.1 s of free fall: g t^2 / 2 = 49 mm; Euler falls g dt t / 2 = 2 mm more
            drop = 0.5 * G * (24 * DT) ** 2 if other in fallen[removed] else 0.0
            assert bodies["z"][other] == pytest.approx(height - drop, abs=0.51 * G * DT * 24 * DT)


@pytest.mark.parametrize("force", [(0.0, 0.0, 15.0), (1e-9, 0.0, 0.0)])
def test_a_force_wakes_and_keeps_awake_as_long_as_it_acts(force) -> None:
    bench = slept()
    for axis, value in zip("xyz", force, strict=True):
        bench.engine.bodies[f"f{axis}"][MIDDLE] = value
    bench.run(40)
    assert asleep(bench) == [LONE]


def test_a_changed_velocity_wakes() -> None:
    bench = slept()
    apply(bench, happens(body="high", velocity=(0.0, 0.0, 1.0)))
    bench.run(1)
    assert asleep(bench) == [LONE]
    assert bench.engine.bodies["z"][HIGH] > 0.5 + 0.9 * DT


def test_a_changed_mass_is_the_mass_it_wakes_with() -> None:
    bench = slept()
    apply(bench, happens(body="high", scale_mass=4.0))
    assert asleep(bench) == [LONE]
    assert bench.engine.bodies["inv_m"][HIGH] == 0.25
    rows = bench.run(5)
    force = rows.step["total_normal_force"][-1]
    # Interfaces of the awake stack carry 4, 5 and 6 kg.
    assert force == pytest.approx(15.0 * G, rel=1e-2)


def test_a_kinematic_body_that_moves_wakes_whom_it_touches() -> None:
    bench = slept()
    bench.engine.bodies["x"][LIFT] = 3.0 - 0.25  # 50 mm off the lone box
    bench.engine.bodies["z"][LIFT] = 0.1
    bench.run(10)
    assert LONE in asleep(bench)  # it stands still
    bench.engine.velocities["vx"][LIFT] = 1.0
    bench.run(24)
    assert asleep(bench) == [LOW, MIDDLE, HIGH]
    assert bench.engine.bodies["x"][LONE] > 3.0 + 0.03


def test_a_body_that_falls_asleep_on_sleepers_wakes_with_them() -> None:
    """A ball set down gently: nothing wakes, it falls asleep too, and it is their island's."""
    bench = slept(ball=(50.0, 0.0, 50.0))
    bodies, velocities = bench.engine.bodies, bench.engine.velocities
    bodies["x"][BALL], bodies["z"][BALL] = 0.0, 0.7 - 1e-6
    bodies["y"][BALL] = 0.0
    velocities[BALL] = np.zeros(1, velocities.dtype)[0]
    bench.run(40)
    assert asleep(bench) == [LOW, MIDDLE, HIGH, LONE, BALL]
    bench.engine.wake(LOW)
    assert asleep(bench) == [LONE]


def test_a_slow_lift_keeps_its_rider_awake() -> None:
    """Slower than sleep_speed, the rider must not stay behind."""
    bench = stack(ball=(6.0, 0.0, 1.2))
    bench.engine.velocities["vz"][LIFT] = 0.002
    rows = bench.run(120)
    assert asleep(bench) == [LOW, MIDDLE, HIGH, LONE]
    assert rows.step["awake"].min() == 1  # the rider, in every step
    assert bench.engine.bodies["z"][BALL] == pytest.approx(1.2 + 0.002 * 0.5, abs=1e-4)


def test_with_sleeping_off_nothing_changes() -> None:
    """The engine that may sleep, never allowed to: equal in every bit to the one without."""
    never = stack(ball=(-2.5, 0.0, 0.9), velocity=(10.0, 0.0, 0.0))
    never.engine.parameters["sleep_time"] = 1e9
    plain = stack(ball=(-2.5, 0.0, 0.9), velocity=(10.0, 0.0, 0.0), sleeping=False)
    assert not plain.spec.has("sleeping")
    assert "asleep" not in plain.engine.bodies.dtype.names
    one, other = never.run(120), plain.run(120)
    assert one.pose.tobytes() == other.pose.tobytes()
    assert one.contact.tobytes() == other.contact.tobytes()
    assert "awake" in one.step.dtype.names
    assert "awake" not in other.step.dtype.names


def tied() -> Bench:
    """Two boxes on the floor, each tied to a hook by a slack spring, one of them to both hooks."""
    size = (0.2, 0.2, 0.2)
    bodies = {
        "floor": plane(),
        "left": sphere(0.01, (0.0, 0.0, 1.0), fixed=True),
        "right": sphere(0.01, (3.0, 0.0, 1.0), fixed=True),
        "one": box(size, (0.0, 0.0, 0.1)),
        "both": box(size, (3.0, 0.0, 0.1)),
    }
    cell = resolved(bodies, (0.0, 0.0, -G), sleeping=True, sleep_time=SLEEP_TIME)
    ties = [("left", "one"), ("left", "both"), ("right", "both")]
    cell["scene"]["springs"] = [{"a": a, "b": b, "stiffness": 0.0} for a, b in ties]
    return Bench(cell, None)


def test_what_loses_its_last_spring_may_sleep() -> None:
    one, both = 3, 4
    bench = tied()
    bench.run(40)
    assert asleep(bench) == []  # what springs join does not sleep
    apply(bench, happens(body="left", remove=True))
    bench.run(40)
    assert asleep(bench) == [one]
    apply(bench, happens(body="right", remove=True))
    bench.run(40)
    assert asleep(bench) == [one, both]
