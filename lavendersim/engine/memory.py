"""The engine's memory: every array that the kernel of a step reads or writes, by name.

    State       what lasts from step to step
    Workspace   what a step works in; of it only the broad phase's list lasts
    Log         rows of the trace, until the caller takes them

The records of the rows are in `records` and `record_layout`. What a spec has no use for is an array
of no rows, or (): it takes part in no kernel.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from .anderson import FixedPoint, allocate_fixed_point
from .collide.broad.broad_phase import allocate_broad_phase
from .collide.broad.images import most_images
from .collide.convex.hull_geometry import HullGeometry
from .collide.manifold.own_normals import has_own_normals
from .collide.mesh_tables import MeshTables
from .collide.scratch import Scratch, allocate_scratch
from .contact_lists import ContactLists, allocate_contact_lists
from .effects import has_hook
from .integrate import keeps_motion
from .midpoint_mixing import WORDS
from .ordering import Ordering, allocate_ordering
from .record_layout import (
    allocate_links,
    cache_dtype,
    contact_dtype,
    contact_row_dtype,
    residual_row_dtype,
    step_row_dtype,
)
from .records import COUNTERS, MOTION, OVERLOOKED, UNMADE, dtype
from .solvers.catalogue import SOLVERS
from .spec import Spec
from .step_doubling import allocate_control, with_capacity
from .step_terms import step_terms

_MOTION, _OVERLOOKED, _UNMADE = dtype(MOTION), dtype(OVERLOOKED), dtype(UNMADE)


class Drives(NamedTuple):
    """Functions of time that act on bodies."""

    records: np.ndarray  # (d,) which body, what of it, and the function but for its knots
    knots: np.ndarray  # (k,) time and value, those of each function side by side


class State(NamedTuple):
    """The scene, from step to step; n bodies and parts, p pairs, m contacts at most."""

    bodies: np.ndarray  # (n,) pose, mass, shape
    velocities: np.ndarray  # (n,) and what a sweep reads of a body beside them
    pairs: np.ndarray  # (p,) bodies that may touch, ascending in `key`
    contacts: np.ndarray  # (m,) rows in use: counters.contacts
    cache: np.ndarray  # (m,) impulses of the last step's contacts: counters.cached
    motion: np.ndarray  # (n,) MOTION: what a body did within the step
    pseudo: np.ndarray  # (n,) pseudo-velocities of the positional projection, as velocities
    links: np.ndarray  # what effects join two bodies by
    drives: Any  # functions of time that act on bodies: Drives, or ()
    triggers: Any  # states that make events happen: TRIGGER (t,), or ()
    control: Any  # of the length of substeps: `step_doubling.Control`, or ()


class Overlooked(NamedTuple):
    """Points ahead that a part of a step has no rows of (`overlooked_points`)."""

    points: np.ndarray  # (2 m,) OVERLOOKED; m contacts at most
    noted: np.ndarray  # (1,) int64, how many
    unmade: np.ndarray  # (1,) UNMADE: the part that waits for room in the log, or for rows


class Trial(NamedTuple):
    """Where two bodies are looked at elsewhere (`impact_location`): rows of theirs meanwhile."""

    bodies: np.ndarray  # (4,) two bodies, and the parts of them that collide
    velocities: np.ndarray  # (2,)
    contact: np.ndarray  # (1,)


# Rounds that are looked back at where springs and contacts act on each other.
SPRING_ROUNDS = 16


class Middle(NamedTuple):
    """What a step keeps while its contacts are looked at in its middle (`midpoint_passes`)."""

    poses: np.ndarray  # (n,) rows of the bodies at its start
    free: np.ndarray  # (n,) velocities that forces alone lead to
    lead: np.ndarray  # (n,) velocities before forces and impulses, spins those at the middle
    rounds: FixedPoint  # (6 n,) velocities by which bodies stand there, `midpoint_mixing`


class SpringTrial(NamedTuple):
    """What springs and contacts that act on each other are tried with (`spring_contacts`)."""

    rounds: FixedPoint  # (9 l,) impulses of l springs: those in use, and what they are off by
    lost: np.ndarray  # (1,) energy that what they act on lost in this part [J]
    passes: np.ndarray  # (1,) whether contacts are looked for at the middle
    impacts: np.ndarray  # (1,) whether those without order happen at their times
    midway: np.ndarray  # (1,) whether bodies stand there, before springs act beside contacts
    before: np.ndarray  # (2,) midpoint_ and gyroscopic_not_converged before contacts were solved
    bodies: np.ndarray  # (n,) where the step leads to
    velocities: np.ndarray  # (n,)


class Workspace(NamedTuple):
    """What a step works in."""

    collision: Scratch
    trial: Trial
    middle: Middle
    beside: SpringTrial
    ordering: Ordering
    contact_lists: ContactLists  # of each body, `flush_contacts`
    overlooked: Overlooked
    islands: np.ndarray  # (n,) int64 label of a body's island, `islands`
    solver: Any  # what the solver allocates
    free_velocities: np.ndarray  # (n,) as velocities: before any contact impulse, `problem_log`
    templates: Any  # (classes, classes) what pairs of two classes of bodies have in common
    broad_phase: Any


class Log(NamedTuple):
    """Rows of the trace; counters say how many are in use."""

    step: np.ndarray  # (steps,)
    pose: np.ndarray  # (steps, n, 7) x y z qw qx qy qz; (steps, n, 13) with `velocity_log`
    contact: np.ndarray  # (rows,)
    residual: np.ndarray  # (rows,) of sweeps
    pose_bits: np.ndarray  # `pose` as uint64, for the hash of the state
    velocity_bits: np.ndarray  # (n, words) State.velocities as uint64


def arrays_of(memory: Any) -> list[np.ndarray]:
    """Return every array in nested tuples, in their order."""
    found: list[np.ndarray] = []
    _collect(memory, found)
    return found


def _collect(memory: Any, found: list[np.ndarray]) -> None:
    # A list that grows: of nested generators an array passes through as many as it lies deep.
    for part in memory if isinstance(memory, tuple) else (memory,):
        if isinstance(part, np.ndarray):
            found.append(part)
        elif isinstance(part, tuple):
            _collect(part, found)


def allocate_state(
    spec: Spec,
    bodies: np.ndarray,
    velocities: np.ndarray,
    pairs: np.ndarray,
    links: np.ndarray | None,
    capacity: int,
    *,
    drives: Any = (),
    triggers: Any = (),
) -> State:
    """Return the state of a scene with room for so many contacts."""
    moving = len(bodies) if keeps_motion(spec) else 0
    projected = len(bodies) if has_hook(spec, "project") else 0
    return State(
        bodies=bodies,
        velocities=velocities,
        pairs=pairs,
        contacts=np.zeros(capacity, contact_dtype(spec)),
        cache=np.zeros(capacity if has_hook(spec, "match") else 0, cache_dtype(spec)),
        motion=np.zeros(moving, _MOTION),
        pseudo=np.zeros(projected, velocities.dtype),
        links=allocate_links(spec, 0) if links is None else links,
        drives=drives,
        triggers=triggers,
        control=allocate_control(spec, bodies, velocities, capacity),
    )


def with_contacts(spec: Spec, state: State, capacity: int) -> State:
    """Return a state with room for so many contacts; cached impulses stay."""
    cache = np.zeros(capacity if has_hook(spec, "match") else 0, state.cache.dtype)
    if len(cache):
        cache[: len(state.cache)] = state.cache
    return state._replace(
        contacts=np.zeros(capacity, state.contacts.dtype),
        cache=cache,
        control=with_capacity(state.control, capacity),
    )


def allocate_workspace(
    spec: Spec,
    state: State,
    hulls: HullGeometry | None,
    templates: np.ndarray | None,
    meshes: MeshTables | None = None,
) -> Workspace:
    """Return the workspace of a state; templates: of the broad phase."""
    bodies, near = len(state.bodies), has_hook(spec, "find_pairs")
    centred = bodies if step_terms(spec).centred else 0
    tried = 1 if step_terms(spec).ordered_impacts else 0
    free = bodies if has_hook(spec, "keep_free") else 0
    links = len(state.links) if centred and has_hook(spec, "act_beside") else 0
    coupled = bodies if links else 0
    empty = Workspace(
        collision=allocate_scratch(hulls, has_own_normals(spec), meshes, state.bodies.dtype),
        trial=Trial(
            np.zeros(4 * tried, state.bodies.dtype),
            np.zeros(2 * tried, state.velocities.dtype),
            np.zeros(tried, state.contacts.dtype),
        ),
        middle=Middle(
            np.zeros(centred, state.bodies.dtype),
            np.zeros(centred, state.velocities.dtype),
            np.zeros(centred, state.velocities.dtype),
            allocate_fixed_point(WORDS * centred),
        ),
        beside=SpringTrial(
            allocate_fixed_point(9 * links, SPRING_ROUNDS),
            np.zeros(1),
            np.zeros(1, np.int64),
            np.zeros(1, np.int64),
            np.zeros(1, np.int64),
            np.zeros(2, np.int64),
            np.zeros(coupled, state.bodies.dtype),
            np.zeros(coupled, state.velocities.dtype),
        ),
        ordering=allocate_ordering(spec, bodies, 0),
        contact_lists=allocate_contact_lists(0, 0),
        overlooked=Overlooked(
            np.zeros(0, _OVERLOOKED), np.zeros(1, np.int64), np.zeros(1, _UNMADE)
        ),
        islands=np.zeros(bodies if has_hook(spec, "update_sleeping") else 0, np.int64),
        solver=(),
        free_velocities=np.zeros(free, state.velocities.dtype),
        templates=templates if near else (),
        broad_phase=(
            allocate_broad_phase(bodies, len(state.pairs), most_images(state.bodies))
            if near
            else ()
        ),
    )
    return for_contacts(spec, empty, state)


def for_contacts(spec: Spec, workspace: Workspace, state: State) -> Workspace:
    """Return the workspace with room for the contacts of a state."""
    bodies, capacity = len(state.bodies), len(state.contacts)
    listed = (bodies, capacity) if step_terms(spec).ordered_impacts else (0, 0)
    rows = 2 * capacity if step_terms(spec).overlooks else 0
    overlooked = np.zeros(rows, _OVERLOOKED)
    return workspace._replace(
        ordering=allocate_ordering(spec, bodies, capacity),
        contact_lists=allocate_contact_lists(*listed),
        overlooked=workspace.overlooked._replace(points=overlooked),
        solver=SOLVERS[spec.solver].allocate(spec, bodies, capacity),
    )


def allocate_log(spec: Spec, state: State, poses: np.ndarray, steps: int, sweeps: int) -> Log:
    """Return room for the rows of so many steps, and of so many sweeps in each.

    poses: (n, 7) that a row has where nothing turns.
    """
    capacity, velocities = len(state.contacts), state.velocities
    # A quarter of the worst case: full columns end a block early, they lose nothing.
    contact_rows = max(capacity, steps * capacity // 4) if steps else 0
    if has_hook(spec, "log_velocity"):
        poses = np.hstack([poses, np.zeros((len(poses), 6))])
    pose = np.repeat(poses[None], steps, axis=0)
    return Log(
        step=np.zeros(steps, step_row_dtype(spec)),
        pose=pose,
        contact=np.zeros(contact_rows, contact_row_dtype(spec)),
        residual=np.zeros(max(steps, 1) * sweeps, residual_row_dtype()),
        pose_bits=pose.view(np.uint64),
        velocity_bits=velocities.view(np.uint64).reshape(len(velocities), -1),
    )


def allocate_counters() -> np.ndarray:
    """Return the counters of an engine that has made no step, shape (1,)."""
    return _new_counters().copy()


@cache
def _new_counters() -> np.ndarray:
    counters = np.zeros(1, dtype(COUNTERS))
    for name in ("residual_contact", "signorini_contact", "cone_contact", "dissipation_contact"):
        counters[name] = -1
    counters["residual_row"] = -1
    return counters
