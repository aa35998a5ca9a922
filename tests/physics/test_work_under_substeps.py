"""Work of forces and torques that act on what turns is what it gains, where substeps are chosen.

A step's work is that of its substeps, each along its own displacement and its own turn: two of a
tenth of a radian are no turn of a fifth. The balance of energy counts it (`measures.balance`).
"""

from __future__ import annotations

import numpy as np
import pytest
from shared_runs import States, run_scenes

ACCURACIES = (1e-3, 1e-5)
AT = "point: [0.05, 0.02, 0.3]"
SINE = "factor: {kind: sine, frequency: 1.7}"
FORCES = {
    "at a point": f"force: [3, 0, 5], {AT}",
    "in the body's frame": f"force: [3, 0, 5], frame: body, {AT}",
    "over time": f"force: [3, 1, 5], {AT}, {SINE}",
    "a torque": f"torque: [0.3, 0.1, 0.5], {SINE}",
}


def text(force: str, accuracy: float) -> str:
    return f"""\
scene:
  gravity: 0
  bodies:
    rod:
      shape: {{kind: box, size: [0.1, 0.2, 0.6]}}
      mass: 2.0
      position: [0, 0, 0]
      angular_velocity: [1, 3, 2]
  forces:
    - {{body: rod, {force}}}
numerics: {{timestep: 1/60, accuracy: {accuracy!r}}}
duration: 1.5
"""


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    cases = {f"{name}|{a!r}": text(force, a) for name, force in FORCES.items() for a in ACCURACIES}
    return run_scenes(cases)


@pytest.mark.parametrize("accuracy", ACCURACIES)
@pytest.mark.parametrize("name", FORCES)
def test_the_work_of_a_force_is_what_a_turning_body_gains(
    ran: dict[str, States], name: str, accuracy: float
) -> None:
    """Of velocities that are off by an accuracy a the energy is off by 2 a of it."""
    states = ran[f"{name}|{accuracy!r}"]
    energy, work = states.energy(), np.cumsum(states.step["force_work"])
    gained = energy - energy[0]
    assert states.step["substeps"].max() > 3
    assert np.abs(gained).max() > 0.3 * energy[0]
    assert np.abs(gained - work).max() < 2.0 * accuracy * energy.max()
