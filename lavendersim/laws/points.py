"""The points that may push within a step, in one pose of it, with the velocities of surfaces there.

Spins are those that the momenta have with the inertia of the pose: what an engine of impulses at
the start of its step solves for, before the body turns on.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .contacts import Contacts, ContactSearch
from .momentum import BodyStates, StepMomentum, half_way, inertias
from .motion import Floats

TOUCHING = 1e-9  # [m] surfaces that are nearer touch


class PointsOfPose(NamedTuple):
    """n contacts of a pose; velocities (n, 3) are of B relative to A in the frame (n, t1, t2)."""

    contacts: Contacts
    rows: Floats  # (n, 2, 3, 6) what a unit of impulse gives to A and to B, scaled; 0: not movable
    approach: Floats  # (n,) [m/s] the most that the surfaces can have approached with
    before: Floats  # [m/s] as the step begins
    free: Floats  # [m/s] with what forces add
    after: Floats  # [m/s]
    meets: NDArray[np.bool_]  # (n,) whether the surfaces touch at some time of the step

    @property
    def names(self) -> NDArray[np.int64]:
        """Which bodies and features each contact is of (n, 3): the same in poses of one step."""
        own = self.contacts
        names: NDArray[np.int64] = np.column_stack([own.a, own.b, own.feature])
        return names

    @property
    def softness(self) -> Floats:
        """k_n of each contact (n,) [1/kg]; 0 where no impulse moves anything."""
        softness: Floats = (self.rows[:, :, 0] ** 2).sum(axis=(1, 2))
        return softness


def points_at(
    search: ContactSearch,
    share: float,
    states: tuple[BodyStates, BodyStates],
    momentum: StepMomentum,
    dt: float,
    *,
    pose: Floats | None = None,
) -> PointsOfPose:
    """Return the points at a share of a step of dt [s] between two states, or in a pose beside it.

    Surfaces meet where they touch in this pose, come to it by the velocity after the step, or
    leave it for each other by that before.
    """
    before, after = states
    pose = pose_at(share, before.pose, after.pose) if pose is None else pose
    speeds = np.maximum(*(_speeds(one.velocity) for one in states))
    speeds[momentum.movable, 0] += dt * _accelerations(momentum, dt)
    contacts = search.at(pose, speeds, dt)
    free = before.velocity.copy()
    ends = [before.velocity.copy(), free, after.velocity.copy()]
    of_momenta = _velocities(search, pose, momentum)
    for velocity, one in zip(ends, of_momenta, strict=True):
        velocity[momentum.movable] = one
    first, pushed, last = (relative_velocities(contacts, one) for one in ends)
    slop = search.slop + TOUCHING
    of_a, of_b = np.array([_normal_velocities(contacts, one) for one in ends]).transpose(1, 0, 2)
    # Contacts with others may have given either body its velocity after the step before they met.
    approach = np.maximum(of_a.max(axis=0) - of_b.min(axis=0), 0.0)
    opening = np.maximum(last[:, 0], 0.0)
    meets = contacts.gap - dt * np.maximum((1.0 - share) * approach, share * opening) <= slop
    return PointsOfPose(contacts, _rows(contacts, momentum), approach, first, pushed, last, meets)


def together(looks: Sequence[PointsOfPose]) -> list[PointsOfPose]:
    """Return the points of some poses of a step, a contact that meets in one of them in all."""
    met: set[tuple[int, ...]] = set()
    for one in looks:
        met.update(map(tuple, one.names[one.meets].tolist()))
    found = []
    for one in looks:
        meets = [tuple(name) in met for name in one.names.tolist()]
        found.append(one._replace(meets=np.array(meets, bool)))
    return found


def pose_at(share: float, before: Floats, after: Floats) -> Floats:
    """Return the poses (bodies, 7) at 0, a half or 1 of a step."""
    if share in (0.0, 1.0):
        return after if share else before
    if share != 0.5:
        raise ValueError("a pose within a step is half way")
    middle = 0.5 * (before + after)
    middle[:, 3:] = half_way(before[:, 3:], after[:, 3:])
    return middle


def relative_velocities(contacts: Contacts, velocity: Floats) -> Floats:
    """Return the velocities of B's points relative to A's, belts included (n, 3)."""
    of_a, of_b = velocity[contacts.a], velocity[contacts.b]
    slip = of_b[:, :3] + np.cross(of_b[:, 3:], contacts.lever_b)
    slip -= of_a[:, :3] + np.cross(of_a[:, 3:], contacts.lever_a)
    relative: Floats = np.einsum("nij,nj->ni", contacts.frame, slip)
    relative[:, 1:] += np.einsum("nij,nj->ni", contacts.frame[:, 1:], contacts.belt)
    return relative


def _normal_velocities(contacts: Contacts, velocity: Floats) -> tuple[Floats, Floats]:
    """Return the velocities of A's and of B's points along the normal (n,)."""
    sides = ((contacts.a, contacts.lever_a), (contacts.b, contacts.lever_b))
    normal = contacts.frame[:, 0]
    of_a, of_b = (
        (normal * (velocity[body, :3] + np.cross(velocity[body, 3:], lever))).sum(axis=1)
        for body, lever in sides
    )
    return of_a, of_b


def _speeds(velocity: Floats) -> Floats:
    speeds: Floats = np.linalg.norm(velocity.reshape(-1, 2, 3), axis=2)
    return speeds


def _accelerations(momentum: StepMomentum, dt: float) -> Floats:
    given: Floats = np.linalg.norm((momentum.free - momentum.before)[:, :3], axis=1)
    accelerations: Floats = given / (momentum.mass * dt)
    return accelerations


def _velocities(search: ContactSearch, pose: Floats, momentum: StepMomentum) -> list[Floats]:
    """Return velocities and spins (k, 6) of the momenta before, free and after, in a pose."""
    moments = search.moments[momentum.movable]
    inverse = inertias(1.0 / moments, pose[momentum.movable, 3:])
    found = []
    for one in (momentum.before, momentum.free, momentum.after):
        spin = np.einsum("kij,kj->ki", inverse, one[:, 3:])
        found.append(np.hstack([one[:, :3] / momentum.mass[:, None], spin]))
    return found


def _rows(contacts: Contacts, momentum: StepMomentum) -> Floats:
    rows = np.zeros((len(contacts.gap), 2, 3, 6))
    place = momentum.place
    sides = ((contacts.a, contacts.lever_a, -1.0), (contacts.b, contacts.lever_b, 1.0))
    for side, (body, lever, sign) in enumerate(sides):
        moved = np.flatnonzero(place[body] >= 0)
        k = place[body[moved]]
        frame = contacts.frame[moved]
        turning = np.cross(lever[moved][:, None, :], frame)
        rows[moved, side, :, :3] = sign * frame / np.sqrt(momentum.mass[k])[:, None, None]
        rows[moved, side, :, 3:] = sign * np.einsum("nij,njl->nil", turning, momentum.root[k])
    return rows
