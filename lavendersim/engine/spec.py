"""Names of effects, shape pairs and a solver enter; `Spec`, the structure of an engine, leaves.

A `Spec` holds structure only. Coefficients (masses, gains, timesteps) stay run-time values, so a
sweep over any of them uses one compiled engine.
"""

from __future__ import annotations

import hashlib
from typing import NamedTuple


class Spec(NamedTuple):
    """Which code an engine is composed of.

    effects: names from `engine.effects.EFFECTS`, sorted.
    shape_pairs: names from `engine.collide.SHAPE_PAIRS`, sorted.
    solver: name from `engine.solvers.SOLVERS`.
    record: whether kernels write trace rows.
    record_residuals: whether the residual of every sweep is evaluated and may be written.
    tolerance: whether sweeping stops at a residual.
    friction_cone: disc, or pyramid (|lambda_1|, |lambda_2| <= mu lambda_n, for study).
    """

    effects: tuple[str, ...] = ()
    shape_pairs: tuple[str, ...] = ()
    solver: str = "projected_gauss_seidel"
    record: bool = True
    record_residuals: bool = False
    tolerance: bool = False
    friction_cone: str = "disc"

    def has(self, effect: str) -> bool:
        """Whether `effect` is part of this engine."""
        return effect in self.effects

    def collides(self, pair: str) -> bool:
        """Whether the manifold of `pair` is part of this engine."""
        return pair in self.shape_pairs

    def digest(self) -> str:
        """Eight hex digits that tell this structure from every other."""
        return hashlib.sha256(repr(self).encode()).hexdigest()[:8]
