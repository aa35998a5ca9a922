"""The structure of an engine: which effects, shape pairs and solver it is composed of.

A `Spec` holds structure only. Coefficients (masses, gains, timesteps) stay run-time values, so a
sweep over any of them uses one compiled engine.
"""

from __future__ import annotations

import hashlib
from functools import lru_cache
from typing import NamedTuple


class Spec(NamedTuple):
    """Which code an engine is composed of.

    effects: names from `engine.effects.EFFECTS`, sorted.
    shape_pairs: names from `engine.collide.SHAPE_PAIRS`, sorted.
    solver: name from `engine.solvers.SOLVER_NAMES`.
    tolerance: whether sweeping stops at a residual.
    friction_cone: disc; for study pyramid (|lambda_1|, |lambda_2| <= mu lambda_n) or convex (no
        De Saxce's shift: what slides is lifted).
    operator: what impulses act on: bodies, or the matrix of a problem by itself (`coupling`).
    over_relaxation: whether sweeps scale their changes, by a factor other than 1.
    order: in which sweeps visit contacts, see `ordering`.
    """

    effects: tuple[str, ...] = ()
    shape_pairs: tuple[str, ...] = ()
    solver: str = "projected_gauss_seidel"
    tolerance: bool = False
    friction_cone: str = "disc"
    operator: str = "bodies"
    over_relaxation: bool = False
    order: str = "coloured"

    def has(self, effect: str) -> bool:
        """Whether `effect` is part of this engine."""
        return effect in self.effects

    def including(self, *effects: str) -> Spec:
        """Return this structure with more effects."""
        return self._replace(effects=tuple(sorted({*self.effects, *effects})))

    def without(self, *effects: str) -> Spec:
        """Return this structure with fewer effects."""
        return self._replace(effects=tuple(e for e in self.effects if e not in effects))

    @property
    def touches(self) -> bool:
        """Whether steps may have contacts: a taut rope is one, and a joint has rows of theirs."""
        return bool(self.shape_pairs) or self.connects

    @property
    def connects(self) -> bool:
        """Whether there are connections with rows of their own: ropes, joints."""
        return self.has("rope") or self.has("joint")

    def collides(self, pair: str) -> bool:
        """Whether the manifold of `pair` is part of this engine."""
        return pair in self.shape_pairs

    def digest(self) -> str:
        """Eight hex digits that tell this structure from every other."""
        return _digest(self)


@lru_cache(maxsize=256)  # each log says it
def _digest(spec: Spec) -> str:
    return hashlib.sha256(repr(spec).encode()).hexdigest()[:8]
