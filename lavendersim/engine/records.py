"""Every record the kernels work on: field, unit, meaning. Scalar float64 or int64 fields only.

A record's dtype is composed from the base fields below and the fields that the effects of a `Spec`
bring (`effects.effect.Fields`), so an absent effect has no column.
World frame, SI units, unless a comment says otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import numpy as np

F8: Final = "f8"
I8: Final = "i8"
U8: Final = "u8"  # body rows in hot loops: numba wraps signed indices, at a cost per visit
Field = tuple[str, str]

# Shape kinds, as stored in BODY.shape.
PLANE: Final = 0
SPHERE: Final = 1
BOX: Final = 2
CAPSULE: Final = 3
CYLINDER: Final = 4
HULL: Final = 5
COMPOUND: Final = 6
ELLIPSOID: Final = 7
BOWL: Final = 8
DRUM: Final = 9
MESH: Final = 10
CONE: Final = 11
CAVITIES: Final = frozenset({"bowl", "drum"})  # shapes that other bodies are inside of
ROPE_END: Final = -1  # where a rope or a joint is on a body: `collide.rope`, `collide.joint`

# PAIR.kind of what no two shapes are: those of shapes are 0 and more, those of joints less than -2.
NO_PAIR: Final = -1  # two classes of bodies that never touch
ROPE: Final = -2  # the ends of a rope

# Surfaces closer than this touch [m]. Bodies placed face to face leave gaps of round-off size
# (1e-16 at 1 m, 1e-11 at 100 km); without it one corner of a box rests while another falls a step.
# Far above: bodies would hover visibly before they touch.
TOUCHING: Final = 1e-9


# Length of a part of a step that is an impact: forces have no time to act in it [s].
INSTANT: Final = 1e-12

# Why `advance` returned.
RUNNING: Final = 0
ROWS_FULL: Final = 1  # trace columns are full: hand them on and call again
CONTACTS_FULL: Final = 2  # contact rows are full: enlarge them and call again; the state is intact
PAIRS_FULL: Final = 4  # rows of pairs are full: likewise
WOKEN: Final = 5  # bodies woke up, the step begins again with them: call again
DIVERGED: Final = 3  # the run cannot go on; `counters.body` and `.cause` name the body and why
RAISED: Final = 6  # of a step called by its address: it raised, and does so again called by Python

# Why a run diverged.
NOT_FINITE: Final = 0  # the body's state is no longer finite
TURNS_TOO_FAST: Final = 1  # the body turns so far in a step that its rotation has no solution
INACCURATE: Final = 2  # no substep is short enough for the accuracy asked for

BODY: Final[list[Field]] = [
    ("x", F8),  # centre of mass [m]
    ("y", F8),
    ("z", F8),
    ("inv_m", F8),  # 1/mass [1/kg], 0 for fixed bodies
    ("shape", I8),  # its kind, see above
    # Plane: unit normal [-]. Box: half edge lengths [m]. Sphere: radius in hx [m]. Capsule and
    # cylinder: radius in hx, half length along the body's z in hz [m]. Cone: radius in hx, height
    # of the centre over the base in hz [m]. Bowl and drum: radius in hx [m]. Ellipsoid: semi-axes
    # [m]. Hull, compound and mesh: unused.
    ("hx", F8),
    ("hy", F8),
    ("hz", F8),
    ("offset", F8),  # plane: n . x of its points [m]; other shapes: unused
    ("bound", F8),  # radius of the bounding sphere about the centre of mass [m]; of a bowl
    # or a drum its own, of a mesh about its origin; plane: unused
]

# Orientation, where some shape but planes and spheres occurs, or something turns.
ORIENTED_BODY: Final[list[Field]] = [
    ("qw", F8),  # quaternion, body to world
    ("qx", F8),
    ("qy", F8),
    ("qz", F8),
    *[(f"r{row}{column}", F8) for row in range(3) for column in range(3)],  # the same as a matrix
]

HULL_BODY: Final[list[Field]] = [("hull", I8)]  # hulls: row of the hull tables

# Meshes: their first row of `collide.mesh_tables.MeshTables.nodes`, and the one behind their last.
MESH_BODY: Final[list[Field]] = [("first_node", I8), ("last_node", I8)]

VELOCITY: Final[list[Field]] = [("vx", F8), ("vy", F8), ("vz", F8)]  # of the centre of mass [m/s]
ANGULAR_VELOCITY: Final[list[Field]] = [("wx", F8), ("wy", F8), ("wz", F8)]  # [rad/s]

# A pair of bodies that may touch, ordered as the kernel of its shape pair takes them.
# Rows ascend in `key`, which names the two bodies whatever row they have.
PAIR: Final[list[Field]] = [("a", I8), ("b", I8), ("kind", I8), ("key", I8)]

# How a body turns by the middle of a step: pushed by what moves, restrained by what may not turn so
# (`gyroscopic.make_turn_midway`), or with a jump.
GIVES: Final = 0
RESTRAINED: Final = 1
JUMPS: Final = 2

# What a body did within a step, beside its velocity at the end.
MOTION: Final[list[Field]] = [
    ("vx", F8),  # velocity at the start of the step [m/s]
    ("vy", F8),
    ("vz", F8),
    ("wx", F8),  # angular velocity at the start [rad/s]
    ("wy", F8),
    ("wz", F8),
    ("dvx", F8),  # change of velocity by forces [m/s]
    ("dvy", F8),
    ("dvz", F8),
    # Change of velocity that foreseen impacts reckon with: by forces, or as in the last part [m/s]
    ("ahead_x", F8),
    ("ahead_y", F8),
    ("ahead_z", F8),
    ("tau", F8),  # time of its first impact, from the start of the step; dt without one [s]
    ("jumps", I8),  # 1: a contact that does not last pushes it, or what jumps (`midpoint_jumps`)
    ("carried", I8),  # by a contact. 0: free; else AFTERWARDS, ALWAYS, LASTING: see `integrate`
    ("midway", I8),  # whether impulses at the middle of the step changed its velocity: `integrate`
    ("unparted", I8),  # 1: its joints stayed together at the last middle
    ("restrained", I8),  # 1: by a joint, a spring or what does not move; where midway is 1
    ("mean_x", F8),  # mean spin of the step, where midway is 1 [rad/s]
    ("mean_y", F8),
    ("mean_z", F8),
    ("in_impact", I8),  # 1: it takes part in the impact of an instant
    ("reach", F8),  # farthest a point of it moves in the step [m]
]

CONTACT: Final[list[Field]] = [
    ("pair", I8),  # row of the pair table
    ("key", I8),  # of the pair: the same two bodies have the same key in every step
    ("a", U8),
    ("b", U8),
    ("feature", I8),  # which vertices, edges, faces made the point; equal while they do
    ("x", F8),  # contact point, half way between the surfaces [m]
    ("y", F8),
    ("z", F8),
    ("nx", F8),  # unit normal from A to B
    ("ny", F8),
    ("nz", F8),
    ("phi", F8),  # signed separation, negative inside [m]
    ("lambda_n", F8),  # accumulated impulse on B along n, A gets the opposite [N s]
    ("inv_m_a", F8),
    ("inv_m_b", F8),
    ("k_n", F8),  # inverse effective mass along n [1/kg]
    ("v_n_pre", F8),  # normal velocity of B relative to A before the solve [m/s]
    ("target", F8),  # b + b_rest: the row asks v_n + target + gamma lambda >= 0 [m/s]
    ("inv_k", F8),  # 1/(k_n + gamma) [kg]
]

# A point ahead that a part of a step has no row of.
OVERLOOKED: Final[list[Field]] = [
    ("pair", I8),  # row of the pair table
    ("a", I8),
    ("b", I8),
    ("waits", I8),  # 1: its row waits for a later part; 0: its manifold was reduced
    ("x", F8),  # half way between the surfaces [m]
    ("y", F8),
    ("z", F8),
    ("nx", F8),  # unit normal from A to B
    ("ny", F8),
    ("nz", F8),
    ("phi", F8),  # [m]
]

# A part of a step that is made again, and has not been: there was no room (`overlooked_points`).
UNMADE: Final[list[Field]] = [
    ("again", I8),  # 1: there is one
    ("listed", I8),  # pairs
    ("longest", F8),  # it may be [s]
]

# Position and orientation, quaternion w x y z.
POSE: Final[list[Field]] = [(name, F8) for name in ("x", "y", "z", "qw", "qx", "qy", "qz")]

# A function of time that acts on a body, by its `Terms` (`effects.time_functions`); an effect adds
# what it drives.
DRIVE: Final[list[Field]] = [
    ("body", I8),
    ("first", I8),  # of its knots
    ("count", I8),
    ("slope", F8),  # behind the last knot [1/s]
    ("amplitude", F8),  # of its sine [-]
    ("omega", F8),  # [rad/s]
    ("phase", F8),  # [rad]
    ("begin_step", I8),  # steps that are done when it begins to act, and when it ends
    ("end_step", I8),
]
KNOT: Final[list[Field]] = [("time", F8), ("value", F8)]  # [s], [-]

# A state that makes an event happen (`effects.triggers`).
TRIGGER: Final[list[Field]] = [
    ("condition", I8),
    ("a", I8),  # the body, or two that touch
    ("b", I8),
    ("x", F8),  # unit direction of a place, world frame [-]
    ("y", F8),
    ("z", F8),
    ("value", F8),  # [m/s] of a speed, [m] of a place
    ("touched", I8),  # 1 once the two bodies have touched
    ("met", I8),  # 1 once the state was met
]

# When the timestep last changed: after how many steps, and at what time. Effects declare it that
# count the time of a step.
STRETCH: Final[list[Field]] = [("stretch_step", I8), ("stretch_begin", F8)]

# Two bodies that an effect joins; it adds what it keeps of them.
LINK: Final[list[Field]] = [("a", I8), ("b", I8), ("active", I8)]  # 0 once one of them is removed

# Angular parts of a row: the lever r x n of each body and what a unit impulse does to its omega.
LEVER: Final[list[Field]] = [
    *[(f"lever_{body}{axis}", F8) for body in "ab" for axis in "xyz"],  # r x n [m]
    *[(f"turn_{body}{axis}", F8) for body in "ab" for axis in "xyz"],  # I^-1 (r x n) [1/(kg m)]
]

# One candidate point of a manifold, before it becomes a contact.
POINT: Final[list[Field]] = [
    ("x", F8),
    ("y", F8),
    ("z", F8),
    ("phi", F8),
    ("feature", I8),
    ("in_line", I8),  # polygon clipping: the lines that meet in this vertex
    ("out_line", I8),
]

PARAMETERS: Final[list[Field]] = [
    ("dt", F8),  # timestep; within a step the length of the part that is being made [s]
    ("timestep", F8),  # of the step that is being made, all its parts [s]
    ("gx", F8),  # gravity [m/s^2]
    ("gy", F8),
    ("gz", F8),
    ("stabilisation_gain", F8),  # beta [-]
    ("slop", F8),  # penetration left alone [m]
    ("projection", F8),  # share of (d - slop) removed per step [-]
    ("restitution_speed", F8),  # approach speed above which restitution applies [m/s]
    ("tolerance", F8),  # residual at which sweeping stops [m/s]
    ("sleep_speed", F8),  # no point of a body at rest is faster [m/s]
    ("sleep_time", F8),  # for which a body is at rest before it sleeps [s]
    ("cache_distance", F8),  # farthest a contact point may have moved to keep its impulse [m]
    ("cache_normal_cosine", F8),  # least cosine between old and new normal [-]
    ("residuals_from", I8),  # first and last step whose sweeps are written
    ("residuals_to", I8),
    ("sweeps", I8),
    ("over_relaxation", F8),  # factor on the changes that sweeps make, 0 to 2 [-]
    ("projection_sweeps", I8),
]

COUNTERS: Final[list[Field]] = [
    ("started", I8),  # 1 once the initial state is recorded
    ("elapsed", F8),  # of a step that is made in parts, so far [s]
    ("parts", I8),  # made of it so far
    ("spent", I8),  # rows of contacts that they had
    ("unordered", I8),  # 1 when its impacts are no longer made in order
    ("plastic", I8),  # 1 when nothing of it rebounds any more
    ("met_a", I8),  # the two bodies whose meeting ended the last of them before its time,
    ("met_b", I8),
    ("met_at", F8),  # and when, of the step [s]
    ("part_sweeps", I8),  # sums over its parts: of sweeps,
    ("part_not_converged", I8),  # whether one did not converge,
    ("part_unordered", I8),  # whether impacts of one were left without order,
    ("part_stronge", I8),  # and whether Stronge's law replaced Newton's in one
    ("substeps", I8),  # of the step so far, see `step_doubling`
    ("rejected", I8),  # substeps that were taken back
    ("shortest", F8),  # length of the shortest [s]
    ("estimated_error", F8),  # sum of theirs, relative [-]
    ("step", I8),  # steps done since the start
    ("contacts", I8),  # rows in use, this step
    ("cached", I8),  # rows in use in the cache
    ("cached_dt", F8),  # timestep the cached impulses belong to [s]
    ("sweeps", I8),  # sweeps spent in the last step
    ("stronge", I8),  # 1 when Stronge's law replaced Newton's in the last step
    # Calls in the step that took all their iterations (`collide.iteration_limits`); impacts whose
    # integration took all its parts (`stronge`).
    ("gjk_not_converged", I8),
    ("epa_not_converged", I8),
    ("ascent_not_converged", I8),
    ("advance_not_converged", I8),
    ("impact_not_converged", I8),
    ("stronge_not_converged", I8),
    # And fixed points that were not found within their passes (`midpoint_passes`,
    # `effects.gyroscopic`, `spring_midpoint`, `solvers.newton.least_norm`).
    ("midpoint_not_converged", I8),
    ("gyroscopic_not_converged", I8),
    ("spring_not_converged", I8),
    ("least_norm_not_converged", I8),
    ("newton_steps", I8),  # of Newton's method since the start
    ("unchosen", F8),  # changes by sweeps since impulses were of least norm [m/s]
    ("chosen", F8),  # the largest impulse then, as the velocity it gives [m/s]
    ("sharpen", I8),  # 1 when the next solve must end sharper than its tolerance
    ("projection_sweeps", I8),  # and by the positional projection, 0: nothing had to move
    ("residual_contact", I8),  # contact with the largest residual, -1 without contacts
    ("residual", F8),  # of the last step [m/s]
    ("not_converged", I8),  # 1 when that is above the tolerance asked for
    ("rows", I8),  # contacts of the last step that were recorded
    ("residual_row", I8),  # the one of them with the largest residual
    ("signorini", F8),  # largest violations of the last step, and the recorded contact, -1: none
    ("signorini_contact", I8),
    ("cone", F8),
    ("cone_contact", I8),
    ("dissipation", F8),
    ("dissipation_contact", I8),
    ("contact_energy", F8),  # that contacts store at the end of the last step [J]
    ("body", I8),  # body that diverged
    ("cause", I8),  # NOT_FINITE, TURNS_TOO_FAST or INACCURATE
    ("step_rows", I8),  # trace rows written since the caller emptied the columns
    ("contact_rows", I8),
    ("residual_rows", I8),
]


def dtype(*groups: Iterable[Field]) -> np.dtype:
    """Join field groups into one aligned record type; a field named twice is taken once."""
    fields: dict[str, str] = {}
    for group in groups:
        for name, kind in group:
            fields.setdefault(name, kind)
    return _dtype(tuple(fields.items()))


@cache
def _dtype(fields: tuple[Field, ...]) -> np.dtype:
    import numpy as np  # declarations of effects load without it

    return np.dtype(list(fields), align=True)
