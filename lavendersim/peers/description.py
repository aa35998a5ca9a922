"""A cell as adapters read it: bodies in order, one gravity, surfaces mixed by lavender's rule.

Engines mix the coefficients of two bodies by rules of their own (product, least, greatest). An
adapter asks for the values of bodies from which its engine's rule makes the mixed ones of lavender:
`values`, `by_first`. Where there are none the scene was refused when it was read (`limits`).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.cell.mixing import mixed
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.rotations import unit_quaternion
from lavendersim.peers.declaration import Peer
from lavendersim.peers.mixing import Unmixable, values_by
from lavendersim.peers.world import CannotRun, Floats
from lavendersim.quantities.scalars import exact


class PeerBody(NamedTuple):
    """One body at the start."""

    row: int  # in the scene
    name: str
    shape: Any  # of `lavendersim.cell`, in the frame of the principal axes
    surface: Any
    moves: bool
    mass: float  # [kg]; 0 where it does not move
    inertia: tuple[float, float, float]  # principal moments [kg m^2]
    position: tuple[float, float, float]  # centre of mass [m]; of a plane a point of it
    orientation: tuple[float, ...]  # unit quaternion w x y z, body to world
    velocity: tuple[float, float, float]  # [m/s]
    spin: tuple[float, float, float]  # world axes [rad/s]

    def pieces(self) -> list[tuple[Any, tuple[float, ...], tuple[float, ...]]]:
        """Return shape, position [m] and orientation of each part, in the body's frame."""
        parts = getattr(self.shape, "parts", None)
        if parts is None:
            return [(self.shape, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))]
        return [(one.shape, one.position, _unit(one.orientation)) for one in parts]


class Scene:
    """A resolved cell."""

    def __init__(self, config: CellConfig) -> None:
        self.bodies = [_body(k, *item) for k, item in enumerate(config.scene.bodies.items())]
        self.movable = [body for body in self.bodies if body.moves]
        self.gravity = config.scene.gravity
        self.timestep = float(config.numerics.timestep)
        self.steps = config.steps
        self._forces, self._clock = config.scene.forces, config.clock

    def pairs(self) -> Iterator[tuple[PeerBody, PeerBody]]:
        """Yield the pairs of bodies of which one moves."""
        return ((a, b) for a, b in combinations(self.bodies, 2) if a.moves or b.moves)

    @property
    def has_forces(self) -> bool:
        """Whether forces act on bodies in some steps."""
        return bool(self._forces)

    def frictional(self) -> bool:
        """Whether any pair has friction."""
        return any(value > 0.0 for value in self._of_pairs("friction").values())

    def of_pair(self, key: str, a: PeerBody, b: PeerBody) -> float:
        """Return a coefficient of a contact of two bodies."""
        return float(getattr(mixed(a.surface, b.surface), key))

    def values(self, key: str, peer: Peer) -> list[float]:
        """Return of each body a value such that the engine's own rule of mixing, which it declares,
        makes the coefficient of every contact; raises CannotRun.
        """
        surfaces = [(body.surface, body.moves) for body in self.bodies]
        found = values_by(peer.mixing, key, surfaces)
        if isinstance(found, Unmixable):
            raise CannotRun(f"its rule of mixing makes no such {key} of these surfaces")
        return found

    def by_first(self, keys: tuple[str, ...]) -> tuple[list[tuple[float, ...]], bool] | None:
        """Return values of each body such that a contact has those of the body that stays, or of
        either where both move; and whether the bodies that stay differ. None: there are none.
        """
        required = [self._of_pairs(key) for key in keys]
        among = {tuple(one[a, b] for one in required) for a, b in required[0] if self._both(a, b)}
        of_fixed: dict[int, set[tuple[float, ...]]] = {}
        for a, b in required[0]:
            if not self._both(a, b):
                fixed = b if self.bodies[a].moves else a
                of_fixed.setdefault(fixed, set()).add(tuple(one[a, b] for one in required))
        if len(among) > 1 or any(len(values) > 1 for values in of_fixed.values()):
            return None
        nothing = (0.0,) * len(keys)
        own = next(iter(among), nothing)
        values = [
            own if body.moves else next(iter(of_fixed.get(body.row, {nothing})))
            for body in self.bodies
        ]
        return values, len({*values}) > 1

    def loads(self, step: int) -> Floats | None:
        """Return force [N] and torque [N m] on each movable body in a step, from 1; None: none.

        They act from the first step on that starts at their time or later, as lavender has it.
        """
        found = None
        rows = {body.name: row for row, body in enumerate(self.movable)}
        for one in self._forces:
            first, last = (self._clock.steps_until(exact(at)) for at in (one.begin, one.end))
            if first < step <= last and one.body in rows:
                found = np.zeros((len(self.movable), 6)) if found is None else found
                found[rows[one.body]] += np.array((*one.force, *one.torque))
        return found

    def mixed(self, key: str) -> Floats:
        """Return a coefficient of the contacts of every two bodies (bodies, bodies)."""
        kinds = {id(body.surface): body.surface for body in self.bodies}
        table = np.array(
            [[getattr(mixed(a, b), key) for b in kinds.values()] for a in kinds.values()]
        )
        places = {one: place for place, one in enumerate(kinds)}
        of = [places[id(body.surface)] for body in self.bodies]
        found: Floats = table[np.ix_(of, of)].astype(np.float64)
        return found

    def _both(self, a: int, b: int) -> bool:
        return self.bodies[a].moves and self.bodies[b].moves

    def _of_pairs(self, key: str) -> dict[tuple[int, int], float]:
        return {(a.row, b.row): self.of_pair(key, a, b) for a, b in self.pairs()}


def _unit(orientation: Any) -> tuple[float, ...]:
    return tuple(float(one) for one in unit_quaternion(orientation))


def _body(row: int, name: str, body: Any) -> PeerBody:
    moves = is_movable(body)
    return PeerBody(
        row,
        name,
        body.shape,
        body.surface,
        moves,
        body.mass if moves else 0.0,
        body.inertia if moves else (0.0, 0.0, 0.0),
        body.position,
        _unit(body.orientation),
        body.velocity,
        body.angular_velocity,
    )
