"""The contact problem of a step, assembled for a file, is the one that the engine solved.

W is compared with unit impulses on the bodies, `free` and W together with the velocities that the
log has, and the engine's impulses on the assembled problem must miss the laws by what the step says
of its own residual.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from idle_scenes import CUBE, balls, boxes, cell
from laboratory import EVERYTHING, Bench, box, plane, planned, sphere

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.engine.spec import Spec

# Sums of some ten products of velocities of 10 m/s and responses of 10 1/kg, each rounded by 1e-16.
ROUND_OFF = 1e-12


def soft_conveyor() -> dict[str, Any]:
    """Boxes that land on a soft belt, which moves."""
    bodies = boxes(CUBE, friction=0.4)
    bodies["floor"]["surface_velocity"] = [0.7, -0.2, 0.0]
    bodies["floor"]["surface"]["compliance"] = 1e-5
    return cell(bodies)


def mixed_balls() -> dict[str, Any]:
    """Frictional balls and a frictionless one, with speculative contacts."""
    bodies = balls(friction=0.4)
    keys = ("friction", "restitution", "compliance", "torsional_friction", "rolling_friction")
    bodies["high"]["surface"] |= dict.fromkeys(keys, 0.0)
    return cell(bodies, speculative=True, sweeps=200, tolerance=1e-9)


def frictionless_box() -> dict[str, Any]:
    """A ball rests off centre on a box, which it tilts."""
    top = sphere(0.1, (0.05, 0.02, 0.3), mass=3.0)
    return cell({"floor": plane(), "box": box((0.3, 0.3, 0.2), (0.0, 0.0, 0.1)), "ball": top})


def asking(made: dict[str, Any]) -> dict[str, Any]:
    made["record"]["problems"] = "every 1"
    return made


# At so many steps both have contacts that stick, slide and land.
SCENES = {
    "a soft conveyor": (lambda: asking(soft_conveyor()), EVERYTHING),
    "frictionless and frictional balls, some not yet there": (lambda: asking(mixed_balls()), None),
    "a frictionless box": (lambda: asking(frictionless_box()), None),
}


class Solved:
    """One step's problem, with the bodies as the step found them."""

    def __init__(self, name: str, steps: int) -> None:
        scene, spec = SCENES[name]
        self.cell = scene()
        self.spec: Spec = spec or planned(self.cell).spec
        assert self.spec.has("problem_log")
        bench = Bench(self.cell, self.spec)
        bench.run(steps - 1)
        bodies = bench.engine.bodies.copy()
        self.rows = bench.run(1)
        found = bench.engine.problem()
        assert found is not None
        self.problem, self.impulses = found
        self.contacts = bench.engine.contacts[: self.problem.contacts].copy()
        self.place = np.stack([bodies[axis] for axis in "xyz"], axis=-1)
        self.inv_m = bodies["inv_m"]
        self.inv_i = np.zeros((len(bodies), 3, 3))
        for i, body in enumerate(bodies):
            turn = np.array([[body[f"r{row}{column}"] for column in range(3)] for row in range(3)])
            self.inv_i[i] = turn @ np.diag([body[f"inv_i{axis}"] for axis in "xyz"]) @ turn.T

    @property
    def shown(self) -> np.ndarray:
        """Which contacts the log has."""
        return (self.contacts["phi"] <= 1e-9) | (self.contacts["lambda_n"] != 0.0)

    def dense(self) -> np.ndarray:
        """Return W, (3 n, 3 n)."""
        count = self.problem.contacts
        w = np.zeros((count, 3, count, 3))
        for column in range(count):
            for at in range(self.problem.begin[column], self.problem.begin[column + 1]):
                w[self.problem.row[at], :, column] = self.problem.blocks[at]
        return w.reshape(3 * count, 3 * count)

    def after(self) -> np.ndarray:
        """Return W r + free, (n, 3)."""
        u = (self.dense() @ self.impulses.ravel()).reshape(-1, 3) + self.problem.free
        return u

    def frames(self) -> np.ndarray:
        normal = np.stack([self.contacts[f"n{axis}"] for axis in "xyz"], axis=-1)
        if not self.spec.has("friction"):
            return np.stack([normal, 0 * normal, 0 * normal], axis=1)
        one = np.stack([self.contacts[f"t1{axis}"] for axis in "xyz"], axis=-1)
        return np.stack([normal, one, np.cross(normal, one)], axis=1)

    def ends(self, c: int) -> list[tuple[int, float, np.ndarray]]:
        """Return body, sign and lever of a contact's two ends, on each body's own surface."""
        contact = self.contacts[c]
        point = np.array([contact[axis] for axis in "xyz"])
        normal = np.array([contact[f"n{axis}"] for axis in "xyz"])
        half = 0.5 * contact["phi"] * normal
        a, b = int(contact["a"]), int(contact["b"])
        return [(a, -1.0, point - half - self.place[a]), (b, 1.0, point + half - self.place[b])]

    def answer(self, c: int, push: np.ndarray) -> np.ndarray:
        """Return the velocities (n, 3) that an impulse (world axes) at contact c gives to all."""
        v, omega = np.zeros_like(self.place), np.zeros_like(self.place)
        for body, sign, lever in self.ends(c):
            v[body] += self.inv_m[body] * sign * push
            omega[body] += self.inv_i[body] @ np.cross(lever, sign * push)
        frames = self.frames()
        seen = np.zeros((len(self.contacts), 3))
        for d in range(len(self.contacts)):
            for body, sign, lever in self.ends(d):
                seen[d] += sign * frames[d] @ (v[body] + np.cross(omega[body], lever))
        return seen


STEPS = 100  # 0.42 s: the stacks carry, what was thrown has landed and slides


@pytest.fixture(scope="module", params=SCENES)
def solved(request: pytest.FixtureRequest) -> Solved:
    return Solved(request.param, STEPS)


def test_columns_are_what_unit_impulses_do(solved: Solved) -> None:
    """A frictionless contact is asked of its normal alone."""
    w, frames = solved.dense(), solved.frames()
    frictional = solved.problem.mu > 0.0
    directions = [(c, j) for c in range(len(frictional)) for j in range(3 if frictional[c] else 1)]
    rows = [3 * c + j for c, j in directions]
    assert len(directions) > 4
    for c, j in directions:
        seen = solved.answer(c, frames[c, j]).ravel()
        np.testing.assert_allclose(w[rows, 3 * c + j], seen[rows], atol=ROUND_OFF)


def test_the_step_ends_with_the_velocities_of_its_impulses(solved: Solved) -> None:
    u, logged = solved.after()[solved.shown], solved.rows.contact
    assert len(logged) > 2
    np.testing.assert_allclose(u[:, 0], logged["normal_velocity"], atol=ROUND_OFF)
    frictional = solved.problem.mu[solved.shown] > 0.0
    if not frictional.any():
        return
    slip = np.stack([logged["slip_t1"], logged["slip_t2"]], axis=-1)
    np.testing.assert_allclose(u[frictional, 1:], slip[frictional], atol=ROUND_OFF)


def natural_map(problem: ContactProblem, impulses: np.ndarray, u: np.ndarray, w: np.ndarray):
    """Return the residual [m/s] of each contact, as `engine.residual` defines it."""
    found = np.zeros(problem.contacts)
    for c in range(problem.contacts):
        block = w[3 * c : 3 * c + 3, 3 * c : 3 * c + 3]
        n, t = impulses[c, 0], impulses[c, 1:]
        away = u[c, 0] + problem.target[c] + problem.gamma[c] * n
        found[c] = abs(min((block[0, 0] + problem.gamma[c]) * n, away))
        if problem.mu[c] > 0.0:
            k_t = np.linalg.eigvalsh(block[1:, 1:])[-1]
            free, limit = k_t * t - u[c, 1:], k_t * problem.mu[c] * n
            size = np.hypot(*free)
            nearest = free if size <= limit else free * (limit / size)
            found[c] = max(found[c], np.hypot(*(nearest - k_t * t)))
    return found


def test_the_engines_impulses_miss_the_laws_by_the_residual_it_states(solved: Solved) -> None:
    missed = natural_map(solved.problem, solved.impulses, solved.after(), solved.dense())
    reported = solved.rows.step["residual"][-1]
    assert missed.max() == pytest.approx(reported, abs=10 * ROUND_OFF)


def test_a_step_without_contacts_has_no_problem() -> None:
    bench = Bench(SCENES["a soft conveyor"][0](), EVERYTHING)
    bench.engine.bodies["z"][1:] += [1.0, 2.0, 3.0]  # out of reach of the belt and each other
    bench.run(1)
    assert bench.engine.problem() is None
