"""What a sweep reads of contacts and bodies, packed in the order in which it reads it.

A sweep over whole contact records fetches twice what it uses, from all over the table, and turns
every impulse into angular velocities by two 3x3 matrices. Packed, with I^-1 = L L^T per body,
    omega = omega_0 + L y,    (r x n) . omega = (r x n) . omega_0 + (L^T (r x n)) . y
three numbers of a body and an axis serve both ways: what y gives the row, and what an impulse gives
y. The state holds what the solve changes, v - v_0 and y; what v_0, omega_0 and targets give a row
is one number of it. Bodies that nothing moves have L = 0 and 1/m = 0: their state stays 0.

For visits of one contact at a time its numbers lie together. For visits of eight they lie by
groups of eight contacts, the eight of each field side by side; a group is a run of consecutive
contacts of the order, which ends before the first that shares a movable body with one of it, and is
filled up with contacts of all 0.

A contact has the fields that the engine's rows require: the block of a normal and a disc, behind it
those of torsion and of rolling; or, in scenes without friction, a normal alone.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from ...compile import kernel
from ...records import ANGULAR_VELOCITY, F8, VELOCITY, Field, dtype
from ...row_terms import row_terms
from ...spec import Spec
from ...team import MOST, TeamMemory, allocate_team
from .lane_memory import LINE, STRIDE, lines
from .lanes import WIDTH

# Fields of a block, in numbers. Axes of the contact, x y z each:
AXIS = 3
N, T1, T2 = range(0, 3 * AXIS, AXIS)
# L^T (r x axis) of body A, negative, and of body B, for the axes n, t1, t2.
TURN_A, TURN_B = 3 * AXIS, 6 * AXIS
# Fields of one number each. W_N, W_1, W_2: velocities without the solve's impulses, with targets.
(
    INV_M_A, INV_M_B, W_N, W_1, W_2, INV_K, K_N1, K_N2, I_11, I_12, I_22, INV_K_T, K_N, K_T, MU,
    GAMMA, LAMBDA_N, LAMBDA_1, LAMBDA_2,
) = range(9 * AXIS, 9 * AXIS + 19)  # fmt: skip
BLOCK = LAMBDA_2 + 1
# Impulses of a group of eight blocks.
GROUP = 3 * WIDTH
# Torsion, behind the block: L^T n of body A, negative, and of body B, and one number each.
TORSION_A, TORSION_B = 0, AXIS
W_TORSION, INV_TORSION, C_TORSION, PSI_N, TORSION_SPEED = range(2 * AXIS, 2 * AXIS + 5)
TORSION = TORSION_SPEED + 1
# Rolling, behind both: the same of t1, t2.
ROLL_A, ROLL_B = 0, 2 * AXIS
(
    W_ROLL_1, W_ROLL_2, H_11, H_12, H_22, INV_ROLL, C_ROLL, PSI_1, PSI_2, ROLL_SPEED,
) = range(4 * AXIS, 4 * AXIS + 10)  # fmt: skip
ROLL = ROLL_SPEED + 1
# A normal alone: n, what each body does about it, and one number each.
NORMAL, ARM_A, ARM_B = range(0, 3 * AXIS, AXIS)
(
    PER_MASS_A, PER_MASS_B, W_NORMAL, INV_K_NORMAL, K_NORMAL, SOFT, PRESSED,
) = range(3 * AXIS, 3 * AXIS + 7)  # fmt: skip
NORMAL_ALONE = PRESSED + 1
YIELDING = 1  # gamma along the surface, the last field of all
# Groups of a run, and sweeps that follow each other run by run (`sweep`).
RUN, TOGETHER = 64, 4
# Pieces that a team may be dealt out, at most, for each contact and beside: see `team_sweeps`.
MOST_PIECES, FEWEST_PIECES = 8, 1024
# Sweeps that the next may begin from (`extrapolation`).
DEPTH = 4
# Lines of the state before those of bodies: what nothing moves, which idle lanes have, too, what is
# written of it, and of each member of a team the same, two lines apart.
HEAD = 2 + 2 * MOST

# Velocity of a body when the solve begins [m/s], [rad/s], and the lower triangle of L.
START: Final[list[Field]] = [*VELOCITY, *ANGULAR_VELOCITY]
FACTOR: Final[list[Field]] = [(name, F8) for name in ("xx", "yx", "yy", "zx", "zy", "zz")]


class Begins(NamedTuple):
    """Where the parts behind a block begin, and where the fields end; absent parts have none."""

    torsion: int
    roll: int
    end: int


def begins(spec: Spec) -> Begins:
    """Return the fields of an engine's contacts, in numbers."""
    terms = row_terms(spec)
    if not terms.frictional:
        return Begins(NORMAL_ALONE, NORMAL_ALONE, NORMAL_ALONE)
    roll = BLOCK + (TORSION if terms.torsional else 0)
    end = roll + (ROLL if terms.rolling else 0)
    return Begins(BLOCK, roll, end + (YIELDING if terms.yielding else 0))


class KeptSweeps(NamedTuple):
    """The last sweeps by slots; vectors of all slots lie one after the other."""

    point: np.ndarray  # impulses with which the last sweep began [N s]
    led_to: np.ndarray  # impulses after each
    defects: np.ndarray  # the same, less those with which it began
    states: np.ndarray  # of bodies after each
    products: np.ndarray  # (DEPTH, DEPTH) of defects [kg m^2/s^2]
    equations: np.ndarray  # (DEPTH, DEPTH + 1) of the least squares
    shares: np.ndarray  # (DEPTH,) of each in the next beginning
    counts: np.ndarray  # (4,) int64, see `extrapolation`


class PackedContacts(NamedTuple):
    """Arrays of one solve."""

    rows: np.ndarray  # the fields of every contact or group
    first: np.ndarray  # (slots,) int64, where the state of body A begins
    second: np.ndarray  # the same of body B
    slot: np.ndarray  # (contacts,) int64, place of the contact visited k-th; by eights: 8 g + lane
    state: np.ndarray  # ((HEAD + bodies) * STRIDE,) v - v_0, 0, y, 0
    start: np.ndarray  # (bodies,) START: v_0, omega_0
    factor: np.ndarray  # (bodies,) FACTOR: L
    group_of: np.ndarray  # (bodies,) int64, last group with a contact of the body
    run_of: np.ndarray  # (bodies,) int64, first run of groups with a contact of it
    reach: np.ndarray  # (1,) int64, most runs from the first to the last with one movable body
    changes: np.ndarray  # (TOGETHER,) of sweeps made together, the last one first [m/s]
    stages: np.ndarray  # (contacts + 1,) int64, see `team_sweeps`
    counts: np.ndarray  # (1,) int64, of stages; 0: sweeps are not shared so
    team: TeamMemory
    kept: KeptSweeps  # of no contacts where no sweep is mixed


def stride(spec: Spec, eight: bool) -> int:
    """Return the numbers from one contact to the next, or from one group of eight to the next."""
    fields = begins(spec).end
    return fields * WIDTH if eight else _whole_lines(fields)


def allocate_packed(spec: Spec, bodies: int, contacts: int, eight: bool) -> PackedContacts:
    """Return the arrays for so many bodies and contacts; memory is taken when it is used."""
    slots = WIDTH * contacts if eight else contacts  # at worst each contact has its own group
    state, mixes = (HEAD + bodies) * STRIDE, eight and spec.has("anderson_acceleration")
    return PackedContacts(
        lines(contacts * stride(spec, eight)),
        np.zeros(slots, np.int64),
        np.zeros(slots, np.int64),
        np.zeros(contacts, np.int64),
        lines(state),
        np.zeros(bodies, dtype(START)),
        np.zeros(bodies, dtype(FACTOR)),
        np.zeros(bodies, np.int64),
        np.zeros(bodies, np.int64),
        np.zeros(1, np.int64),
        np.zeros(TOGETHER),
        np.zeros(contacts + 1, np.int64),
        np.zeros(1, np.int64),
        allocate_team(MOST_PIECES * contacts + FEWEST_PIECES),
        _allocate_kept(contacts * GROUP, state) if mixes else _allocate_kept(0, 0),
    )


def _allocate_kept(impulses: int, state: int) -> KeptSweeps:
    return KeptSweeps(
        lines(impulses),
        lines(DEPTH * impulses),
        lines(DEPTH * impulses),
        lines(DEPTH * state),
        np.zeros((DEPTH, DEPTH)),
        np.zeros((DEPTH, DEPTH + 1)),
        np.zeros(DEPTH),
        np.zeros(4, np.int64),
    )


def _whole_lines(numbers: int) -> int:
    return -(-numbers // LINE) * LINE


def make_place(spec: Spec, eight: bool, fields: int) -> Any:
    """Return `kernel(slot) -> where its fields begin in the rows`, of so many fields each."""
    alone, group = _whole_lines(fields), fields * WIDTH

    def place_alone(slot):
        return slot * alone

    def place_in_group(slot):
        return slot // WIDTH * group + slot % WIDTH

    return kernel(place_in_group if eight else place_alone, spec)
