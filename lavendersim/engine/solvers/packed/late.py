"""Sweeps that pack contacts once a solve has turned out to be a long one of many contacts.

Many contacts are packed before the first sweep, and while the end is far sweeps follow each other
run by run (`sweep.make_sweep_together`): what is packed then comes from memory once for several.

Packing costs about as much as two sweeps over the records save. Most steps of bodies at rest end
after one or two, so those go over the records, and contacts are packed when more follow. Few
contacts stay in the records: eight of a colour are rare among them.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

from ...compile import kernel
from ...effects import has_hook
from ...slabs import FEWEST_CONTACTS as MANY
from ...spec import Spec
from ..sweep import make_sweep
from .layout import TOGETHER
from .sweep import can_pack, make_pack, make_sweep_packed, make_sweep_together, make_unpack

# Sweeps over the records before contacts are packed.
FIRST = 2
# Contacts from which on they are packed; with fewer an engine that packs has the bits of any other.
FEWEST_CONTACTS = 128
# Sweeps follow each other while their changes are so many times the aim: no few of them reach it.
FAR = 1000.0


def packs_late(spec: Spec) -> bool:
    """Whether long solves of this engine pack their contacts."""
    return spec.has("packed_sweeps") and spec.solver == "adaptive" and can_pack(spec)


class Packing(NamedTuple):
    """Where the contacts of a solve are."""

    first: int  # sweeps over the records that are left
    slots: int  # of packed contacts, idle lanes included; 0: they are in the records alone
    ahead: int  # sweeps that are made and not counted yet


def make_sweep_late(spec: Spec) -> tuple[Any, Any]:
    """Return kernels that sweep, and that put impulses and velocities back into the records.

    kernel(system, packed, params, packing, most, far) -> (greatest change [m/s], or infinity where
    more sweeps are made already, change, packing); begins with `Packing(FIRST, 0, 0)`. most: sweeps
    until somebody looks; far: whether the end is.
    kernel(system, packed, packing): packed contacts stay as they are.
    """
    sweep, sweep_packed = make_sweep(spec), make_sweep_packed(spec, eight=True)
    pack, unpack = make_pack(spec, eight=True), make_unpack(spec, eight=True)
    sweep_together = make_sweep_together(spec)
    looks_at_each = has_hook(spec, "sweep_row")

    def sweep_late(system, packed, params, packing, most, far):
        count, slots, ahead = system.count, packing.slots, packing.ahead
        if count < FEWEST_CONTACTS or (packing.first > 0 and count < MANY):
            change = sweep(system, params)
            return change, change, Packing(packing.first - 1, 0, 0)
        if slots == 0:
            slots = pack(system, packed)
        if ahead == 0:
            sweeps = min(most, TOGETHER)
            if not far or count < MANY or sweeps < 2:
                change = sweep_packed(packed, slots)
                return change, change, Packing(0, slots, 0)
            if not looks_at_each:
                sweep_together(packed, slots, sweeps)
            ahead = sweeps
        # Who records each sweep has them one by one. They count as made together all the same: what
        # ends a solve, and what it begins from (`extrapolation`), is what it is without a record.
        if looks_at_each:
            change = sweep_packed(packed, slots)
        else:
            change = packed.changes[ahead - 1]
        return inf if ahead > 1 else change, change, Packing(0, slots, ahead - 1)

    def put_back(system, packed, packing):
        if packing.slots > 0:
            unpack(system, packed)

    return kernel(sweep_late, spec), kernel(put_back, spec)
