"""The engine of one scene: its memory, its compiled step, and what may be done between steps.

    engine = Engine(spec, bodies, velocities, pairs, parameters, poses)
    status = engine.advance(steps)
    rows = engine.take_rows()

The caller fills `bodies`, `velocities` and `pairs` once (`record_layout.allocate_bodies`, ...) and
may change masses and parameters between calls. Rows of the trace are written into columns allocated
here; rows of contacts grow when a step needs more.
"""

from __future__ import annotations

from functools import partial
from operator import is_
from typing import Any, NamedTuple

import numpy as np

from lavendersim.record_tables import copied

from . import memory, removal
from .assemble import StepProblem, step_problem
from .collide.broad.broad_phase import allocate_broad_phase
from .collide.broad.images import most_images
from .collide.convex.hull_geometry import HullGeometry
from .collide.mesh_tables import MeshTables
from .compile import compiling
from .effects import effects_of, has_hook, sleeping
from .effects.packed_sweeps import SHARED_SWEEP
from .records import CONTACTS_FULL, PAIRS_FULL, ROWS_FULL, WOKEN
from .solvers.packed.members import packed_of, serve_for
from .spec import Spec
from .step import advance_for
from .team import with_team

# Steps whose rows are kept before they must be handed on; several hundred amortise a kernel call.
BLOCK_STEPS = 512
# Contacts that memory is taken for at first, at most: more are made room for when they come.
FIRST_CONTACTS = 1024
# So many contacts [byte] are handed on in the memory that the step wrote them into, and it gets
# another: to copy them takes as long as to compress them. Fewer, or in memory of which less than
# half is in use, are copied, and nothing is kept that holds no row.
HANDED_ON = 256 * 1024


class Rows(NamedTuple):
    """Trace rows of some steps: structured arrays, and poses of shape (steps, bodies, 7).

    With `velocity_log` the row of a pose goes on with velocities: (steps, bodies, 13).
    """

    step: np.ndarray
    pose: np.ndarray
    contact: np.ndarray
    residual: np.ndarray


# Bits of numpy's flags that numba tells arrays apart by: whether rows stand behind each other, may
# be written, are aligned.
_FLAGS = 0x0001 | 0x0400 | 0x0100
# Engines of one spec and of equal types of what they are given have arrays of equal types, so one
# machine code: a kind, by its number.
_kinds: dict[Any, int] = {}
# Machine code by kind, where it is known: as Python calls it, and where it lies for other kernels.
_entries: dict[int, Any] = {}
_codes: dict[int, int] = {}


def _types_of(arrays: Any) -> tuple[Any, ...]:
    """Return what numba tells arrays apart by, and the tuples that they stand in."""
    found: list[Any] = []
    _note_types(arrays, found)
    return tuple(found)


def _note_types(part: Any, found: list[Any]) -> None:
    if isinstance(part, np.ndarray):
        found += part.dtype, part.ndim, part.flags.num & _FLAGS
    elif isinstance(part, tuple):
        found += type(part), len(part)
        for inner in part:
            _note_types(inner, found)
    else:
        found.append(type(part))


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
        *,
        templates: np.ndarray | None = None,
        hulls: HullGeometry | None = None,
        meshes: MeshTables | None = None,
        links: np.ndarray | None = None,
        drives: Any = (),
        triggers: Any = (),
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
        self.spec, self.parameters = spec, parameters
        self._records_sweeps = has_hook(spec, "sweep_row")
        self.block_steps = max(block_steps, 1) if has_hook(spec, "log_step") else 0
        self.counters = memory.allocate_counters()
        self._done = self.counters["step"]
        self._initial_pose = poses
        self._kernel = advance_for(spec)
        capacity = max(4, min(4 * len(pairs), FIRST_CONTACTS))
        self.state = memory.allocate_state(
            spec, bodies, velocities, pairs, links, capacity, drives=drives, triggers=triggers
        )
        self.workspace = memory.allocate_workspace(spec, self.state, hulls, templates, meshes)
        self.log = self._allocate_log()
        # Looking up the types of forty arrays costs 6 us a call, and 1 ms for the first of an
        # engine; they stay what they are. Of what is allocated here, they follow from the spec and
        # from the types of what is given: engines of one kind differ in sizes alone.
        given = bodies, velocities, pairs, parameters, poses, links, drives, triggers
        types = spec, _types_of((*given, hulls, templates, meshes))
        self.kind = _kinds.setdefault(types, len(_kinds))
        self._entry = _entries.get(self.kind)
        self._objects: tuple[Any, np.ndarray] = (), np.empty(0, np.int64)
        self._threads = 1

    def note_memory(self) -> None:
        """Take up arrays that were put in the place of its own: equal in type, shape and values."""
        self._done = self.counters["step"]

    @property
    def machine_code(self) -> int:
        """Where the machine code of its step lies; 0: it is not known, or steps need room first."""
        alone = self._records_sweeps or self._has_team()
        return 0 if alone else _codes.get(self.kind, 0)

    def array_objects(self) -> np.ndarray:
        """Return the addresses of the array objects of its memory, parameters and counters last."""
        now = self.state, self.workspace, self.log, self.parameters, self.counters
        before, objects = self._objects
        if len(before) == len(now) and all(map(is_, before, now)):
            return objects
        objects = np.array([*map(id, memory.arrays_of(now))])
        self._objects = now, objects
        return objects

    @property
    def threads(self) -> int:
        """Threads that share the sweeps of a step, see `team`; bits are those of one."""
        return self._threads

    @threads.setter
    def threads(self, asked: int) -> None:
        """Ask for so many, whose kernel is compiled; one where there is nothing to share."""
        self._threads = 1 if packed_of(self.workspace.solver) is None else asked
        if self._threads > 1:
            serve_for(self.spec)

    def _has_team(self) -> bool:
        # By the last step: a call is brief, and its contacts may become more.
        return self._threads > 1 and int(self.counters["contacts"][0]) >= SHARED_SWEEP

    @property
    def bodies(self) -> np.ndarray:
        """Records of the bodies and of their parts."""
        return self.state.bodies

    @property
    def velocities(self) -> np.ndarray:
        """Records of their velocities."""
        return self.state.velocities

    @property
    def contacts(self) -> np.ndarray:
        """Records of the contacts of the last step; counters["contacts"] of them are in use."""
        return self.state.contacts

    def _allocate_log(self) -> memory.Log:
        sweeps = self._sweep_rows()
        return memory.allocate_log(
            self.spec, self.state, self._initial_pose, self.block_steps, sweeps
        )

    def _grow_contacts(self, capacity: int) -> None:
        self.state = memory.with_contacts(self.spec, self.state, capacity)
        self.workspace = memory.for_contacts(self.spec, self.workspace, self.state)
        before, self.log = self.log, self._allocate_log()
        self._keep_unfinished(before)

    def _keep_unfinished(self, before: memory.Log) -> None:
        """Move the rows of a step of which parts are left to the head of the empty columns."""
        counters = self.counters[0]
        at, step = int(counters["contact_rows"]), int(counters["step_rows"])
        history = before.residual[: counters["residual_rows"]]
        self._take_all()
        if not counters["parts"] or not self.block_steps:
            return
        count = int(before.step["contact_count"][step])
        self.log.contact[:count] = before.contact[at : at + count].copy()
        self.log.step[0] = before.step[step].copy()
        own = history[history["step"] == counters["step"] + 1]
        self.log.residual[: len(own)] = own
        counters["residual_rows"] = len(own)

    def _take_all(self) -> None:
        for name in ("step_rows", "contact_rows", "residual_rows"):
            self.counters[name] = 0

    def _grow_log(self) -> None:
        """Make room for a step with more rows than a block has: one made in many parts."""
        before = self.log
        self.log = before._replace(
            contact=np.zeros(2 * len(before.contact), before.contact.dtype),
            residual=np.zeros(2 * len(before.residual), before.residual.dtype),
        )
        self._keep_unfinished(before)

    def _grow_pairs(self) -> None:
        needed = int(self.workspace.broad_phase.state["needed"][0])
        pairs = removal.larger_table(self.state.pairs, needed + needed // 4)
        self.state = self.state._replace(pairs=pairs)
        near = allocate_broad_phase(len(self.bodies), len(pairs), most_images(self.bodies))
        self.workspace = self.workspace._replace(broad_phase=near)

    def _sweep_rows(self) -> int:
        """Rows that the sweeps of one step need."""
        return int(self.parameters["sweeps"][0]) + 1 if self._records_sweeps else 0

    def advance(self, steps: int) -> int:
        """Do up to `steps` steps; return RUNNING, ROWS_FULL (take rows, call again) or DIVERGED."""
        if self._records_sweeps:
            if len(self.log.residual) < self._sweep_rows():  # more sweeps are required
                if self.counters["step_rows"][0]:
                    return ROWS_FULL
                self.log = self._allocate_log()
        target = int(self._done[0]) + steps
        while True:
            status = self._call(target - int(self._done[0]))
            if status == PAIRS_FULL:
                self._grow_pairs()
                continue
            if status == WOKEN:
                continue
            if status == ROWS_FULL and not self.counters["step_rows"][0] and self.block_steps:
                self._grow_log()
                continue
            if status != CONTACTS_FULL:
                return status
            if self.counters["step_rows"][0]:
                return ROWS_FULL  # rows first: enlarging the columns would drop them
            self._grow_contacts(2 * len(self.contacts))

    def _call(self, steps: int) -> int:
        arguments = self.state, self.workspace, self.log, self.parameters, self.counters, steps
        if self._entry is not None:
            packed = packed_of(self.workspace.solver) if self._has_team() else None
            if packed is None:
                return int(self._entry(*arguments))
            serve, words = partial(serve_for(self.spec), packed), packed.team.words
            return int(with_team(serve, words, self._threads, partial(self._entry, *arguments)))
        with compiling():
            status = int(self._kernel(*arguments))
        compiled = list(self._kernel.overloads.values())
        if len(compiled) == 1:
            self._entry = _entries[self.kind] = compiled[0].entry_point
            symbol = compiled[0].fndesc.llvm_func_name
            _codes[self.kind] = compiled[0].library.get_pointer_to_function(symbol)
        return status

    def take_rows(self, room: bool = False) -> Rows:
        """Return the rows written since the last call, for the caller to keep, and empty the log.

        Behind each row of a step or a contact is room for its time, with any content. room: steps
        and poses have a row of zeros in front of the first, for the state before them.
        """
        count, log = self.counters[0], self.log
        contact = log.contact[: count["contact_rows"]]
        if contact.nbytes >= HANDED_ON and 2 * len(contact) >= len(log.contact):
            self.log = log._replace(contact=np.empty(len(log.contact), log.contact.dtype))
        else:
            contact = copied(contact)
        history = log.residual[: count["residual_rows"]]
        step, pose = log.step[: count["step_rows"]], log.pose[: count["step_rows"]]
        rows = Rows(
            copied(step, room),
            copied(pose, room),
            contact,
            history[history["step"] <= count["step"]],  # of steps that are done
        )
        self._keep_unfinished(log)
        return rows

    def problem(self) -> StepProblem | None:
        """Return the contact problem of the last step, None where nothing touched.

        For an engine with `problem_log`, after a call of `advance` that did all its steps.
        """
        count = int(self.counters["contacts"][0])
        if not count:
            return None
        free_velocities = self.workspace.free_velocities
        return step_problem(self.spec, self.contacts[:count], free_velocities)

    def wake(self, body: int) -> None:
        """Wake the bodies that sleep beside one that is about to be changed."""
        if has_hook(self.spec, "update_sleeping"):
            sleeping.wake_around(self.bodies, body)

    def wake_all(self) -> None:
        """Wake every body that sleeps: something has changed that all feel."""
        if has_hook(self.spec, "update_sleeping"):
            sleeping.wake_rows(self.bodies, self.bodies["asleep"] == 1)

    def list_pairs_anew(self) -> None:
        """Let the broad phase list its pairs again: what it writes into them has changed."""
        self.workspace.broad_phase.state["listed"] = 0

    def remove(self, body: int) -> None:
        """Take a body out for good: it stays where it is, and takes part in nothing."""
        self.wake(body)
        self.forget_contacts(body)
        rows = removal.rows_of(self.bodies, body)
        removal.cut_links(self.state.links, self.bodies, body)
        removal.hold_still(self.bodies, self.velocities, rows)
        if has_hook(self.spec, "find_pairs"):
            templates = removal.make_untouchable(self.bodies, self.workspace.templates, rows)
            self.workspace = self.workspace._replace(templates=templates)
            self.list_pairs_anew()
            pairs = removal.connections_without(self.state.pairs, rows)
        else:
            pairs = removal.pairs_without(self.state.pairs, rows)
        self.state = self.state._replace(pairs=pairs)

    def forget_contacts(self, body: int | None = None) -> None:
        """Drop cached impulses, of every contact or of those of one body (it was changed)."""
        cached = int(self.counters["cached"][0])
        if body is None or not cached:
            self.counters["cached"] = 0
            return
        cache = self.state.cache
        rows = cache[:cached]
        kept = rows[(rows["a"] != body) & (rows["b"] != body)]
        cache[: len(kept)] = kept
        self.counters["cached"] = len(kept)
