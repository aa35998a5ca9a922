"""Scenes on PhysX on the processor, through sapien's components; single precision.

Sapien reports the normal impulse of a contact, and no friction. It has no cylinder but a
polyhedron, which would be another shape.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import sqrt
from typing import Any

import numpy as np
import sapien
from sapien import physx

from lavendersim.peers.declaration import Value
from lavendersim.peers.description import PeerBody, Scene
from lavendersim.peers.physx import PEER
from lavendersim.peers.world import Floats

OWN = (10, 1)  # sapien's iterations of positions and of velocities
SINGLE = np.float32
FASTEST = 1e10  # [rad/s]; its own 100 would be cut off without a word


class World:
    """One scene; its settings are those of the process when it is made."""

    def __init__(self, scene: Scene, settings: Mapping[str, Value]) -> None:
        get: Any = settings.get
        config = physx.PhysxSceneConfig()
        config.gravity = np.array(scene.gravity, SINGLE)
        config.enable_tgs, config.enable_ccd = get("tgs", True), get("swept", False)
        config.bounce_threshold = get("bounce_threshold", config.bounce_threshold)
        physx.set_scene_config(config)
        sweeps = get("iterations", OWN[0]), get("velocity_iterations", OWN[1])
        physx.set_body_config(*sweeps, sleep_threshold=0.0)  # never
        self._system = physx.PhysxCpuSystem()
        self._system.timestep = scene.timestep
        self._scene = sapien.Scene([self._system])
        # The rule that sapien leaves as it is: means.
        self._friction = scene.values("friction", PEER)
        self._restitution = scene.values("restitution", PEER)
        self._all = [self._add(body) for body in scene.bodies]
        self._bodies = [self._all[body.row] for body in scene.movable]
        self._rows = {one.entity.name: row for row, one in enumerate(self._all)}

    def _add(self, body: PeerBody) -> Any:
        mu, e = self._friction[body.row], self._restitution[body.row]
        material = physx.PhysxMaterial(mu, mu, e)
        kind = physx.PhysxRigidDynamicComponent if body.moves else physx.PhysxRigidStaticComponent
        component = kind()
        for shape, position, turn in body.pieces():
            collider, own = _collider(shape, material)
            collider.local_pose = sapien.Pose(position, turn) * own
            component.attach(collider)
        if body.moves:
            component.mass = body.mass
            component.inertia = np.array(body.inertia, SINGLE)
            component.cmass_local_pose = sapien.Pose()
            component.linear_damping = component.angular_damping = 0.0
            component.max_angular_velocity = FASTEST
        entity = sapien.Entity()
        entity.name = f"{body.row}"
        entity.add_component(component)
        pose = sapien.Pose(body.position, body.orientation)
        entity.pose = sapien.Pose() if body.shape.kind == "plane" else pose
        self._scene.add_entity(entity)
        if body.moves:
            component.linear_velocity = np.array(body.velocity, SINGLE)
            component.angular_velocity = np.array(body.spin, SINGLE)
        return component

    def inertias(self) -> Floats:
        """Return mass and principal moments."""
        return np.array([(body.mass, *body.inertia) for body in self._bodies], float)

    def mixed(self) -> tuple[Floats, Floats]:
        """Return friction and restitution of every two bodies: means."""
        own = [one.collision_shapes[0].physical_material for one in self._all]
        friction = np.array([one.dynamic_friction for one in own], float)
        restitution = np.array([one.restitution for one in own], float)
        friction, restitution = (np.add.outer(one, one) / 2.0 for one in (friction, restitution))
        return friction, restitution

    def poses(self) -> Floats:
        """Return poses."""
        poses = [body.entity.pose for body in self._bodies]
        return np.array([(*pose.p, *pose.q) for pose in poses], float)

    def velocities(self) -> Floats:
        """Return velocities."""
        rows = [(*body.linear_velocity, *body.angular_velocity) for body in self._bodies]
        return np.array(rows, float)

    def push(self, loads: Floats) -> None:
        """Have forces and torques act in the next step, which clears them."""
        for body, load in zip(self._bodies, loads.astype(SINGLE), strict=True):
            body.add_force_torque(load[:3], load[3:])

    def step(self) -> None:
        """Advance by one timestep."""
        self._system.step()

    def contacts(self) -> list[tuple[float, ...]]:
        """Return the contacts of the last step. Normals and impulses are on its first: our B."""
        found = []
        for one in self._system.get_contacts():
            b, a = (self._rows[body.entity.name] for body in one.bodies)
            for point in one.points:
                place = (*point.position, *point.normal, point.separation)
                push = float(np.dot(point.impulse, point.normal))
                found.append((a, b, *(float(value) for value in place), push))
        return found


def _collider(shape: Any, material: Any) -> tuple[Any, Any]:
    """Return a shape and where it stands in its piece: planes and capsules lie along its x."""
    if shape.kind == "plane":
        place = [shape.offset * n for n in shape.normal]
        turn = sapien.Pose(place, _turn_x_to(shape.normal))
        return physx.PhysxCollisionShapePlane(material), turn
    if shape.kind == "sphere":
        return physx.PhysxCollisionShapeSphere(shape.radius, material), sapien.Pose()
    if shape.kind == "capsule":
        upright = sapien.Pose(q=_turn_x_to((0.0, 0.0, 1.0)))
        return physx.PhysxCollisionShapeCapsule(shape.radius, 0.5 * shape.length, material), upright
    if shape.kind == "hull":
        scale, corners = np.ones(3, SINGLE), np.array(shape.points, SINGLE)
        return physx.PhysxCollisionShapeConvexMesh(corners, scale, material), sapien.Pose()
    half = [0.5 * edge for edge in shape.size]
    return physx.PhysxCollisionShapeBox(half, material), sapien.Pose()


def _turn_x_to(normal: tuple[float, float, float]) -> list[float]:
    """Return the quaternion w x y z that takes the x axis to a unit vector."""
    x, y, z = normal
    if x < -1.0 + 1e-12:
        return [0.0, 0.0, 0.0, 1.0]
    size = sqrt(2.0 + 2.0 * x)
    return [(1.0 + x) / size, 0.0, -z / size, y / size]
