"""Scenes on Rapier, one thread.

Its Python reports no directions of friction, and of its default friction no impulse either.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import rapier3d
from rapier3d import CoefficientCombineRule as Rule
from rapier3d import Collider, MassProperties, PhysicsWorld, RigidBody

from lavendersim.peers.declaration import Value
from lavendersim.peers.description import PeerBody, Scene
from lavendersim.peers.rapier import PEER
from lavendersim.peers.world import Floats

FASTEST = 1e30  # [m/s]; its own 400 would be cut off without a word


class World:
    """One world."""

    def __init__(self, scene: Scene, settings: Mapping[str, Value]) -> None:
        self._world = PhysicsWorld(scene.gravity)
        self._world.set_num_threads(1)
        self._swept = bool(settings.get("swept", False))
        own = self._world.integration_parameters
        own.dt = scene.timestep
        own.normalized_max_linear_velocity = FASTEST
        for name, of_rapier in (
            ("iterations", "num_solver_iterations"),
            ("internal_iterations", "num_internal_pgs_iterations"),
            ("allowed_error", "normalized_allowed_linear_error"),
        ):
            if name in settings:
                setattr(own, of_rapier, settings[name])
        if "stiff_steps" in settings:
            frequency = float(settings["stiff_steps"]) / scene.timestep
            softness = rapier3d.SpringCoefficients(frequency, 5.0)
            own.contact_softness = own.static_contact_softness = softness
        # Both of its rules are given: roots are multiplied, the larger restitution is taken.
        self._friction = scene.values("friction", PEER)
        self._restitution = scene.values("restitution", PEER)
        self._all = handles = [self._add(body) for body in scene.bodies]
        self._rows = {handle.index: row for row, handle in enumerate(handles)}
        self._handles = [handles[body.row] for body in scene.movable]
        for one in self._bodies():  # else only its first step would do it
            one.recompute_mass_properties_from_colliders(self._world.colliders)

    def _add(self, body: PeerBody) -> Any:
        shape, position = body.shape, body.position
        if shape.kind == "plane":
            collider = Collider.halfspace(shape.normal)
            x, y, z = (shape.offset * n for n in shape.normal)
            position = (x, y, z)
        elif shape.kind == "box":
            collider = Collider.cuboid(*(0.5 * edge for edge in shape.size))
        else:
            collider = Collider.ball(shape.radius)
        collider = collider.friction(self._friction[body.row]).density(0.0)
        collider = collider.restitution(self._restitution[body.row])
        collider = collider.friction_combine_rule(Rule.MULTIPLY)
        collider = collider.restitution_combine_rule(Rule.MAX)
        turn = (1.0, 0.0, 0.0, 0.0) if shape.kind == "plane" else body.orientation
        place = rapier3d.Isometry3(position, rapier3d.Rotation3(*turn))
        builder = (RigidBody.dynamic() if body.moves else RigidBody.fixed()).position(place)
        if body.moves:
            properties = MassProperties((0.0, 0.0, 0.0), body.mass, body.inertia)
            builder = (
                builder.additional_mass_properties(properties)
                .linvel(body.velocity)
                .angvel(body.spin)
                .can_sleep(False)
                .ccd_enabled(self._swept)
                .gyroscopic_forces(True)
                .allow_fast_rotation(True)  # else pi/4 a step is the most
            )
        return self._world.add_body(builder, [collider])

    def _bodies(self) -> list[Any]:
        return [self._world.rigid_bodies[handle] for handle in self._handles]

    def inertias(self) -> Floats:
        """Return mass and principal moments."""
        found = []
        for body in self._bodies():
            moments = body.mass_properties.principal_inertia
            found.append((body.mass, moments.x, moments.y, moments.z))
        return np.array(found)

    def mixed(self) -> tuple[Floats, Floats]:
        """Return friction and restitution of every two bodies, by the rules that were given."""
        handles = [self._world.rigid_bodies[one].colliders[0] for one in self._all]
        colliders = [self._world.colliders[one] for one in handles]
        friction = np.array([one.friction for one in colliders])
        restitution = np.array([one.restitution for one in colliders])
        return np.outer(friction, friction), np.maximum.outer(restitution, restitution)

    def poses(self) -> Floats:
        """Return poses."""
        found = np.empty((len(self._handles), 7))
        for row, body in zip(found, self._bodies(), strict=True):
            centre, turn = body.translation, body.rotation
            row[:] = [centre.x, centre.y, centre.z, turn.w, turn.i, turn.j, turn.k]
        return found

    def velocities(self) -> Floats:
        """Return velocities."""
        found = np.empty((len(self._handles), 6))
        for row, body in zip(found, self._bodies(), strict=True):
            v, w = body.linvel, body.angvel
            row[:] = [v.x, v.y, v.z, w.x, w.y, w.z]
        return found

    def push(self, loads: Floats) -> None:
        """Have forces and torques act in the next step; they last until they are taken back."""
        for body, load in zip(self._bodies(), loads.tolist(), strict=True):
            body.reset_forces(True)
            body.reset_torques(True)
            body.add_force(tuple(load[:3]), True)
            body.add_torque(tuple(load[3:]), True)

    def step(self) -> None:
        """Advance by one timestep."""
        self._world.step()

    def contacts(self) -> list[tuple[float, ...]]:
        """Return the contacts solved in the last step, with the impulses of all of it."""
        found = []
        for pair in self._world.narrow_phase.contact_pairs():
            for manifold in pair.manifolds:
                data, normal = manifold.data, manifold.data.normal
                bodies = data.rigid_body1, data.rigid_body2
                rows = [self._rows[body.index] for body in bodies if body is not None]
                impulses = {one.contact_id: one.impulse for one in manifold.points}
                for one in data.solver_contacts:
                    place = (one.point.x, one.point.y, one.point.z, normal.x, normal.y, normal.z)
                    found.append((*rows, *place, one.dist, impulses[one.contact_id]))
        return found
