"""Projected Gauss-Seidel that visits eight independent contacts at a time.

The order of sweeps colours the contacts (`ordering`): most of any eight that follow each other
share no movable body, and visiting them at once is visiting them in turn. So it gives the bits of
`block_gauss_seidel`, its scalar loop, and what that says of other engines holds here. Where a run
of the order is shorter, lanes are left idle: contacts that all share one movable body are visited
one by one, at the cost of eight.
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
    return allocate_packed(spec, bodies, contacts, eight=True)


def make(spec: Spec) -> Iteration:
    """Return the sweeps over packed contacts, or those of `projected_gauss_seidel`."""
    if _packs(spec):
        return make_packed_iteration(spec, eight=True)
    return projected_gauss_seidel.make(spec)


SOLVER = Solver(name="coloured_gauss_seidel", iteration=make, allocate=allocate)
