"""Calls of the engine come to take a part of a second, whatever a step costs."""

from __future__ import annotations

import pytest

from lavendersim.runner.call_length import CALL, GROWTH, MOST, CallLength, block_steps

COSTS = (1e-9, 1e-7, 1e-5, 1e-3, 0.02, 0.2, 3.0)  # [s] of a step


@pytest.mark.parametrize("bodies", [0, 1, 30, 1000, 10**6])
@pytest.mark.parametrize("cost", COSTS)
def test_calls_come_to_take_a_part_of_a_second(cost: float, bodies: int) -> None:
    """From the first guess, growing by GROWTH: within log(MOST) / log(GROWTH) + 1 = 5 calls."""
    calls = CallLength(bodies)
    for _ in range(5):
        assert 1 <= calls.steps <= MOST
        calls.after(calls.steps, calls.steps * cost)
    assert calls.steps * cost <= max(CALL, cost)
    assert calls.steps == MOST or (calls.steps + 1) * cost > CALL * (1.0 - 1e-9)


def test_a_scene_that_becomes_dear_is_noticed_after_one_call() -> None:
    calls = CallLength(1)
    calls.after(calls.steps, 1e-4)
    calls.after(calls.steps, calls.steps * 0.1)
    assert calls.steps == int(CALL / 0.1)


def test_a_call_without_a_step_or_without_time_changes_little() -> None:
    calls = CallLength(1)
    before = calls.steps
    calls.after(0, 5.0)
    assert calls.steps == before
    calls.after(16, 0.0)
    assert calls.steps == 16 * GROWTH


def test_an_engine_has_room_for_its_run_and_no_more() -> None:
    assert block_steps(10, 3) == 11
    assert block_steps(10**6, 1) == MOST
    assert block_steps(10**6, 10**4) == 64  # few as the poses of a step are many
