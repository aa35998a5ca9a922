"""A cell as adapters read it: bodies in order, one gravity, surfaces mixed by lavender's rule.

Engines mix the coefficients of two bodies by rules of their own (product, least, greatest). An
adapter asks for the values of bodies from which its engine's rule makes the mixed ones of lavender:
`by_product`, `by_first`; where there are none it says so instead of taking others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations
from math import inf, sqrt
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.cell.mixing import mixed
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.rotations import unit_quaternion
from lavendersim.peers.world import CannotRun, Floats
from lavendersim.quantities.scalars import exact

SAME: Final = 1e-15  # relative, of a coefficient and what a rule makes: round-off


def _itself(required: float) -> float:
    return required


def harmonic_mean(a: float, b: float) -> float:
    """Return 2ab / (a + b); 0 of two zeros."""
    return 2.0 * a * b / (a + b) if a + b else 0.0


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

    def by_product(self, key: str) -> list[float]:
        """Return of each body a value such that the product of two is that of their contact."""
        return self._values(key, [sqrt, _itself], lambda a, b: a * b, (1.0, _itself))

    def by_least(self, key: str) -> list[float]:
        """Return of each body a value such that the lesser of two is that of their contact."""
        return self._values(key, [_itself], min, (inf, _itself))

    def by_larger(self, key: str) -> list[float]:
        """Return of each body a value such that the larger of two is that of their contact."""
        return self._values(key, [_itself], max, (0.0, _itself))

    def by_mean(self, key: str) -> list[float]:
        """Return of each body a value such that the mean of two is that of their contact."""
        return self._values(
            key, [_itself], lambda a, b: 0.5 * (a + b), (0.0, lambda required: 2.0 * required)
        )

    def by_harmonic_mean(self, key: str) -> list[float]:
        """Return of each body a value such that 2ab / (a + b) is that of their contact."""
        return self._values(
            key,
            [_itself],
            harmonic_mean,
            (1.0, lambda required: required / (2.0 - required) if required < 2.0 else inf),
        )

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

    def _values(
        self,
        key: str,
        inverses: list[Callable[[float], float]],
        rule: Callable[[float, float], float],
        left_to_fixed: tuple[float, Callable[[float], float]],
    ) -> list[float]:
        """Return values of bodies from which a rule makes those of pairs, or raise CannotRun.

        left_to_fixed: what bodies that move have, where those that stay decide, and what these.
        """
        required = self._of_pairs(key)
        tried = [
            [inverse(getattr(body.surface, key)) for body in self.bodies] for inverse in inverses
        ]
        tried += [
            [inverse(max(required.values(), default=0.0))] * len(self.bodies)
            for inverse in inverses
        ]
        # What moves leaves the choice to what stays, where moving bodies meet nothing else.
        of_fixed = {b if self.bodies[a].moves else a: value for (a, b), value in required.items()}
        moving, beside = left_to_fixed
        most = 2.0 * max([1.0, *required.values()])  # any that is larger than all
        tried.append(
            [
                min(moving, most) if body.moves else beside(of_fixed.get(body.row, 0.0))
                for body in self.bodies
            ]
        )
        for values in tried:
            made = ((rule(values[a], values[b]), value) for (a, b), value in required.items())
            if all(abs(one - value) <= SAME * value for one, value in made):
                return values
        raise CannotRun(f"its rule of mixing makes no such {key} of these surfaces")


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
