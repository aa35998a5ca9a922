"""The contacts of bodies where they stand, without a step: what collision detection finds there.

Who judges a step of whatever engine asks for the points that may have pushed in it: those of all
pairs within the reach of their bodies.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from lavendersim.garbage import uncollected

from . import memory
from .collide import narrow_phase
from .collide.broad.broad_phase import allocate_broad_phase
from .collide.broad.images import most_images
from .compile import compiling, kernel
from .effects import made_once
from .engine import Engine
from .kernel_cache import cached
from .records import CONTACTS_FULL, PAIRS_FULL
from .spec import Spec


def make_find_contacts(spec: Spec) -> Any:
    """Compose `find_contacts(state, workspace, parameters) -> count`, or PAIRS_FULL, CONTACTS_FULL.

    The two are below 0 here. `state.motion["reach"]` says how far [m] each body is looked around.
    """
    compound, place_parts = made_once(spec, "place_parts")
    broad, find_pairs = made_once(spec, "find_pairs")
    collide: Any = narrow_phase.make(spec)

    def find_contacts(state, workspace, parameters):
        params = parameters[0]
        pull = workspace.collision.outline_a.pull
        pull[0], pull[1], pull[2] = params.gx, params.gy, params.gz
        if compound:
            place_parts(state.bodies)
        listed = state.pairs.shape[0]
        if broad:
            listed = find_pairs(
                state.bodies,
                state.velocities,
                state.pairs,
                workspace.templates,
                params,
                workspace.broad_phase,
            )
        if listed < 0:
            return -PAIRS_FULL
        count = collide(state, listed, workspace, params.dt)
        if count < 0:
            return -CONTACTS_FULL
        return count

    return kernel(find_contacts, spec)


@cache
def _kernel_of(spec: Spec) -> Any:
    with uncollected():
        return cached(make_find_contacts, spec)


def contacts_at_pose(engine: Engine) -> np.ndarray:
    """Return the records of the contacts of an engine's bodies where they stand now.

    A view that the next call overwrites. The engine needs `speculative`: its `state.motion` says
    how far around each body is looked.
    """
    if not engine.spec.touches:
        return engine.contacts[:0]
    find = _kernel_of(engine.spec)
    while True:
        with compiling():
            count = int(find(engine.state, engine.workspace, engine.parameters))
        if count == -PAIRS_FULL:
            _make_room_for_pairs(engine)
        elif count == -CONTACTS_FULL:
            capacity = 2 * len(engine.contacts)
            engine.state = memory.with_contacts(engine.spec, engine.state, capacity)
        else:
            return engine.contacts[:count]


def _make_room_for_pairs(engine: Engine) -> None:
    needed = int(engine.workspace.broad_phase.state["needed"][0])
    pairs = np.zeros(needed + needed // 4, engine.state.pairs.dtype)
    engine.state = engine.state._replace(pairs=pairs)
    near = allocate_broad_phase(len(engine.bodies), len(pairs), most_images(engine.bodies))
    engine.workspace = engine.workspace._replace(broad_phase=near)
