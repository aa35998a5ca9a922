"""Resolving a scene: bodies in their principal frames, forces in time."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from lavendersim.cell.body import CellBody
from lavendersim.cell.scene import CellForce, CellScene
from lavendersim.cell.shapes import Cavity, CellMesh, CellShape, Plane
from lavendersim.cell.shared_parts import shared
from lavendersim.engine.effects import BODY_KEYS, SCENE_KEYS, TurnOf
from lavendersim.experiment.models.bodies import ArrangedBody, Body
from lavendersim.experiment.models.meshes import HeightField, Mesh
from lavendersim.experiment.models.scene import Force, Scene
from lavendersim.experiment.models.tree import (
    ARRANGEMENTS,
    BODIES,
    PRESCRIBE_MOTION,
    member_name,
)
from lavendersim.experiment.resolve.arrangements import centres, turns_of
from lavendersim.experiment.resolve.cavities import refuse_what_does_not_fit
from lavendersim.experiment.resolve.frames import Frames
from lavendersim.experiment.resolve.gravity import gravity_vector
from lavendersim.experiment.resolve.placement import below, released_position
from lavendersim.experiment.resolve.shape import quaternion_of, resolve_shape
from lavendersim.experiment.resolve.surface_pairs import surface_of
from lavendersim.experiment.resolve.surfaces import resolve_surface
from lavendersim.geometry.quaternions import IDENTITY, Quaternion, product, to_body, to_world
from lavendersim.geometry.vectors import unit
from lavendersim.quantities.quantity import Vector3

AS_WRITTEN = 0  # the seed that moves nothing
_ORIGIN: Vector3 = (0.0, 0.0, 0.0)


def resolve_scene(scene: Scene, timestep: Fraction, duration: float) -> tuple[CellScene, Frames]:
    """Fill in what the file leaves open; raises SceneError with the path of what to change."""
    gravity = gravity_vector(scene.gravity)
    bodies: dict[str, CellBody] = {}
    written: dict[str, Quaternion] = {}  # orientation of the frame that the file means
    for name, body in scene.bodies.items():
        written[name] = quaternion_of(body.orientation)
        with below(*BODIES, name):
            bodies[name] = _body(body, scene, gravity, timestep)
    for name, arrangement in scene.arrangements.items():
        with below(*ARRANGEMENTS, name, "body"):
            one = CellBody.of(**_matter(arrangement.body, scene))
        first = one
        if arrangement.first is not None:
            with below(*ARRANGEMENTS, name, "first"):
                first = CellBody.of(**_matter(arrangement.first, scene))
        assert not isinstance(one.shape, Plane | Cavity | CellMesh)
        places = centres(arrangement, one.shape, one.orientation)
        turns = turns_of(arrangement)
        for number, position in enumerate(places, start=1):
            member, turn = member_name(name, number), turns[number - 1] if turns else IDENTITY
            placed, source = (first, arrangement.first) if number == 1 else (one, arrangement.body)
            bodies[member] = _turned(placed, turn, position)
            as_written = quaternion_of((source or arrangement.body).orientation)
            written[member] = as_written if turn == IDENTITY else product(turn, as_written)

    if scene.perturbation is not None and scene.perturbation.seed != AS_WRITTEN:
        from lavendersim.geometry.perturbed_bodies import perturbed  # late: few scenes need it

        bodies = perturbed(bodies, scene.perturbation.seed, scene.perturbation.distance, gravity)
    frames = Frames(written, bodies)
    turned = frames.vector
    forces = tuple(_force(force, duration, turned) for force in scene.forces)
    by_effect = {key.name: key.resolve(getattr(scene, key.name), turned) for key in SCENE_KEYS}
    resolved: CellScene = CellScene.of(gravity=gravity, bodies=bodies, forces=forces, **by_effect)
    return resolved, frames


def _turned(body: CellBody, turn: Quaternion, position: Vector3) -> CellBody:
    """Return a body at its place, with its velocities turned about the origin of the world."""
    changes: dict[str, object] = {"position": position}
    if turn != IDENTITY:
        changes["orientation"] = product(turn, body.orientation)
        changes["velocity"] = to_world(turn, body.velocity)
        changes["angular_velocity"] = to_world(turn, body.angular_velocity)
    return body.model_copy(update=changes)


def _body(body: Body, scene: Scene, gravity: Vector3, timestep: Fraction) -> CellBody:
    matter = _matter(body, scene)
    shape = matter["shape"]
    if isinstance(shape, Plane):
        x, y, z = shape.normal
        position: Vector3 = (x * shape.offset, y * shape.offset, z * shape.offset)
    elif body.release is not None:
        plane = scene.bodies[body.release.above].shape
        assert isinstance(plane, Plane)
        position = released_position(
            body.release, plane, shape, matter["orientation"], gravity, timestep
        )
    else:
        assert body.position is not None
        position = body.position
    release = None if body.release is None else shared(body.release)
    placed: CellBody = CellBody.of(**matter | {"position": position, "release": release})
    return placed


def _matter(body: Body | ArrangedBody, scene: Scene) -> dict[str, Any]:
    """Return the values of a body that stands at the origin; its velocities are as written."""
    surface = surface_of(body.surface, scene)
    prescribed = any(getattr(body, key) for key in PRESCRIBE_MOTION)
    fixed = body.fixed or prescribed or isinstance(body.shape, Plane | Cavity | Mesh | HeightField)
    orientation, axes = quaternion_of(body.orientation), IDENTITY
    mass: float | None = None
    inertia: Vector3 | None = None
    shape: CellShape
    if isinstance(body.shape, Plane):
        shape = body.shape.model_copy(update={"normal": unit(body.shape.normal)})
    elif isinstance(body.shape, Cavity):
        shape = body.shape
    elif isinstance(body.shape, Mesh | HeightField):
        with below("shape"):
            shape = resolve_surface(body.shape)
    else:
        with below("shape"):
            shape, volume, (x, y, z), axes = resolve_shape(body.shape)
            if not fixed:
                refuse_what_does_not_fit(shape, scene)
        if axes != IDENTITY:
            orientation = product(orientation, axes)
        if not fixed:
            mass = body.mass if body.mass is not None else (body.density or 0.0) * volume
            inertia = body.inertia or (mass * x, mass * y, mass * z)

    def turned(vector: Vector3) -> Vector3:
        """Return a vector of the frame as written in the frame of the principal axes."""
        return vector if axes == IDENTITY else to_body(axes, vector)

    by_effect = {key.name: key.resolve(getattr(body, key.name), turned) for key in BODY_KEYS}
    return {
        "shape": shared(shape),
        "fixed": fixed,
        "mass": mass,
        "density": body.density,
        "inertia": inertia,
        "surface": shared(surface),
        "position": _ORIGIN,
        "release": None,
        "orientation": orientation,
        "velocity": body.velocity,
        "angular_velocity": body.angular_velocity,
        **by_effect,
    }


def _force(force: Force, duration: float, turned: TurnOf) -> CellForce:
    written = force.model_dump(by_alias=True, exclude_none=True)
    for key in ("point", "force", "torque") if force.frame == "body" else ("point",):
        written[key] = turned(force.body, written[key])
    return CellForce.model_validate({"to": duration} | written)
