"""Rows of a log from the states of another engine: sums of each step, poses, contacts.

Energy, momentum and the hash of the state are of poses and velocities, by one formula for every
engine; contacts are what the engine reports of them.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.engine.tangents import first_tangent, second_tangent
from lavendersim.geometry.bodies import is_movable, mass_of, principal_inertia, vector
from lavendersim.geometry.rotations import rotation_matrices, unit_quaternion
from lavendersim.measures.not_finite import without_warnings
from lavendersim.peers.declaration import TANGENTIAL
from lavendersim.peers.messages import States
from lavendersim.trace import Block

Floats = NDArray[np.float64]
FNV_BASIS: Final = np.uint64(0xCBF29CE484222325)  # as the engine's own step log
FNV_PRIME: Final = np.uint64(0x100000001B3)

STEP: Final = (
    *(("step", "i8"), ("contact_count", "i8")),
    *(("total_normal_force", "f8"), ("max_penetration", "f8")),
    *(("kinetic_energy", "f8"), ("potential_energy", "f8")),
    *((f"momentum_{axis}", "f8") for axis in "xyz"),
    *((f"angular_momentum_{axis}", "f8") for axis in "xyz"),
    *(("state_hash", "u8"), ("time_ns", "i8")),
)
ITERATIONS: Final = (("sweeps", "i8"),)  # of an engine's own solver, whatever it iterates
BODIES: Final = (("step", "i8"), ("body_a", "i8"), ("body_b", "i8"))


def step_columns(reported: tuple[str, ...], counted: bool) -> list[tuple[str, str]]:
    """Return the columns of /step that a log has; reported: of contacts, counted: iterations."""
    of = {
        "contact_count": "separation",
        "total_normal_force": "impulse_n",
        "max_penetration": "separation",
    }
    found = [(name, kind) for name, kind in STEP if name not in of or of[name] in reported]
    return [*found, *ITERATIONS] if counted else found


def contact_columns(reported: tuple[str, ...]) -> list[tuple[str, str]]:
    """Return the columns of contacts that a log has of what is reported, and what follows.

    A tangential impulse is a vector to engines; a log has it along tangents of the normal.
    """
    names = [*reported]
    if TANGENTIAL[0] in reported:
        names = [name for name in reported if name not in TANGENTIAL]
        names += ["impulse_t1", "impulse_t2", "t1x", "t1y", "t1z"]
    derived = {"impulse_n": "force_n", "separation": "penetration"}
    names += [derived[name] for name in reported if name in derived]
    return [*BODIES, *((name, "f8") for name in names)]


class RowsOfStates:
    """Makes the rows of one run."""

    def __init__(
        self, config: CellConfig, reported: tuple[str, ...], counted: bool = False
    ) -> None:
        self._config, self._reported, self._counted = config, reported, counted
        bodies = list(config.scene.bodies.values())
        self._moving = np.flatnonzero([is_movable(body) for body in bodies])
        self._still = np.array(
            [(*one.position, *unit_quaternion(one.orientation), *[0.0] * 6) for one in bodies]
        )
        moving = [bodies[k] for k in self._moving]
        self._mass = np.array([mass_of(body) for body in moving])
        self._inertia = np.array([principal_inertia(body) for body in moving]).reshape(-1, 3)

    @without_warnings  # what is beyond all numbers is how a cell ends, and is judged
    def block(self, states: States) -> Block:
        """Return the rows of some states."""
        count = len(states.pose)
        pose = np.repeat(self._still[None], count, axis=0)
        pose[:, self._moving, :7], pose[:, self._moving, 7:] = states.pose, states.velocity
        contact = self._contacts(states)
        step = np.zeros(count, step_columns(self._reported, self._counted))
        step["step"] = states.first + np.arange(count)
        step["time_ns"] = self._config.clock.nanoseconds(step["step"])
        self._sum_bodies(step, states)
        rows = np.searchsorted(step["step"], contact["step"])
        if "contact_count" in (step.dtype.names or ()):
            step["contact_count"] = np.bincount(rows, minlength=count)
        if self._counted and states.iterations is not None:
            step["sweeps"] = states.iterations
        if "total_normal_force" in (step.dtype.names or ()):
            np.add.at(step["total_normal_force"], rows, contact["force_n"])
        if "max_penetration" in (step.dtype.names or ()):
            np.maximum.at(step["max_penetration"], rows, contact["penetration"])
        step["state_hash"] = state_hashes(step["step"], pose)
        return Block(
            step, contact, pose, np.zeros(0, [("step", "i8"), ("sweep", "i8"), ("residual", "f8")])
        )

    def _contacts(self, states: States) -> NDArray[Any]:
        columns = ("step", "body_a", "body_b", *self._reported)
        given = dict(zip(columns, states.contacts.T, strict=True))
        found = np.zeros(len(states.contacts), contact_columns(self._reported))
        for name in given.keys() & set(found.dtype.names or ()):
            found[name] = given[name]
        if "separation" in given:
            found["penetration"] = np.maximum(0.0 - given["separation"], 0.0)
        if "impulse_n" in given:
            found["force_n"] = given["impulse_n"] / float(self._config.numerics.timestep)
        if TANGENTIAL[0] in given:
            normal = given["nx"], given["ny"], given["nz"]
            side = np.where(given["nz"] >= 0.0, 1.0, -1.0)
            for which, tangent in (("t1", first_tangent), ("t2", second_tangent)):
                along = tangent(*normal, side)
                parts = zip(TANGENTIAL, along, strict=True)
                found[f"impulse_{which}"] = sum(given[name] * part for name, part in parts)
                for axis, part in zip("xyz", along, strict=True) if which == "t1" else ():
                    found[f"t1{axis}"] = part
        return found

    def _sum_bodies(self, step: NDArray[Any], states: States) -> None:
        place, v, w = states.pose[:, :, :3], states.velocity[:, :, :3], states.velocity[:, :, 3:]
        mass = self._mass[None, :, None]
        shape = states.pose.shape[:2]
        turn = rotation_matrices(states.pose[:, :, 3:].reshape(-1, 4)).reshape(*shape, 3, 3)
        local = np.einsum("sbji,sbj->sbi", turn, w)
        own = np.einsum("sbij,sbj->sbi", turn, local * self._inertia)
        step["kinetic_energy"] = 0.5 * (
            (mass * v * v).sum(axis=(1, 2)) + (own * w).sum(axis=(1, 2))
        )
        pull = vector(self._config.scene.gravity)
        step["potential_energy"] = -((mass * place) @ pull).sum(axis=1)
        carried = (mass * v).sum(axis=1)
        turning = (np.cross(place, mass * v) + own).sum(axis=1)
        for k, axis in enumerate("xyz"):
            step[f"momentum_{axis}"] = carried[:, k]
            step[f"angular_momentum_{axis}"] = turning[:, k]


def state_hashes(steps: NDArray[Any], pose: Floats) -> NDArray[np.uint64]:
    """Return FNV-1a over the words of positions and velocities of each state; -0 counts as 0."""
    words = (pose + 0.0).view(np.uint64).reshape(len(steps), -1)
    found = FNV_BASIS ^ steps.astype(np.uint64)
    for column in words.T:
        found = (found ^ column) * FNV_PRIME
    return found
