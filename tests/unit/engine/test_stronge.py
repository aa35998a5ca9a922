"""Stronge's law at one contact: planar impacts in closed form, a spatial one by another march.

In a plane slip keeps its direction until it stops, so u_n and u_t are linear in the impulse from
one event to the next and the work of each piece is its mean speed times its impulse.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numba
import numpy as np
import pytest

from lavendersim.engine import stronge
from lavendersim.engine.spec import Spec
from lavendersim.engine.stronge import make_leave

FIELDS = ("k_n", "k_n1", "k_n2", "i_11", "i_12", "i_22", "mu", "approach_speed", "e")
SPEC = Spec(("friction", "restitution"), ("sphere_plane",), "adaptive", tolerance=True)
LEAVE = make_leave(SPEC)


@numba.njit
def leave(contacts, u_1, u_2):
    return LEAVE(contacts[0], u_1, u_2)


def row_of(matrix: np.ndarray, mu: float, e: float, hit: float) -> np.ndarray:
    """Return a contact with K (rows n, t1, t2) that meets at a speed."""
    contact = np.zeros(1, np.dtype([(name, "f8") for name in FIELDS]))
    inverse = np.linalg.inv(matrix[1:, 1:])
    values = (*matrix[0], inverse[0, 0], inverse[0, 1], inverse[1, 1], mu, hit, e)
    for name, value in zip(FIELDS, values, strict=True):
        contact[name] = value
    return contact


def speed(matrix: np.ndarray, mu: float, e: float, hit: float, slip: tuple[float, float]) -> float:
    """Return what the kernel makes of K and a velocity (-hit, *slip)."""
    found, ended = leave(row_of(matrix, mu, e, hit), *slip)
    assert ended
    return float(found)


class Planar(NamedTuple):
    k_n: float
    k_nt: float
    k_t: float


def closed_form(k: Planar, mu: float, e: float, hit: float, slip: float) -> float:
    """Piece by piece: slip until it stops, then stick, or slip back where friction cannot hold."""
    held = -k.k_nt / k.k_t
    first = -mu if slip > 0.0 else mu
    pieces = []  # du_n per impulse, impulse it lasts
    closing = k.k_nt + k.k_t * first
    if slip != 0.0:
        lasts = -slip / closing if closing * slip < 0.0 else np.inf
        pieces.append((k.k_n + k.k_nt * first, lasts))
    after = held if abs(held) <= mu else (mu if held > 0.0 else -mu)
    pieces.append((k.k_n + k.k_nt * after, np.inf))
    u, work, back = -hit, 0.0, None
    for rate, lasts in pieces:
        left = lasts
        if back is None:
            if u + rate * left < 0.0 or rate <= 0.0:
                work += (u + 0.5 * rate * left) * left
                u += rate * left
                continue
            spent = -u / rate
            work += 0.5 * u * spent
            u, left, back = 0.0, left - spent, -e * e * work
        gain = (u + 0.5 * rate * left) * left if np.isfinite(left) else np.inf
        if gain >= back:
            return sqrt(u * u + 2.0 * rate * back)
        back -= gain
        u += rate * left
    raise AssertionError("the last piece has no end")


RODS = [Planar(*k) for k in ((2.0, 1.2, 3.0), (3.0, -1.5, 1.5), (1.6, 0.9, 1.0), (2.0, 0.0, 3.5))]


@pytest.mark.parametrize("e", [0.0, 0.3, 0.9, 1.0])
@pytest.mark.parametrize("mu", [0.1, 0.5, 1.1])
@pytest.mark.parametrize("slip", [-3.0, -0.4, 0.0, 0.4, 3.0])
@pytest.mark.parametrize("k", RODS)
def test_a_planar_impact_leaves_at_the_speed_of_the_closed_form(k, slip, mu, e):
    """Every part is linear and ends at its event: round-off of some 300 parts."""
    matrix = np.array([[k.k_n, k.k_nt, 0.0], [k.k_nt, k.k_t, 0.0], [0.0, 0.0, 2.0]])
    found = speed(matrix, mu, e, 2.0, (slip, 0.0))
    assert found == pytest.approx(closed_form(k, mu, e, 2.0, slip), abs=1e-11)


def march(matrix: np.ndarray, mu: float, e: float, u: np.ndarray, parts: int) -> float:
    """Explicit Euler in the impulse: first order in 1/parts."""
    part = -u[0] / (matrix[0, 0] * parts)
    work = back = 0.0
    compressing = True
    while True:
        slip = np.hypot(*u[1:])
        change = matrix @ np.array([1.0, *(-mu * u[1:] / slip)]) * part
        mean = u[0] + 0.5 * change[0]
        if compressing:
            work += mean * part
        else:
            back += mean * part
        u = u + change
        compressing = compressing and u[0] < 0.0
        if not compressing and back >= -e * e * work:
            beyond = back + e * e * work  # the last part's share that is too much
            return float(np.sqrt(u[0] * u[0] - 2.0 * beyond * change[0] / part))


def test_a_slip_that_turns_is_followed():
    """It turns by some 60 degrees and never stops. Euler's error halves with its parts, so the
    difference of two marches is the error of the finer one, which is taken off; ours is of second
    order in 256 parts, (1/256)^2 = 1.5e-5 of what the turning changes.
    """
    matrix = np.array([[2.0, 0.5, 0.7], [0.5, 3.0, 0.4], [0.7, 0.4, 2.5]])
    start = np.array([-2.0, 3.0, -1.0])
    coarse, fine = (march(matrix, 0.4, 0.8, start, parts) for parts in (10_000, 20_000))
    found = speed(matrix, 0.4, 0.8, 2.0, (3.0, -1.0))
    assert abs(coarse - fine) < 1e-3
    assert found == pytest.approx(2.0 * fine - coarse, abs=1e-5)


def test_without_friction_it_is_newtons_law():
    matrix = np.diag([2.0, 3.0, 3.0])
    assert speed(matrix, 0.0, 0.7, 2.0, (1.0, 0.5)) == pytest.approx(1.4, abs=1e-13)


@pytest.mark.parametrize(("parts", "ends"), [(stronge.PARTS - 2, False), (3 * stronge.PARTS, True)])
def test_an_impact_that_takes_all_its_parts_says_so(
    parts: int, ends: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Compression alone takes PARTS without friction, and restitution the share e of them."""
    monkeypatch.setattr(stronge, "MOST_PARTS", parts)
    short = make_leave(SPEC)

    @numba.njit
    def leave_soon(contacts):
        return short(contacts[0], 1.0, 0.5)

    found, ended = leave_soon(row_of(np.diag([2.0, 3.0, 3.0]), 0.0, 0.5, 2.0))
    assert ended == ends
    assert found == (pytest.approx(1.0, abs=1e-13) if ends else 0.0)
