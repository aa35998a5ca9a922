"""Bodies that turn, drawn at random, with contacts anywhere between them; and their dense matrices.

The Jacobian and the inverse mass are written here from their definitions, of what a kernel reads.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from interpreted import records

from lavendersim.engine.record_layout import (
    allocate_bodies,
    allocate_velocities,
    contact_dtype,
)
from lavendersim.engine.spec import Spec


class Drawn(NamedTuple):
    """Records of n bodies and m contacts, and the same as matrices."""

    bodies: np.ndarray
    velocities: np.ndarray
    contacts: np.ndarray
    jacobian: np.ndarray  # (3m, 6n) rows n, t1, t2 of the velocity of B from A's
    mass: np.ndarray  # (6n, 6n), 0 of what is fixed
    inverse: np.ndarray  # (6n, 6n), likewise

    @property
    def motion(self) -> np.ndarray:
        """The velocities, (6n,): of each body its linear and its angular one."""
        return stacked(self.velocities)


def stacked(velocities: np.ndarray) -> np.ndarray:
    names = ("vx", "vy", "vz", "wx", "wy", "wz")
    return np.array([[row[name] for name in names] for row in velocities]).ravel()


def put_vector(row: Any, prefix: str, vector: Sequence[float] | np.ndarray) -> None:
    """Write the fields x, y, z behind a prefix, where the record has them."""
    for axis, value in zip("xyz", vector, strict=True):
        put(row, f"{prefix}{axis}", value)


def put(row: Any, name: str, value: float) -> None:
    if name in row.dtype.names:
        row[name] = value


def random_frame(rng: np.random.Generator) -> np.ndarray:
    """Return three orthonormal rows, right-handed."""
    frame: np.ndarray = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    if np.linalg.det(frame) < 0.0:
        frame = -frame
    return frame


def cross_matrix(r: np.ndarray) -> np.ndarray:
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])


def drawn(
    spec: Spec,
    rng: np.random.Generator,
    pairs: Sequence[tuple[int, int]],
    fixed: Sequence[int] = (0,),
    frame_of: Callable[[np.random.Generator], np.ndarray] = random_frame,
) -> Drawn:
    """Return contacts between these pairs of bodies; impulses are inside their cones.

    frame_of: draws n, t1, t2 of a contact.
    """
    n = 1 + max(max(pair) for pair in pairs)
    bodies, velocities = allocate_bodies(spec, n), allocate_velocities(spec, n)
    mass, inverse = np.zeros((6 * n, 6 * n)), np.zeros((6 * n, 6 * n))
    for i in range(n):
        body, v, at = bodies[i], velocities[i], slice(6 * i, 6 * i + 6)
        put_vector(body, "", rng.normal(size=3))
        turn, moments = random_frame(rng), rng.uniform(0.2, 2.0, 3)
        for r in range(3):
            for c in range(3):
                put(body, f"r{r}{c}", turn[r, c])
        if i not in fixed:
            body["inv_m"] = rng.uniform(0.3, 3.0)
            put_vector(body, "inv_i", 1.0 / moments)
            world = turn @ np.diag(1.0 / moments) @ turn.T
            inverse[at, at] = np.diag([body["inv_m"]] * 3 + [0.0] * 3)
            inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = world
            mass[at, at] = np.linalg.inv(inverse[at, at])
            for r, c in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
                put(v, f"j{'xyz'[r]}{'xyz'[c]}", world[r, c])
            put_vector(v, "v", rng.normal(size=3))
            put_vector(v, "w", rng.normal(size=3))
    contacts = np.zeros(len(pairs), contact_dtype(spec))
    jacobian = np.zeros((3 * len(pairs), 6 * n))
    for k, (a, b) in enumerate(pairs):
        frame, point = frame_of(rng), rng.normal(size=3)
        r_a, r_b = (point - [bodies[i][axis] for axis in "xyz"] for i in (a, b))
        own = jacobian[3 * k : 3 * k + 3]
        own[:, 6 * a : 6 * a + 3], own[:, 6 * b : 6 * b + 3] = -frame, frame
        own[:, 6 * a + 3 : 6 * a + 6] = frame @ cross_matrix(r_a)
        own[:, 6 * b + 3 : 6 * b + 6] = -frame @ cross_matrix(r_b)
        row, w = contacts[k], own @ inverse @ own.T
        row["a"], row["b"], row["key"], row["pair"] = a, b, k, k
        row["inv_m_a"], row["inv_m_b"] = bodies["inv_m"][a], bodies["inv_m"][b]
        put_vector(row, "", point)
        for axis, vector in zip(("n", "t1", "t2"), frame, strict=True):
            put_vector(row, axis, vector)
        put_vector(row, "ra", r_a)
        put_vector(row, "rb", r_b)
        for side, i, r in (("a", a, r_a), ("b", b, r_b)):
            lever = np.cross(r, frame[0])
            put_vector(row, f"lever_{side}", lever)
            turned = inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] @ lever
            put_vector(row, f"turn_{side}", turned)
        gamma = rng.uniform(0.1, 0.5) if "gamma" in row.dtype.names else 0.0
        values = {
            "k_n": w[0, 0], "k_n1": w[1, 0], "k_n2": w[2, 0], "gamma": gamma,
            "inv_k": 1.0 / (w[0, 0] + gamma), "k_t": np.linalg.eigvalsh(w[1:, 1:])[-1],
            "mu": rng.uniform(0.2, 0.9), "target": rng.uniform(-0.2, 0.2), "frictional": 1,
            "lambda_n": rng.uniform(0.5, 2.0),
        }  # fmt: skip
        across = np.linalg.inv(w[1:, 1:])
        values |= {"i_11": across[0, 0], "i_12": across[0, 1], "i_22": across[1, 1]}
        along = rng.uniform(0.0, 2.0 * np.pi)
        size = rng.uniform(0.1, 0.9) * values["mu"] * values["lambda_n"]
        values |= {"lambda_1": size * np.cos(along), "lambda_2": size * np.sin(along)}
        for name, value in values.items():
            put(row, name, value)
    return Drawn(bodies, velocities, contacts, jacobian, mass, inverse)


def views(scene: Drawn) -> tuple[Any, Any, Any]:
    """Return bodies, velocities and contacts as kernels read them."""
    return records(scene.bodies), records(scene.velocities), records(scene.contacts)


def set_contact_velocity(scene: Drawn, w: Sequence[float] | np.ndarray) -> None:
    """Give bodies the least velocities at which J v is w: of a contact or two of free bodies."""
    v = (np.linalg.pinv(scene.jacobian) @ np.asarray(w)).reshape(-1, 6)
    for row, own in zip(scene.velocities, v, strict=True):
        put_vector(row, "v", own[:3])
        put_vector(row, "w", own[3:])
