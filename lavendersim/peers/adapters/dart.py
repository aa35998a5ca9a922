"""Scenes on DART: every movable body a skeleton with one free joint."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import dartpy
import numpy as np
from dartpy import dynamics

from lavendersim.peers.dart import PEER
from lavendersim.peers.declaration import Value
from lavendersim.peers.description import PeerBody, Scene
from lavendersim.peers.world import Floats

DETECTORS = {
    "fcl": dartpy.collision.FCLCollisionDetector,
    "bullet": dartpy.collision.BulletCollisionDetector,
    "dart": dartpy.collision.DARTCollisionDetector,
}


class World:
    """One world."""

    def __init__(self, scene: Scene, settings: Mapping[str, Value]) -> None:
        self._world, self._dt = dartpy.simulation.World(), scene.timestep
        self._world.setTimeStep(scene.timestep)
        self._world.setGravity(np.array(scene.gravity))
        self._world.setNumSimulationThreads(1)
        sleeping = self._world.getDeactivationOptions()
        sleeping.mEnabled = False
        self._world.setDeactivationOptions(sleeping)
        solver = self._world.getConstraintSolver()
        if "detector" in settings:
            solver.setCollisionDetector(DETECTORS[str(settings["detector"])]())
        if "split_impulse" in settings:
            solver.setSplitImpulseEnabled(settings["split_impulse"])
        if "sweeps" in settings:
            options = solver.getMatrixFreeContactSolverOptions()
            options.mEnabled, options.mMinRows = True, 1
            options.mMaxIterations = settings["sweeps"]
            solver.setMatrixFreeContactSolverOptions(options)
        # A copy, which cannot be given back: what it has beyond these it leaves out.
        self._most_contacts = solver.getCollisionOption().maxNumContacts
        # Both of its rules are given: the lesser friction, the product of restitutions.
        self._friction = scene.values("friction", PEER)
        self._restitution = scene.values("restitution", PEER)
        self._all = [self._add(body) for body in scene.bodies]
        self._nodes = [self._all[body.row] for body in scene.movable]

    def _add(self, body: PeerBody) -> Any:
        skeleton = dynamics.Skeleton(f"{body.row}")
        kind = "Free" if body.moves else "Weld"
        joint, node = getattr(skeleton, f"create{kind}JointAndBodyNodePair")()
        shape = node.createShapeNode(_shape(body.shape))
        shape.createCollisionAspect()
        contact = shape.createDynamicsAspect()
        contact.setFrictionCoeff(self._friction[body.row])
        contact.setRestitutionCoeff(self._restitution[body.row])
        place = dartpy.math.Isometry3()
        if body.shape.kind != "plane":  # its normal is of the world
            place.set_quaternion(dartpy.math.Quaternion(*body.orientation))
            place.set_translation(np.array(body.position))
        if body.moves:
            node.setInertia(dynamics.Inertia(body.mass, np.zeros(3), np.diag(body.inertia)))
            joint.setPositions(dynamics.FreeJoint.convertToPositions(place))
            joint.setLinearVelocity(np.array(body.velocity))
            joint.setAngularVelocity(np.array(body.spin))
        else:
            joint.setTransformFromParentBodyNode(place)
            skeleton.setMobile(False)
        self._world.addSkeleton(skeleton)
        return node

    def inertias(self) -> Floats:
        """Return mass and principal moments."""
        found = []
        for node in self._nodes:
            inertia = node.getInertia()
            found.append((inertia.getMass(), *np.diag(inertia.getMoment())))
        return np.array(found)

    def mixed(self) -> tuple[Floats, Floats]:
        """Return friction and restitution of every two bodies: the lesser, the product."""
        own = [node.getShapeNode(0).getDynamicsAspect() for node in self._all]
        friction = np.array([one.getFrictionCoeff() for one in own])
        restitution = np.array([one.getRestitutionCoeff() for one in own])
        return np.minimum.outer(friction, friction), np.outer(restitution, restitution)

    def poses(self) -> Floats:
        """Return poses."""
        found = np.empty((len(self._nodes), 7))
        for row, node in zip(found, self._nodes, strict=True):
            place = node.getWorldTransform()
            turn = place.quaternion()
            row[:3], row[3:] = place.translation(), (turn.w(), turn.x(), turn.y(), turn.z())
        return found

    def velocities(self) -> Floats:
        """Return velocities."""
        rows = [(*one.getLinearVelocity(), *one.getAngularVelocity()) for one in self._nodes]
        return np.array(rows)

    def push(self, loads: Floats) -> None:
        """Have forces and torques act in the next step, which clears them."""
        for node, load in zip(self._nodes, loads, strict=True):
            node.setExtForce(load[:3], np.zeros(3), False, True)
            node.setExtTorque(load[3:], False)

    def step(self) -> None:
        """Advance by one timestep."""
        self._world.step()

    def is_full(self) -> bool:
        """Return whether the last step had no room for more contacts."""
        return bool(self._world.getLastCollisionResult().getNumContacts() >= self._most_contacts)

    def contacts(self) -> list[tuple[float, ...]]:
        """Return the contacts of the last step. Normals and forces are on its first body: our B."""
        found = []
        for one in self._world.getLastCollisionResult().getContacts():
            normal, impulse = np.array(one.normal), np.array(one.force) * self._dt
            push = float(impulse @ normal)
            place = (*one.point, *normal, -one.penetrationDepth)
            rows = (_row(one.collisionObject2), _row(one.collisionObject1))
            found.append((*rows, *place, push, *(impulse - push * normal)))
        return found


def _row(collider: Any) -> int:
    node = collider.getShapeFrame().asShapeNode()
    return int(node.getSkeleton().getName())


def _shape(shape: Any) -> Any:
    if shape.kind == "plane":
        return dynamics.PlaneShape(np.array(shape.normal), shape.offset)
    if shape.kind == "sphere":
        return dynamics.SphereShape(shape.radius)
    return dynamics.BoxShape(np.array(shape.size))
