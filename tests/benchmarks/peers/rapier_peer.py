"""Scenes on Rapier, single precision, one thread."""

from __future__ import annotations

from typing import Final

import numpy as np
import rapier3d
from rapier3d import Collider, MassProperties, PhysicsWorld, RigidBody

from .description import Body, Box, Plane, Scene, Sphere

VARIANTS: Final = {
    "rapier": "defaults: 4 iterations, 30 Hz contact softness, 5 mm allowed error",
    "rapier-stiff": "8 iterations of 4 sweeps, 10 um allowed error, contact springs of 2/dt, "
    "swept collision",
}


def version() -> str:
    """Return the engine's version."""
    from importlib.metadata import version as installed

    return f"Rapier {installed('rapier3d')}"


def _collider(body: Body, scene: Scene) -> rapier3d.ColliderBuilder:
    shape = body.shape
    if isinstance(shape, Sphere):
        found = Collider.ball(shape.radius)
    elif isinstance(shape, Box):
        found = Collider.cuboid(*(0.5 * edge for edge in shape.size))
    else:
        found = Collider.halfspace(shape.normal)
    # The mean of two equal coefficients is the coefficient.
    return found.friction(scene.friction).restitution(scene.restitution).density(0.0)


class RapierHandle:
    """One world."""

    def __init__(self, scene: Scene, variant: str) -> None:
        self.world = PhysicsWorld(scene.gravity)
        self.world.set_num_threads(1)
        self.stiff = variant == "rapier-stiff"
        settings = self.world.integration_parameters
        settings.dt = float(scene.timestep)
        if self.stiff:
            # Of some fifteen settings tried, the least drift and overlap of the pyramid and the
            # tower at a cost near the default's.
            settings.num_solver_iterations = 8
            settings.num_internal_pgs_iterations = 4
            settings.normalized_allowed_linear_error = 1e-5
            softness = rapier3d.SpringCoefficients(2.0 / settings.dt, 5.0)
            settings.contact_softness = settings.static_contact_softness = softness
        self.bodies = []
        for body in scene.bodies:
            handle = self._add(body, scene)
            if body.moves:
                self.bodies.append(handle)

    def _add(self, body: Body, scene: Scene) -> rapier3d.RigidBodyHandle:
        position = body.position
        if isinstance(body.shape, Plane):
            x, y, z = (body.shape.offset * n for n in body.shape.normal)
            position = (x, y, z)
        w, x, y, z = body.orientation
        place = rapier3d.Isometry3(position, rapier3d.Rotation3(w, x, y, z))
        builder = (RigidBody.dynamic() if body.moves else RigidBody.fixed()).position(place)
        if body.moves:
            properties = MassProperties((0.0, 0.0, 0.0), body.mass, body.inertia)
            builder = (
                builder.additional_mass_properties(properties)
                .linvel(body.velocity)
                .angvel(body.angular_velocity)
                .can_sleep(False)
                .ccd_enabled(self.stiff)
                .gyroscopic_forces(True)
            )
        return self.world.add_body(builder, [_collider(body, scene)])

    def step(self, count: int) -> None:
        """Advance by `count` timesteps."""
        step = self.world.step
        for _ in range(count):
            step()

    def poses(self) -> np.ndarray:
        """Return poses, shape (bodies, 7)."""
        found = np.empty((len(self.bodies), 7))
        for row, handle in zip(found, self.bodies, strict=True):
            body = self.world.rigid_bodies[handle]
            centre, turn = body.translation, body.rotation
            row[:] = [centre.x, centre.y, centre.z, turn.w, turn.i, turn.j, turn.k]
        return found

    def velocities(self) -> np.ndarray:
        """Return velocities, shape (bodies, 6)."""
        found = np.empty((len(self.bodies), 6))
        for row, handle in zip(found, self.bodies, strict=True):
            body = self.world.rigid_bodies[handle]
            v, w = body.linvel, body.angvel
            row[:] = [v.x, v.y, v.z, w.x, w.y, w.z]
        return found

    def close(self) -> None:
        """Drop the world."""
        del self.world


def build(scene: Scene, variant: str) -> RapierHandle:
    """Return the scene at its initial state."""
    return RapierHandle(scene, variant)
