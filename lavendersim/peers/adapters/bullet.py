"""Scenes on Bullet, by pybullet's direct connection."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pybullet

from lavendersim.peers.bullet import PEER
from lavendersim.peers.declaration import Value
from lavendersim.peers.description import PeerBody, Scene
from lavendersim.peers.world import CannotRun, Floats

FASTEST = 1e30  # [m/s], [rad/s] of a multibody; its own 100 would be cut off without a word


class World:
    """One physics server."""

    def __init__(self, scene: Scene, settings: Mapping[str, Value]) -> None:
        client = pybullet.connect(pybullet.DIRECT)
        self._here: dict[str, Any] = {"physicsClientId": client}
        self._rigid = bool(settings.get("rigid", False))
        self._reported: Any = None
        pybullet.setGravity(*scene.gravity, **self._here)
        own: dict[str, Any] = {"fixedTimeStep": scene.timestep}
        for name, of_bullet in (
            ("iterations", "numSolverIterations"),
            ("residual_threshold", "solverResidualThreshold"),
        ):
            if name in settings:
                own[of_bullet] = settings[name]
        pybullet.setPhysicsEngineParameter(**own, **self._here)
        # Bullet multiplies the coefficients of two bodies.
        self._friction = scene.values("friction", PEER)
        self._restitution = scene.values("restitution", PEER)
        numbers = [self._add(body) for body in scene.bodies]
        self._numbers = [numbers[body.row] for body in scene.movable]
        self._rows, self._dt = {number: row for row, number in enumerate(numbers)}, scene.timestep

    def _shape(self, shape: Any) -> int:
        create, here = pybullet.createCollisionShape, self._here
        if shape.kind == "plane":
            return int(create(pybullet.GEOM_PLANE, planeNormal=list(shape.normal), **here))
        if shape.kind == "box":
            half = [0.5 * edge for edge in shape.size]
            return int(create(pybullet.GEOM_BOX, halfExtents=half, **here))
        if shape.kind == "sphere":
            return int(create(pybullet.GEOM_SPHERE, radius=shape.radius, **here))
        kind = pybullet.GEOM_CAPSULE if shape.kind == "capsule" else pybullet.GEOM_CYLINDER
        return int(create(kind, radius=shape.radius, height=shape.length, **here))

    def _add(self, body: PeerBody) -> int:
        position, (w, x, y, z) = body.position, body.orientation
        if body.shape.kind == "plane":  # its normal is of the world
            px, py, pz = (body.shape.offset * n for n in body.shape.normal)
            position, (w, x, y, z) = (px, py, pz), (1.0, 0.0, 0.0, 0.0)
        number = pybullet.createMultiBody(
            baseMass=body.mass,
            baseCollisionShapeIndex=self._shape(body.shape),
            basePosition=position,
            baseOrientation=(x, y, z, w),
            useMaximalCoordinates=self._rigid,
            **self._here,
        )
        if number < 0:
            raise CannotRun(f"pybullet makes no body of {body.name}")
        # Damping is no part of a scene.
        changes: dict[str, Any] = {
            "lateralFriction": self._friction[body.row],
            "restitution": self._restitution[body.row],
            "linearDamping": 0.0,
            "angularDamping": 0.0,
            "maxJointVelocity": FASTEST,
        }
        if body.moves:  # inertia alone would take the mass of a plain rigid body away
            changes |= {"mass": body.mass, "localInertiaDiagonal": body.inertia}
        pybullet.changeDynamics(number, -1, **changes, **self._here)
        if body.moves:
            pybullet.resetBaseVelocity(number, body.velocity, body.spin, **self._here)
        return int(number)

    def inertias(self) -> Floats:
        """Return mass and principal moments."""
        rows = [pybullet.getDynamicsInfo(number, -1, **self._here) for number in self._numbers]
        return np.array([(row[0], *row[2]) for row in rows])

    def mixed(self) -> tuple[Floats, Floats]:
        """Return friction and restitution of every two bodies: products."""
        rows = [pybullet.getDynamicsInfo(number, -1, **self._here) for number in self._rows]
        friction, restitution = (np.array([row[k] for row in rows]) for k in (1, 5))
        return np.outer(friction, friction), np.outer(restitution, restitution)

    def poses(self) -> Floats:
        """Return poses."""
        found = np.empty((len(self._numbers), 7))
        for row, number in zip(found, self._numbers, strict=True):
            position, turn = pybullet.getBasePositionAndOrientation(number, **self._here)
            x, y, z, w = turn
            row[:] = [*position, w, x, y, z]
        return found

    def velocities(self) -> Floats:
        """Return velocities."""
        rows = [pybullet.getBaseVelocity(number, **self._here) for number in self._numbers]
        return np.array([np.concatenate(row) for row in rows])

    def push(self, loads: Floats) -> None:
        """Refuse: its declaration has no forces."""
        raise CannotRun("forces are not passed on to it")

    def step(self) -> None:
        """Advance by one timestep."""
        self._reported = pybullet.stepSimulation(**self._here)

    def iterations(self) -> int:
        """Return those of the last step; reported from the first call on."""
        if not self._reported:
            pybullet.setPhysicsEngineParameter(reportSolverAnalytics=1, **self._here)
        return max((one["numIterationsUsed"] for one in self._reported or ()), default=0)

    def contacts(self) -> list[tuple[float, ...]]:
        """Return the contacts of the last step, at points of their collision detection.

        Its normal points from its B to its A, and forces are on its A: its B is our A.
        """
        found = []
        for one in pybullet.getContactPoints(**self._here):
            (a, b), point, normal = one[1:3], one[6], one[7]
            gap, push, slide, first, across, second = one[8:14]
            friction = (
                (slide * s + across * t) * self._dt for s, t in zip(first, second, strict=True)
            )
            place = (self._rows[b], self._rows[a], *point, *normal, gap)
            found.append((*place, push * self._dt, *friction))
        return found
