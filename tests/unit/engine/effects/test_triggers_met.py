"""States that make events happen: the step that meets each, by closed forms; no other bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from laboratory import Bench, config, plane, planned, resolved, sphere

from lavendersim.engine.engine import Rows
from lavendersim.engine.spec import Spec
from lavendersim.scene.events import EventQueue

G, RATE, STEPS = 10.0, 240, 200
KEPT = dict.fromkeys(("scale_mass", "teleport", "angular_velocity"))
EVENT = {
    "at": 0.0, "body": "ball", "contact_cache": "keep", "remove": False, **KEPT,
    "velocity": [1, 0, 0],
}  # fmt: skip
SPEC = Spec(
    effects=(
        "contact_log",
        "frictionless_contact",
        "gravity",
        "pose_log",
        "restitution",
        "step_log",
    ),
    shape_pairs=("sphere_plane",),
)


def when(condition: str, bodies: Any = ("ball",), value: float = 0.0, **along: Any) -> dict:
    """Return an event with its trigger, as a resolved cell has it."""
    state = {"condition": condition, "bodies": list(bodies), "value": value, **along}
    return {"when": state, "event": EVENT}


def fall(*triggered: dict, position=(0, 0, 1.1), velocity=(0, 0, 0), has: bool = True) -> Bench:
    """A ball above a floor that it leaves with half its speed; has: the engine has triggers."""
    bodies = {
        "floor": plane(restitution=0.5),
        "ball": sphere(0.1, position, velocity=velocity, restitution=0.5),
    }
    cell = resolved(bodies, (0.0, 0.0, -G), timestep=f"1/{RATE}") | {"triggered": list(triggered)}
    effects = tuple(sorted({*SPEC.effects, "triggers"})) if has else SPEC.effects
    return Bench(cell, spec=SPEC._replace(effects=effects))


def met(bench: Bench) -> int:
    """Return the step that meets the trigger: there the engine stops."""
    rows = bench.run(STEPS)
    steps = rows.step["step"][rows.step["triggered"] == 1]
    if len(steps) == 0:
        return -1
    assert steps.tolist() == [bench.engine.counters["step"][0]]
    return int(steps[0])


@pytest.mark.parametrize(
    ("condition", "value", "speed", "expected"),
    [
        # |v| = G k/RATE after k steps; from 2 m/s upwards |2 - G k/RATE|.
        ("faster_than", 3.01, 0.0, 73),
        ("slower_than", 0.51, 2.0, 36),
        ("slower_than", 0.01, 0.0, 1),  # at 0 m/s it begins; the first step makes 0.04
    ],
)
def test_a_speed_is_met_by_the_first_step_beyond_it(
    condition: str, value: float, speed: float, expected: int
) -> None:
    bench = fall(when(condition, value=value), velocity=(0, 0, speed))
    if speed == 0.0 and condition == "slower_than":
        rows = bench.run(1)
        assert rows.step["triggered"].tolist() == [1, 0]  # the initial state, and not again
        return
    assert met(bench) == expected


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("condition", ["above", "below"])
def test_a_place_is_met_by_the_first_step_beyond_it(condition: str, sign: float) -> None:
    """Along [0.6, 0, 0.8] of a ball thrown along x: by steps, semi-implicit.

    x = v k/RATE, z = 1.1 - G k (k + 1)/2/RATE^2
    """
    along, speed, level = np.array([0.6, 0.0, 0.8]), 3.0, 1.0
    trigger = when(condition, value=sign * level, along=(sign * along).tolist())
    k = np.arange(60)
    places = 0.6 * speed * k / RATE + 0.8 * (1.1 - G * k * (k + 1) / 2 / RATE**2)
    beyond = places > level if (condition == "above") == (sign > 0) else places < level
    expected = int(np.argmax(beyond)) if beyond.any() else -1
    bench = fall(trigger, velocity=(speed, 0, 0))
    rows = bench.run(59)
    assert rows.step["step"][rows.step["triggered"] == 1].tolist()[:1] == [expected]


def pressed(rows: Rows) -> np.ndarray:
    """Return the steps in which the ball presses on the floor."""
    return np.unique(rows.contact["step"][rows.contact["impulse_n"] > 0.0])


@pytest.mark.parametrize("bodies", [("ball", "floor"), ("floor", "ball")])
def test_a_touch_is_met_where_bodies_press_and_a_leave_where_they_press_no_more(bodies) -> None:
    steps = pressed(fall(has=False).run(STEPS))
    last = int(steps[np.argmax(np.diff(steps, append=STEPS + 9) > 1)])  # of the first impact
    assert met(fall(when("touches", bodies))) == int(steps[0])
    assert met(fall(when("leaves", bodies))) == last + 1
    assert met(fall(when("leaves", bodies), position=(0, 0, 9.0))) == -1


def test_steps_without_a_met_trigger_are_those_without_it_to_the_bit() -> None:
    watched, plain = fall(when("faster_than", value=99.0)).run(STEPS), fall(has=False).run(STEPS)
    assert watched.pose.tobytes() == plain.pose.tobytes()
    assert watched.contact.tobytes() == plain.contact.tobytes()
    assert (watched.step["state_hash"] == plain.step["state_hash"]).all()
    assert not watched.step["triggered"].any()
    assert "triggered" not in (plain.step.dtype.names or ())


def test_each_trigger_has_its_bit_and_is_met_once() -> None:
    fast, slow = when("faster_than", value=1.01), when("faster_than", value=0.51)
    bench = fall(fast, slow, when("below", value=9.0))
    parts = [bench.run(STEPS - int(bench.engine.counters["step"][0])) for _ in range(4)]
    found = np.concatenate([rows.step for rows in parts])
    bits = {int(row["step"]): int(row["triggered"]) for row in found if row["triggered"]}
    # 0.51 m/s: k > 12.24; 1.01 m/s: k > 24.24
    assert bits == {0: 0b100, 13: 0b010, 25: 0b001}
    assert found["step"].tolist() == [*range(STEPS + 1)]


def test_its_event_acts_before_the_next_step_and_once() -> None:
    bench = fall(when("faster_than", value=1.01))
    cell = config(bench.cell)
    queue = EventQueue(bench.engine, bench.scene, cell.events, cell.triggered)
    queue.apply_due(0)
    assert met(bench) == 25
    queue.apply_due(25)
    assert bench.velocity[1].tolist() == [1.0, 0.0, 0.0]
    bench.run(30)
    queue.apply_due(55)
    # 30 steps of fall on; the speed is beyond 1.01 m/s again, and nothing happens
    assert bench.velocity[1][2] == pytest.approx(-30 * G / RATE, abs=30 * 2.2e-16)


@pytest.mark.parametrize("record", [True, False])
def test_it_is_on_where_an_event_of_a_logged_run_has_one(record: bool) -> None:
    cell = resolved({"ball": sphere(0.1, (0, 0, 5))})
    assert planned(cell, record).decisions["triggers"].reason == "every event has its time"
    cell["triggered"] = [when("faster_than", value=2.0)]
    decided = planned(cell, record).decisions["triggers"]
    assert decided.on == record
    if record:
        assert decided.reason == "an event happens when ball is faster than 2 m/s"
