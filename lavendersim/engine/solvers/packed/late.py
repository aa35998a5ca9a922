"""Sweeps that pack contacts once a solve has turned out to be a long one of many contacts.

Packing costs about as much as two sweeps over the records save. Most steps of bodies at rest end
after one or two, so those go over the records, and contacts are packed when more follow. Few
contacts stay in the records: eight of a colour are rare among them.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...compile import kernel
from ...spec import Spec
from ..sweep import make_sweep
from .sweep import can_pack, make_pack, make_sweep_packed, make_unpack

# Sweeps over the records before contacts are packed.
FIRST = 2
# Contacts from which on they are packed; with fewer an engine that packs has the bits of any other.
FEWEST_CONTACTS = 128


def packs_late(spec: Spec) -> bool:
    """Whether long solves of this engine pack their contacts."""
    return spec.has("packed_sweeps") and spec.solver == "adaptive" and can_pack(spec)


class Packing(NamedTuple):
    """Where the contacts of a solve are."""

    first: int  # sweeps over the records that are left
    slots: int  # of packed contacts, idle lanes included; 0: they are in the records alone


def make_sweep_late(spec: Spec) -> tuple[Any, Any]:
    """Return kernels that sweep, and that put impulses and velocities back into the records.

    kernel(system, packed, params, packing) -> (greatest change [m/s], packing); begins with
    `Packing(FIRST, 0)`.
    kernel(system, packed, packing): packed contacts stay as they are.
    """
    sweep, sweep_packed = make_sweep(spec), make_sweep_packed(spec, eight=True)
    pack, unpack = make_pack(spec, eight=True), make_unpack(spec, eight=True)

    def sweep_late(system, packed, params, packing):
        if packing.first > 0 or system.count < FEWEST_CONTACTS:
            return sweep(system, params), Packing(packing.first - 1, 0)
        slots = packing.slots
        if slots == 0:
            slots = pack(system, packed)
        return sweep_packed(packed, slots), Packing(0, slots)

    def put_back(system, packed, packing):
        if packing.slots > 0:
            unpack(system, packed)

    return kernel(sweep_late, spec), kernel(put_back, spec)
