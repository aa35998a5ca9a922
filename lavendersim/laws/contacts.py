"""Contacts of bodies in some pose, by collision detection, with levers and what the pair obeys."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.engine.contacts_at_pose import contacts_at_pose
from lavendersim.engine.records import PLANE
from lavendersim.engine.row_terms import row_terms
from lavendersim.engine.tangents import first_tangent, second_tangent
from lavendersim.errors import UsageError
from lavendersim.geometry.bodies import principal_inertia
from lavendersim.geometry.periodic_cell import nearest_images
from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.geometry.shapes import bounding_radius, thickness
from lavendersim.scene.body_rows import orient
from lavendersim.scene.build import build
from lavendersim.scene.events import EventQueue
from lavendersim.scene.plan import plan_of

from .motion import Floats, RecordedMotion

# What of a plan says who may touch whom, where its points are and what the pair obeys.
_GEOMETRY = {
    *("broad_phase", "compound", "compliance", "contact_torque", "external_force", "friction"),
    "periodic_boundary",
    *(
        "hertz_contact",
        "kinematic",
        "restitution",
        "rotation",
        "static_friction",
        "surface_velocity",
    ),
}
# Impulses of these are in no pose and no velocity, or they have no round cone of three numbers.
_UNKNOWN = (
    *("anisotropic_friction", "contact_patch", "tangential_compliance", "tangential_restitution"),
    *("cohesion", "drag", "joint", "rolling_friction", "rope", "spring"),
    *("torsional_friction", "varying_force"),
)

# Of a body's radius: what pushes nearer than that and cannot meet it pushes across a gap [-].
AROUND: Final = 0.1


class Contacts(NamedTuple):
    """n points that may push, in one pose."""

    a: NDArray[np.intp]  # (n,) row of the body
    b: NDArray[np.intp]
    feature: NDArray[np.int64]  # (n,) equal while the same vertices, edges and faces make the point
    frame: Floats  # (n, 3, 3) n from A to B, t1, t2 as rows
    lever_a: Floats  # (n, 3) from the centre of mass to the own surface, or one point [m]
    lever_b: Floats
    gap: Floats  # (n,) separation, negative inside [m]
    mu: Floats  # (n,) [-] that of rest, where it is the larger
    restitution: Floats  # (n,) [-]
    rigid: NDArray[np.bool_]  # (n,) without compliance
    belt: Floats  # (n, 3) velocity of B's surface in B less that of A's in A, world axes [m/s]


class ContactSearch:
    """Finds the contacts of a run's bodies wherever they are put."""

    def __init__(self, motion: RecordedMotion) -> None:
        """UsageError where the config has what poses and velocities do not tell."""
        config = motion.config
        plan = plan_of(config, record=False)
        if unknown := [name for name in _UNKNOWN if name in plan.spec.effects]:
            effect = unknown[0]
            raise UsageError(
                f"{motion.path}: {effect.replace('_', ' ')} ({plan.decisions[effect].reason}): "
                "its impulses do not follow from poses and velocities, so no step is judged"
            )
        if config.triggered:
            raise UsageError(
                f"{motion.path}: an event happens when {config.triggered[0].when.text}: poses and "
                "velocities do not tell when that was, so no step is judged"
            )
        effects = _GEOMETRY.intersection(plan.spec.effects) | {"speculative"}
        spec = plan.spec._replace(
            effects=tuple(sorted(effects)), solver="projected_gauss_seidel", order="forward"
        )
        self._springs = row_terms(plan.spec).elastic
        self._periodic = config.scene.periodic if "periodic_boundary" in effects else None
        self.slop = config.numerics.slop  # gap and penetration that the config calls none [m]
        scene = build(config, spec)
        self.engine = scene.engine(spec)
        self._events = EventQueue(self.engine, scene, config.events)
        self._count = len(motion.bodies)
        self._radii = np.array(
            [bounding_radius(body.shape) for body in config.scene.bodies.values()], float
        )
        self._radii[~np.isfinite(self._radii)] = 0.0  # planes, which do not move
        self._thickness = [thickness(body.shape) for body in config.scene.bodies.values()]
        moments = [principal_inertia(body) for body in config.scene.bodies.values()]
        inv_m = self.engine.bodies["inv_m"][: self._count]
        # Events that scale a mass scale its moments: what they are for each kilogram stays.
        self._moments = np.array(moments).reshape(-1, 3) * inv_m[:, None]

    def begin(self, done: int) -> None:
        """Let events act that are due after so many steps."""
        self._events.apply_due(done)

    @property
    def masses(self) -> Floats:
        """Mass of each body now (bodies,) [kg]; 0 of what impulses do not move."""
        inv_m = self.engine.bodies["inv_m"][: self._count]
        masses: Floats = np.where(inv_m > 0.0, 1.0 / np.where(inv_m > 0.0, inv_m, 1.0), 0.0)
        return masses

    @property
    def moments(self) -> Floats:
        """Moments of inertia of each body now (bodies, 3) [kg m^2], about its own axes."""
        moments: Floats = self._moments * self.masses[:, None]
        return moments

    @property
    def gravity(self) -> Floats:
        """Gravity now [m/s^2]."""
        p = self.engine.parameters[0]
        return np.array([p["gx"], p["gy"], p["gz"]])

    def thickness(self, bodies: tuple[int, int]) -> float:
        """Return the thickness [m] of the thinner of two bodies, of which one is no plane."""
        return min(self._thickness[row] for row in bodies)

    def forces(self) -> tuple[Floats, Floats]:
        """Return the constant forces [N] and torques [N m] on each body now (bodies, 3)."""
        rows = self.engine.bodies[: self._count]
        return _vectors(rows, "f"), _vectors(rows, "t")

    def at(self, pose: Floats, velocity: Floats, dt: float) -> Contacts:
        """Return the contacts of a pose (bodies, 7), as far as bodies get in dt [s] and AROUND.

        velocity: the larger of their speeds (bodies, 2), of centres [m/s] and spins [rad/s].
        """
        engine, count = self.engine, self._count
        for row, one in zip(engine.bodies, pose, strict=False):
            if row["shape"] != PLANE:
                row["x"], row["y"], row["z"] = one[:3]
                orient(row, one[3:] / np.linalg.norm(one[3:]))
        engine.velocities["vx"][:count] = velocity[:, 0]
        if "wx" in (engine.velocities.dtype.names or ()):
            engine.velocities["wx"][:count] = velocity[:, 1]
        engine.parameters["dt"] = dt
        reach = dt * (velocity[:, 0] + velocity[:, 1] * self._radii) + AROUND * self._radii
        engine.state.motion["reach"][:count] = np.where(np.isfinite(reach), reach, 0.0)
        return self._described(contacts_at_pose(engine))

    def _described(self, found: np.ndarray) -> Contacts:
        bodies, pairs = self.engine.bodies, self.engine.state.pairs
        normal, point = _vectors(found, "n"), _vectors(found, "")
        x, y, z = normal.T
        side = np.where(z >= 0.0, 1.0, -1.0)
        tangents = (
            np.stack(one(x, y, z, side), axis=-1) for one in (first_tangent, second_tangent)
        )
        a, b = found["a"].astype(np.intp), found["b"].astype(np.intp)
        of_pair = pairs[found["pair"]]
        soft = (_number(of_pair, "compliance") > 0.0) | (_number(of_pair, "hertz_stiffness") > 0.0)
        # Two that move and give way push on each other at one point, as in `engine.block`.
        moves = bodies["inv_m"] > 0.0
        at_one_point = self._springs & soft & moves[a] & moves[b]
        half = 0.5 * np.where(at_one_point, 0.0, found["phi"])[:, None] * normal
        places = _vectors(bodies[b], ""), _vectors(bodies[a], "")
        mu = np.maximum(_number(of_pair, "friction"), _number(of_pair, "static_friction"))
        return Contacts(
            a,
            b,
            found["feature"].copy(),
            np.stack([normal, *tangents], axis=1),
            point - half - _vectors(bodies[a], ""),
            point + half - nearest_images(*places, self._periodic),
            found["phi"].copy(),
            np.where(_number(of_pair, "friction") > 0.0, mu, 0.0),
            _number(of_pair, "restitution"),
            ~soft,
            self._belt(b) - self._belt(a),
        )

    def _belt(self, body: NDArray[np.intp]) -> Floats:
        rows = self.engine.bodies[body]
        if "sx" not in (rows.dtype.names or ()):
            return np.zeros((len(rows), 3))
        turned: Floats = np.einsum("nij,nj->ni", rotations_of(rows), _vectors(rows, "s"))
        return turned


def rotations_of(rows: np.ndarray) -> Floats:
    """Return the matrices of records of bodies, body to world."""
    q = np.stack([rows[f"q{axis}"] for axis in "wxyz"], axis=-1)
    return rotation_matrices(q)


def _vectors(rows: np.ndarray, name: str) -> Floats:
    if f"{name}x" not in (rows.dtype.names or ()):
        return np.zeros((len(rows), 3))
    return np.stack([rows[f"{name}{axis}"] for axis in "xyz"], axis=-1)


def _number(rows: np.ndarray, name: str) -> Floats:
    return rows[name].copy() if name in (rows.dtype.names or ()) else np.zeros(len(rows))
