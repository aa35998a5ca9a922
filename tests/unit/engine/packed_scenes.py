"""Scenes whose contacts of one step are prepared for solvers that pack them.

One engine of many effects makes the contacts of all of them, and its compilation serves them all.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from laboratory import EVERYTHING, Bench, box, plane, resolved, sphere

from tests.benchmarks.prepared_contacts import Prepared, next_step

GRAVITY = (0.0, 0.0, -9.81)
# Contacts that resist turning are no blocks of a normal and a disc.
BLOCKS = EVERYTHING.without("torsional_friction", "rolling_friction", "residual_log")


def _towers(count: int, speed: float) -> dict:
    """Towers of three boxes on the floor; every other one is pushed so that its top slides."""
    bodies = {"floor": plane(friction=0.5)}
    for t in range(count):
        for k in range(3):
            bodies[f"box_{t}_{k}"] = box(
                (0.2, 0.3, 0.2),
                (0.5 * t, 0.01 * k, 0.1 + 0.2 * k),
                mass=1.0 + k,
                friction=0.4,
                velocity=(speed * (t % 2) * (k == 2), -0.3 * speed * (t % 2), 0.0),
            )
    return bodies


def _mixed() -> dict:
    """Belts, ice, soft, heavy, fixed, kinematic and spinning bodies."""
    bodies = _towers(3, 1.0)
    bodies["belt"] = box((1, 1, 0.2), (0, 2, 0.1), fixed=True, friction=0.9,
                         surface_velocity=(0.5, 0.2, 0.0))  # fmt: skip
    bodies["load"] = box((0.2, 0.2, 0.2), (0, 2, 0.3), mass=20.0, friction=0.5)
    bodies["soft"] = box((0.3, 0.2, 0.1), (1, 2, 0.05), friction=0.6, compliance=1e-5)
    bodies["ice"] = box((0.3, 0.3, 0.1), (2, 2, 0.05), velocity=(1.0, 0.0, -0.1))
    bodies["lift"] = box((0.5, 0.5, 0.1), (3, 2, 0.5), kinematic=True, friction=0.3,
                         velocity=(0.1, 0.0, 0.2))  # fmt: skip
    bodies["rider"] = box((0.2, 0.3, 0.1), (3, 2, 0.6), friction=0.3)
    spin = {"angular_velocity": (3.0, 20.0, -5.0), "friction": 0.3, "restitution": 0.5}
    for k in range(6):
        bodies[f"ball_{k}"] = sphere(0.1, (0.2 * k, 3.0, 0.0999), mass=0.5 + k,
                                     velocity=(0.5 * k, 0.0, -0.5), **spin)  # fmt: skip
    return bodies


SCENES = {
    "one ball": lambda: {
        "floor": plane(friction=0.5),
        "ball": sphere(0.1, (0.0, 0.0, 0.0999), velocity=(1.0, 0.0, -1.0), friction=0.5),
    },
    "tower": lambda: _towers(1, 0.0),
    "towers": lambda: _towers(4, 2.0),
    "mixed": _mixed,
    "many towers": lambda: _towers(14, 2.0),
}


@cache
def found(name: str) -> Prepared:
    """Return what a solver finds in the fourth step of a scene: warm, and under way."""
    cell = resolved(SCENES[name](), GRAVITY, stabilisation_gain=0.02, slop=1e-4)
    bench = Bench(cell)
    bench.run(3)
    return next_step(bench.engine, BLOCKS)


def mechanics(prepared: Prepared) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M^-1 (6n, 6n), J (3m, 6n), its rows n, t1, t2, and v (6n,) from first principles.

    Of the records only poses, masses, normals, tangents, points and separations are taken.
    """
    bodies, contacts = prepared.bodies, prepared.contacts
    inverse = np.zeros((6 * len(bodies),) * 2)
    for i, body in enumerate(bodies):
        turn = np.array([[body[f"r{r}{c}"] for c in range(3)] for r in range(3)])
        moments = np.diag([body[f"inv_i{axis}"] for axis in "xyz"])
        inverse[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = body["inv_m"] * np.eye(3)
        inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = turn @ moments @ turn.T
    rows = np.zeros((len(contacts), 3, len(bodies), 6))
    for c, contact in enumerate(contacts):
        point = np.array([contact[axis] for axis in "xyz"])
        normal = np.array([contact[f"n{axis}"] for axis in "xyz"])
        for k, axis in enumerate(("n", "t1", "t2")):
            along = np.array([contact[f"{axis}{part}"] for part in "xyz"])
            for sign, body in ((-1.0, contact["a"]), (1.0, contact["b"])):
                # Each body is touched on its own surface, half the separation from the middle.
                centre = np.array([bodies[body][part] for part in "xyz"])
                arm = point + 0.5 * sign * contact["phi"] * normal - centre
                rows[c, k, body, :3] += sign * along
                rows[c, k, body, 3:] += sign * np.cross(arm, along)
    velocity = np.stack(
        [prepared.velocities[name] for name in ("vx", "vy", "vz", "wx", "wy", "wz")], axis=1
    )
    return inverse, rows.reshape(3 * len(contacts), -1), velocity.ravel()


def natural_maps(contacts: np.ndarray, w: np.ndarray, impulses: np.ndarray) -> np.ndarray:
    """Return the residual of every contact [m/s], written as projections.

    w: velocities with targets and what surfaces bring, shape (count, 3).
    """
    n, t = impulses[:, 0], impulses[:, 1:]
    stiffness = 1.0 / contacts["inv_k"]
    normal = stiffness * n - np.maximum(stiffness * n - w[:, 0] - contacts["gamma"] * n, 0.0)
    held = contacts["k_t"][:, None] * t
    moved = held - w[:, 1:]
    size = np.linalg.norm(moved, axis=1)
    limit = contacts["k_t"] * contacts["mu"] * n
    share = np.where(size > limit, limit / np.where(size > 0.0, size, 1.0), 1.0)
    across = np.linalg.norm(held - moved * share[:, None], axis=1)
    across[contacts["frictional"] == 0] = 0.0
    return np.maximum(np.abs(normal), across)
