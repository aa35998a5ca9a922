"""Plates that land on an edge, bounce, pivot and rock to rest, against their events.

A box falls tilted onto a smooth floor, e = 0.3, in a plane: its height z and its tilt th. The twin
has flights in closed form, the time of each meeting by a root, impacts by Newton's law for both
edges in one problem, and what an edge that stays on the floor lets move as an ODE. Bounces of an
edge are shorter by e each, without end: the twin follows them down to 1 ns.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from shared_runs import GRAVITY, States, config, flow, plane, run_scenes

E = 0.3
DURATION = 0.6
RATES = (240, 480, 960)  # steps a second
CLOSED = 1e-10  # [m]: an edge on the floor
# Half of its width, half of its height, its tilt and what is below its lower edge at first.
PLATES = {
    "thin": (0.2, 0.01, 0.05, 0.1),
    "steep": (0.2, 0.01, 0.2, 0.1),
    "slab": (0.2, 0.02, 0.01, 0.05),
    "block": (0.2, 0.1, 0.1, 0.2),
}


class Plate:
    """A box of 1 kg; q = (z, th), v their rates; edges at (+-a, -h) in its frame."""

    def __init__(self, a: float, h: float) -> None:
        self.a, self.h, self.inertia = a, h, (a * a + h * h) / 3.0

    def edges(self, th: float) -> np.ndarray:
        """Return where the two edges are from its centre, (2, 2): x and height."""
        c, s, one = math.cos(th), math.sin(th), np.array([1.0, -1.0])
        return np.stack([one * self.a * c - self.h * s, -one * self.a * s - self.h * c], axis=1)

    def heights(self, q: Any) -> np.ndarray:
        return q[0] + self.edges(q[1])[:, 1]

    def rates(self, q: Any, v: Any) -> np.ndarray:
        return v[0] - self.edges(q[1])[:, 0] * v[1]

    def energy(self, q: Any, v: Any) -> float:
        """Return what it has above lying flat [J]."""
        return 0.5 * v[0] ** 2 + 0.5 * self.inertia * v[1] ** 2 + GRAVITY * (q[0] - self.h)

    def push(self, q: Any, w: float, edge: int) -> float:
        """Return the force of an edge that stays on the floor [N]."""
        x, y = self.edges(q[1])[edge]
        return float((GRAVITY + y * w * w) / (1.0 + x * x / self.inertia))

    def impact(self, q: Any, v: np.ndarray) -> np.ndarray:
        """Return velocities behind an impact: of pushes >= 0 those that leave v+ + e v- >= 0."""
        rates, x = self.rates(q, v), self.edges(q[1])[:, 0]
        closed = np.flatnonzero(self.heights(q) < CLOSED)
        for many in range(1, len(closed) + 1):
            for active in itertools.combinations(closed, many):
                rows = np.array([[1.0, -x[k] / self.inertia] for k in active])
                levers = np.array([[1.0, -x[k]] for k in active])
                asked = -rates[list(active)] - E * np.minimum(rates[list(active)], 0.0)
                pushes = np.linalg.solve(levers @ rows.T, asked)
                after = v + rows.T @ pushes
                left = self.rates(q, after) + E * np.minimum(rates, 0.0)
                if (pushes >= -1e-12).all() and (left[closed] >= -1e-12).all():
                    return after
        raise AssertionError("no impact leaves both edges outside")


class Twin:
    """The motion of a plate, by events; `states(times)` has its q and v."""

    def __init__(self, plate: Plate, q: tuple[float, float]) -> None:
        self.plate, self.at = plate, 0.0
        self.q, self.v = np.array(q), np.zeros(2)
        self.taken: list[np.ndarray] = []

    def flown(self, t: float) -> tuple[np.ndarray, np.ndarray]:
        fall = np.array([GRAVITY, 0.0])
        return self.q + t * self.v - 0.5 * t * t * fall, self.v - t * fall

    def meeting(self) -> float:
        """Return when the first edge meets the floor in flight [s]."""
        first = math.inf
        for edge in range(2):

            def height(t: float, edge: int = edge) -> float:
                return float(self.plate.heights(self.flown(t)[0])[edge])

            low = 0.0
            if self.plate.heights(self.q)[edge] < CLOSED:
                y = self.plate.edges(self.q[1])[edge, 1]
                rate = self.plate.rates(self.q, self.v)[edge]
                low = rate / (GRAVITY + y * self.v[1] ** 2)  # half of a small bounce
            bounces = 0.0 < low < 1e-3
            grid = low * 1.5 ** np.arange(60) if bounces else 1e-6 + np.linspace(0.0, DURATION, 600)
            for one, other in itertools.pairwise(grid):
                if height(other) < 0.0:
                    met = height(one) > 0.0
                    first = min(first, brentq(height, one, other, xtol=1e-15) if met else one)
                    break
        return first

    def take(self, times: np.ndarray, until: float, states: Any) -> None:
        due = times[len(self.taken) :]
        for t in due[due <= until]:
            self.taken.append(np.concatenate(states(t - self.at)))

    def states(self, times: np.ndarray) -> np.ndarray:
        while len(self.taken) < len(times):
            closed = self.plate.heights(self.q) < CLOSED
            rates = self.plate.rates(self.q, self.v)
            stays = [k for k in range(2) if closed[k] and abs(rates[k]) < 1e-8]
            stays = [k for k in stays if self.plate.push(self.q, self.v[1], k) > 0.0]
            if len(stays) == 2:
                self.take(times, math.inf, lambda _: (np.array([self.plate.h, 0.0]), np.zeros(2)))
            elif stays:
                self.pivot(times, stays[0])
            else:
                self.fly(times)
        return np.array(self.taken)

    def fly(self, times: np.ndarray) -> None:
        length = self.meeting()
        self.take(times, self.at + length, self.flown)
        (self.q, self.v), self.at = self.flown(length), self.at + length
        self.v = self.plate.impact(self.q, self.v)

    def pivot(self, times: np.ndarray, edge: int) -> None:
        plate = self.plate

        def motion(_: float, state: np.ndarray) -> list[float]:
            x = plate.edges(state[0])[edge, 0]
            return [state[1], -x * plate.push((0.0, state[0]), state[1], edge) / plate.inertia]

        def placed(state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            x, y = plate.edges(state[0])[edge]
            return np.array([-y, state[0]]), np.array([x * state[1], state[1]])

        def other(_: float, state: np.ndarray) -> float:
            return float(plate.heights(placed(state)[0])[1 - edge])

        def lifts(_: float, state: np.ndarray) -> float:
            return plate.push((0.0, state[0]), state[1], edge)

        other.terminal = lifts.terminal = True  # type: ignore[attr-defined]
        other.direction = -1.0  # type: ignore[attr-defined]
        begin = np.array([self.q[1], self.v[1]])
        done = solve_ivp(
            *(motion, (0.0, DURATION), begin), method="DOP853", events=(other, lifts),
            rtol=1e-12, atol=1e-13, dense_output=True,
        )  # fmt: skip
        length = float(done.t[-1])
        self.take(times, self.at + length, lambda t: placed(done.sol(t)))
        (self.q, self.v), self.at = placed(done.y[:, -1]), self.at + length
        if done.t_events[0].size:
            self.v = plate.impact(self.q, self.v)
            if abs(self.v[1]) < 1e-7:
                self.v[:] = 0.0


def text(name: str, rate: int) -> str:
    a, h, th, drop = PLATES[name]
    height = h * math.cos(th) + a * math.sin(th) + drop
    shape = f"{{kind: box, size: {flow((2 * a, 0.4, 2 * h))}}}"
    turn = flow((math.cos(th / 2.0), 0.0, math.sin(th / 2.0), 0.0))
    plate = f"position: {flow((0, 0, height))}, orientation: {turn}, surface: one"
    bodies = {"floor": plane(), "plate": f"{{shape: {shape}, mass: 1.0, {plate}}}"}
    return config(bodies, rate, DURATION, f"restitution: {E}", repr(GRAVITY))


@pytest.fixture(scope="module")
def runs() -> dict[str, States]:
    return run_scenes({f"{name} {rate}": text(name, rate) for name in PLATES for rate in RATES})


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("name", PLATES)
def test_a_plate_bounces_rocks_and_rests_as_its_events_have_it(
    runs: dict[str, States], name: str, rate: int
) -> None:
    """At second order: while an edge lasts, by the square of the angle that a step turns it by.

    A turn that is off moves an edge by its lever a: m a^2/I = 3 of a plate without height. Impacts
    are at their times, so that no sample is on another side of one.
    """
    a, h, th, drop = PLATES[name]
    plate, run = Plate(a, h), runs[f"{name} {rate}"]
    lowest = h * math.cos(th) + a * math.sin(th)
    expected = Twin(plate, (lowest + drop, th)).states(run.time)
    place, velocity, spin = run.of("plate")
    energy = 0.5 * (velocity**2).sum(axis=1) + 0.5 * plate.inertia * spin[:, 1] ** 2
    energy += GRAVITY * (place[:, 2] - h)
    truth = np.array([plate.energy(row[:2], row[2:]) for row in expected])
    assert truth[-1] < 0.01 * truth[0]  # it has bounced, and rocks
    turned = np.abs(expected[:, 3]).max() / rate
    assert np.abs(energy - truth).max() < 3.0 * turned**2 * truth[0]
    assert np.abs(place[:, 2] - expected[:, 0]).max() < 3.0 * turned**2 * a
