"""Errors of an engine's motion in a scene, each by a formula on poses.

Positions and orientations decide; velocities are used where the law is about them (impacts, free
rotation). No contact, force or depth that an engine reports is used.
"""

from __future__ import annotations

from math import cos, hypot, sin
from typing import NamedTuple

import numpy as np

from .description import Body, Box, Plane, Scene, Sphere
from .geometry import deepest, matrices
from .jacobi import body_rates

SETTLED = 0.5  # drift is counted from the pose at this time [s]
WINDOW = 1.0  # overlap is looked for in the last second [s]


class Track(NamedTuple):
    """What is known of a run: states at the end of some steps."""

    scene: Scene
    steps: np.ndarray  # (k,) step numbers, ascending; 0 is the start
    poses: np.ndarray  # (k, movable, 7)
    velocities: np.ndarray  # (k, movable, 6), world frame

    @property
    def times(self) -> np.ndarray:
        """Time of every state [s]."""
        return self.steps * float(self.scene.timestep)

    def at(self, time: float) -> int:
        """Return the index of the state nearest to `time` [s]."""
        return int(np.argmin(np.abs(self.times - time)))


def drift(track: Track) -> float:
    """Greatest distance of any centre from where it was at 0.5 s [m]."""
    first = track.at(SETTLED)
    centres = track.poses[first:, :, :3]
    return float(np.linalg.norm(centres - centres[0], axis=2).max())


def overlap(track: Track) -> float:
    """Deepest penetration in the last second [m]."""
    inside = track.times >= track.times[-1] - WINDOW - 1e-9
    return max(deepest(track.scene, poses) for poses in track.poses[inside])


def stands(track: Track) -> bool:
    """Whether no centre has left its place at the start by half the least edge of the bodies."""
    movable = track.scene.movable
    edge = min(min(body.shape.size) for body in movable if isinstance(body.shape, Box))
    start = np.array([body.position for body in movable])
    moved = np.linalg.norm(track.poses[:, :, :3] - start, axis=2).max()
    return bool(moved < 0.5 * edge)


def vertex(before: float, top: float, after: float) -> float:
    """Return the greatest value of the parabola through three equidistant values, top in between.

    Free flight at a fixed step is a parabola in every one of these integrators.
    """
    bend = before - 2.0 * top + after
    return top - (after - before) ** 2 / (8.0 * bend) if bend < 0.0 else top


def apexes(track: Track) -> np.ndarray:
    """Return the clearances [m] of the first body's apexes above the plane z = 0, after t = 0."""
    shape = track.scene.movable[0].shape
    assert isinstance(shape, Sphere)
    height = track.poses[:, 0, 2] - shape.radius
    rises = (height[1:-1] > height[:-2]) & (height[1:-1] >= height[2:])
    found = [vertex(*height[k : k + 3]) for k in np.nonzero(rises)[0]]
    return np.array(found)


def apex_error(track: Track) -> float:
    """First apex against e^2 h, relative; infinite where there is none."""
    ball = track.scene.movable[0]
    assert isinstance(ball.shape, Sphere)
    ideal = track.scene.restitution**2 * (ball.position[2] - ball.shape.radius)
    found = apexes(track)
    return abs(float(found[0]) / ideal - 1.0) if len(found) else float("inf")


def bounce_drift(track: Track, count: int) -> float:
    """Greatest |m g apex - m g h| / (m g h) over the apexes of `count` bounces."""
    ball = track.scene.movable[0]
    assert isinstance(ball.shape, Sphere)
    height = ball.position[2] - ball.shape.radius
    found = apexes(track)
    # An engine that gains height needs longer for a bounce: the last apex may not be reached.
    if len(found) < 0.95 * count:
        return float("inf")
    return float(np.abs(found[:count] / height - 1.0).max())


def along_slope(track: Track) -> np.ndarray:
    """Return the way down the slope [m] of the first body, for every state."""
    lean = np.array(track.scene.gravity)
    lean[2] = 0.0
    found: np.ndarray = track.poses[:, 0, :3] @ (lean / np.linalg.norm(lean))
    return found


def creep(track: Track) -> float:
    """Speed of a box that should stick, from 0.5 s to the end [m/s]."""
    first = track.at(SETTLED)
    place = track.poses[:, 0, :3]
    return float(np.linalg.norm(place[-1] - place[first]) / (track.times[-1] - track.times[first]))


def effective_friction(track: Track) -> float:
    """Friction that explains the acceleration down the slope, by second differences of the way."""
    gx, gy, gz = track.scene.gravity
    last, first = len(track.times) - 1, track.at(SETTLED)
    middle = track.at(0.5 * (track.times[first] + track.times[last]))
    t = track.times[[first, middle, last]]
    s = along_slope(track)[[first, middle, last]]
    speeds = np.diff(s) / np.diff(t)
    acceleration = float(np.diff(speeds)[0]) / (0.5 * (t[2] - t[0]))
    return float((hypot(gx, gy) - acceleration) / -gz)


def tunnelled(track: Track) -> bool:
    """Whether the first body was ever beyond the middle of the wall at x = 0."""
    return bool((track.poses[:, 0, 0] > 0.0).any())


class Rotation(NamedTuple):
    """How free rotation departs from the exact one."""

    energy: float  # greatest relative change
    momentum: float  # greatest |L - L0| / |L0|, as a vector in the world
    rates: float  # greatest |omega - exact| / |omega0|, in the body's frame


def free_rotation(track: Track) -> Rotation:
    """Energy, angular momentum and angular velocity over a torque-free run."""
    (body,) = track.scene.movable
    moments = np.array(body.inertia)
    turns = matrices(track.poses[:, 0, 3:])
    rates = np.einsum("kij,ki->kj", turns, track.velocities[:, 0, 3:])
    energy = 0.5 * (moments * rates**2).sum(axis=1)
    momentum = np.einsum("kij,kj->ki", turns, moments * rates)
    exact = body_rates(moments, np.array(body.angular_velocity), track.times)
    return Rotation(
        float(np.abs(energy / energy[0] - 1.0).max()),
        float(np.linalg.norm(momentum - momentum[0], axis=1).max() / np.linalg.norm(momentum[0])),
        float(np.linalg.norm(rates - exact, axis=1).max() / np.linalg.norm(rates[0])),
    )


def after_oblique_impact(scene: Scene) -> np.ndarray:
    """Return vx vy vz wx wy wz of a sphere after it has hit the floor z = 0, shape (6,).

    Newton's law and Coulomb's cone: the normal impulse is (1 + e) m |v_z|; the tangential one
    stops the slip of the contact point (2/7 m |slip|) or is mu times the normal one.
    """
    ball: Body = scene.movable[0]
    assert isinstance(ball.shape, Sphere)
    assert ball.mass is not None
    v, w = np.array(ball.velocity), np.array(ball.angular_velocity)
    arm = np.array([0.0, 0.0, -ball.shape.radius])
    slip = v + np.cross(w, arm)
    slip[2] = 0.0
    normal = -(1.0 + scene.restitution) * ball.mass * v[2]
    impulse = np.array([0.0, 0.0, normal])
    size = float(np.linalg.norm(slip))
    if size > 0.0:
        stopping = 2.0 / 7.0 * ball.mass * size
        impulse -= slip / size * min(stopping, scene.friction * normal)
    return np.concatenate([v + impulse / ball.mass, w + np.cross(arm, impulse) / ball.inertia])


def after_end_impact(scene: Scene, lean: float) -> np.ndarray:
    """Return the velocity of a rod after its lower edge hit the floor without friction, (6,)."""
    rod = scene.movable[0]
    assert isinstance(rod.shape, Box)
    assert rod.mass is not None
    length, _, height = rod.shape.size
    # The lowest edge seen from the centre, for a rod turned by `lean` about y: its +x end is down.
    arm_x = 0.5 * (length * cos(lean) - height * sin(lean))
    moment = rod.inertia[1]
    speed = -rod.velocity[2]
    impulse = (1.0 + scene.restitution) * speed / (1.0 / rod.mass + arm_x**2 / moment)
    found = np.zeros(6)
    found[:3] = rod.velocity
    found[2] += impulse / rod.mass
    found[4] = -arm_x * impulse / moment  # y part of (arm_x, 0, z) x (0, 0, impulse)
    return found


def velocity_error(track: Track, exact: np.ndarray) -> float:
    """Greatest difference of the last velocities from the exact ones; spins times size [m/s]."""
    shape = track.scene.movable[0].shape
    assert not isinstance(shape, Plane)
    size = shape.radius if isinstance(shape, Sphere) else 0.5 * max(shape.size)
    apart = np.abs(track.velocities[-1, 0] - exact)
    return float(max(apart[:3].max(), size * apart[3:].max()))


def kinetic_gain(track: Track) -> float:
    """Kinetic energy at the end over that at the start, less one; positive is a gain."""
    body = track.scene.movable[0]
    assert body.mass is not None

    def energy(k: int) -> float:
        turn = matrices(track.poses[k : k + 1, 0, 3:])[0]
        v, w = track.velocities[k, 0, :3], turn.T @ track.velocities[k, 0, 3:]
        return 0.5 * float(body.mass * v @ v + (np.array(body.inertia) * w) @ w)

    return energy(len(track.steps) - 1) / energy(0) - 1.0
