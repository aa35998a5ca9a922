"""Effects: one file each, which declares the whole effect (`effect.Effect`), and one line here.

The step is composed of the kernels that the effects of a `Spec` have for its hooks (`Hooks`).
"""

from dataclasses import replace
from functools import lru_cache
from importlib import import_module
from typing import Any, Final, Literal

from ..records import Field
from ..spec import Spec
from .decision import BodyFacts, Decision, Facts, PairFacts
from .effect import CHAINED, Choice, Column, Derived, Effect, Hooks, hook_names
from .joint_models import JOINTS, holding, turned_by_joints
from .keys import TurnOf
from .rope import pulling
from .time_functions import TimeFunction

# Order matters within a hook: kernels of one hook run in this order.
NAMES: Final = (
    "compound",
    "rope",
    "joint",
    "joint_stop",
    "motor",
    "broad_phase",
    "periodic_boundary",
    "gravity",
    "external_force",
    "varying_force",
    "drag",
    "spring",
    "rotation",
    "gyroscopic",
    "kinematic",
    "prescribed_motion",
    "contact_torque",
    "frictionless_contact",
    "friction",
    "contact_patch",
    "anisotropic_friction",
    "torsional_friction",
    "rolling_friction",
    "surface_velocity",
    "static_friction",
    "cohesion",
    "midpoint",
    "contact_midpoint",
    "impact_time",
    "impact_order",
    "pairwise_impacts",
    "sliding_stops",
    "overlooked_points",
    "error_control",
    "speculative",
    "fast_bodies",
    "falling_restitution",
    "restitution",
    "tangential_restitution",
    "capture_in_sweeps",
    "impact_energy",
    "stabilisation",
    "compliance",
    "contact_spring",
    "hertz_contact",
    "tangential_compliance",
    "warm_start",
    "newton",
    "supernodes",
    "packed_sweeps",
    "anderson_acceleration",
    "least_norm",
    "projection",
    "sleeping",
    "triggers",
    "step_log",
    "pose_log",
    "velocity_log",
    "contact_log",
    "residual_log",
    "problem_log",
)
EFFECTS: Final[tuple[Effect, ...]] = tuple(
    import_module(f".{name}", __name__).EFFECT for name in NAMES
)


BY_NAME: Final = {effect.name: effect for effect in EFFECTS}


SURFACE_KEYS: Final = tuple(key for effect in EFFECTS for key in effect.surface_keys)
SCENE_KEYS: Final = tuple(key for effect in EFFECTS for key in effect.scene_keys)
BODY_KEYS: Final = tuple(key for effect in EFFECTS for key in effect.body_keys)
EVENT_KEYS: Final = tuple(
    replace(key, type=key.type | None, default=None, doc=f"{key.doc}; none: as before")
    for key in BODY_KEYS
    if key.by_event
)
MOTION_KEYS: Final = tuple(key for key in BODY_KEYS if key.prescribes_motion)


@lru_cache(maxsize=256)
def effects_of(spec: Spec) -> tuple[Effect, ...]:
    """Return the effects of an engine, in order."""
    return tuple(effect for effect in EFFECTS if spec.has(effect.name))


def made_by(spec: Spec, hook: str) -> list[Any]:
    """Return the kernels that the effects of `spec` have for a hook, in order."""
    makers = [getattr(effect.hooks, hook) for effect in effects_of(spec)]
    return [make(spec) for make in makers if make is not None]


def made_once(spec: Spec, hook: str, *others: Any) -> tuple[bool, Any]:
    """Return whether an effect of `spec` has a hook that only one has, and its kernel.

    others: what its maker is given beside the spec.
    """
    for effect in effects_of(spec):
        make = getattr(effect.hooks, hook)
        if make is not None:
            return True, make(spec, *others)
    return False, None


@lru_cache(maxsize=4096)  # asked for every engine of a sweep
def has_hook(spec: Spec, hook: str) -> bool:
    """Return whether some effect of `spec` has a hook; nothing is made."""
    return any(getattr(effect.hooks, hook) is not None for effect in effects_of(spec))


def rows_of_surfaces(rows: Any) -> Any:
    """Return the logged contacts without those of ropes and joints, which are of no surface."""
    for connection in ("rope", "joint"):
        if connection in (rows.dtype.names or ()):
            rows = rows[rows[connection] == 0]
    return rows


def surface_fields(spec: Spec) -> list[Field]:
    """Return the columns that surfaces bring to pairs."""
    return [field for effect in effects_of(spec) for field in effect.fields.pair]


def columns_of(spec: Spec, row: Literal["contact", "step", "residual"]) -> list[Column]:
    """Return the columns of a log row: the log's own, then those of the effects of `spec`."""
    log = BY_NAME[f"{row}_log"]
    effects = [log, *(effect for effect in effects_of(spec) if effect is not log)]
    columns = [column for effect in effects for column in getattr(effect, f"{row}_columns")]
    return [column for column in columns if column.when is None or column.when(spec)]


def row_fields(spec: Spec, row: Literal["contact", "step", "residual"]) -> list[Field]:
    """Return the fields of a log row."""
    return [(column.name, column.kind) for column in columns_of(spec, row)]


__all__ = [
    "BODY_KEYS",
    "BY_NAME",
    "CHAINED",
    "EFFECTS",
    "EVENT_KEYS",
    "JOINTS",
    "MOTION_KEYS",
    "SCENE_KEYS",
    "SURFACE_KEYS",
    "BodyFacts",
    "Choice",
    "Column",
    "Decision",
    "Derived",
    "Effect",
    "Facts",
    "Hooks",
    "PairFacts",
    "TimeFunction",
    "TurnOf",
    "columns_of",
    "effects_of",
    "has_hook",
    "holding",
    "hook_names",
    "made_by",
    "made_once",
    "pulling",
    "row_fields",
    "rows_of_surfaces",
    "surface_fields",
    "turned_by_joints",
]
