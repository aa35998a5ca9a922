"""A free spin keeps its angular momentum and energy; a jump has the energy it was promised."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from interpreted import interpreted
from plain_facts import body_facts, facts, one_row, pair_facts, vector_fields

from lavendersim.engine import rotation
from lavendersim.engine.effects import gyroscopic
from lavendersim.engine.effects.gyroscopic import EFFECT
from lavendersim.engine.records import GIVES, JUMPS, RESTRAINED
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

INERTIA = np.array([0.2, 0.5, 0.6])


def copied(row):
    """Return another row of the same fields."""
    return one_row(**{name: float(row[name]) for name in row._row.dtype.names})


class Spinning:
    """A turned body of unequal inertias with a spin."""

    def __init__(self, rng, inertia=INERTIA, spin: float = 1.0) -> None:
        q = rng.normal(size=4)
        q /= np.linalg.norm(q)
        matrix, self.inertia = convex.matrix_of(q), inertia
        names = [f"r{i}{j}" for i in range(3) for j in range(3)]
        self.body = one_row(
            **dict(zip(("qw", "qx", "qy", "qz"), q, strict=True)),
            **dict(zip(names, matrix.ravel(), strict=True)),
            **{f"inv_i{axis}": 1.0 / i for axis, i in zip("xyz", inertia, strict=True)},
        )
        self.velocity = one_row(**vector_fields("w", spin * rng.normal(size=3)))

    @property
    def matrix(self) -> np.ndarray:
        return np.array([[self.body[f"r{i}{j}"] for j in range(3)] for i in range(3)])

    @property
    def omega(self) -> np.ndarray:
        return np.array([self.velocity[f"w{axis}"] for axis in "xyz"])

    @property
    def tensor(self) -> np.ndarray:
        return self.matrix @ np.diag(self.inertia) @ self.matrix.T

    @property
    def momentum(self) -> np.ndarray:
        return self.tensor @ self.omega

    @property
    def energy(self) -> float:
        return float(0.5 * self.omega @ self.momentum)


def test_a_free_turn_keeps_momentum_and_energy_and_follows_euler(rng) -> None:
    """The change of the body's spin in a short step: I dw/dt = (I w) x w, body axes."""
    kernel = interpreted(gyroscopic.make(Spec(("rotation",))))
    for _ in range(10):
        one = Spinning(rng, spin=5.0)
        momentum, energy, local = one.momentum, one.energy, one.matrix.T @ one.omega
        dt = 1e-4
        assert kernel(one.body, one.velocity, dt)
        np.testing.assert_allclose(one.momentum, momentum, atol=1e-13)
        assert one.energy == pytest.approx(energy, rel=1e-13)
        rate = (one.matrix.T @ one.omega - local) / dt
        euler = np.cross(INERTIA * local, local) / INERTIA
        np.testing.assert_allclose(rate, euler, atol=1e-3 * np.linalg.norm(local) ** 3)
        for _ in range(50):  # and over long steps
            assert kernel(one.body, one.velocity, 0.05)
        np.testing.assert_allclose(one.momentum, momentum, atol=1e-12)
        assert one.energy == pytest.approx(energy, rel=1e-12)


def test_the_middle_momentum_solves_its_equation_or_says_that_it_does_not(rng) -> None:
    find = interpreted(gyroscopic.make_find_middle(Spec()))
    one = Spinning(rng)
    for _ in range(20):
        p, dt = rng.normal(size=3), 0.1
        *m, found = find(one.body, *p, dt)
        assert found
        m = np.array(m)
        np.testing.assert_allclose(m - 0.5 * dt * np.cross(m, m / INERTIA), p, atol=1e-14)
    assert not find(one.body, np.nan, 1.0, 1.0, 0.1)[3]


def test_newton_doubles_its_digits(rng, monkeypatch) -> None:
    """From 0.1 of the momentum off, 1e-14 takes four passes; a wrong derivative gains one digit."""
    monkeypatch.setattr(gyroscopic, "PASSES", 5)
    find = interpreted(gyroscopic.make_find_middle(Spec()))
    for _ in range(20):
        p = rng.normal(size=3)
        dt = 0.3 / np.linalg.norm(p / INERTIA)
        assert find(Spinning(rng).body, *p, dt)[3]


def test_a_turn_by_the_mean_adds_what_impulses_gave_to_the_momentum_of_the_world(rng) -> None:
    """L = 2 I (end - mean) at the middle of the turn: to the last digit, whatever the mean is."""
    kernel = interpreted(gyroscopic.make_turn_by_mean(Spec()))
    for _ in range(20):
        one, half, mean, end = Spinning(rng), Spinning(rng), rng.normal(size=3), rng.normal(size=3)
        for name in ("qw", "qx", "qy", "qz"):
            setattr(half.body, name, getattr(one.body, name))
        interpreted(rotation.half_turn)(half.body, *mean, 0.1)
        momentum, matrix = one.momentum, one.matrix
        kernel(one.body, one.velocity, Vec3(*mean), Vec3(*end), GIVES, 0.1)
        given = 2.0 * half.tensor @ (end - mean)
        np.testing.assert_allclose(one.momentum, momentum + given, atol=1e-13)
        # Turned about the mean, which alone stays where it was.
        np.testing.assert_allclose(one.matrix @ matrix.T @ mean, mean, atol=1e-14)


def test_a_jump_by_the_mean_ends_with_twice_the_mean_less_the_start_in_body_axes(rng) -> None:
    kernel = interpreted(gyroscopic.make_turn_by_mean(Spec()))
    one, mean, end = Spinning(rng), rng.normal(size=3), rng.normal(size=3)
    before, matrix = one.matrix.T @ one.omega, one.matrix
    kernel(one.body, one.velocity, Vec3(*mean), Vec3(*end), JUMPS, 0.1)
    expected = 2.0 * matrix.T @ mean - before
    np.testing.assert_allclose(one.matrix.T @ one.omega, expected, atol=1e-14)
    np.testing.assert_allclose(one.matrix @ matrix.T @ end, end, atol=1e-14)
    assert not np.allclose(one.matrix, matrix)


@pytest.mark.parametrize("restrained", [0, 1])
def test_an_impulse_at_the_middle_gives_the_world_its_momentum_and_its_work(
    rng, restrained
) -> None:
    """R P' = P + L and dE = L . omega_m, both for turns of a third of a radian: no torque is lost.

    The passes of a step hand L on as spins at the last middle; a few find the fixed point. Of what
    is pushed by what does not move it works the same, as a torque in the axes of the middle.
    """
    kind = RESTRAINED if restrained else GIVES
    midway = interpreted(gyroscopic.make_turn_midway(Spec()))
    inverse = interpreted(rotation.inverse_inertia_times)
    by_mean = interpreted(gyroscopic.make_turn_by_mean(Spec()))
    for _ in range(10):
        start, given = Spinning(rng), 0.2 * rng.normal(size=3)
        dt = 0.3 / np.linalg.norm(start.omega)
        body, lead, end = map(copied, (start.body, start.velocity, start.velocity))
        m = one_row(**vector_fields("w", start.omega), restrained=restrained)
        for _ in range(40):
            gained = inverse(body, *given)
            end.wx, end.wy, end.wz = np.add((lead.wx, lead.wy, lead.wz), gained)
            assert midway(body, start.body, m, lead, end, dt)
        gained = np.array(inverse(body, *given))
        mean = np.array([lead.wx, lead.wy, lead.wz]) + 0.5 * gained
        momentum, energy = start.momentum, start.energy
        if restrained:
            middle, spin = start.matrix.T @ mean * start.inertia, start.matrix.T @ mean
            torque = np.array(interpreted(rotation.to_body)(body, *given))
            before = start.matrix.T @ momentum
            right = before + 0.5 * torque + 0.5 * dt * np.cross(middle, spin)
            np.testing.assert_allclose(middle, right, atol=1e-13)
        ends = Vec3(*mean), Vec3(*(mean + 0.5 * gained))
        by_mean(start.body, start.velocity, *ends, kind, dt)
        if not restrained:
            np.testing.assert_allclose(start.momentum, momentum + given, atol=1e-13)
        assert start.energy - energy == pytest.approx(given @ mean, abs=1e-12)


def test_a_jump_changes_the_energy_by_what_the_solver_counts_on(rng) -> None:
    """dw . L + dw . I_0 dw/2, L of the spin now; found with another tensor I_0 than that now."""
    kernel = interpreted(gyroscopic.make_jump(Spec()))
    for _ in range(30):
        one, other, jump = Spinning(rng), Spinning(rng), 0.3 * rng.normal(size=3)
        twice = float(jump @ other.tensor @ jump)
        promised = float(jump @ one.momentum + 0.5 * twice)
        energy, omega = one.energy, one.omega
        direction = jump / np.linalg.norm(jump)
        lost = 0.5 * (one.momentum @ jump) ** 2 / (jump @ one.tensor @ jump)
        if promised < -0.99 * lost:
            continue  # more than its direction can take
        kernel(one.body, one.velocity, *jump, twice)
        assert one.energy - energy == pytest.approx(promised, abs=1e-13)
        change = one.omega - omega
        np.testing.assert_allclose(np.cross(change, direction), 0.0, atol=1e-12)


def test_round_bodies_and_no_jump_need_no_scale(rng) -> None:
    kernel = interpreted(gyroscopic.make_jump(Spec()))
    ball = Spinning(rng, inertia=np.full(3, 0.3))
    before = ball.omega
    kernel(ball.body, ball.velocity, 0.1, -0.2, 0.3, 77.0)
    np.testing.assert_array_equal(ball.omega, before + np.array([0.1, -0.2, 0.3]))
    one = Spinning(rng)
    before = one.omega
    kernel(one.body, one.velocity, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_array_equal(one.omega, before)


def test_it_is_on_where_an_uneven_body_may_turn() -> None:
    touching = (pair_facts("floor", "b"),)
    for body, pairs, on in (
        (body_facts("b", spins=True), (), True),
        (body_facts("b", torque=True), (), True),
        (body_facts("b", twisted=True), (), True),
        (body_facts("b"), touching, True),
        (body_facts("b"), (), False),
        (body_facts("b", round=True, spins=True), touching, False),
        (body_facts("b", movable=False, spins=True), touching, False),
    ):
        assert EFFECT.decide(facts(body, pairs=pairs)).on is on
