"""An upright prism of n sides on a slope tips where statics says, whichever edge is down the slope.

The weight of a prism of height h leaves the polygon that it stands on at tan(angle) = b/(h/2). b is
how far the polygon's edge is from its centre along the slope: a/cos(azimuth - that of the edge's
normal), a: the radius of the circle inside. Of its corners, five and more, a manifold has rows for
four, and those need not be the ones that carry it.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, plane, run_scenes

RADIUS, HEIGHT = 0.07, 0.3  # of the circle through the corners
SIDES = (5, 6, 8)
BELOW = (0.98, 0.999)  # of the tipping angle
BEYOND = 1.001
ASIDE = (-0.3, 0.0, 0.4)  # of the slope from the normal of an edge, of the angle of a side
FRICTION = 2.0
RATE = 240
SLOP = 1e-7  # [m], the default


def azimuths(sides: int) -> list[float]:
    """Return directions of the slope, three for each edge: none at a corner."""
    side = 2.0 * math.pi / sides
    return [side * (k + 0.5 + aside) for k in range(sides) for aside in ASIDE]


def leaning(sides: int, azimuth: float, share: float) -> str:
    """Return a config whose gravity is turned instead of its floor; share: of the tipping angle."""
    side = 2.0 * math.pi / sides
    aside = (azimuth % side) - 0.5 * side
    reach = RADIUS * math.cos(0.5 * side) / math.cos(aside)
    angle = share * math.atan(reach / (HEIGHT / 2.0))
    assert math.tan(angle) < 0.5 * FRICTION
    along = math.sin(angle) * np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    gravity = GRAVITY * (along - np.array([0.0, 0.0, math.cos(angle)]))
    outline = [
        (RADIUS * math.cos(k * side), RADIUS * math.sin(k * side), z)
        for k in range(sides)
        for z in (-HEIGHT / 2.0, HEIGHT / 2.0)
    ]
    shape = f"{{kind: hull, points: [{', '.join(map(flow, outline))}]}}"
    upright = f"{{shape: {shape}, mass: 1.0, surface: one, position: [0, 0, {HEIGHT / 2.0}]}}"
    bodies = {"floor": plane(), "upright": upright}
    seconds = 1.5 if share > 1.0 else 0.25
    return config(bodies, RATE, seconds, f"friction: {FRICTION}", flow(gravity))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    # What falls takes six times as long as what stands: one azimuth for each edge.
    scenes = [
        (sides, share, k, azimuth)
        for sides in SIDES
        for share in (*BELOW, BEYOND)
        for k, azimuth in enumerate(azimuths(sides))
        if share < 1.0 or k % len(ASIDE) == 0
    ]
    return run_scenes({f"{n} {s} {k}": leaning(n, azimuth, s) for n, s, k, azimuth in scenes})


@pytest.mark.parametrize("share", BELOW)
@pytest.mark.parametrize("sides", SIDES)
def test_it_stands_below_its_angle(ran: dict[str, States], sides: int, share: float) -> None:
    """A corner without a row may sink by the slop in the step in which it starts, and by as much in
    the next one, in which it has a row and stops: bodies move by the mean of both ends of a step.
    The prism then leans by 2 slop/d at most, d: of a corner from the chord of its neighbours, and
    its centre is aside by h/2 of that. From there on steps solved to 1e-9 m/s move it by no more
    than 1e-9 m a second.

    One that tips at 0.999 of its angle begins with some 0.001 g sideways: after a quarter of a
    second it is a hundred times as far.
    """
    leans = 2.0 * SLOP / (RADIUS * (1.0 - math.cos(2.0 * math.pi / sides)))
    for k in range(sides * len(ASIDE)):
        place, _, _ = ran[f"{sides} {share} {k}"].of("upright")
        assert abs(place - place[0]).max() <= leans * HEIGHT / 2.0 + 3e-9
        assert abs(place[RATE // 10 :] - place[-1]).max() <= 3e-9


@pytest.mark.parametrize("sides", SIDES)
def test_it_falls_a_thousandth_above(ran: dict[str, States], sides: int) -> None:
    """It begins 3.6e-4 rad beyond its unstable balance on the edge, at the least, and departs from
    it by cosh(t/T), T = sqrt(k^2/(g d)) = 0.149 s at most, k^2: its moment of inertia about the
    edge by its mass, at most R^2/4 + h^2/12 + d^2, d^2 = a^2 + h^2/4: within 1.2 s it has turned by
    half a radian.
    """
    for k in range(0, sides * len(ASIDE), len(ASIDE)):
        states = ran[f"{sides} {BEYOND} {k}"]
        _, x, y, _ = states.turn[-1, states.names.index("upright")]
        assert 1.0 - 2.0 * (x * x + y * y) < math.cos(0.5)
