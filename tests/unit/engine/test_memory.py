"""Memory has the rows that a spec has use for and no other, and keeps what lasts as it grows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.engine import memory
from lavendersim.engine.record_layout import (
    allocate_bodies,
    allocate_pairs,
    allocate_velocities,
)
from lavendersim.engine.spec import Spec

BODIES, PAIRS, CAPACITY = 5, 7, 12
PLAIN = Spec(effects=("friction", "rotation"))


def state_of(spec: Spec, capacity: int = CAPACITY) -> memory.State:
    bodies, velocities = allocate_bodies(spec, BODIES), allocate_velocities(spec, BODIES)
    return memory.allocate_state(
        spec, bodies, velocities, allocate_pairs(spec, PAIRS), None, capacity
    )


def sizes(value: Any, name: str = "") -> dict[str, int]:
    """Return the length of every array, by its path."""
    if isinstance(value, np.ndarray):
        return {name: len(value)}
    if hasattr(value, "_fields"):
        parts = [sizes(getattr(value, part), f"{name}.{part}") for part in value._fields]
        return {key: length for part in parts for key, length in part.items()}
    return {}


# Arrays that an effect brings, and their rows where it is: by its definition in `memory`.
BROUGHT = {
    "warm_start": {".cache": CAPACITY},
    "projection": {".pseudo": BODIES},
    "midpoint": {".motion": BODIES},
    "speculative": {".motion": BODIES},
}
WORKED_IN = {
    "impact_order": {
        ".trial.bodies": 4, ".trial.velocities": 2, ".trial.contact": 1,
        ".contact_lists.first": BODIES, ".contact_lists.following": 2 * CAPACITY,
        ".contact_lists.listed": CAPACITY,
    },
    "contact_midpoint": {
        ".middle.poses": BODIES, ".middle.free": BODIES, ".middle.lead": BODIES,
        ".middle.rounds.point": 6 * BODIES, ".middle.rounds.defect": 6 * BODIES,
        ".middle.rounds.last_point": 6 * BODIES, ".middle.rounds.last_defect": 6 * BODIES,
    },
    "sleeping": {".islands": BODIES},
    "problem_log": {".free_velocities": BODIES},
}  # fmt: skip


@pytest.mark.parametrize("effect", BROUGHT)
def test_a_state_has_the_rows_of_an_effect_only_with_it(effect: str) -> None:
    without, with_it = sizes(state_of(PLAIN)), sizes(state_of(PLAIN.including(effect)))
    for name, rows in BROUGHT[effect].items():
        assert (without[name], with_it[name]) == (0, rows)
    others = set(without) - set(BROUGHT[effect])
    assert {name: without[name] for name in others} == {name: with_it[name] for name in others}
    assert without[".contacts"] == CAPACITY


@pytest.mark.parametrize("effect", WORKED_IN)
def test_a_workspace_has_the_rows_of_an_effect_only_with_it(effect: str) -> None:
    both = []
    for spec in (PLAIN, PLAIN.including(effect)):
        state = state_of(spec)
        both.append(sizes(memory.allocate_workspace(spec, state, None, None)))
    for name, rows in WORKED_IN[effect].items():
        assert (both[0][name], both[1][name]) == (0, rows)
    others = set(both[0]) - set(WORKED_IN[effect])
    assert {name: both[0][name] for name in others} == {name: both[1][name] for name in others}
    assert both[0][".ordering.order"] == CAPACITY
    assert both[0][".ordering.colour_mask"] == BODIES


def test_a_broad_phase_has_its_templates_and_room_for_all_pairs() -> None:
    templates = np.zeros((2, 2))
    plain = memory.allocate_workspace(PLAIN, state_of(PLAIN), None, templates)
    assert (plain.templates, plain.broad_phase) == ((), ())
    near = PLAIN.including("broad_phase")
    found = memory.allocate_workspace(near, state_of(near), None, templates)
    assert found.templates is templates
    assert len(found.broad_phase.found.first) == PAIRS
    assert len(found.broad_phase.fat_bounds) == BODIES


@pytest.mark.parametrize("capacity", [CAPACITY, 3 * CAPACITY])
def test_room_for_more_contacts_keeps_the_cached_impulses(capacity: int) -> None:
    spec = PLAIN.including("impact_order", "warm_start")
    state = state_of(spec)
    state.cache["lambda_n"] = np.arange(CAPACITY) + 1.0
    grown = memory.with_contacts(spec, state, capacity)
    assert len(grown.contacts) == len(grown.cache) == capacity
    expected = [*(np.arange(CAPACITY) + 1.0), *[0.0] * (capacity - CAPACITY)]
    np.testing.assert_array_equal(grown.cache["lambda_n"], expected)
    assert grown.bodies is state.bodies
    before = memory.allocate_workspace(spec, state, None, None)
    after = memory.for_contacts(spec, before, grown)
    assert len(after.ordering.order) == capacity
    assert len(after.contact_lists.following) == 2 * capacity
    assert after.trial is before.trial
    plain = memory.with_contacts(PLAIN, state_of(PLAIN), capacity)
    assert (len(plain.contacts), len(plain.cache)) == (capacity, 0)


@pytest.mark.parametrize(("steps", "rows"), [(0, 0), (1, CAPACITY), (8, 2 * CAPACITY)])
def test_a_log_has_room_for_its_steps_and_at_least_one_full_one(steps: int, rows: int) -> None:
    poses = np.arange(7.0 * BODIES).reshape(BODIES, 7)
    log = memory.allocate_log(PLAIN, state_of(PLAIN), poses, steps, sweeps=6)
    assert (len(log.step), len(log.contact)) == (steps, rows)
    assert len(log.residual) == max(steps, 1) * 6
    assert log.pose.shape == (steps, BODIES, 7)
    assert (log.pose == poses).all()


def test_a_log_reads_poses_and_velocities_as_the_bits_they_are() -> None:
    spec = PLAIN.including("velocity_log")
    state = state_of(spec)
    log = memory.allocate_log(spec, state, np.ones((BODIES, 7)), 2, sweeps=1)
    assert log.pose.shape == (2, BODIES, 13)
    assert not log.pose[..., 7:].any()
    log.pose[1, 2, 3] = -0.0
    assert log.pose_bits[1, 2, 3] == 1 << 63
    state.velocities["vx"][3] = 1.0
    assert log.velocity_bits[3, 0] == 0x3FF0000000000000


def test_counters_begin_at_nothing_and_are_each_engine_s_own() -> None:
    one, other = memory.allocate_counters(), memory.allocate_counters()
    none = {name for name in one.dtype.names if one[name][0] == -1}
    assert none == {
        *(f"{part}_contact" for part in ("residual", "signorini", "cone", "dissipation")),
        "residual_row",
    }
    assert all(one[name][0] == 0 for name in set(one.dtype.names) - none)
    one["step"] = 5
    assert other["step"][0] == 0
