"""The greatest change of a sweep by eight is that of any of its lanes."""

from __future__ import annotations

from typing import Any

import numpy as np
from packed_scenes import BLOCKS

from lavendersim.engine.compile import kernel
from lavendersim.engine.solvers.packed import sweep
from lavendersim.engine.solvers.packed.lane_memory import take_eight
from lavendersim.engine.solvers.packed.lanes import WIDTH


def test_the_greatest_change_is_found_in_whichever_lane_it_is(monkeypatch: Any) -> None:
    def visit(numbers, at, slot, own, most):
        return take_eight(numbers, at)

    monkeypatch.setattr(sweep, "_make_visit", lambda spec, eight: kernel(visit, spec))
    greatest = sweep.make_sweep_groups(BLOCKS)
    for place in range(WIDTH):
        changes = np.linspace(0.1, 0.2, WIDTH)
        changes[place] = 0.5
        assert greatest(changes, 0, 1, 0) == 0.5
