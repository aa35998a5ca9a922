"""A box that meets a low stop turns about it: its face lies on the stop's face, then on its edge.

Contacts of the middle of that step have other features than those of its start, and are at their
places. Left on the turning box, they went up with it, the box came away from the stop, and ran
into it a step later.

The box slides on a smooth floor, its lower edge along it and its face past the stop's upper edge
at height s: with the angle t its lower edge is at x = -s tan t, one degree of freedom. The impact
keeps what the two contacts cannot change, m v (c - s) = M omega, M = I + m (c - s)^2 + m a^2; from
there the energy is kept.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, run_scenes

RATES = (60, 120, 240, 1000)  # steps a second
HALF, STOP, SPEED = 0.1, 0.004, 1.2  # half side of the cube [m], height of the stop [m], [m/s]
SLOP = 1e-7  # [m], the default
AHEAD = 0.0137  # way to the stop [m]
ARM = HALF - STOP
INERTIA = 2.0 / 3.0 * HALF**2 + ARM**2 + HALF**2  # M, of 1 kg
OMEGA = SPEED * ARM / INERTIA


def scene(rate: int) -> str:
    stop, cube = flow((0.1, 1.0, STOP)), flow(3 * (2.0 * HALF,))
    bodies = {
        "floor": "{shape: {kind: plane}, surface: one}",
        "stop": f"{{shape: {{kind: box, size: {stop}}}, surface: one, fixed: true, "
        f"position: {flow((0.05, 0.0, STOP / 2.0))}}}",
        "cube": f"{{shape: {{kind: box, size: {cube}}}, mass: 1.0, surface: one, "
        f"position: {flow((-HALF - AHEAD, 0.0, HALF))}, velocity: {flow((SPEED, 0.0, 0.0))}}}",
    }
    return config(bodies, rate, 0.4, surface="friction: 0", gravity=repr(GRAVITY))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes({f"stop {rate}": scene(rate) for rate in RATES})


def highest() -> float:
    """Return the angle at which the height of the centre, a (sin t + cos t - 1), takes all."""
    height = INERTIA * OMEGA**2 / (2.0 * GRAVITY)
    return math.asin((1.0 + height / HALF) / math.sqrt(2.0)) - math.pi / 4.0


@pytest.mark.parametrize("rate", RATES)
def test_box_turns_up_on_the_stop_as_far_as_its_energy_takes_it(
    ran: dict[str, States], rate: int
) -> None:
    states = ran[f"stop {rate}"]
    turn = states.turn[:, states.names.index("cube")]
    angle = 2.0 * np.arctan2(turn[:, 2], turn[:, 0])
    peak = int(np.argmax(angle))
    before, at, after = angle[peak - 1 : peak + 2]
    found = at - (after - before) ** 2 / (8.0 * (after - 2.0 * at + before))
    # Second order: some (omega dt)^2 of the angle, omega dt = 0.07 at 1/60.
    assert found == pytest.approx(highest(), rel=(OMEGA / rate) ** 2)


@pytest.mark.parametrize("rate", RATES)
def test_box_does_not_run_into_the_stop(ran: dict[str, States], rate: int) -> None:
    """Every step has its impacts in order: it would not where bodies overlap by 0.05 mm."""
    step = ran[f"stop {rate}"].step
    assert not step["unordered"].any()
    # In a step the end of an arm of STOP is off its chord by at most STOP (omega dt)^2/2, of which
    # projection takes a fifth in each step after it: five of them are there at most.
    assert step["max_penetration"].max() <= SLOP + 5.0 / 2.0 * STOP * (OMEGA / rate) ** 2
