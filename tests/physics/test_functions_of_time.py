"""Shaken tables, and forces over time among impacts and substeps: closed forms of whole scenes."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config

MU, OMEGA = 0.4, 4.0 * math.pi  # [-], [rad/s]
LIMIT = MU * GRAVITY / OMEGA**2  # amplitude [m] at which a table accelerates by mu g
LEAVES = GRAVITY / OMEGA**2  # and by g
INTEGRATORS = ("midpoint_contact", "midpoint", "semi_implicit_euler")
SINE = "{kind: sine, frequency: 2, phase_degrees: 90}"
SHAKEN = """\
question: Does a box slip?
expected: Where the table accelerates by more than mu g.
scene:
  bodies:
    table:
      shape: {{kind: box, size: [2, 2, 0.2]}}
      kinematic: true
      surface: {{friction: 0.4}}
      position: [0, 0, -0.1]
      motion:
        - {{displacement: [{along!r}, 0, 0], factor: {sine}}}
        - {{displacement: [0, 0, {up!r}], factor: {sine}}}
    box:
      shape: {{kind: box, size: [0.4, 0.4, 0.1]}}
      mass: 1
      surface: {{friction: 0.4}}
      position: [0, 0, 0.05]
numerics: {{timestep: 1/{rate}, integrator: {integrator}}}
duration: 1.0
"""


def shaken(integrator: str, along: float = 0.0, up: float = 0.0, rate: int = 240) -> np.ndarray:
    """Return where the box is on its table, beside where it was at first [m] (steps, 3)."""
    text = SHAKEN.format(integrator=integrator, along=along, up=up, rate=rate, sine=SINE)
    (course,) = run_config(text)
    place: np.ndarray = course.pose[:, 1, :3] - course.pose[:, 0, :3]
    return place - place[0]


# A box that holds is where the table is, to the 1e-9 m/s that contacts are solved to.
HELD = 1e-8


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_box_slips_where_the_table_accelerates_by_more_than_mu_g(integrator: str) -> None:
    """The table's mean acceleration over a step is less than its largest by (w h)^2/12 = 2e-4."""
    held = shaken(integrator, along=0.995 * LIMIT)
    assert np.abs(held).max() < HELD
    slipped = shaken(integrator, along=1.005 * LIMIT)
    # Where cos > 1/1.005, a tenth of a radian about a turning point, it falls behind by
    # mu g (1.005 cos - 1): a velocity of mu g/w times 2/3 of 0.005 and 0.1, for some 0.1/w.
    assert np.abs(slipped[:, 0]).max() > 0.2 * MU * GRAVITY * 0.005 * 0.1**2 / OMEGA**2
    assert np.abs(slipped[:, 0]).max() > 3.0 * HELD


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_box_leaves_a_table_that_falls_faster_than_it(integrator: str) -> None:
    """At 0.9 g it stays; at 1.3 g it flies on at the turning point above, and higher the harder."""
    assert shaken(integrator, up=0.9 * LEAVES)[:, 2].max() < 2e-6
    assert shaken(integrator, up=1.3 * LEAVES)[:, 2].max() > 1e-3


PUSHED = """\
question: Does a ball that bounces take all of a force over time?
expected: Its impulse, and its work.
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 2
      surface: {{restitution: 0.8}}
      position: [0, 0, 0.3]
      angular_velocity: [0, 0, 1]
    other:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 1
      surface: {{restitution: 0.8}}
      position: [0, 5, 0.4]
  forces:
    - {{body: ball, force: [3, 0, 5], factor: {{kind: sine, frequency: 1.7}}}}
    - {{body: ball, force: [0, 2, 0], factor: {{kind: pulse, from: 0.2511, to: 0.2532}}}}
numerics: {{timestep: 1/60{more}}}
duration: 1.5
"""


@pytest.mark.parametrize("more", ["", ", accuracy: 1e-4"], ids=["parts", "substeps"])
def test_parts_and_substeps_of_a_step_have_all_of_a_force(more: str) -> None:
    """The floor is smooth: along it the ball has the integral of the force, however it bounces."""
    (course,) = run_config(PUSHED.format(more=more))
    row, w = course.step, 2.0 * math.pi * 1.7
    t = np.arange(len(row)) / 60.0
    along = 3.0 / w * (1.0 - np.cos(w * t))
    across = 2.0 * np.clip(t - 0.2511, 0.0, 0.0021)
    assert row["substeps" if more else "parts"].max() > 1
    # Impulses of 1 N s, of some thousand parts at the most.
    np.testing.assert_allclose(row["momentum_x"], along, atol=1e-12)
    np.testing.assert_allclose(row["momentum_y"], across, atol=1e-12)
    np.testing.assert_allclose(np.cumsum(row["force_impulse_x"]), along, atol=1e-12)
    np.testing.assert_allclose(np.cumsum(row["force_impulse_y"]), across, atol=1e-12)


def free_energy(course: Course) -> np.ndarray:
    """Return what is left of the energy once the work of the force is taken off [J]."""
    row = course.step
    energy = row["kinetic_energy"] + row["potential_energy"] - np.cumsum(row["force_work"])
    return np.asarray(energy - energy[0])


def test_a_bounce_takes_energy_and_flight_under_a_force_none() -> None:
    (course,) = run_config(PUSHED.format(more=""))
    energy = free_energy(course)
    changes = np.diff(energy)
    flies = course.step["contact_count"][1:] == 0
    # In flight by the mean of velocities, exactly: some 10 J, a few roundings a step.
    assert np.abs(changes[flies]).max() < 1e-13
    assert changes.max() < 1e-13
    assert energy[-1] < -1.0


RAMP = """\
question: When does a block slide?
expected: When the ramp is mu m g.
scene:
  bodies:
    floor: {{shape: {{kind: plane}}, surface: {{friction: 0.4}}}}
    block:
      shape: {{kind: box, size: [0.4, 0.4, 0.1]}}
      mass: 1
      surface: {{friction: 0.4}}
      position: [0, 0, 0.05]
  forces:
    - {{body: block, force: [7.848, 0, 0], factor: {{kind: ramp}}}}
numerics: {{timestep: 1/{rate}}}
duration: 1.0
"""


def test_a_block_starts_when_the_ramp_is_mu_m_g_and_slides_at_second_order() -> None:
    """k t = mu m g at 0.5 s; from there x = k (t - 0.5 s)^3/(6 m)."""
    errors = []
    for rate in (60, 120, 240):
        (course,) = run_config(RAMP.format(rate=rate))
        x = course.pose[:, 1, 0]
        start = int(np.argmax(np.abs(x) > 1e-6)) / rate
        # The first millionth of a metre takes (6e-6/7.848)^(1/3) s, and is seen a step later.
        assert 0.5 <= start <= 0.5 + 0.0092 + 1.0 / rate
        errors.append(abs(x[-1] - 7.848 * 0.5**3 / 6.0))
    found = [math.log2(one / other) for one, other in itertools.pairwise(errors)]
    assert found == pytest.approx([2.0, 2.0], abs=0.02)
