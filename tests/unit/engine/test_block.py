"""How rows are handed on, and how often memory had to grow, changes no bit of them."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, Rows, box, plane, resolved

STEPS = 60


def heap():
    """Boxes that land one after the other: the number of contacts grows while they fall."""
    bodies = {"floor": plane(restitution=0.3)}
    for i in range(5):
        place = (0.05 * i, -0.03 * i, 0.26 + 0.55 * i)
        bodies[f"box_{i}"] = box((0.5, 0.5, 0.5), place, velocity=(0.0, 0.0, -3.0))
    return resolved(bodies, (0.0, 0.0, -9.81), stabilisation_gain=0.02, projection=0.2, slop=0.001)


def run(block_steps: int = 512, capacity: int | None = None) -> Rows:
    bench = Bench(heap(), block_steps=block_steps)
    if capacity:
        state = bench.engine.state
        bench.engine.state = state._replace(cache=state.cache[:0])
        bench.engine._grow_contacts(capacity)
    rows = bench.run(STEPS)
    assert bench.status == 0
    return rows


@pytest.fixture(scope="module")
def whole() -> Rows:
    return run(capacity=4096)


def assert_same(rows: Rows, expected: Rows) -> None:
    for found, correct in zip(rows, expected, strict=True):
        assert found.tobytes() == correct.tobytes()


@pytest.mark.parametrize("block_steps", [1, 2, 7, 61, 512])
def test_rows_do_not_depend_on_the_block_they_come_in(whole, block_steps):
    assert_same(run(block_steps), whole)


@pytest.mark.parametrize("block_steps", [1, 7, 512])
@pytest.mark.parametrize("capacity", [1, 3])
def test_rows_do_not_depend_on_how_often_contacts_had_to_grow(whole, block_steps, capacity):
    assert whole.step["contact_count"].max() > 12
    assert_same(run(block_steps, capacity), whole)


def test_the_first_row_is_the_initial_state_and_every_step_has_one(whole):
    np.testing.assert_array_equal(whole.step["step"], np.arange(STEPS + 1))
    assert whole.step["contact_count"][0] == 0
    counts = np.bincount(whole.contact["step"], minlength=STEPS + 1)
    np.testing.assert_array_equal(counts, whole.step["contact_count"])


def test_sweeps_raised_during_a_run_find_room_for_their_residuals():
    bench = Bench(heap(), block_steps=1)
    bench.run(2)
    bench.engine.parameters["sweeps"] = 500
    rows = bench.run(1)
    assert len(rows.residual) == 501


def test_a_block_holds_at_least_one_step():
    assert_same(run(0), run(1))
