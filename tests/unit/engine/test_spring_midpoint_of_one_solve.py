"""The impulse of a spring off both centres is its discrete gradient's, written here in numpy.

    J = dt F (X_0 + X_1)/(l_0 + l_1),   F = k ((l_0 + l_1)/2 - L) + c (l_1 - l_0)/dt
and beta k dt (v_0 + 3 v_1)/4 beside where steps do not resolve it, of rates along the middle. Round
bodies are carried by the mean of both velocities, and by `late` more of their change.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from drawn_contacts import put_vector, random_frame
from interpreted import interpreted, records
from interpreted_steps import Steps
from laboratory import Bench, box, resolved

from lavendersim.engine import spring_midpoint
from lavendersim.engine.effects.spring import make_place
from lavendersim.engine.spring_midpoint import FAST, make_act_midway, make_find

DT, EDGE, MASSES = 0.01, 0.3, (1.3, 2.1)
MOMENTS = [m * EDGE**2 / 6.0 for m in MASSES]


def vector(row: Any, prefix: str = "") -> np.ndarray:
    return np.array([row[f"{prefix}{axis}"] for axis in "xyz"])


class Tied:
    """Two cubes of any place, turn and velocity, with a spring between points of theirs."""

    def __init__(self, rng: np.random.Generator, place: Any = (0.0, 0.0, 0.0), **spring: float):
        turns = rng.normal(size=(2, 4))
        places = [np.array(place), place + rng.normal(size=3)]
        bodies = {
            name: box((EDGE,) * 3, tuple(p), mass=mass, orientation=tuple(q / np.linalg.norm(q)))
            for name, p, mass, q in zip("ab", places, MASSES, turns, strict=True)
        }
        cell = resolved(bodies, timestep=DT, integrator="midpoint")
        points = {f"point_{name}": tuple(0.2 * random_frame(rng)[0]) for name in "ab"}
        self.law = {"stiffness": 80.0, "damping": 0.0, "rest_length": 0.4, **spring}
        cell["scene"]["springs"] = [{"a": "a", "b": "b", **points, **self.law}]
        self.bench = Bench(cell, None)
        self.spec, state = self.bench.spec, self.bench.engine.state
        self.bodies, self.velocities, self.motion = state.bodies, state.velocities, state.motion
        self.links = state.links
        for v, m in zip(self.velocities, self.motion, strict=True):
            for prefix in ("v", "w"):
                start, forced = rng.normal(size=3), 0.1 * rng.normal(size=3)
                put_vector(m, prefix, start)
                put_vector(v, prefix, start + forced)
                if prefix == "v":
                    put_vector(m, "dv", forced)
        self.free = self.velocities.copy()
        self.rows = [
            records(array) for array in (self.links, self.bodies, self.velocities, self.motion)
        ]
        pose = interpreted(make_place(self.spec))(self.rows[0][0], *self.rows[1])
        self.arms = [np.array(pose.r_a), np.array(pose.r_b)]
        self.place, self.length = make_place(self.spec), float(pose.length)

    def gained(self, name: str) -> np.ndarray:
        """Return what the spring gave each body, of momentum or angular momentum."""
        weights = MASSES if name == "v" else MOMENTS
        change = [
            vector(v, name) - vector(f, name)
            for v, f in zip(self.velocities, self.free, strict=True)
        ]
        return np.array(weights)[:, None] * np.array(change)


class Expected(NamedTuple):
    """The impulse on A, and the mean levers."""

    impulse: np.ndarray
    arms: list[np.ndarray]


def expected(tied: Tied, late: float = 0.0, late_turn: float = 0.0) -> Expected:
    """Return the law's impulse, by the velocities that were found."""
    ends, arms = [], []
    for k, arm in enumerate(tied.arms):
        m, v = tied.motion[k], tied.velocities[k]
        way = (
            0.5 * DT * (vector(m, "v") + vector(v, "v") + late * (vector(v, "v") - vector(m, "v")))
        )
        a = vector(m, "w") + vector(v, "w") + late_turn * (vector(v, "w") - vector(m, "w"))
        a = 0.25 * DT * a
        cross = np.cross(a, np.eye(3)).T  # cross @ r = a x r
        after = np.linalg.solve(np.eye(3) - cross, (np.eye(3) + cross) @ arm)  # Cayley's map
        ends.append((vector(tied.bodies[k]) + arm, vector(tied.bodies[k]) + way + after))
        arms.append(0.5 * (arm + after))
    x_0, x_1 = (ends[1][i] - ends[0][i] for i in (0, 1))
    l_0, l_1 = np.linalg.norm(x_0), np.linalg.norm(x_1)
    law, middle = tied.law, (x_0 + x_1) / np.linalg.norm(x_0 + x_1)
    force = law["stiffness"] * (0.5 * (l_0 + l_1) - law["rest_length"])
    force += law["damping"] * (l_1 - l_0) / DT
    response = sum(
        1.0 / mass + np.cross(arm, middle) @ np.cross(arm, middle) / moment
        for mass, moment, arm in zip(MASSES, MOMENTS, arms, strict=True)
    )
    if law["stiffness"] * response * DT**2 > FAST:
        beta = min(1.0, 0.25 * law["damping"] * response * DT)
        first, last = (
            middle
            @ (
                vector(rows[1], "v") + np.cross(vector(rows[1], "w"), arms[1])
                - vector(rows[0], "v") - np.cross(vector(rows[0], "w"), arms[0])
            )
            for rows in (tied.motion, tied.velocities)
        )  # fmt: skip
        force += 0.25 * beta * law["stiffness"] * DT * (first + 3.0 * last)
    return Expected(DT * force * (x_0 + x_1) / (l_0 + l_1), arms)


# Found to 1e-14 of the impulse, or as good as that; of a stiff one by digits of a metre.
FOUND = 1e-10


@pytest.mark.parametrize("damping", [0.0, 3.0])
def test_both_bodies_are_pushed_by_the_discrete_gradient(damping: float, rng) -> None:
    """And it is noted what springs added to velocities, beside the forces before them."""
    for _ in range(3):
        tied = Tied(rng, damping=damping)
        counters = records(tied.bench.engine.counters)[0]
        act = interpreted(make_act_midway(tied.spec, tied.place))
        act(*tied.rows, records(np.array([(DT,)], dtype=[("dt", "f8")]))[0], counters)
        assert counters.spring_not_converged == 0
        impulse, arms = expected(tied)
        size = FOUND * np.linalg.norm(impulse)
        np.testing.assert_allclose(vector(tied.links[0], "p"), impulse, atol=size)
        moments = [np.cross(arms[0], impulse), -np.cross(arms[1], impulse)]
        np.testing.assert_allclose(tied.gained("v"), [impulse, -impulse], atol=2.0 * size)
        np.testing.assert_allclose(tied.gained("w"), moments, atol=2.0 * size)
        for body, mass, inertia, sign, moment in zip(
            tied.bodies, MASSES, MOMENTS, (1.0, -1.0), moments, strict=True
        ):
            np.testing.assert_allclose(
                mass * vector(body, "sprung_"), sign * impulse, atol=2 * size
            )
            turned = vector(body, "to_w") - vector(body, "spun_")
            np.testing.assert_allclose(inertia * turned, moment, atol=2.0 * size)


NOT_RESOLVED = [(3e4, 60.0), (3e4, 900.0)]  # beta below 1, and 1


@pytest.mark.parametrize(("stiffness", "damping"), [(80.0, 3.0), *NOT_RESOLVED])
@pytest.mark.parametrize(("late", "late_turn"), [(0.0, 0.0), (1.0, 1.0), (0.6, 0.0), (0.0, -0.4)])
def test_bodies_that_are_carried_by_more_of_their_change_are_there(
    late: float, late_turn: float, stiffness: float, damping: float, rng
) -> None:
    tied = Tied(rng, stiffness=stiffness, damping=damping)
    if stiffness > 80.0:  # stretched by so little that it does not throw bodies about
        tied.law["rest_length"] = tied.length - 0.01
        tied.links["rest_length"] = tied.law["rest_length"]
    kernels = make_find(tied.spec, tied.place)
    interpreted(kernels.note_start)(*tied.rows)
    tied.bodies["late"], tied.bodies["late_turn"] = late, late_turn
    found, _ = interpreted(kernels.find)(*tied.rows, DT)
    assert found
    impulse, arms = expected(tied, late, late_turn)
    size = FOUND * np.linalg.norm(impulse)
    np.testing.assert_allclose(tied.gained("v"), [impulse, -impulse], atol=size)
    moments = [np.cross(arms[0], impulse), -np.cross(arms[1], impulse)]
    np.testing.assert_allclose(tied.gained("w"), moments, atol=size)


@pytest.mark.parametrize("damping", [30.0, 60.0, 900.0])
def test_newtons_method_has_the_slope_of_the_force(damping: float, monkeypatch, rng) -> None:
    """By the length at the end of the step, of which the force is linear: differenced to digits."""
    laws: list[Any] = []
    newton_step = spring_midpoint.make_newton_step

    def noted(spec: Any, place: Any, law: Any, push: Any) -> Any:
        laws.append(law)
        return newton_step(spec, place, law, push)

    monkeypatch.setattr(spring_midpoint, "make_newton_step", noted)
    for stiffness in (80.0, 3e4):
        tied = Tied(rng, stiffness=stiffness, damping=damping)
        make_find(tied.spec, tied.place)
        links, bodies, _, motion = tied.rows
        start = interpreted(tied.place)(links[0], *bodies)
        law = interpreted(laws[-1])
        (one, slope), (two, _) = (
            law(links[0], bodies, motion, start, end, DT) for end in (1.0, 1.5)
        )
        assert two - one == pytest.approx(0.5 * slope, rel=1e-12)


def test_an_uneven_body_that_a_spring_twists_goes_on_by_the_mean_velocity(rng) -> None:
    """m (x_1 - x_0) = m dt (v_0 + v_1)/2 of each body, whatever it is pulled by."""
    bodies = [
        box((0.2, 0.3, 0.1), place, velocity=tuple(rng.normal(size=3)))
        for place in ((0.0, 0.0, 0.0), (0.5, 0.2, 0.1))
    ]
    points = {"point_a": (0.05, 0.1, -0.02), "point_b": (-0.08, 0.03, 0.04)}
    cell = resolved(dict(zip("ab", bodies, strict=True)), timestep=DT, integrator="midpoint")
    spring = {"a": "a", "b": "b", "damping": 0.0, "stiffness": 300.0, "rest_length": 0.3}
    cell["scene"]["springs"] = [{**spring, **points}]
    steps = Steps(cell)
    assert steps.spec.has("gyroscopic")
    places, before = steps.places, steps.velocities
    steps.run(1)
    assert abs(steps.velocities - before).max() > 0.1
    mean = 0.5 * (before + steps.velocities)
    np.testing.assert_allclose(steps.places - places, DT * mean, atol=1e-15)
