"""In a resting stack every layer carries exactly the weight of the blocks above it."""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config

BLOCKS = 6
MASS = 1.0
STACK = (
    """
scene:
  bodies:
    floor: {shape: {kind: plane}}
"""
    + "".join(
        f"    block_{k}: {{shape: {{kind: box, size: [0.2, 0.2, 0.2]}}, mass: {MASS}, "
        f"position: [0, 0, {0.1 + 0.2 * k:.1f}]}}\n"
        for k in range(BLOCKS)
    )
    + """
numerics: chapter
duration: 2.0
"""
)


@pytest.fixture(scope="module")
def stack() -> Course:
    (course,) = run_config(STACK)
    return course


def test_each_layer_carries_the_blocks_above_it(stack: Course) -> None:
    last = stack.step[-1]
    # A row misses v_n = 0 by at most the residual, so a block's velocity changes by no more than
    # twice that per step; a layer carries the errors of the blocks above it.
    residual = float(last["residual"])
    assert residual < 1e-5, "the stack was to come to rest"
    tolerance = BLOCKS * MASS * 2 * residual / stack.dt  # 0.03 N at most, of 58.86 N
    names = ["floor", *(f"block_{k}" for k in range(BLOCKS))]
    for layer in range(BLOCKS):
        rows = stack.contacts_of(names[layer], names[layer + 1])
        force = rows["force_n"][rows["step"] == last["step"]]
        assert len(force) == 4
        carried = (BLOCKS - layer) * MASS * GRAVITY
        assert force.sum() == pytest.approx(carried, abs=tolerance), f"layer {layer}"


def test_all_layers_together_are_the_total_normal_force(stack: Course) -> None:
    # 6 + 5 + 4 + 3 + 2 + 1 blocks; every step's sum is that of its own contacts.
    total = stack.step["total_normal_force"]
    per_step = np.bincount(stack.contact["step"], stack.contact["force_n"], len(total))
    assert total == pytest.approx(per_step, rel=1e-14)
    assert total[-1] == pytest.approx(21 * MASS * GRAVITY, rel=1e-3)
