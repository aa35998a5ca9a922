"""What an adapter is: a class `World` that builds a scene in its engine, and steps it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lavendersim.peers.declaration import Value

Floats = NDArray[np.float64]


class CannotRun(Exception):  # noqa: N818 - it is a fact about an engine, not a fault
    """This engine cannot build this scene as described; the message says what is missing."""


class World(Protocol):
    """A scene in an engine, at its initial state when it is made; rows are of movable bodies."""

    def __init__(self, scene: Any, settings: Mapping[str, Value]) -> None:
        """Build a `description.Scene`; raises CannotRun."""

    def inertias(self) -> Floats:
        """Return mass [kg] and principal moments [kg m^2] as the engine has them (bodies, 4)."""

    def poses(self) -> Floats:
        """Return x y z [m] and qw qx qy qz (bodies, 7)."""

    def velocities(self) -> Floats:
        """Return vx vy vz [m/s] of the centre of mass, wx wy wz [rad/s], world axes (bodies, 6)."""

    def mixed(self) -> tuple[Floats, Floats]:
        """Return friction and restitution of contacts of every two bodies of the scene, by the
        engine's rule from what is read back of it, each (bodies, bodies); NaN where it has none.
        """

    def push(self, loads: Floats) -> None:
        """Have forces [N] and torques [N m], world axes, act in the next step (bodies, 6)."""

    def step(self) -> None:
        """Advance by one timestep; nothing else, this is what is timed."""

    def contacts(self) -> list[tuple[float, ...]]:
        """Return of each contact of the last step its two bodies (rows of the scene), A and B, then
        what the engine reports, in the order of `Peer.reported`; impulses on B [N s].
        """


class CountingWorld(World, Protocol):
    """That of an engine which counts its iterations: `Peer.counted`."""

    def iterations(self) -> int:
        """Return the iterations of the last step, 0 before the first."""


class BoundedWorld(World, Protocol):
    """That of an engine which has room for so many contacts and no more: `Peer.bounded`."""

    def is_full(self) -> bool:
        """Return whether contacts of the last step had no room."""
