"""What the balances of the fuzz allow: laws that hold for other than contacts at rest, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fuzz_balances import TAKEN_BACK, _brought_together, _momentum
from fuzz_gaps import NEAR, deeper_than_moved, pushes_across_gaps
from fuzz_steps import State, Steps

from lavendersim.engine.contact_spring_law import FLATTEST

DT, MASS = 0.01, 2.0
STILL = {"step": 2, "body_a": 0, "body_b": 1, "impulse_n": 0.0}


def steps_of(contacts: list[dict[str, float]], count: int = 2, v: Any = 0.0) -> Steps:
    """Return steps of a fixed body and of one that has the speeds v, (steps + 1) [m/s]."""
    velocity = np.zeros((count + 1, 2, 3))
    velocity[:, 1, 2] = v
    zeros = np.zeros((count, 2))
    still = State(
        np.tile([0.0, MASS], (count, 1)), zeros, velocity[:-1], np.zeros((count, 2, 3)),
        np.zeros((count, 2, 3)), np.zeros((count, 3)), zeros, np.full(count, DT),
    )  # fmt: skip
    names = {name: "i8" if name in ("step", "body_a", "body_b", "joint") else "f8"
             for row in contacts for name in row}  # fmt: skip
    rows = np.zeros(len(contacts), list(names.items()))
    for place, row in enumerate(contacts):
        for name, value in row.items():
            rows[name][place] = value
    return Steps(still, still._replace(velocity=velocity[1:]), rows, rows["step"] - 1, zeros)


def logged(first: float, second: float, parts: int = 1) -> Any:
    """Return what two steps log of their depths [m]."""
    step = np.zeros(3, [("max_penetration", "f8"), ("parts", "i8")])
    step["max_penetration"], step["parts"] = (0.0, first, second), parts
    return SimpleNamespace(step=step)


def cell_of(
    cone: str = "disc", warm_start: bool = False, slop: float = 0.0, floor: str = "plane"
) -> Any:
    numerics = SimpleNamespace(friction_cone=cone, warm_start=warm_start, slop=slop)
    bodies = {
        name: SimpleNamespace(drag=None, shape=SimpleNamespace(kind=kind))
        for name, kind in (("floor", floor), ("ball", "sphere"))
    }
    scene = SimpleNamespace(bodies=bodies, forces=[], springs=[])
    return SimpleNamespace(numerics=numerics, scene=scene)


@pytest.mark.parametrize("joint", [0, 1])
def test_a_stop_that_its_joint_tears_past_is_no_overlap(joint: int) -> None:
    """Its depth is an arm, as long as the axis is far, times the turn that is missing."""
    steps = steps_of([STILL | {"joint": joint, "penetration": 5.0}])
    assert bool(deeper_than_moved(cell_of(), logged(0.0, 5.0), steps)) == (joint == 0)


@pytest.mark.parametrize("floor", ["plane", "mesh"])
@pytest.mark.parametrize("deep", [0.49, 0.51])
def test_what_comes_before_a_face_from_behind_is_as_deep_as_it_reaches(floor: str, deep: float):
    """A ball of 0.5 m whose centre was behind a mesh's face, where it does not touch it."""
    steps = steps_of([STILL | {"penetration": deep}])
    bound = np.tile([0.0, 0.5], (2, 1))
    steps = steps._replace(before=steps.before._replace(bound=bound))
    allowed = floor == "mesh" and deep < 0.5
    assert bool(deeper_than_moved(cell_of(floor=floor), logged(0.0, deep), steps)) != allowed


def test_what_is_passed_over_as_flush_is_as_deep_as_ten_slops_when_it_is_met() -> None:
    steps = steps_of([STILL | {"penetration": 0.1}])
    for deep, seen in ((0.0999, False), (0.1001, True)):
        assert bool(deeper_than_moved(cell_of(slop=0.01), logged(0.0, deep), steps)) == seen


def test_what_is_thrown_back_within_a_step_has_been_farther_than_its_ends_say() -> None:
    """1 kg m/s in a part of many carries the end of a rod of that mass by 4 m/s dt at most."""
    row = {"step": 1, "body_a": 0, "body_b": 1, "nz": 1.0, "impulse_n": MASS, "penetration": 0.0}
    steps = steps_of([row])
    for parts, deep, seen in ((1, 0.1 * DT, True), (2, 3.9 * DT, False), (2, 4.1 * DT, True)):
        assert bool(deeper_than_moved(cell_of(), logged(0.0, deep, parts), steps)) == seen


@pytest.mark.parametrize("cone", ["disc", "convex"])
@pytest.mark.parametrize("grain", [False, True])
def test_what_slides_under_the_convex_cone_is_pushed_ahead(cone: str, grain: bool) -> None:
    """w_n = mu |w_t|, with a grain |F w_t|: ends mu |w_t| dt, or 0.5 m/s dt, away."""
    row = {"step": 1, "body_a": 0, "body_b": 1, "impulse_n": 1.0, "inverse_effective_mass": 1.0,
           "residual": 0.0, "slip_t1": 3.0, "slip_t2": 4.0, "friction": 0.1}  # fmt: skip
    if grain:  # along t2 alone, by 0.125
        row |= {"friction": 0.0, "friction_11": 0.0, "friction_12": 0.0, "friction_22": 0.125}
    for separation, seen in ((0.49 * DT, cone == "disc"), (0.51 * DT, True)):
        found = pushes_across_gaps(cell_of(cone), steps_of([row | {"separation": separation}]))
        assert bool(found) == seen


@pytest.mark.parametrize("warm_start", [False, True])
def test_a_warm_start_rounds_by_the_impulses_of_the_step_before(warm_start: bool) -> None:
    """100 N s, then none: what they leave as they are taken back is their last digits."""
    row = {"step": 1, "body_a": 0, "body_b": 1, "nz": 1.0, "impulse_n": 100.0}
    left = 0.5 * TAKEN_BACK * 100.0 / MASS
    steps = steps_of([row], v=np.array([-50.0, 0.0, left]))
    found = _momentum(cell_of(warm_start=warm_start), SimpleNamespace(step=np.zeros(3)), steps)
    assert bool(found) == (not warm_start)


@pytest.mark.parametrize(("share", "seen"), [(0.9, False), (1.1, True)])
def test_a_push_that_cohesion_takes_back_rounds_like_one_that_is_left(share: float, seen: bool):
    """100 N s against 100 N s: as large as both may a row be, on its way, that ends with none."""
    held = {"step": 1, "body_a": 0, "body_b": 0, "nz": 1.0, "impulse_n": 100.0}
    left = share * TAKEN_BACK * 100.0 / MASS
    row = held | {"adhesive_impulse": 100.0}
    steps = steps_of([row], v=np.array([0.0, left, left]))
    found = _momentum(cell_of(), SimpleNamespace(step=np.zeros(3)), steps)
    assert bool(found) == seen


def test_a_torque_that_a_contact_holds_would_have_brought_its_body_near() -> None:
    """3 N m by 2 N s^2/m/(0.5 kg m^2): 6 m/s^2 dt of a surface 0.5 m from the centre, for dt."""
    row = {"step": 1, "body_a": 0, "body_b": 1, "impulse_n": 1.0, "inverse_effective_mass": 1.0,
           "residual": 0.0}  # fmt: skip
    steps = steps_of([row])
    bound = np.zeros_like(steps.before.bound)
    bound[:, 1] = 0.5
    steps = steps._replace(before=steps.before._replace(bound=bound))
    twist = SimpleNamespace(body="ball", torque=(0.0, 0.0, 3.0), force=(0.0, 0.0, 0.0), factor=None)
    allowed = 0.5 * 3.0 / 0.5 * DT * DT + NEAR * 0.5
    for forces, share, seen in (([], 1.0, True), ([twist], 0.99, False), ([twist], 1.01, True)):
        cell = cell_of()
        cell.duration, cell.scene.forces = 1.0, forces
        cell.scene.bodies["ball"].mass, cell.scene.bodies["ball"].inertia = MASS, (0.5, 1.0, 1.0)
        twist.constant_at_centre = True
        steps.contact["impulse_n"] = 1.0
        rows = steps._replace(contact=with_separation(steps.contact, share * allowed))
        assert bool(pushes_across_gaps(cell, rows)) == seen


def with_separation(contact: np.ndarray, separation: float) -> np.ndarray:
    wide = np.zeros(contact.shape, [*contact.dtype.descr, ("separation", "f8")])
    for name in contact.dtype.names:
        wide[name] = contact[name]
    wide["separation"] = separation
    return wide


@pytest.mark.parametrize(("share", "seen"), [(0.9, True), (1.0, False)])
def test_the_flattest_tangent_of_an_open_spring_is_no_push(share: float, seen: bool) -> None:
    row = {"step": 1, "body_a": 0, "body_b": 1, "impulse_n": 1.0, "inverse_effective_mass": 2.0,
           "residual": 0.0, "separation": 1.0, "gamma": share * 2.0 / FLATTEST}  # fmt: skip
    assert bool(pushes_across_gaps(cell_of(), steps_of([row]))) == seen


def test_what_brings_ends_together_moves_and_turns_by_four_times_their_distance() -> None:
    """0.1 m apart: 4 x 0.1 m of 2 kg, against 10 m/s^2, and of 3 rad/s by 0.5 m."""
    row = {"step": 1, "body_a": 0, "body_b": 1, "joint": 1, "separation": 0.1}
    steps = steps_of([row, row | {"joint": 0}])
    before = steps.before
    before.spin[:, 1] = (0.0, 3.0, 0.0)
    bound = np.where(before.mass > 0.0, 0.5, 0.0)
    given = _brought_together(steps._replace(before=before._replace(bound=bound)), 10.0)
    assert given.tolist() == pytest.approx([0.4 * MASS * (10.0 + 0.5 * 9.0), 0.0])
