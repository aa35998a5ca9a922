"""The change of momentum in a step that forces do not explain: what contacts have to.

    p - p' - (m g + F) dt,   L - L' - T dt          L = I omega about the own centre, world axes
with the momenta before and after: so a body that turns freely has none, whichever way its engine
integrates the gyroscopic term, and one whose engine leaves that out has changed its angular
momentum without a cause. Coordinates are scaled by the inertia of each body half way,
    s = (p / sqrt(m), A^T L),   A A^T = I^-1,     |s|^2 / 2 the kinetic energy [J],
of bodies that impulses move, six numbers each.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.geometry.rotations import rotation_matrices

from .contacts import ContactSearch
from .motion import Floats


class BodyStates(NamedTuple):
    """Bodies before or after a step."""

    pose: Floats  # (bodies, 7)
    velocity: Floats  # (bodies, 6)


class StepMomentum(NamedTuple):
    """The momenta of a step; k bodies that impulses move, by their rows in the log."""

    movable: np.ndarray  # (k,) rows
    place: np.ndarray  # (bodies,) which of the k a body is; -1: none
    root: Floats  # (k, 3, 3) A of each [1/(kg^(1/2) m)]
    mass: Floats  # (k,) [kg]
    before: Floats  # (k, 6) p' [N s], L' [N m s]
    free: Floats  # (k, 6) with what forces add
    after: Floats  # (k, 6)

    @property
    def unexplained(self) -> Floats:
        """Scaled change that forces do not explain (6 k,) [J^(1/2)]."""
        return self.scaled(self.after - self.free).ravel()

    @property
    def at_play(self) -> Floats:
        """Scaled momentum of each body, before, after and given, (k,) [J^(1/2)]."""
        parts = (self.before, self.after, self.after - self.free)
        sizes = [np.linalg.norm(self.scaled(one), axis=1) for one in parts]
        at_play: Floats = np.sum(sizes, axis=0)
        return at_play

    def scaled(self, momenta: Floats) -> Floats:
        """Return momenta (k, 6) in scaled coordinates."""
        linear = momenta[:, :3] / np.sqrt(self.mass)[:, None]
        return np.hstack([linear, np.einsum("kij,ki->kj", self.root, momenta[:, 3:])])


def momentum_of(
    search: ContactSearch, before: BodyStates, after: BodyStates, dt: float
) -> StepMomentum:
    """Return the momenta of a step of dt [s]; the search stands where events have put it."""
    mass = search.masses
    movable = np.flatnonzero(mass > 0.0)
    mass, moments = mass[movable], search.moments[movable]
    start, end = (one.pose[movable, 3:] for one in (before, after))
    root = rotation_matrices(half_way(start, end)) / np.sqrt(moments)[:, None, :]
    first, last = (
        _momenta(mass, moments, one.pose[movable], one.velocity[movable]) for one in (before, after)
    )
    force, torque = (one[movable] for one in search.forces())
    given = np.hstack([force + mass[:, None] * search.gravity, torque]) * dt
    place = np.full(len(before.pose), -1)
    place[movable] = np.arange(len(movable))
    return StepMomentum(movable, place, root, mass, first, first + given, last)


def half_way(start: Floats, end: Floats) -> Floats:
    """Return the quaternions (n, 4) half way between two of each, the shorter way round."""
    same = np.where((start * end).sum(axis=1) < 0.0, -1.0, 1.0)
    middle = start + same[:, None] * end
    unit: Floats = middle / np.linalg.norm(middle, axis=1)[:, None]
    return unit


def inertias(moments: Floats, quaternions: Floats) -> Floats:
    """Return inertias in world axes (n, 3, 3)."""
    turn = rotation_matrices(quaternions)
    inertia: Floats = np.einsum("nij,nj,nkj->nik", turn, moments, turn)
    return inertia


def _momenta(mass: Floats, moments: Floats, pose: Floats, velocity: Floats) -> Floats:
    spin = np.einsum("nij,nj->ni", inertias(moments, pose[:, 3:]), velocity[:, 3:])
    return np.hstack([mass[:, None] * velocity[:, :3], spin])
