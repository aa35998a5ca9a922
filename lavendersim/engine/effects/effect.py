"""Effect: one term of the physics or of the log, declared whole in one file of this folder.

Each file ends with `EFFECT = Effect(...)`: when a scene requires it and why, the record fields, log
columns and config keys that it brings, and its kernels by the hooks of the step that call them. The
list in `effects/__init__.py` names the file; nothing else needs to.

Declarations load without numba: a maker imports what its kernel is made of when it is called.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from dataclasses import fields as dataclass_fields
from typing import Any, Final, Literal, NamedTuple

from ..records import Field
from ..spec import Spec
from ..terms import RowTerms, StepTerms
from .decision import Decision, Facts
from .keys import BodyKey, SceneKey, SurfaceKey
from .time_functions import Terms

Kernel = Any  # a compiled function
Maker = Callable[..., Kernel]  # (spec, ...) -> kernel; what it is given beside the spec: see Hooks


class Derived(NamedTuple):
    """How a column follows from others of its row, bit for bit: a log does not store it.

    A log keeps the rule by which its reader gives the column back, so a rule is never changed:
    another one has another text.
    """

    rule: str  # in the names of columns, as the log has it
    sources: tuple[str, ...]  # the columns it follows from
    value: Callable[[Any, Any], Any]  # (rows, timestep of each [s]) -> the column


class Column(NamedTuple):
    """One number of a log row."""

    name: str
    kind: str  # f8, i8 or u8
    meaning: str
    unit: str = ""  # "" where it is a count, an index, a hash or a direction
    number: int = 0  # of the field in the messages of /step and /residuals; fixed for ever
    when: Callable[[Spec], bool] | None = None  # the engines of the effect that log it; None: all
    derived: Derived | None = None  # None: it is stored

    @property
    def text(self) -> str:
        """Meaning and unit."""
        return f"{self.meaning} [{self.unit}]" if self.unit else self.meaning


@dataclass(frozen=True, kw_only=True)
class Fields:
    """Columns of the engine's records that an effect brings."""

    body: Sequence[Field] = ()
    velocity: Sequence[Field] = ()
    pair: Sequence[Field] = ()
    contact: Sequence[Field] = ()
    contact_with: Callable[[Spec], Sequence[Field]] | None = None  # that depend on other effects
    link: Sequence[Field] = ()  # of what joins two bodies, beside LINK
    drive: Sequence[Field] = ()  # of a function of time that acts on a body, beside DRIVE
    cache: Sequence[Field] = ()  # of a contact, kept until the next step
    parameters: Sequence[Field] = ()  # of the run: the key of the numerics that has the same name


# Hooks that several effects may have.
CHAINED: Final = (
    *("drive", "end_part", "start_step", "accelerate", "prepare", "capture", "preload"),
    *("contact_row", "step_row", "pushes", "differs_midway", "note_middle"),
)


@dataclass(frozen=True, kw_only=True)
class Hooks:
    """Where the step calls an effect: makers of kernels, by the signatures of the kernels.

    Several effects may have a hook of the first group (CHAINED); they run in the order of the list
    EFFECTS. Of the second group one effect has each: the step is made with it or without it.
    """

    drive: Maker | None = None  # (drives, bodies, velocities, params, counters), in every part
    start_step: Maker | None = None  # (bodies, velocities), before forces act
    end_part: Maker | None = None  # (state, params), once poses have moved
    accelerate: Maker | None = None  # (body, velocity, params), before contacts are completed
    act_between: Maker | None = None  # (links, bodies, velocities, motion, params, counters)
    link_row: Maker | None = None  # (row, links, bodies): fills the columns of a step, which ends
    prepare: Maker | None = None  # (contact, va, vb, pair, params), when it has frame and levers
    capture: Maker | None = None  # (contact, pair, params), once per contact and step
    preload: Maker | None = None  # (contact, velocities, motion): before the solve; 1 in `loaded`
    contact_row: Maker | None = None  # (out, contact, va, vb): fills the columns of a contact
    step_row: Maker | None = None  # (row, bodies, counters): fills the columns of a step
    pushes: Maker | None = None  # (body) -> whether it does, so that the body may not sleep
    differs_midway: Maker | None = None  # (state, count, params) -> whether forces at the middle do
    note_middle: Maker | None = (
        None  # (bodies, velocities, lead, midway, params), by the last solve
    )
    act_midway: Maker | None = None  # (bodies, poses, velocities), in a pass, before its solve

    prescribe: Maker | None = None  # (body, velocity): a kinematic body's, when forces act
    measure_speeds: Maker | None = None  # (bodies, velocities), before forces act
    refresh_inertia: Maker | None = None  # (bodies, velocities), when forces have acted
    place_parts: Maker | None = None  # (bodies), before collision detection
    place_part: Maker | None = None  # (bodies, row)
    find_pairs: Maker | None = None  # the broad phase, see `collide.broad.broad_phase`
    is_still: Maker | None = None  # (body) -> whether it cannot move in this step
    wake: Maker | None = None  # (bodies, contacts, count, params) -> whether a body woke
    mark_middle: Maker | None = None  # (contacts, first, last, pair, found), of a manifold
    stretch_tangents: Maker | None = None  # (contact, body_a, body_b, pair): units of its tangents
    recall_stretch: Maker | None = None  # (contacts, count, bodies, cache, counters, params)
    yield_row: Maker | None = None  # (contact, pair, ma, mb, params), of a completed row
    keep_stretch: Maker | None = None  # (contacts, count, velocities, motion, params), once solved
    surface_velocity: Maker | None = None  # (contact, body_a, body_b), once its tangents are set
    complete_torsion: Maker | None = None  # (contact, pair, x, y, z): response to a unit psi_n
    complete_rolling: Maker | None = None  # (contact, pair, k_11, k_12, k_22)
    solve_torsion: Maker | None = None  # (contact, spin) -> change of psi_n
    solve_rolling: Maker | None = None  # (contact, w1, w2) -> changes of psi_1, psi_2
    torsion_residual: Maker | None = None  # (contact, spin) -> r [rad/s]
    rolling_residual: Maker | None = None  # (contact, w1, w2) -> r [rad/s]
    is_drawn: Maker | None = None  # (contact, pair, params) -> whether its bodies draw together
    restitution_at: Maker | None = None  # (e, row, speed) -> e at an approach speed
    note_slip: Maker | None = None  # (contact, va, vb): the slip before the solve
    mark_impact: Maker | None = None  # (state, count, params) -> rows of the impact
    order_impacts: Maker | None = None  # (state, count, workspace, params, counters): see there
    first_stop: Maker | None = None  # (state, count, params, counters) -> when sliding stops [s]
    note_rate: Maker | None = None  # (body, velocity, motion, dt), once a part is solved
    # (contacts, begin, end, count, motion, params) -> whether any is foreseen, of rows begin to end
    foresee_impacts: Maker | None = None
    predict_impacts: Maker | None = None  # (contacts, count, motion, params), where one is
    reverse_slip: Maker | None = None  # (contact, pair, va, vb), before the solve
    slowed_n: Maker | None = None  # (contact, body_a, body_b) -> what of dv_n resists motion [m/s]
    keep_free: Maker | None = None  # (velocities, free), before any contact impulse acts
    match: Maker | None = None  # (contacts, count, bodies, cache, counters, params)
    recapture: Maker | None = None  # (contact, w, params) -> w, in every sweep
    limit_impacts: Maker | None = None  # made with (spec, solve, classify); after the solve
    choose_impulses: Maker | None = None  # (system, workspace, params, counters), once solved
    act_beside: Maker | None = None  # made with (spec, solve): `spring_contacts`
    limit_projection: Maker | None = None  # (state, workspace, params), once it is found
    spring_row: Maker | None = None  # (contact, v_n, params): its target and gamma
    contact_energy: Maker | None = None  # (contacts, count, velocities, params) -> stored [J]
    sweep_row: Maker | None = None  # (params, counters, rows, sweep, residual): after each sweep
    log_contacts: Maker | None = None  # made with (spec, kernels of contact_row); after the solve
    store: Maker | None = None  # (contacts, count, bodies, cache, counters, params)
    project: Maker | None = None  # (system, motion, pseudo, solver's workspace, params) -> sweeps
    turn: Maker | None = None  # (body, velocity, dt) -> whether the turn has a solution
    turn_uneven: Maker | None = None  # the same for unequal principal inertias
    turn_midway: Maker | None = None  # (body, start, m, lead, end, dt) -> whether a middle is found
    turn_by_mean: Maker | None = None  # (body, velocity, mean, end, kind, dt)
    add_spin: Maker | None = None  # (body, velocity, x, y, z, twice_spent): jump of spin
    meet_triggers: Maker | None = None  # (state, log, counters) -> how many, at the end of a step
    update_sleeping: Maker | None = None  # at the end of a step, see `sleeping`
    log_pose: Maker | None = None  # (body, row)
    log_velocity: Maker | None = None  # (v, row): behind the pose of its body
    log_step: Maker | None = None  # made with (spec, log_pose, kernels of step_row)


class Unlogged(NamedTuple):
    """A part of a balance that is in no log: the balance cannot be judged where it is."""

    check: Literal["energy", "momentum"]
    what: str  # what is not in the log; {body} stands for the name


@dataclass(frozen=True, kw_only=True)
class Balance:
    """Its share in the balances of energy and momentum (`measures.balance`), by log columns."""

    pull: str = ""  # of a contact: impulse that draws its bodies together along n [N s]
    stored: str = ""  # of a step: energy that it stores [J]
    work: str = ""  # of a step: work that it does on movable bodies from outside [J]
    varies_friction: str = ""  # surface key: where above 0, the logged coefficient is the one
    outer: tuple[str, ...] = ()  # of a step: impulse on movable bodies from others, x y z [N s]
    unlogged: Unlogged | None = None  # where a body has a key of the effect


class Drive(NamedTuple):
    """A function of time that acts on a body."""

    body: int  # its row
    terms: Terms
    begin: float | None  # [s] it acts from the first step that starts then; None: at all times
    end: float | None  # [s] and up to the first that starts then
    values: Mapping[str, Any]  # of the fields that the effect adds


class Choice(NamedTuple):
    """The key of a config that chooses an effect: a law, which no coefficient turns off."""

    key: str
    section: str = "numerics"
    examples: tuple[Any, ...] = ()  # of its values, with and without; none: the key names them all


@dataclass(frozen=True, kw_only=True)
class Effect:
    """A term of the physics or of the log; all there is to know of it outside its kernels."""

    name: str  # that of its file
    decide: Callable[[Facts], Decision]  # whether a scene requires it, and the reason
    per: Literal["body", "contact"]  # what its cost grows with
    needs: tuple[str, ...] = ()  # effects without which it cannot be
    chosen_by: Choice | None = None
    overhead_with: str = ""  # effect with which it is timed, where it comes and goes with that one
    surface_keys: tuple[SurfaceKey, ...] = ()  # of a config: properties of surfaces
    scene_keys: tuple[SceneKey, ...] = ()
    body_keys: tuple[BodyKey, ...] = ()
    # Of a cell: paths of the keys that it cannot be with, and why; nothing where it is off.
    excludes: Callable[[Any], Iterable[tuple[tuple[str | int, ...], str]]] | None = None
    acts_on: Callable[[Any], Iterable[tuple[str, bool]]] | None = None  # bodies, whether it turns
    links: Callable[[Any, dict[str, int]], list[dict[str, Any]]] | None = None  # of a scene
    drives: Callable[[Any, dict[str, int]], list[Drive]] | None = None  # of a scene
    moves: Callable[[Any], tuple[float, bool]] | None = (
        None  # a body: speed [m/s], whether it turns
    )
    row: RowTerms = field(default_factory=RowTerms)
    step: StepTerms = field(default_factory=StepTerms)
    balance: Balance = Balance()
    study_only: str = ""  # of a deliberate error, what it does: every run that has it says so
    fields: Fields = Fields()
    body_values: Callable[[Any], Mapping[str, Any]] | None = None  # of fields.body
    contact_columns: tuple[Column, ...] = ()  # of /contacts
    step_columns: tuple[Column, ...] = ()  # of /step
    residual_columns: tuple[Column, ...] = ()  # of /residuals
    counts: tuple[str, ...] = ()  # counters of its own that begin at 0 in every step
    channels: tuple[str, ...] | None = None  # of the log; None: it is no log
    hooks: Hooks = Hooks()

    def columns_by_record(self, spec: Spec | None = None) -> dict[str, list[str]]:
        """Return the names of all columns that it brings: of records, and of log rows (`step_row`).

        spec: with those that depend on what else an engine has.
        """
        own = self.fields
        dependent = own.contact_with(spec) if spec and own.contact_with else ()
        groups: dict[str, Sequence[Field]] = {
            "body": own.body,
            "velocity": own.velocity,
            "pair": own.pair,
            "contact": [*own.contact, *dependent],
            "cache": own.cache,
            "parameters": own.parameters,
        }
        found = {record: [name for name, _ in fields] for record, fields in groups.items()}
        rows = {
            "contact_row": self.contact_columns,
            "step_row": self.step_columns,
            "residual_row": self.residual_columns,
        }
        for row, columns in rows.items():
            found[row] = [c.name for c in columns if c.when is None or (spec and c.when(spec))]
        return {record: list(dict.fromkeys(names)) for record, names in found.items() if names}


def hook_names() -> tuple[str, ...]:
    """Return the names of all hooks of the step."""
    return tuple(field.name for field in dataclass_fields(Hooks))


def kernel(function: Callable[..., Any], spec: Spec) -> Kernel:
    """Compile `function`, made for `spec`, for use inside other kernels."""
    from ..compile import kernel as compiled  # numba

    return compiled(function, spec)
