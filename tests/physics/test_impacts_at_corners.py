"""A frictionless ball leaves a corner or a wedge as its walls have it, met at once or in turn.

At e = 1, where mirrors give the velocity in closed form. All scenes are run in one engine.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from shared_runs import States, ball, config, plane, run_scenes

RATES = (60, 240, 1000)  # steps a second
CORNERS = tuple(itertools.product((2, 3), ("at once", "in turn"), range(4)))
RADIUS = 0.05  # [m]
# An impact is solved to the default tolerance of a step.
IMPACT = 1e-9  # [m/s]


def corner(walls: int, how: str, aim: int, rate: int) -> tuple[str, np.ndarray]:
    """Walls at right angles; with the velocity that every wall has turned round."""
    away = np.zeros(3)
    away[:walls] = [(1, 1, 1), (1, 2, 3), (3, 1, 0.5), (1, 5, 2)][aim][:walls]
    away /= np.linalg.norm(away)
    start = np.zeros(3)
    start[:walls] = RADIUS
    start += (0.3 + 3.0 / rate * aim / 4.0) * away
    if how == "in turn":
        start[:walls] += np.array([0.0, 0.004, 0.010])[:walls]
    bodies = {f"wall{k}": plane(np.eye(3)[k]) for k in range(walls)}
    bodies["ball"] = ball(RADIUS, 1.0, start, tuple(-3.0 * away))
    # The farthest that the ball has to come to the last wall: 10 mm at its least share of 3 m/s.
    late = (0.3 + 3.0 / rate + 0.010 / min(away[:walls])) / 3.0
    return config(bodies, rate, math.ceil(late * rate + 1) / rate), 3.0 * away


def wedge(angle: float, aside: float, rate: int) -> tuple[str, np.ndarray]:
    """Walls at 30 degrees on either side of -x, a ball from there; with its velocity."""
    tilt = math.radians(30)
    bodies = {
        f"wall{k}": plane((-math.sin(tilt), sign * math.cos(tilt), 0))
        for k, sign in enumerate((1, -1))
    }
    velocity = 3.0 * np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0])
    apex = np.array([-RADIUS / math.sin(tilt), 0, 0])  # of the places that the centre can take
    bodies["ball"] = ball(RADIUS, 1.0, apex - 0.1 * velocity + (0, aside, 0), tuple(velocity))
    return config(bodies, rate, math.ceil(0.2 * rate) / rate), velocity


CORNERED = {(*key, rate): corner(*key, rate) for key in CORNERS for rate in RATES}
WEDGED = {
    (angle, aside, rate): wedge(angle, aside, rate)
    for angle, aside in ((-24, 0.003), (-7, -0.003), (11, 0.003), (-20, 0), (0, 0), (28, 0))
    for rate in RATES
}


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"corner {key}": text for key, (text, _) in CORNERED.items()}
    return run_scenes(texts | {f"wedge {key}": text for key, (text, _) in WEDGED.items()})


@pytest.mark.parametrize(("walls", "how", "aim"), CORNERS)
@pytest.mark.parametrize("rate", RATES)
def test_every_wall_of_a_corner_turns_its_own_velocity_round(
    ran: dict[str, States], walls: int, how: str, aim: int, rate: int
) -> None:
    got = ran[f"corner {(walls, how, aim, rate)}"].velocity[-1, -1]
    # Three impacts or rows at right angles, which have no part in each other.
    expected = CORNERED[walls, how, aim, rate][1]
    np.testing.assert_allclose(got, expected, atol=math.sqrt(3) * IMPACT)


@pytest.mark.parametrize("key", WEDGED)
def test_wedge_of_60_degrees_turns_a_ball_round(
    ran: dict[str, States], key: tuple[float, float, int]
) -> None:
    """In turn: three reflections, in either order R1 R2 R1 = R2 R1 R2 = diag(-1, 1): the only
    composition that leads out of the wedge again. At once: both normal velocities turn round, so
    all of it does; both impulses push, as -v is within the cone of the normals.
    """
    velocity = WEDGED[key][1]
    in_turn = key[1] != 0
    got = ran[f"wedge {key}"].velocity[-1, -1]
    # Three impacts. At once: two rows at 120 degrees, whose errors add to 1/cos(60) of one.
    np.testing.assert_allclose(got, velocity * ([-1, 1, 1] if in_turn else -1), atol=3 * IMPACT)
