"""A gap in a cavity is foreseen to close where the chord of the flight ends."""

from __future__ import annotations

import math

import numpy as np
import pytest
from interpreted import interpreted, records
from single_bodies import body, row

from lavendersim.engine.cavity_flight import make_closing
from lavendersim.engine.records import CONTACT, MOTION, dtype
from lavendersim.engine.spec import Spec

R, BALL = 2.0, 0.5
SPEC = Spec(("rotation", "speculative"), ("sphere_bowl", "box_bowl", "sphere_drum"))
CLOSING = interpreted(make_closing(SPEC))


class Pair:
    a, b = 0, 1


def acceleration(cavity: str, place, velocity, left: float) -> tuple[float, float, float]:
    """Return it [m/s^2], of a ball, with the gap and its rate."""
    bodies = [row(body(cavity, (R, 0.0, 0.0))), row(body("sphere", (BALL, 0.0, 0.0), place))]
    contact, motion = np.zeros(1, dtype(CONTACT)), np.zeros(2, dtype(MOTION))
    d = np.array(place) * (1.0, 1.0, 0.0 if cavity == "drum" else 1.0)
    n = -d / np.linalg.norm(d)
    gap = R - BALL - float(np.linalg.norm(d))
    point = np.array(place) - (BALL + 0.5 * gap) * n
    contact[0]["b"], contact[0]["phi"] = 1, gap
    for k, axis in enumerate("xyz"):
        contact[0][axis], contact[0][f"n{axis}"] = point[k], n[k]
        motion[1][f"v{axis}"] = velocity[k]
    found = CLOSING(records(contact)[0], Pair, bodies, records(motion), left)
    return float(found), gap, float(n @ velocity)


@pytest.mark.parametrize("cavity", ["bowl", "drum"])
@pytest.mark.parametrize("velocity", [(3.0, 1.0, 0.0), (0.0, 4.0, 1.0), (-5.0, 0.5, 2.0)])
def test_the_gap_is_closed_when_the_flight_is_at_the_wall(cavity: str, velocity) -> None:
    place = np.array([0.9, 0.3, 0.2])
    a, gap, rate = acceleration(cavity, place, velocity, 10.0)
    flat = np.array([1.0, 1.0, 0.0 if cavity == "drum" else 1.0])
    u, v = place * flat, np.array(velocity) * flat
    polynomial = [v @ v, 2.0 * (u @ v), u @ u - (R - BALL) ** 2]
    t = float(max(np.roots(polynomial).real))
    assert gap + rate * t + 0.5 * a * t * t == pytest.approx(0.0, abs=1e-13)


def test_what_stays_within_the_part_has_the_acceleration_of_its_start() -> None:
    """phi'' = -(|v|^2 - v_n^2)/rho of a circle; of the wall's radius where it touches."""
    a, gap, _ = acceleration("bowl", (R - BALL, 0.0, 0.0), (0.0, 3.0, 4.0), 1e-6)
    assert gap == pytest.approx(0.0, abs=1e-15)
    assert a == pytest.approx(-25.0 / (R - BALL), rel=1e-12)
    assert acceleration("bowl", (0.5, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0)[0] == 0.0
    assert math.isfinite(acceleration("bowl", (1e-9, 0.0, 0.0), (1.0, 0.0, 0.0), 1.0)[0])
