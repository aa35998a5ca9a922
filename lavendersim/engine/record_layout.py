"""Layout of the engine's records: which columns each one has in an engine of a given `Spec`.

A record is its base fields (`records`), the fields of every effect that the engine has, in the
order of `EFFECTS`, and for contacts those of its solver. A field that several bring stands once.
"""

from __future__ import annotations

import numpy as np

from .collide.convex.support import shapes_in
from .effects import EFFECTS, contact_log, residual_log, step_log
from .records import (
    BODY,
    CONTACT,
    HULL_BODY,
    ORIENTED_BODY,
    PAIR,
    PARAMETERS,
    VELOCITY,
    Field,
    dtype,
)
from .solvers import SOLVERS
from .spec import Spec


def body_dtype(spec: Spec) -> np.dtype:
    """Return the record of a body; orientation and hulls only where some shape has them."""
    shapes = shapes_in(spec)
    oriented = not shapes <= {"plane", "sphere"}
    base = [*BODY, *(ORIENTED_BODY if oriented else []), *(HULL_BODY if "hull" in shapes else [])]
    return _with_effects(base, spec, "BODY_FIELDS")


def velocity_dtype(spec: Spec) -> np.dtype:
    """Return the record of a body's velocity."""
    return _with_effects(VELOCITY, spec, "VELOCITY_FIELDS")


def pair_dtype(spec: Spec) -> np.dtype:
    """Return the record of a pair of bodies that may touch, with its mixed surface."""
    return _with_effects(PAIR, spec, "PAIR_FIELDS")


def contact_dtype(spec: Spec) -> np.dtype:
    """Return the record of a contact: geometry, what effects add, what the solver keeps of it."""
    dependent = [
        field
        for effect in EFFECTS
        if spec.has(effect.NAME) and hasattr(effect, "contact_fields")
        for field in effect.contact_fields(spec)
    ]
    solver = getattr(SOLVERS[spec.solver], "CONTACT_FIELDS", [])
    return dtype(CONTACT, _of_effects(spec, "CONTACT_FIELDS"), dependent, solver)


def cache_dtype(spec: Spec) -> np.dtype:
    """Return the record of a contact's impulse that the next step may start from."""
    return _with_effects([("key", "i8")], spec, "CACHE_FIELDS")


def step_row_dtype(spec: Spec) -> np.dtype:
    """Return the row that the log has of a step."""
    not_converged = step_log.UNSOLVED_ROW if spec.tolerance else []
    fields = _of_effects(spec, "STEP_ROW_FIELDS")
    return dtype(step_log.STEP_ROW_FIELDS, fields, not_converged)


def contact_row_dtype(spec: Spec) -> np.dtype:
    """Return the row that the log has of a contact."""
    return _with_effects(contact_log.CONTACT_ROW_FIELDS, spec, "CONTACT_ROW_FIELDS")


def residual_row_dtype() -> np.dtype:
    """Return the row that the log has of a sweep."""
    return dtype(residual_log.RESIDUAL_ROW_FIELDS)


def _of_effects(spec: Spec, group: str) -> list[Field]:
    """Return the fields that the effects of `spec` bring to one record, in order."""
    return [
        field for effect in EFFECTS if spec.has(effect.NAME) for field in getattr(effect, group, [])
    ]


def _with_effects(base: list[Field], spec: Spec, group: str) -> np.dtype:
    return dtype(base, _of_effects(spec, group))


def allocate_bodies(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed body records with the columns that `spec` has."""
    return np.zeros(count, body_dtype(spec))


def allocate_velocities(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed velocity records."""
    return np.zeros(count, velocity_dtype(spec))


def allocate_pairs(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed pair records."""
    return np.zeros(count, pair_dtype(spec))


def allocate_parameters() -> np.ndarray:
    """Return one zeroed parameter record, shape (1,)."""
    return np.zeros(1, dtype(PARAMETERS))
