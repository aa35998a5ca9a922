"""A row of dominoes falls as fast as energy and impacts say.

Feet do not slide and faces have no friction: domino k has turned by theta_k about its front foot,
and leans with its upper edge on the next one,
    h sin(theta_k - theta_k+1) = p cos(theta_k+1) - d,        p: pitch, d: thickness, h: height
so all that have been hit move as one. Between impacts their energy is kept; as the foremost hits
the next one, e = 0, momentum is: of their velocities the part stays that the contacts allow, in the
metric of the kinetic energy. All forces push, so nothing parts.
"""

from __future__ import annotations

import numpy as np
import pytest
from shared_runs import GRAVITY, run_scenes

from tests.thorough import THOROUGH

TALL, THICK = 0.1, 0.01  # [m]
PUSHED = 6.0  # [rad/s]
FOUND = 0.02  # [rad] by which a domino has turned that falls
POINTS = 2001  # of the integral over an angle
# Gap [m], dominoes, the first and the last between which the wave is timed.
ROWS = [(0.03, 16, 5, 15)]
if THOROUGH:
    ROWS += [(0.01, 30, 10, 29), (0.02, 30, 10, 29), (0.03, 60, 20, 59), (0.05, 30, 5, 29)]


def moved(gap: float, behind: int, turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return inertia and height of the foremost and those behind, by its angles.

    Of the inertia and the height, of mass 1, of one domino about its foot [-, m].
    """
    angle, rate = turned, np.ones_like(turned)
    inertia, height = np.ones_like(turned), 0.5 * (TALL * np.cos(angle) + THICK * np.sin(angle))
    for _ in range(behind):
        lean = np.arcsin(((gap + THICK) * np.cos(angle) - THICK) / TALL)
        rate = rate * (1.0 - (gap + THICK) * np.sin(angle) / (TALL * np.cos(lean)))
        angle = angle + lean
        inertia = inertia + rate * rate
        height = height + 0.5 * (TALL * np.cos(angle) + THICK * np.sin(angle))
    return inertia, height


def begins(gap: float, count: int) -> np.ndarray:
    """Return when each domino has turned by FOUND [s], by energy and impacts."""
    turned = np.linspace(0.0, np.arcsin(gap / TALL), POINTS)
    own = (TALL * TALL + THICK * THICK) / 3.0  # about the foot, of mass 1
    spin, begun, times = PUSHED, 0.0, []
    for behind in range(count):
        inertia, height = moved(gap, behind, turned)
        energy = 0.5 * own * inertia[0] * spin * spin + GRAVITY * height[0]
        spins = np.sqrt(2.0 * (energy - GRAVITY * height) / (own * inertia))
        slowness = 1.0 / spins
        steps = 0.5 * (slowness[1:] + slowness[:-1]) * np.diff(turned)
        time = begun + np.concatenate([[0.0], np.cumsum(steps)])
        times.append(np.interp(FOUND, turned, time))
        begun = time[-1]
        # Next to the upright one the foremost turns as fast as that.
        spin = spins[-1] * inertia[-1] / (inertia[-1] + 1.0)
    return np.array(times)


def row(gap: float, count: int) -> str:
    velocity = [0.5 * PUSHED * TALL, 0.0, 0.5 * PUSHED * THICK]  # about its foot
    push = f"velocity: {velocity}, angular_velocity: [0, {PUSHED}, 0]"
    duration = begins(gap, count)[-1] + 0.1
    return f"""\
scene:
  surfaces: {{smooth: {{friction: 0}}, floor: {{friction: 0}}}}
  surface_pairs: {{feet: {{between: [smooth, floor], friction: 5}}}}
  bodies: {{floor: {{shape: {{kind: plane}}, surface: floor}}}}
  arrangements:
    domino:
      kind: row
      count: {count}
      origin: [0, 0, {TALL / 2}]
      gap: {gap}
      first: {{{push}}}
      body: {{shape: {{kind: box, size: [{THICK}, 0.05, {TALL}]}}, mass: 0.1, surface: smooth}}
duration: {duration}
"""


@pytest.mark.parametrize(("gap", "count", "first", "last"), ROWS)
def test_the_wave_runs_as_energy_and_impacts_say(
    gap: float, count: int, first: int, last: int
) -> None:
    """Impacts come within a step of 1/240 s, of which some have no order: 3 % are allowed."""
    states = run_scenes({"row": row(gap, count)})["row"]
    turned = 2.0 * np.arcsin(states.turn[:, 1:, 2])  # [rad], without the floor
    found = []
    for angle in turned.T:
        after = int(np.argmax(angle > FOUND))
        around = slice(after - 1, after + 1)
        found.append(np.interp(FOUND, angle[around], states.time[around]))
    exact = begins(gap, count)
    assert found[last] - found[first] == pytest.approx(exact[last] - exact[first], rel=0.03)
