"""An impact just before the end of a step leaves a brief part, whose impulses are no guess.

A stack stands; beside it a ball lands and leaves so shortly before the end of a step that the
stack's impulses in the last part are no more than what solves leave. The stack's forces do not
change, and the step after has them from the step before.
"""

from __future__ import annotations

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, run_scenes

RATE, BLOCKS, LANDS = 60, 10, 24  # steps a second; blocks; the step in which the ball lands
BEFORE_END = (1e-6, 1e-8, 1e-10)  # of that step [s]
SIDE, RADIUS = 0.2, 0.05  # [m]
SURFACES = "surfaces: {one: {friction: 0.5}, elastic: {restitution: 1}}"


def scene(before: float) -> str:
    """The blocks stand askew by millimetres, so that forces are not what symmetry gives."""
    bodies = {"floor": "{shape: {kind: plane}, surface: one}"}
    for i in range(BLOCKS):
        mass, place = 10.0 if i == BLOCKS - 1 else 1.0, (0.003 * (i % 2), 0.002 * (i % 3))
        bodies[f"block_{i}"] = (
            f"{{shape: {{kind: box, size: {flow(3 * (SIDE,))}}}, mass: {mass}, surface: one, "
            f"position: {flow((*place, SIDE * (i + 0.5)))}}}"
        )
    fall = LANDS / RATE - before
    place = (1.0, 0.0, RADIUS + 0.5 * GRAVITY * fall**2)
    bodies["ball"] = (
        f"{{shape: {{kind: sphere, radius: {RADIUS}}}, mass: 1.0, surface: elastic, "
        f"position: {flow(place)}}}"
    )
    text = config(bodies, RATE, 0.5, surface="friction: 0.5", gravity=repr(GRAVITY))
    return text.replace("surfaces: {one: {friction: 0.5}}", SURFACES)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes({f"{before}": scene(before) for before in BEFORE_END})


@pytest.mark.parametrize("before", BEFORE_END)
def test_step_after_an_impact_beside_a_stack_begins_with_its_forces(
    ran: dict[str, States], before: float
) -> None:
    step = ran[f"{before}"].step
    at = LANDS  # row of the step that ends then; row 0 is the start
    assert step["parts"][at] == 3  # up to the impact, the impact, and what is left
    assert np.all(step["parts"][at + 1 : at + 4] == 1)
    # A solved start needs one sweep, which finds that nothing changes.
    assert np.all(step["sweeps"][at - 3 : at] == 1)
    assert np.all(step["sweeps"][at + 1 : at + 4] == 1)
