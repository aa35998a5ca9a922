"""Facts of small scenes, and single rows with the fields that a kernel asks for."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from interpreted import Row, records

from lavendersim.engine.effects.decision import BodyFacts, Facts, PairFacts

SURFACE = {
    **dict.fromkeys(("friction", "restitution", "compliance"), 0.0),
    **dict.fromkeys(("torsional_friction", "rolling_friction", "tangential_restitution"), 0.0),
    **dict.fromkeys(("hertz_stiffness", "tangential_stiffness"), 0.0),
    "tangential_damping_ratio": 0.0,
}


def surface(**properties: float) -> SimpleNamespace:
    return SimpleNamespace(**{**SURFACE, **properties})


def body_facts(name: str, shape: str = "box", **properties: Any) -> BodyFacts:
    known = {"movable": True, "spins": False, "round": False, **properties}
    return BodyFacts(name, shape, **known)


def pair_facts(a: str, b: str, **properties: float) -> PairFacts:
    return PairFacts(a, b, surface(**properties))


def facts(*bodies: BodyFacts, pairs: tuple[PairFacts, ...] = (), **properties: Any) -> Facts:
    known: dict[str, Any] = {
        **{"gravity": (0.0, 0.0, 0.0), "stabilisation_gain": 0.0, "projection": 0.0},
        **{"warm_start": False},
        **properties,
    }
    return Facts(bodies, pairs, **known)


def one_row(**fields: Any) -> Row:
    """Return a row with these fields."""
    rows = np.zeros(1, [(name, "i8" if isinstance(v, int) else "f8") for name, v in fields.items()])
    for name, value in fields.items():
        rows[name] = value
    return records(rows)[0]


def vector_fields(prefix: str, vector: Any) -> dict[str, float]:
    """Return the fields x, y, z behind a prefix."""
    return {f"{prefix}{axis}": float(v) for axis, v in zip("xyz", vector, strict=True)}


def matrix_fields(matrix: np.ndarray) -> dict[str, float]:
    """Return the fields r00 to r22 of a rotation."""
    return {f"r{i}{j}": float(matrix[i, j]) for i in range(3) for j in range(3)}
