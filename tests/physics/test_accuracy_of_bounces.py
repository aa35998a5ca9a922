"""Substeps as long as an accuracy allows, of a ball on a spring that it meets anywhere in a step.

Flight is without an error, so that the substep in which the spring is met is tried as long as the
timestep. What of it is pressed must have an error that is estimated, wherever it begins.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, plane, run_scenes

ACCURACIES = (1e-4, 1e-5, 1e-6)
LONGEST = 1.0 / 60.0  # [s]
# When it meets the spring first, in longest substeps: in the first half of one and in the second.
MEETS = (6.06, 6.3, 6.45, 6.55, 6.7, 6.9)
COMPLIANCE = 2e-4  # of both surfaces [m/N], of a ball of 1 kg
OMEGA = 1.0 / math.sqrt(COMPLIANCE)


def fall(share: float) -> float:
    return share * LONGEST


def height(share: float) -> float:
    return 0.5 * GRAVITY * fall(share) ** 2


def bouncing(share: float, accuracy: float) -> str:
    """Return the config of a ball that falls so many longest substeps, for a second."""
    bodies = {"floor": plane(), "ball": ball(0.1, 1.0, (0, 0, 0.1 + height(share)))}
    text = config(bodies, 60, 1.0, f"compliance: {COMPLIANCE / 2}", f"[0, 0, -{GRAVITY}]")
    return text.replace("timestep: 1/60", f"timestep: 1/60, accuracy: {accuracy!r}")


def worst(states: States, share: float) -> float:
    """Return how far it is off at the end of any step, of the path that it flies in the run.

    It presses by A (1 - cos w t) + B sin w t, A = g/w^2, B = v/w, and flies for twice its fall.
    """
    a, b = GRAVITY / OMEGA**2, GRAVITY * fall(share) / OMEGA
    pressed = 2.0 * (math.pi - math.atan(b / a)) / OMEGA
    since = (states.time + fall(share)) % (2.0 * fall(share) + pressed)  # since it left the spring
    phase = OMEGA * (since - 2.0 * fall(share))
    inside = -(a * (1.0 - np.cos(phase)) + b * np.sin(phase))
    flying = GRAVITY * (fall(share) - 0.5 * since) * since
    there = np.where(since > 2.0 * fall(share), inside, flying)
    periods = states.time[-1] / (2.0 * fall(share) + pressed)
    path = 2.0 * height(share) * periods
    place, _, _ = states.of("ball")
    return float(abs(place[:, 2] - 0.1 - there).max() / path)


@pytest.fixture(scope="module")
def ran() -> dict[tuple[float, float], States]:
    cases = {(share, each): f"{share} {each}" for share in MEETS for each in ACCURACIES}
    found = run_scenes({name: bouncing(*case) for case, name in cases.items()})
    return {case: found[name] for case, name in cases.items()}


@pytest.mark.parametrize("share", MEETS)
def test_no_bounce_is_off_by_ten_times_what_is_asked_for(
    ran: dict[tuple[float, float], States], share: float
) -> None:
    """A pressed half of the longest substep may be off by (w dt/2)^3/12 = 0.02 of the speed."""
    assert all(worst(ran[share, each], share) <= 10.0 * each for each in ACCURACIES)


def test_bounces_are_off_by_a_tenth_of_what_is_asked_for_in_nine_of_ten_cases(
    ran: dict[tuple[float, float], States],
) -> None:
    """Where they are off most: at its highest point a ball that comes late is off by nothing."""
    enough = [worst(states, share) >= 0.1 * each for (share, each), states in ran.items()]
    assert sum(enough) >= 0.9 * len(enough)
