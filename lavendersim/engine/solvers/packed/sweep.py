"""Gauss-Seidel sweeps over packed contacts: the updates of `row_update`, one at a time or eight.

A contact is a block of a normal and a disc (`blocks`), and what resists turning follows it
(`spins`); scenes without friction have rows of a normal alone (`normals`). One text serves both
widths: every lane makes the operations that a single contact makes, in the same order.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...compile import chain, kernel
from ...effects import made_once
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from ...team import SWEEP
from ..iteration import Iteration
from .blocks import make_pack_block, make_unpack_block, make_visit_block
from .lane_memory import STRIDE
from .lanes import WIDTH, greater, lane, zeros
from .layout import RUN, begins, stride
from .normals import make_pack_normal, make_unpack_normal, make_visit_normal
from .packing import make_pack_rows, make_unpack_rows
from .spins import make_pack_spins, make_unpack_spins
from .team_sweeps import make_share_following, make_share_sweep


def can_pack(spec: Spec) -> bool:
    """Whether sweeps over packed contacts do what those over the records of this engine do."""
    plain = not spec.over_relaxation and spec.order != "symmetric"
    captured_once = not made_once(spec, "recapture")[0]
    cones = spec.friction_cone == "disc" and not row_terms(spec).bilateral
    return plain and captured_once and cones and spec.operator == "bodies"


def are_blocks(spec: Spec) -> bool:
    """Whether contacts of this engine are blocks of a normal and a disc, and nothing else."""
    return row_terms(spec).frictional and not resists_turning(spec)


def make_pack(spec: Spec, eight: bool) -> Any:
    """Return `kernel(system, packed) -> slots`."""
    fields = begins(spec).end
    if not row_terms(spec).frictional:
        return make_pack_rows(spec, eight, make_pack_normal(spec, eight), fields)
    pack_contact = make_pack_block(spec, eight)
    if resists_turning(spec):
        pack_contact = chain([pack_contact, make_pack_spins(spec, eight)], spec)
    return make_pack_rows(spec, eight, pack_contact, fields)


def make_unpack(spec: Spec, eight: bool) -> Any:
    """Return `kernel(system, packed)`: impulses and velocities as the sweeps left them."""
    fields = begins(spec).end
    if not row_terms(spec).frictional:
        return make_unpack_rows(spec, eight, make_unpack_normal(spec, eight), fields)
    unpack_contact = make_unpack_block(spec, eight)
    if resists_turning(spec):
        unpack_contact = chain([unpack_contact, make_unpack_spins(spec, eight)], spec)
    return make_unpack_rows(spec, eight, unpack_contact, fields)


def _make_visit(spec: Spec, eight: bool) -> Any:
    if row_terms(spec).frictional:
        return make_visit_block(spec, eight)
    return make_visit_normal(spec, eight)


def make_sweep_groups(spec: Spec) -> Any:
    """Return `kernel(packed, first, last, own) -> greatest change` [m/s] of groups in turn.

    own: where what nothing moves would go (`lane_memory`).
    """
    visit, numbers = _make_visit(spec, True), stride(spec, True)

    def sweep_groups(packed, first, last, own):
        most = zeros()
        for g in range(first, last):
            most = visit(packed, g * numbers, g * WIDTH, own, most)
        greatest = lane(most, 0)
        for k in range(1, WIDTH):
            greatest = greater(lane(most, k), greatest)
        return greatest

    return kernel(sweep_groups, spec)


def make_sweep_packed(spec: Spec, eight: bool) -> Any:
    """Return `kernel(packed, slots) -> greatest change` [m/s]."""
    if eight:
        return make_share_sweep(spec, make_sweep_groups(spec), SWEEP)
    visit, numbers = _make_visit(spec, False), stride(spec, False)

    def sweep_singly(packed, slots):
        most = 0.0
        for k in range(slots):
            most = visit(packed, k * numbers, k, STRIDE, most)
        return most

    return kernel(sweep_singly, spec)


def make_sweep_together(spec: Spec) -> Any:
    """Return `kernel(packed, slots, sweeps)`: sweeps by eight, each run by run behind the last.

    No run shares a movable body with one that is more than `packed.reach` away, so the next sweep
    may visit a run as soon as the last one has visited those: to the same bits as one sweep after
    the other, and what is read is still near. Greatest changes go to `packed.changes`, the last
    sweep's first.
    """
    sweep_groups = make_sweep_groups(spec)

    def follow(packed, slots, sweeps):
        groups, behind, changes = slots // WIDTH, packed.reach[0], packed.changes
        runs = (groups + RUN - 1) // RUN
        for k in range(sweeps):
            changes[k] = 0.0
        for leading in range(runs + (sweeps - 1) * behind):
            for k in range(sweeps):
                run = leading - k * behind
                if 0 <= run < runs:
                    first, last = run * RUN, min((run + 1) * RUN, groups)
                    change = sweep_groups(packed, first, last, STRIDE)
                    changes[sweeps - 1 - k] = greater(change, changes[sweeps - 1 - k])

    return make_share_following(spec, sweep_groups, kernel(follow, spec))


class PackedCarry(NamedTuple):
    """What sweeps over packed contacts carry, see `iteration.Carry`."""

    aim: float
    slots: int  # contacts, idle lanes included


def make_packed_iteration(spec: Spec, eight: bool) -> Iteration:
    """Return the sweeps over packed contacts; for a `spec` that `can_pack`."""
    pack, unpack = make_pack(spec, eight), make_unpack(spec, eight)
    sweep = make_sweep_packed(spec, eight)

    def prepare(system, workspace, params, counters):
        return PackedCarry(params.tolerance, pack(system, workspace))

    def sweep_packed(system, workspace, params, counters, carry):
        return sweep(workspace, carry.slots), carry

    def finish(system, workspace, carry):
        unpack(system, workspace)

    return Iteration(
        kernel(sweep_packed, spec), prepare=kernel(prepare, spec), finish=kernel(finish, spec)
    )
