"""The members of a team that share packed sweeps: their kernel, and which engines have them."""

from __future__ import annotations

from functools import cache
from typing import Any

from ...atomics import CAN_WAIT
from ...compile import compiling
from ...kernel_cache import cached
from ...spec import Spec
from .layout import PackedContacts, allocate_packed
from .team_sweeps import make_serve


def packed_of(workspace: Any) -> PackedContacts | None:
    """Return what a solver's workspace packs contacts into; None: it packs none."""
    own = isinstance(workspace, PackedContacts)
    packed = workspace if own else getattr(workspace, "packed", None)
    return packed if isinstance(packed, PackedContacts) and CAN_WAIT else None


@cache
def serve_for(spec: Spec) -> Any:
    """Return the kernel of `make_serve`, compiled."""
    kernel = cached(make_serve, spec)
    with compiling():  # here, and not in one of several threads
        kernel(allocate_packed(spec, 0, 0, eight=True))  # of no members: it returns at once
    return kernel
