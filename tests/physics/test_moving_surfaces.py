"""Belts carry, lifts lift, wind drags and compounds stand, each as its own law says.

One scene, its bodies far apart, in the default numerics: one compilation serves all claims.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config

import lavendersim
from lavendersim.experiment import load_experiment_text
from lavendersim.measures import evaluate
from lavendersim.measures.specs.optimality import Optimality
from lavendersim.scene.plan import plan_of_cell
from lavendersim.trace import open_trace
from tests.families_of_plans import spec_of_family

BLOCK = "{kind: box, size: [0.2, 0.2, 0.2]}"
SCENE = f"""\
scene:
  surfaces: {{rubber: {{friction: 0.5}}}}
  bodies:
    belt: {{shape: {{kind: plane}}, surface: rubber, surface_velocity: [0.6, 0, 0]}}
    block: {{shape: {BLOCK}, mass: 1, surface: rubber, position: [0, 0, 0.1]}}
    dumbbell:
      shape:
        kind: compound
        parts:
          - {{shape: {BLOCK}, position: [0, -0.3, 0]}}
          - {{shape: {BLOCK}, position: [0, 0.3, 0]}}
      mass: 3
      surface: rubber
      position: [0, 2, 0.1]
    lift:
      shape: {{kind: box, size: [0.4, 0.4, 0.2]}}
      kinematic: true
      surface: rubber
      position: [0, 5, 1]
      velocity: [0, 0, 0.25]
    rider: {{shape: {BLOCK}, mass: 1, surface: rubber, position: [0, 5, 1.2]}}
    kite: {{shape: {BLOCK}, mass: 1, position: [0, -5, 3], drag: {{linear: 2}}}}
  forces:
    - {{body: kite, force: [1, 0, {GRAVITY}]}}
numerics: {{timestep: 1/240}}
duration: 1.0
"""
DT, MU, BELT = 1.0 / 240.0, 0.5, 0.6


@pytest.fixture(scope="module")
def course() -> Course:
    return run_config(SCENE)[0]


def velocity(course: Course, body: str) -> np.ndarray:
    return np.diff(course.pose[:, course.names.index(body), :3], axis=0) / DT


@pytest.mark.parametrize("body", ["block", "dumbbell"])
def test_belt_speeds_up_with_mu_g_to_its_own_speed_and_no_further(
    course: Course, body: str
) -> None:
    v = velocity(course, body)[:, 0]
    slipping = int(BELT / (MU * GRAVITY * DT))  # whole steps
    # x = mu g t^2/2 up to the instant at which the slip ends in a step. The impulses are solved
    # to 1e-7 m/s a step, the default tolerance.
    time, stops = DT * np.arange(241), BELT / (MU * GRAVITY)
    way = 0.5 * MU * GRAVITY * np.minimum(time, stops) ** 2 + BELT * np.maximum(time - stops, 0.0)
    mean = np.diff(way) / DT
    np.testing.assert_allclose(v[: slipping + 1], mean[: slipping + 1], atol=(slipping + 1) * 1e-7)
    np.testing.assert_allclose(v[slipping + 1 :], BELT, atol=1e-6)


@pytest.mark.parametrize("body", ["block", "dumbbell"])
def test_logged_slip_is_that_of_the_surfaces(course: Course, body: str) -> None:
    """That of the belt counts: mu g t brings the slip to rest, and what goes with it has none."""
    rows = course.contacts_of("belt", body)
    n, one = (np.stack([rows[f"{name}{axis}"] for axis in "xyz"], axis=-1) for name in ("n", "t1"))
    slip = rows["slip_t1"][:, None] * one + rows["slip_t2"][:, None] * np.cross(n, one)
    # Velocities of the ends of steps; B is the body, and what little it turns is residual as well.
    along = np.minimum(MU * GRAVITY * DT * rows["step"], BELT) - BELT
    expected = np.stack([along, 0.0 * along, 0.0 * along], axis=-1)
    # The impulses of the steps before it are solved to 1e-7 m/s each, as long as it slides.
    np.testing.assert_allclose(slip, expected, atol=int(BELT / (MU * GRAVITY * DT)) * 1e-7)


def test_contacts_with_a_belt_keep_the_laws_of_contact(tmp_path: Path) -> None:
    """To the residuals of their steps; a slip that lacked the belt would be off by its speed."""
    config = tmp_path / "belt.yaml"
    spec = spec_of_family(plan_of_cell(load_experiment_text(SCENE, "belt.yaml").cells()[0]))
    switches = dict.fromkeys((*spec.effects, *spec.shape_pairs), "on")  # compiled already
    config.write_text(f"{SCENE}effects: {json.dumps(switches)}\n")
    (cell,) = lavendersim.run(config, root=tmp_path).run.cells
    found = evaluate(Optimality(kind="optimality"), open_trace(cell.path))
    # Products of numbers below 10 m/s and N s, rounded.
    np.testing.assert_allclose(found, 0.0, atol=1e-14)


def test_lift_keeps_its_velocity_and_carries_its_rider(course: Course) -> None:
    np.testing.assert_allclose(velocity(course, "lift"), [[0, 0, 0.25]] * 240, atol=1e-12)
    np.testing.assert_allclose(velocity(course, "rider")[5:, 2], 0.25, atol=1e-6)
    late = course.contacts_of("lift", "rider")
    late = late[late["step"] > 20]
    force = late["force_n"].sum() / (240 - 20)
    assert force == pytest.approx(GRAVITY, rel=1e-6)


def test_weight_of_a_compound_rests_on_its_parts(course: Course) -> None:
    rows = course.contacts_of("belt", "dumbbell")
    last = rows[rows["step"] == 240]
    assert len(last) == 8  # four corners of each part
    assert last["force_n"].sum() == pytest.approx(3 * GRAVITY, rel=1e-6)
    assert sorted(np.unique(last["y"].round(6))) == pytest.approx([1.6, 1.8, 2.2, 2.4])


def test_kite_tends_to_the_speed_that_its_drag_carries(course: Course) -> None:
    # v_{k+1} - v_t = (v_k - v_t)/(1 + x + x^2/2), x = c dt, at the ends of steps; means are logged
    x = 2.0 * DT
    ends = 0.5 * (1.0 - (1.0 + x + 0.5 * x * x) ** -np.arange(241.0))
    expected = 0.5 * (ends[1:] + ends[:-1])
    found = velocity(course, "kite")[:, 0]
    # Where the slip of others ends, the step is made in two parts. Its mean is then another one by
    # v'' dt^2/12 at most, v'' <= 4/s^2 0.5 m/s; what comes after has an error less of v_t x^3/6.
    split = int(BELT / (MU * GRAVITY * DT))
    np.testing.assert_allclose(found[:split], expected[:split], atol=1e-12)
    assert abs(found[split] - expected[split]) < 2.0 * DT**2 / 12.0
    np.testing.assert_allclose(found[split + 1 :], expected[split + 1 :], atol=0.5 * x**3 / 6.0)
    # the weight is carried to the rounding of the decimal it is written with
    np.testing.assert_allclose(course.height("kite"), 3.0, atol=1e-12)
