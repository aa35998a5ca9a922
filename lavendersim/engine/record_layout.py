"""Layout of the engine's records: which columns each one has in an engine of a given `Spec`.

A record is its base fields (`records`), the fields of every effect that the engine has, in the
order of `EFFECTS`, and for contacts those of its solver. A field that several bring stands once.
Rows of the log are the columns that effects declare, those of the log itself first.
"""

from __future__ import annotations

from functools import cache
from typing import Literal

import numpy as np

from lavendersim.record_tables import with_room

from .collide.shapes import shapes_in
from .effects import EFFECTS, effects_of, row_fields
from .records import (
    BODY,
    CONTACT,
    DRIVE,
    I8,
    KNOT,
    LINK,
    ORIENTED_BODY,
    PAIR,
    PARAMETERS,
    TRIGGER,
    VELOCITY,
    Field,
    dtype,
)
from .spec import Spec

# Of contacts: what passes over all of them read, behind the base and before all else, those of one
# pass side by side. A record takes a dozen lines of the processor's cache, and a scene larger than
# the caches has them from memory in every pass.
READ_BY_ALL = (
    # what begins where the last step ended
    "matched",
    # sweeps, what prepares them, the residual
    *("mu", "t1x", "t1y", "t1z", "t2x", "t2y", "t2z", "rax", "ray", "raz", "rbx", "rby", "rbz"),
    *("k_n1", "k_n2", "i_11", "i_12", "i_22", "k_t", "lambda_1", "lambda_2"),
    # the projection
    *("correction", "push", "inv_k_n"),
    # what bodies do in the step
    *("lasts", "is_impact", "tau", "dv_n", "begin_n", "middle_n", "separation_speed"),
    # the order of impacts
    *("waits", "located", "rate", "due", "passed_on"),
)

Record = Literal["body", "velocity", "pair", "contact", "link", "drive", "cache"]


@cache
def body_dtype(spec: Spec) -> np.dtype:
    """Return the record of a body; orientation and hulls only where some shape has them."""
    shapes = shapes_in(spec)
    oriented = ORIENTED_BODY if any(shape.oriented for shape in shapes) else []
    of_shapes = [field for shape in shapes for field in shape.fields]
    return dtype(BODY, oriented, of_shapes, _of_effects(spec, "body"))


@cache
def velocity_dtype(spec: Spec) -> np.dtype:
    """Return the record of a body's velocity."""
    return dtype(VELOCITY, _of_effects(spec, "velocity"))


@cache
def pair_dtype(spec: Spec) -> np.dtype:
    """Return the record of a pair of bodies that may touch, with its mixed surface."""
    return dtype(PAIR, _of_effects(spec, "pair"))


def template_dtype(surface: list[Field]) -> np.dtype:
    """Return the record of `templates`: what pairs of two classes of bodies have in common.

    templates[c, d], c and d `material` of the first and second row of a pair: `kind` of its
    manifold, negative for classes that never touch, `swap` 1 where the kernel of that manifold
    takes the second first, and the surface fields that go into the pair's row.
    """
    kind = [field for field in PAIR if field[0] == "kind"]
    return dtype([*kind, ("swap", I8)], surface)


@cache
def contact_dtype(spec: Spec) -> np.dtype:
    """Return the record of a contact: geometry, what effects add, what the solver keeps of it."""
    dependent = [
        field
        for effect in effects_of(spec)
        if effect.fields.contact_with
        for field in effect.fields.contact_with(spec)
    ]
    from .solvers.catalogue import SOLVERS  # late: numba

    solver = SOLVERS[spec.solver].contact_fields
    added = [*_of_effects(spec, "contact"), *dependent, *solver]
    read = {name: place for place, name in enumerate(READ_BY_ALL)}
    return dtype(CONTACT, sorted(added, key=lambda field: read.get(field[0], len(read))))


@cache
def cache_dtype(spec: Spec) -> np.dtype:
    """Return the record of a contact's impulse that the next step may start from."""
    return dtype([("key", "i8")], _of_effects(spec, "cache"))


@cache
def step_row_dtype(spec: Spec) -> np.dtype:
    """Return the row that the log has of a step, with room for its time."""
    return with_room(dtype(row_fields(spec, "step")))


@cache
def contact_row_dtype(spec: Spec) -> np.dtype:
    """Return the row that the log has of a contact, with room for its time."""
    return with_room(dtype(row_fields(spec, "contact")))


@cache
def residual_row_dtype() -> np.dtype:
    """Return the row that the log has of a sweep."""
    return dtype(row_fields(Spec(), "residual"))


@cache
def link_dtype(spec: Spec) -> np.dtype:
    """Return the record of what joins two bodies."""
    return dtype(LINK, _of_effects(spec, "link"))


@cache
def drive_dtype(spec: Spec) -> np.dtype:
    """Return the record of a function of time that acts on a body."""
    return dtype(DRIVE, _of_effects(spec, "drive"))


@cache
def parameters_dtype() -> np.dtype:
    """Return the record of the parameters: the same in every engine."""
    return dtype(PARAMETERS, [field for effect in EFFECTS for field in effect.fields.parameters])


def _of_effects(spec: Spec, record: Record) -> list[Field]:
    """Return the fields that the effects of `spec` bring to one record, in order."""
    return [field for effect in effects_of(spec) for field in getattr(effect.fields, record)]


def allocate_bodies(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed body records with the columns that `spec` has."""
    return np.zeros(count, body_dtype(spec))


def allocate_velocities(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed velocity records."""
    return np.zeros(count, velocity_dtype(spec))


def allocate_pairs(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed pair records."""
    return np.zeros(count, pair_dtype(spec))


def allocate_links(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed records of what joins two bodies."""
    return np.zeros(count, link_dtype(spec))


def allocate_drives(spec: Spec, count: int) -> np.ndarray:
    """Return zeroed records of functions of time that act on bodies."""
    return np.zeros(count, drive_dtype(spec))


def allocate_triggers(count: int) -> np.ndarray:
    """Return zeroed records of states that make events happen."""
    return np.zeros(count, dtype(TRIGGER))


def allocate_knots(count: int) -> np.ndarray:
    """Return zeroed records of their knots."""
    return np.zeros(count, dtype(KNOT))


def allocate_parameters() -> np.ndarray:
    """Return one zeroed parameter record, shape (1,): the same in every engine."""
    return np.zeros(1, parameters_dtype())
