"""Forces and events act before the first step that starts at their time, and leave no remainder."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from laboratory import body, config, plane, resolved

from lavendersim.cell import CellRecord, TimeWindow
from lavendersim.engine.engine import Engine
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.spec import Spec
from lavendersim.scene.build import Scene, build, residual_window
from lavendersim.scene.events import EventQueue
from lavendersim.scene.facts import facts_of
from lavendersim.scene.plan import plan_of

SPEC = Spec(effects=("external_force", "kinematic", "rotation"), shape_pairs=("sphere_plane",))
BALL = {"kind": "sphere", "radius": 0.1}


def force(begin: float, end: float, **loads: list[float]) -> dict:
    return {
        "body": "ball", "from": begin, "to": end,
        "force": loads.get("force", [0.0] * 3), "torque": loads.get("torque", [0.0] * 3),
    }  # fmt: skip


def event(at: float, name: str = "ball", **values) -> dict:
    changes = ("scale_mass", "teleport", "velocity", "angular_velocity")
    return {
        "at": at, "body": name, "contact_cache": "keep", "remove": False,
        **dict.fromkeys(changes), **values,
    }  # fmt: skip


class Bench:
    """A scene of floor, ball and belt at 0.1 s, whose engine is nothing but its arrays."""

    def __init__(self, forces=(), events=(), gravity=0.0) -> None:
        bodies = {"floor": plane(), "ball": body(BALL), "belt": body(BALL, kinematic=True)}
        cell = resolved(bodies, (0.0, 0.0, gravity), timestep="1/10")
        cell["scene"]["forces"] = list(forces)
        cell["events"] = list(events)
        self.cell = config(cell)
        self.scene: Scene = build(self.cell, SPEC)
        self.forgotten: list = []
        self.woken: list = []
        self.motion = np.ones(len(self.scene.bodies), dtype(MOTION))
        engine = SimpleNamespace(
            spec=SPEC, bodies=self.scene.bodies, velocities=self.scene.velocities,
            parameters=self.scene.parameters,
            forget_contacts=lambda *body: self.forgotten.append(body),
            wake=self.woken.append, wake_all=lambda: self.woken.append("all"),
            state=SimpleNamespace(pairs=self.scene.pairs, motion=self.motion),
        )  # fmt: skip
        self.queue = EventQueue(engine, self.scene, self.cell.events)

    def after(self, steps: int) -> list[float]:
        """Return force and torque of the ball once what is due after `steps` steps acts."""
        self.queue.apply_due(steps)
        return [float(self.scene.bodies[1][k]) for k in ("fx", "fy", "fz", "tx", "ty", "tz")]


def test_force_acts_from_its_begin_up_to_its_end() -> None:
    bench = Bench([force(0.2, 0.5, force=[1, 2, 3], torque=[4, 5, 6])])
    acting = [any(bench.after(step)) for step in range(7)]
    assert acting == [False, False, True, True, True, False, False]


def test_time_within_a_step_waits_for_the_next() -> None:
    bench = Bench([force(0.01, 0.11, force=[1, 0, 0])])
    assert [bench.after(step)[0] for step in range(4)] == [0.0, 1.0, 0.0, 0.0]


def test_forces_add_and_leave_no_remainder() -> None:
    """0.1 + 0.2 + 0.3 less its parts again is 2.8e-17 in floats; here it is 0."""
    shares = (0.1, 0.2, 0.3)
    bench = Bench([force(0.1 * k, 1.0 - 0.1 * k, force=[s, 0, 0]) for k, s in enumerate(shares)])
    found = [bench.after(step)[0] for step in range(11)]
    assert found[2:8] == [0.1 + 0.2 + 0.3 - 1.1102230246251565e-16] * 6  # 0.6, rounded once
    assert found[10] == 0.0


def test_one_force_follows_another_without_a_gap() -> None:
    bench = Bench([force(0.0, 0.3, force=[1, 0, 0]), force(0.3, 0.6, force=[2, 0, 0])])
    assert [bench.after(step)[0] for step in range(7)] == [1.0] * 3 + [2.0] * 3 + [0.0]


def test_force_shorter_than_the_way_to_a_step_does_nothing() -> None:
    bench = Bench([force(0.11, 0.19, force=[1, 0, 0])])
    assert bench.queue.next_stop(9) == 9
    assert not any(any(bench.after(step)) for step in range(4))


def test_queue_stops_where_something_changes() -> None:
    bench = Bench([force(0.2, 0.5, force=[1, 0, 0])], [event(0.35, scale_mass=2.0)])
    stops = []
    done = 0
    while done < 9:
        bench.queue.apply_due(done)
        done = bench.queue.next_stop(9)
        stops.append(done)
    assert stops == [2, 4, 5, 9]


def test_events_set_velocities() -> None:
    events = [
        event(0.1, velocity=[1, 2, 3], angular_velocity=[4, 5, 6]),
        event(0.1, "belt", velocity=[7, 0, 0]),
    ]
    bench = Bench(events=events)
    bench.queue.apply_due(1)
    ball, belt = bench.scene.velocities[1], bench.scene.velocities[2]
    assert [ball[k] for k in ("vx", "vy", "vz", "wx", "wy", "wz")] == [1, 2, 3, 4, 5, 6]
    assert belt["vx"] == 7
    assert bench.forgotten == []
    # Ends of joints may part by it: what stayed together before tells nothing.
    assert bench.motion["unparted"].tolist()[:3] == [1, 0, 0]


def test_mass_and_inertia_are_scaled_together() -> None:
    bench = Bench(events=[event(0.0, scale_mass=4.0)])
    before = bench.scene.bodies[1].copy()
    bench.queue.apply_due(0)
    for name in ("inv_m", "inv_ix", "inv_iy", "inv_iz"):
        assert bench.scene.bodies[1][name] == before[name] / 4.0


def test_gravity_changes_with_what_is_made_of_it_and_wakes_everybody() -> None:
    bench = Bench(events=[{"at": 0.25, "gravity": [3.0, 0.0, -4.0]}], gravity=-9.81)
    parameters = bench.scene.parameters[0]
    bench.queue.apply_due(2)
    assert (parameters["gz"], bench.woken) == (-9.81, [])
    bench.queue.apply_due(3)
    assert [float(parameters[f"g{axis}"]) for axis in "xyz"] == [3.0, 0.0, -4.0]
    assert parameters["restitution_speed"] == 2.0 * 5.0 * 0.1
    assert bench.woken == ["all"]


def test_an_orientation_is_written_with_its_matrix_and_its_contacts_are_forgotten() -> None:
    """(1, 0, 0, 1) / sqrt(2): a quarter turn about z takes x to y."""
    bench = Bench(events=[event(0.1, orientation=[1.0, 0.0, 0.0, 1.0])])
    bench.queue.apply_due(1)
    ball = bench.scene.bodies[1]
    found = np.array([[ball[f"r{i}{j}"] for j in range(3)] for i in range(3)])
    np.testing.assert_allclose(found, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=3e-16)
    assert [float(ball[k]) for k in ("qw", "qx", "qy", "qz")] == pytest.approx(
        [0.5**0.5, 0.0, 0.0, 0.5**0.5], rel=1e-15
    )
    assert (bench.forgotten, bench.woken) == ([(1,)], [1])


FRICTIONAL = Spec(
    effects=("contact_torque", "friction", "rotation", "surface_velocity"),
    shape_pairs=("sphere_plane", "sphere_sphere"),
)


@pytest.mark.parametrize("broad", [False, True])
@pytest.mark.parametrize("name", ["floor", "ball"])
def test_a_new_surface_is_mixed_into_every_pair_of_its_body_and_no_other(
    name: str, broad: bool
) -> None:
    """0.5 and 0.5 mix to 0.5, 0.5 and 0.08 to 0.2; the floor says nothing of belt and ball."""
    spec = FRICTIONAL._replace(effects=(*FRICTIONAL.effects, *(("broad_phase",) if broad else ())))
    events = [event(0.1, name, surface={"friction": 0.08}, surface_velocity=[0.0, 2.0, 0.0])]
    bodies = {
        "floor": plane(friction=0.5),
        "ball": body(BALL, friction=0.5),
        "belt": body(BALL, friction=0.5, kinematic=True),
    }
    cell = config(resolved(bodies, timestep="1/10") | {"events": events})
    engine = build(cell, spec).engine(spec)
    before = [friction_of(engine, row, 1) for row in (0, 2)]
    if broad:
        engine.workspace.broad_phase.state["listed"] = 1
    EventQueue(engine, build(cell, spec), cell.events).apply_due(1)
    assert before == [0.5, 0.5]
    # the root of 0.04: two roundings
    assert friction_of(engine, 0, 1) == pytest.approx(0.2, rel=4e-16)
    belt_and_ball = 0.5 if name == "floor" else 0.2
    assert friction_of(engine, 2, 1) == pytest.approx(belt_and_ball, rel=4e-16)
    row = list(bodies).index(name)
    assert [float(engine.bodies[row][k]) for k in ("sx", "sy", "sz")] == [0.0, 2.0, 0.0]
    if broad:
        assert engine.workspace.broad_phase.state["listed"][0] == 0


def friction_of(engine: Engine, one: int, other: int) -> float:
    """Return the coefficient of the pair of two rows as the engine has it."""
    if engine.spec.has("broad_phase"):
        a, b = (int(engine.bodies[row]["material"]) for row in (one, other))
        return float(engine.workspace.templates[a, b]["friction"])
    pairs = engine.state.pairs
    rows = [{int(line["a"]), int(line["b"])} == {one, other} for line in pairs]
    return float(pairs[rows]["friction"][0])


def test_plan_knows_what_is_pushed_twisted_and_thrown() -> None:
    pushed = Bench([force(0.0, 1.0, force=[1, 0, 0])], [event(0.5, velocity=[0, 3, 4])])
    facts = {one.name: one for one in facts_of(pushed.cell).bodies}
    assert (facts["ball"].force, facts["ball"].torque, facts["ball"].speed) == (True, False, 5.0)
    assert facts["belt"].kinematic
    assert not facts["belt"].movable
    decisions = plan_of(pushed.cell).decisions
    assert decisions["external_force"].on
    assert not decisions["rotation"].on
    twisted = Bench([force(0.0, 1.0, torque=[1, 0, 0])])
    assert plan_of(twisted.cell).decisions["rotation"].on
    spun = Bench(events=[event(0.5, angular_velocity=[0, 0, 1])])
    assert plan_of(spun.cell).decisions["rotation"].on
    assert not np.isnan(pushed.scene.poses).any()


def test_a_timestep_and_what_is_made_of_it_change_together() -> None:
    """1/10 s up to 0.2 s, then 1/4 s: 0.25 s and 0.6 s are reached after 3 and after 4 steps."""
    events = [{"at": 0.15, "timestep": "1/4"}, event(0.25, velocity=[1, 0, 0])]
    bench = Bench([force(0.0, 0.6, force=[1, 0, 0])], events, gravity=-9.81)
    parameters = bench.scene.parameters[0]
    assert bench.after(1)[0] == 1.0
    assert parameters["dt"] == 0.1
    bench.after(2)
    assert (parameters["dt"], parameters["restitution_speed"]) == (0.25, 2.0 * 9.81 * 0.25)
    assert bench.scene.velocities[1]["vx"] == 0
    assert bench.after(3)[0] == 1.0
    assert bench.scene.velocities[1]["vx"] == 1
    assert bench.after(4)[0] == 0.0


def test_a_window_of_residuals_is_counted_in_steps_of_their_length() -> None:
    bench = Bench(events=[{"at": 0.2, "timestep": "1/4"}])
    window = TimeWindow.model_validate({"from": 0.2, "to": 0.95})
    record = CellRecord(residuals=window, problems="none")  # steps end at 0.2, 0.45, 0.7, 0.95
    assert residual_window(record, bench.scene.clock) == (2, 5)


def test_the_plan_knows_the_longest_step_and_what_changes_no_body() -> None:
    facts = facts_of(Bench(events=[{"at": 0.2, "timestep": "1/4"}]).cell)
    assert (facts.timestep, facts.events) == (0.25, False)
    assert facts_of(Bench(events=[{"at": 0.2, "timestep": "1/40"}]).cell).timestep == 0.1


@pytest.mark.parametrize("at", [0.3, 0.30000000000000004])
def test_times_are_read_as_written(at: float) -> None:
    """3 steps of 1/10 s are 0.3 s, although the float 0.3 lies below it and 0.1 + 0.2 above."""
    bench = Bench([force(at, 1.0, force=[1, 0, 0])])
    assert bench.queue.next_stop(9) == (3 if at == 0.3 else 4)
