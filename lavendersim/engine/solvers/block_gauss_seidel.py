"""Projected Gauss-Seidel by contact blocks: a contact's normal and disc in one packed visit.

The sweeps of `projected_gauss_seidel`, to round-off, on contacts that are packed once a solve
(`packed`). That pays from some three sweeps on. Elsewhere (without friction, another cone than the
disc, what resists turning, sweeps that are over-relaxed or go there and back) the sweeps are those
of `projected_gauss_seidel` over the records, to the bit.
"""

from __future__ import annotations

from typing import Any

from ..spec import Spec
from . import projected_gauss_seidel
from .iteration import Iteration
from .packed.layout import allocate_packed
from .packed.sweep import are_blocks, can_pack, make_packed_iteration
from .solver import Solver, no_workspace


def _packs(spec: Spec) -> bool:
    return are_blocks(spec) and can_pack(spec)


def allocate(spec: Spec, bodies: int, contacts: int) -> Any:
    """Return the arrays this solver works in."""
    if not _packs(spec):
        return no_workspace(spec, bodies, contacts)
    return allocate_packed(spec, bodies, contacts, eight=False)


def make(spec: Spec) -> Iteration:
    """Return the sweeps over packed contacts, or those of `projected_gauss_seidel`."""
    if _packs(spec):
        return make_packed_iteration(spec, eight=False)
    return projected_gauss_seidel.make(spec)


SOLVER = Solver(name="block_gauss_seidel", iteration=make, allocate=allocate)
