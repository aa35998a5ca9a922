"""Scenes on Drake: a MultibodyPlant with discrete steps; what stays is of its world body."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from pydrake import geometry
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig
from pydrake.multibody.tree import SpatialInertia, UnitInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from lavendersim.peers.declaration import Value
from lavendersim.peers.description import PeerBody, Scene
from lavendersim.peers.drake import PEER
from lavendersim.peers.mixing import harmonic_mean
from lavendersim.peers.world import Floats

MODULUS, RESOLUTION = 1e7, 0.02  # [Pa], [m] of patches: Drake's defaults


class World:
    """One plant and its simulator."""

    def __init__(self, scene: Scene, settings: Mapping[str, Value]) -> None:
        get: Any = settings.get
        config = MultibodyPlantConfig(time_step=scene.timestep)
        config.contact_model = "hydroelastic" if get("hydroelastic") else "point"
        config.discrete_contact_approximation = get("model", "lagged")
        config.stiction_tolerance = get("stiction_tolerance", config.stiction_tolerance)
        builder = DiagramBuilder()
        self._plant, graph = AddMultibodyPlant(config, builder)
        self._plant.mutable_gravity_field().set_gravity_vector(np.array(scene.gravity))
        self._of, self._dt, self._steps = settings, scene.timestep, 0
        self._friction = scene.values("friction", PEER)  # its rule
        self._rows: dict[Any, int] = {}  # by geometry
        nodes = [self._add(body) for body in scene.bodies]
        self._bodies = [nodes[body.row] for body in scene.movable]
        self._plant.Finalize()
        self._simulator = Simulator(builder.Build())
        context = self._simulator.get_mutable_context()
        self._context = self._plant.GetMyMutableContextFromRoot(context)
        self._inspector = graph.model_inspector()
        for body, node in zip(scene.movable, self._bodies, strict=True):
            place = _place(body.position, body.orientation)
            self._plant.SetFreeBodyPose(self._context, node, place)
            motion = SpatialVelocity(np.array(body.spin), np.array(body.velocity))
            self._plant.SetFreeBodySpatialVelocity(self._context, node, motion)
        self.push(np.zeros((len(self._bodies), 6)))
        self._simulator.Initialize()

    def _add(self, body: PeerBody) -> Any:
        node, at = self._plant.world_body(), _place(body.position, body.orientation)
        if body.moves:
            unit = UnitInertia(*(moment / body.mass for moment in body.inertia))
            inertia = SpatialInertia(body.mass, np.zeros(3), unit)
            node, at = self._plant.AddRigidBody(f"{body.row}", inertia), RigidTransform()
        for k, (shape, position, turn) in enumerate(body.pieces()):
            form, place = _form(shape)
            place = place if shape.kind == "plane" else at @ _place(position, turn)
            rest = (f"{body.row}_{k}", self._properties(body, shape))
            made = self._plant.RegisterCollisionGeometry(node, place, form, *rest)
            self._rows[made] = body.row
        return node

    def _properties(self, body: PeerBody, shape: Any) -> Any:
        get: Any = self._of.get
        found, mu = geometry.ProximityProperties(), self._friction[body.row]
        rest = get("dissipation"), get("stiffness"), CoulombFriction(mu, mu)
        geometry.AddContactMaterial(*rest, found)
        if get("hydroelastic"):
            if shape.kind == "plane":  # it meets nothing compliant but as a rigid one
                geometry.AddRigidHydroelasticProperties(found)
            else:
                modulus = get("modulus", MODULUS)
                geometry.AddCompliantHydroelasticProperties(RESOLUTION, modulus, found)
        return found

    def inertias(self) -> Floats:
        """Return mass and principal moments."""
        own = [node.CalcSpatialInertiaInBodyFrame(self._context) for node in self._bodies]
        return np.array([(m.get_mass(), *m.CalcRotationalInertia().get_moments()) for m in own])

    def mixed(self) -> tuple[Floats, Floats]:
        """Return friction of every two bodies, the harmonic mean; it has no restitution."""
        own = np.zeros(1 + max(self._rows.values()))
        for one, row in self._rows.items():
            properties = self._inspector.GetProximityProperties(one)
            own[row] = properties.GetProperty("material", "coulomb_friction").dynamic_friction()
        friction = np.array([[harmonic_mean(a, b) for b in own] for a in own])
        return friction, np.full_like(friction, np.nan)

    def poses(self) -> Floats:
        """Return poses."""
        own = [self._plant.EvalBodyPoseInWorld(self._context, node) for node in self._bodies]
        return np.array([(*a.translation(), *a.rotation().ToQuaternion().wxyz()) for a in own])

    def velocities(self) -> Floats:
        """Return velocities."""
        evaluate = self._plant.EvalBodySpatialVelocityInWorld
        own = [evaluate(self._context, node) for node in self._bodies]
        return np.array([(*one.translational(), *one.rotational()) for one in own])

    def push(self, loads: Floats) -> None:
        """Have forces and torques act from now on; a free body's axes are the world's."""
        found = np.zeros(self._plant.num_velocities())
        for node, load in zip(self._bodies, loads, strict=True):
            first = node.floating_velocities_start_in_v()
            found[first : first + 6] = (*load[3:], *load[:3])
        self._plant.get_applied_generalized_force_input_port().FixValue(self._context, found)

    def step(self) -> None:
        """Advance by one timestep."""
        self._steps += 1
        self._simulator.AdvanceTo(self._steps * self._dt)

    def contacts(self) -> list[tuple[float, ...]]:
        """Return the contacts of the last step; a force is on its B, whose normal points to A."""
        results = self._plant.get_contact_results_output_port().Eval(self._context)
        found = []
        for k in range(results.num_point_pair_contacts()):
            one = results.point_pair_contact_info(k)
            pair, impulse = one.point_pair(), one.contact_force() * self._dt
            normal = -pair.nhat_BA_W
            push = float(impulse @ normal)
            rows = self._rows[pair.id_A], self._rows[pair.id_B], *one.contact_point()
            found.append((*rows, *normal, -pair.depth, push, *(impulse - push * normal)))
        return found


def _place(position: Any, orientation: Any) -> Any:
    return RigidTransform(Quaternion(np.array(orientation)), np.array(position))


def _form(shape: Any) -> tuple[Any, Any]:
    if shape.kind == "plane":
        point = np.array(shape.normal) * shape.offset
        return geometry.HalfSpace(), geometry.HalfSpace.MakePose(np.array(shape.normal), point)
    if shape.kind == "box":
        return geometry.Box(*shape.size), None
    if shape.kind == "sphere":
        return geometry.Sphere(shape.radius), None
    form = geometry.Capsule if shape.kind == "capsule" else geometry.Cylinder
    return form(shape.radius, shape.length), None
