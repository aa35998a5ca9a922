"""Arrays enter, arrays leave: the engine of one scene, its memory and its kernel.

    engine = Engine(spec, bodies, velocities, pairs, parameters)
    status = engine.advance(steps)
    block = engine.take_rows()

The caller fills `bodies`, `velocities` and `pairs` once (see `allocate_*`) and may change masses
and parameters between calls. Rows are written into columns allocated here; contact rows grow when
a step needs more.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from . import removal
from .assemble import StepProblem, step_problem
from .collide.broad.broad_phase import allocate_broad_phase
from .collide.convex.hull_geometry import HullGeometry
from .collide.scratch import allocate_scratch
from .compile import compiling
from .effects import effects_of, sleeping
from .integrate import keeps_motion
from .ordering import BUCKETS
from .record_layout import (
    cache_dtype,
    contact_dtype,
    contact_row_dtype,
    residual_row_dtype,
    step_row_dtype,
)
from .records import (
    CONTACTS_FULL,
    COUNTERS,
    MOTION,
    PAIRS_FULL,
    POINT,
    ROWS_FULL,
    WOKEN,
    dtype,
)
from .solvers.catalogue import SOLVERS
from .spec import Spec
from .step import advance_for

# Points of one manifold before reduction: two polygons of at most eight vertices each.
MANIFOLD_POINTS = 16
# Steps whose rows are held before they must be handed on; several hundred amortise a kernel call.
BLOCK_STEPS = 512


class Rows(NamedTuple):
    """Trace rows of some steps: structured arrays, and poses of shape (steps, bodies, 7)."""

    step: np.ndarray
    pose: np.ndarray
    contact: np.ndarray
    residual: np.ndarray


class Engine:
    """One scene in motion. Not thread-safe; kernels release the interpreter lock."""

    def __init__(
        self,
        spec: Spec,
        bodies: np.ndarray,
        velocities: np.ndarray,
        pairs: np.ndarray,
        parameters: np.ndarray,
        poses: np.ndarray,
        templates: np.ndarray | None = None,
        hulls: HullGeometry | None = None,
        block_steps: int = BLOCK_STEPS,
    ) -> None:
        lacking = {
            f"{effect.name} needs {name}"
            for effect in effects_of(spec)
            for name in effect.needs
            if not spec.has(name)
        }
        if lacking:
            raise ValueError(", ".join(sorted(lacking)))
        self.spec = spec
        self.bodies, self.velocities = bodies, velocities
        self.pairs, self.parameters = pairs, parameters
        self.block_steps = max(block_steps, 1) if spec.has("step_log") else 0
        self.counters = np.zeros(1, dtype(COUNTERS))
        self._done = self.counters["step"]
        for name in ("residual", "signorini", "cone", "dissipation"):
            self.counters[f"{name}_contact"] = -1
        self.counters["residual_row"] = -1
        self.motion = np.zeros(len(bodies) if keeps_motion(spec) else 0, dtype(MOTION))
        self.pseudo = np.zeros(len(bodies) if spec.has("projection") else 0, velocities.dtype)
        self.free = np.zeros(len(bodies) if spec.has("problem_log") else 0, velocities.dtype)
        self._velocity_bits = velocities.view(np.uint64).reshape(len(velocities), -1)
        self._initial_pose = poses
        self._kernel = advance_for(spec)
        self._entry: Any = None  # its machine code for the types of these arrays, once known
        self._hulls = hulls
        self._templates = templates if spec.has("broad_phase") else ()
        self._near = self._allocate_near()
        self._grow_contacts(max(4, min(4 * len(pairs), 1024)))

    def _grow_contacts(self, capacity: int) -> None:
        self.contacts = np.zeros(capacity, contact_dtype(self.spec))
        self._work = (
            np.zeros(MANIFOLD_POINTS, dtype(POINT)),
            np.zeros(3),
            allocate_scratch(self._hulls),
            np.zeros(len(self.bodies), np.int64),
            np.zeros(BUCKETS + 1, np.int64),
            np.zeros(capacity, np.int64),
            np.zeros(capacity, np.uint64),
            SOLVERS[self.spec.solver].allocate(self.spec, len(self.bodies), capacity),
            self.free,
            self._templates,
            self._near,
        )
        held = getattr(self, "cache", None)
        warm = self.spec.has("warm_start")
        self.cache = np.zeros(capacity if warm else 0, cache_dtype(self.spec))
        if held is not None and warm:
            self.cache[: len(held)] = held
        self._allocate_rows(capacity)

    def _allocate_near(self) -> Any:
        if not self.spec.has("broad_phase"):
            return ()
        return allocate_broad_phase(len(self.bodies), len(self.pairs))

    def _grow_pairs(self) -> None:
        needed = int(self._near.state["needed"][0])
        self.pairs = np.zeros(needed + needed // 4, self.pairs.dtype)
        self._near = self._allocate_near()
        self._work = (*self._work[:-1], self._near)

    def _allocate_rows(self, capacity: int) -> None:
        steps = self.block_steps
        # A quarter of the worst case: full columns end a block early, they lose nothing.
        contact_rows = max(capacity, steps * capacity // 4) if steps else 0
        self._rows = (
            np.zeros(steps, step_row_dtype(self.spec)),
            np.repeat(self._initial_pose[None], steps, axis=0),
            np.zeros(contact_rows, contact_row_dtype(self.spec)),
        )
        self._pose_bits = self._rows[1].view(np.uint64)
        residual_rows = max(steps, 1) * self._sweep_rows()
        self._residual_rows = np.zeros(residual_rows, residual_row_dtype())

    def _sweep_rows(self) -> int:
        """Rows that the sweeps of one step need."""
        return int(self.parameters["sweeps"][0]) + 1 if self.spec.has("residual_log") else 0

    def advance(self, steps: int) -> int:
        """Do up to `steps` steps; return RUNNING, ROWS_FULL (take rows, call again) or DIVERGED."""
        if self.spec.has("residual_log"):
            if len(self._residual_rows) < self._sweep_rows():  # more sweeps are asked for
                if self.counters["step_rows"][0]:
                    return ROWS_FULL
                self._allocate_rows(len(self.contacts))
        target = int(self._done[0]) + steps
        while True:
            status = self._call(target - int(self._done[0]))
            if status == PAIRS_FULL:
                self._grow_pairs()
                continue
            if status == WOKEN:
                continue
            if status != CONTACTS_FULL:
                return status
            if self.counters["step_rows"][0]:
                return ROWS_FULL  # rows first: enlarging the columns would drop them
            self._grow_contacts(2 * len(self.contacts))

    def _call(self, steps: int) -> int:
        if self._entry is not None:
            return int(self._entry(*self._arguments(), steps))
        with compiling():
            status = int(self._kernel(*self._arguments(), steps))
        # Looking up the types of forty arrays costs 6 us a call; they stay what they are.
        compiled = list(self._kernel.overloads.values())
        if len(compiled) == 1:
            self._entry = compiled[0].entry_point
        return status

    def _arguments(self) -> tuple[Any, ...]:
        return (
            self.bodies,
            self.velocities,
            self.motion,
            self.pseudo,
            (self._pose_bits, self._velocity_bits),
            self.contacts,
            self.cache,
            self.pairs,
            self._work,
            self.parameters,
            self.counters,
            self._rows,
            self._residual_rows,
        )

    def take_rows(self) -> Rows:
        """Return copies of the rows written since the last call and empty the columns."""
        count = self.counters[0]
        steps, contacts, residuals = (
            int(count["step_rows"]),
            int(count["contact_rows"]),
            int(count["residual_rows"]),
        )
        rows = Rows(
            self._rows[0][:steps].copy(),
            self._rows[1][:steps].copy(),
            self._rows[2][:contacts].copy(),
            self._residual_rows[:residuals].copy(),
        )
        for name in ("step_rows", "contact_rows", "residual_rows"):
            self.counters[name] = 0
        return rows

    def problem(self) -> StepProblem | None:
        """Return the contact problem of the last step, None where nothing touched.

        For an engine with `problem_log`, after a call of `advance` that did all its steps.
        """
        count = int(self.counters["contacts"][0])
        return step_problem(self.spec, self.contacts[:count], self.free) if count else None

    def wake(self, body: int) -> None:
        """Wake who sleeps beside a body that is about to be changed."""
        if self.spec.has("sleeping"):
            sleeping.wake_around(self.bodies, body)

    def remove(self, body: int) -> None:
        """Take a body out for good: it stays where it is, and takes part in nothing."""
        self.wake(body)
        self.forget_contacts(body)
        rows = removal.rows_of(self.bodies, body)
        removal.hold_still(self.bodies, self.velocities, rows)
        if self.spec.has("broad_phase"):
            templates = np.asarray(self._templates)
            self._templates = removal.make_untouchable(self.bodies, templates, rows)
            self._near.state["listed"] = 0
            self._work = (*self._work[:-2], self._templates, self._near)
        else:
            self.pairs = removal.pairs_without(self.pairs, rows)

    def forget_contacts(self, body: int | None = None) -> None:
        """Drop cached impulses, of every contact or of those of one body (it was changed)."""
        cached = int(self.counters["cached"][0])
        if body is None or not cached:
            self.counters["cached"] = 0
            return
        rows = self.cache[:cached]
        kept = rows[(rows["a"] != body) & (rows["b"] != body)]
        self.cache[: len(kept)] = kept
        self.counters["cached"] = len(kept)
