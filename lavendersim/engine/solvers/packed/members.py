"""The members of a team that share packed sweeps: their kernel, and which engines have them."""

from __future__ import annotations

from functools import cache
from typing import Any

from ...atomics import CAN_WAIT
from ...compile import compiling
from ...kernel_cache import cached
from ...spec import Spec
from .lanes import WIDTH
from .layout import PackedContacts, allocate_packed
from .team_sweeps import WORTH_IT, make_serve

# Contacts from which on a step may have a sweep that is worth sharing.
WORTH_SHARING = WIDTH * WORTH_IT


def packed_of(workspace: Any) -> PackedContacts | None:
    """Return what a solver's workspace packs contacts into; None: it packs none."""
    own = isinstance(workspace, PackedContacts)
    packed = workspace if own else getattr(workspace, "packed", None)
    return packed if isinstance(packed, PackedContacts) and CAN_WAIT else None


def shares_sweeps(spec: Spec) -> bool:
    """Whether an engine of this spec has sweeps that a team would share."""
    from ..catalogue import SOLVERS

    return packed_of(SOLVERS[spec.solver].allocate(spec, 0, 0)) is not None


@cache
def serve_for(spec: Spec) -> Any:
    """Return the kernel of `make_serve`, compiled."""
    kernel = cached(make_serve, spec)
    with compiling():  # here, and not in one of several threads
        kernel(allocate_packed(spec, 0, 0, eight=True))  # of no members: it returns at once
    return kernel
