"""Scenes on PhysX on the processor, through sapien's components; single precision."""

from __future__ import annotations

from typing import Final

import numpy as np
import sapien
from sapien import physx

from .description import Body, Box, Plane, Scene, Sphere

VARIANTS: Final = {
    "physx": "sapien's defaults: TGS, 10 position and 1 velocity iterations",
    "physx-pgs": "PGS, 10 position and 1 velocity iterations",
    "physx-accurate": "TGS, 100 position and 10 velocity iterations, the scene's CCD flag",
}
NEVER_SLEEPS: Final = 0.0


def version() -> str:
    """Return the engine's version, by the package that brings it."""
    return f"PhysX (sapien {sapien.__version__})"


def _turn_x_to(normal: tuple[float, float, float]) -> list[float]:
    """Return the quaternion w x y z that takes the x axis to `normal`: PhysX's planes face x."""
    x, y, z = normal
    if x < -1.0 + 1e-12:
        return [0.0, 0.0, 0.0, 1.0]
    turn = np.array([1.0 + x, 0.0, -z, y])
    return list(turn / np.linalg.norm(turn))


def _configure(scene: Scene, variant: str) -> None:
    config = physx.PhysxSceneConfig()
    config.gravity = np.array(scene.gravity, np.float32)
    config.enable_tgs = variant != "physx-pgs"
    config.enable_ccd = variant == "physx-accurate"
    physx.set_scene_config(config)
    accurate = variant == "physx-accurate"
    physx.set_body_config(
        solver_position_iterations=100 if accurate else 10,
        solver_velocity_iterations=10 if accurate else 1,
        sleep_threshold=NEVER_SLEEPS,
    )


class PhysxHandle:
    """One PhysX scene on the processor."""

    def __init__(self, scene: Scene, variant: str) -> None:
        _configure(scene, variant)
        self.system = physx.PhysxCpuSystem()
        self.scene = sapien.Scene([self.system])
        self.system.timestep = float(scene.timestep)
        self.material = physx.PhysxMaterial(scene.friction, scene.friction, scene.restitution)
        self.bodies = []
        for body in scene.bodies:
            component = self._add(body)
            if body.moves:
                self.bodies.append(component)

    def _shape(self, body: Body) -> physx.PhysxCollisionShape:
        shape = body.shape
        if isinstance(shape, Sphere):
            return physx.PhysxCollisionShapeSphere(shape.radius, self.material)
        if isinstance(shape, Box):
            half = [0.5 * edge for edge in shape.size]
            return physx.PhysxCollisionShapeBox(half, self.material)
        return physx.PhysxCollisionShapePlane(self.material)

    def _add(self, body: Body) -> physx.PhysxRigidBaseComponent:
        position, orientation = list(body.position), list(body.orientation)
        if isinstance(body.shape, Plane):
            position = [body.shape.offset * n for n in body.shape.normal]
            orientation = _turn_x_to(body.shape.normal)
        moves = body.moves
        component = (
            physx.PhysxRigidDynamicComponent() if moves else physx.PhysxRigidStaticComponent()
        )
        component.attach(self._shape(body))
        if moves:
            component.mass = body.mass
            component.inertia = np.array(body.inertia, np.float32)
            component.cmass_local_pose = sapien.Pose()
            component.linear_damping = component.angular_damping = 0.0
        entity = sapien.Entity()
        entity.add_component(component)
        entity.pose = sapien.Pose(position, orientation)
        self.scene.add_entity(entity)
        if moves:
            component.linear_velocity = np.array(body.velocity, np.float32)
            component.angular_velocity = np.array(body.angular_velocity, np.float32)
        return component

    def step(self, count: int) -> None:
        """Advance by `count` timesteps."""
        step = self.system.step
        for _ in range(count):
            step()

    def poses(self) -> np.ndarray:
        """Return poses, shape (bodies, 7)."""
        found = np.empty((len(self.bodies), 7))
        for row, body in zip(found, self.bodies, strict=True):
            pose = body.entity.pose
            row[:3], row[3:] = pose.p, pose.q
        return found

    def velocities(self) -> np.ndarray:
        """Return velocities, shape (bodies, 6)."""
        rows = [[*body.linear_velocity, *body.angular_velocity] for body in self.bodies]
        return np.array(rows, float)

    def close(self) -> None:
        """Drop the scene."""
        del self.bodies, self.scene, self.system


def build(scene: Scene, variant: str) -> PhysxHandle:
    """Return the scene at its initial state."""
    return PhysxHandle(scene, variant)
