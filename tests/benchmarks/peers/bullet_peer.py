"""Scenes on Bullet, through pybullet's direct connection."""

from __future__ import annotations

from math import sqrt
from typing import Any, Final

import numpy as np
import pybullet

from .description import Body, Box, Plane, Scene, Sphere

VARIANTS: Final = {
    "bullet": "pybullet's defaults: 50 iterations, every body a multibody",
    "bullet-rigid": "plain rigid bodies (useMaximalCoordinates), 50 iterations",
    "bullet-accurate": "plain rigid bodies, 1000 iterations, no residual threshold, swept spheres",
}


def version() -> str:
    """Return the engine's version; pybullet tells a date."""
    from importlib.metadata import version as installed

    return f"Bullet (pybullet {installed('pybullet')})"


class BulletHandle:
    """One physics server."""

    def __init__(self, scene: Scene, variant: str) -> None:
        self.client = pybullet.connect(pybullet.DIRECT)
        self.rigid = variant != "bullet"
        self.accurate = variant == "bullet-accurate"
        pybullet.setGravity(*scene.gravity, physicsClientId=self.client)
        settings: dict[str, Any] = {"fixedTimeStep": float(scene.timestep)}
        if self.accurate:
            settings |= {"numSolverIterations": 1000, "solverResidualThreshold": 0.0}
        pybullet.setPhysicsEngineParameter(**settings, physicsClientId=self.client)
        self.bodies = []
        for body in scene.bodies:
            number = self._add(body, scene)
            if body.moves:
                self.bodies.append(number)

    def _shape(self, body: Body) -> int:
        shape, here = body.shape, {"physicsClientId": self.client}
        if isinstance(shape, Sphere):
            return pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=shape.radius, **here)
        if isinstance(shape, Box):
            half = [0.5 * edge for edge in shape.size]
            return pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, **here)
        return pybullet.createCollisionShape(
            pybullet.GEOM_PLANE, planeNormal=list(shape.normal), **here
        )

    def _add(self, body: Body, scene: Scene) -> int:
        here = {"physicsClientId": self.client}
        position = body.position
        if isinstance(body.shape, Plane):
            x, y, z = (body.shape.offset * n for n in body.shape.normal)
            position = (x, y, z)
        w, x, y, z = body.orientation
        number = pybullet.createMultiBody(
            baseMass=body.mass or 0.0,
            baseCollisionShapeIndex=self._shape(body),
            basePosition=position,
            baseOrientation=(x, y, z, w),
            useMaximalCoordinates=self.rigid,
            **here,
        )
        # Bullet multiplies the coefficients of the two bodies. Damping is no part of the scene.
        changes: dict[str, Any] = {
            "lateralFriction": sqrt(scene.friction),
            "restitution": sqrt(scene.restitution),
            "linearDamping": 0.0,
            "angularDamping": 0.0,
        }
        if body.moves:
            # Inertia alone would take the mass of a plain rigid body away.
            changes |= {"mass": body.mass, "localInertiaDiagonal": body.inertia}
            if self.accurate and isinstance(body.shape, Sphere):
                changes["ccdSweptSphereRadius"] = body.shape.radius
        pybullet.changeDynamics(number, -1, **changes, **here)
        if body.moves:
            pybullet.resetBaseVelocity(number, body.velocity, body.angular_velocity, **here)
        return int(number)

    def step(self, count: int) -> None:
        """Advance by `count` timesteps."""
        step, client = pybullet.stepSimulation, self.client
        for _ in range(count):
            step(client)

    def poses(self) -> np.ndarray:
        """Return poses, shape (bodies, 7)."""
        found = np.empty((len(self.bodies), 7))
        for row, body in zip(found, self.bodies, strict=True):
            position, (x, y, z, w) = pybullet.getBasePositionAndOrientation(body, self.client)
            row[:] = [*position, w, x, y, z]
        return found

    def velocities(self) -> np.ndarray:
        """Return velocities, shape (bodies, 6)."""
        rows = [np.concatenate(pybullet.getBaseVelocity(b, self.client)) for b in self.bodies]
        return np.array(rows)

    def close(self) -> None:
        """Disconnect."""
        pybullet.disconnect(self.client)


def build(scene: Scene, variant: str) -> BulletHandle:
    """Return the scene at its initial state."""
    return BulletHandle(scene, variant)
