"""Scenes on DART: every movable body a skeleton with one free joint."""

from __future__ import annotations

from math import sqrt
from typing import Final

import dartpy
import numpy as np
from dartpy import dynamics

from .adapter import CannotRun
from .description import Body, Box, Scene, Sphere

VARIANTS: Final = {
    "dart": "defaults: Dantzig's method on a boxed LCP, FCL collisions",
    "dart-bullet": "Bullet's collisions, split impulse, projected Gauss-Seidel without matrix",
}
# Dantzig's method takes a step to the third power of the contacts; beyond this many bodies a step
# takes minutes and cannot be interrupted.
DANTZIG_BODIES: Final = 40


def version() -> str:
    """Return the engine's version."""
    return f"DART {dartpy.__version__}"


def _shape(body: Body) -> dynamics.Shape:
    shape = body.shape
    if isinstance(shape, Sphere):
        return dynamics.SphereShape(shape.radius)
    if isinstance(shape, Box):
        return dynamics.BoxShape(np.array(shape.size))
    return dynamics.PlaneShape(np.array(shape.normal), shape.offset)


def _place(body: Body) -> dartpy.math.Isometry3:
    place = dartpy.math.Isometry3()
    w, x, y, z = body.orientation
    place.set_quaternion(dartpy.math.Quaternion(w, x, y, z))
    place.set_translation(np.array(body.position))
    return place


class DartHandle:
    """One world."""

    def __init__(self, scene: Scene, variant: str) -> None:
        self.world = dartpy.simulation.World()
        self.world.setTimeStep(float(scene.timestep))
        self.world.setGravity(np.array(scene.gravity))
        sleeping = self.world.getDeactivationOptions()
        sleeping.mEnabled = False
        self.world.setDeactivationOptions(sleeping)
        solver = self.world.getConstraintSolver()
        if variant == "dart-bullet":
            solver.setCollisionDetector(dartpy.collision.BulletCollisionDetector())
            solver.setSplitImpulseEnabled(True)
            options = solver.getMatrixFreeContactSolverOptions()
            options.mEnabled, options.mMinRows, options.mMaxIterations = True, 1, 200
            solver.setMatrixFreeContactSolverOptions(options)
        solver.getCollisionOption().maxNumContacts = 100_000
        self.bodies = []
        for number, body in enumerate(scene.bodies):
            node = self._add(body, f"body_{number}", scene)
            if body.moves:
                self.bodies.append(node)

    def _add(self, body: Body, name: str, scene: Scene) -> dynamics.BodyNode:
        skeleton = dynamics.Skeleton(name)
        if body.moves:
            joint, node = skeleton.createFreeJointAndBodyNodePair()
        else:
            joint, node = skeleton.createWeldJointAndBodyNodePair()
        shape = node.createShapeNode(_shape(body))
        shape.createCollisionAspect()
        contact = shape.createDynamicsAspect()
        # DART takes the lesser friction and the product of the restitutions.
        contact.setFrictionCoeff(scene.friction)
        contact.setRestitutionCoeff(sqrt(scene.restitution))
        place = _place(body)
        if body.moves:
            x, y, z = body.inertia
            inertia = dynamics.Inertia(body.mass, np.zeros(3), np.diag([x, y, z]))
            node.setInertia(inertia)
            joint.setPositions(dynamics.FreeJoint.convertToPositions(place))
            joint.setLinearVelocity(np.array(body.velocity))
            joint.setAngularVelocity(np.array(body.angular_velocity))
        else:
            joint.setTransformFromParentBodyNode(place)
            skeleton.setMobile(False)
        self.world.addSkeleton(skeleton)
        return node

    def step(self, count: int) -> None:
        """Advance by `count` timesteps."""
        step = self.world.step
        for _ in range(count):
            step()

    def poses(self) -> np.ndarray:
        """Return poses, shape (bodies, 7)."""
        found = np.empty((len(self.bodies), 7))
        for row, node in zip(found, self.bodies, strict=True):
            place = node.getWorldTransform()
            turn = place.quaternion()
            row[:3] = place.translation()
            row[3:] = [turn.w(), turn.x(), turn.y(), turn.z()]
        return found

    def velocities(self) -> np.ndarray:
        """Return velocities, shape (bodies, 6)."""
        rows = [
            np.concatenate([n.getLinearVelocity(), n.getAngularVelocity()]) for n in self.bodies
        ]
        return np.array(rows)

    def close(self) -> None:
        """Drop the world."""
        del self.bodies, self.world


def build(scene: Scene, variant: str) -> DartHandle:
    """Return the scene at its initial state; raises CannotRun where a step would take minutes."""
    if variant == "dart" and len(scene.movable) > DANTZIG_BODIES:
        raise CannotRun(f"Dantzig's method takes minutes a step beyond {DANTZIG_BODIES} bodies")
    return DartHandle(scene, variant)
