"""Sweeps that threads share have the bits of one thread, and pieces side by side share no body."""

from __future__ import annotations

import time
from functools import partial
from itertools import combinations, pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from interpreted import interpreted
from packed_scenes import BLOCKS, found

from lavendersim.engine.atomics import CAN_WAIT
from lavendersim.engine.compile import inner
from lavendersim.engine.solvers.packed import late, packing, sweep, team_sweeps
from lavendersim.engine.solvers.packed.lane_memory import STRIDE
from lavendersim.engine.solvers.packed.lanes import WIDTH
from lavendersim.engine.solvers.packed.layout import HEAD
from lavendersim.engine.solvers.packed.members import packed_of, serve_for
from lavendersim.engine.spec import Spec
from lavendersim.engine.team import MEMBERS, with_team
from tests.benchmarks.prepared_contacts import Solve

threaded = pytest.mark.skipif(not CAN_WAIT, reason="threads wait by what POSIX has")
BODIES, CONTACTS = 1000, 400  # of 16 movable bodies and 16 others one is the same in 23 %


def drawn(rng: np.random.Generator) -> SimpleNamespace:
    """Return groups of contacts as `packing` makes them: none has a movable body twice."""
    first, second = np.zeros(8 * CONTACTS, np.int64), np.zeros(8 * CONTACTS, np.int64)
    slot, inside = 0, set[int]()
    for _ in range(CONTACTS):
        bodies = {int(i) for i in rng.integers(0, BODIES, 2)}
        if slot % WIDTH == 0:
            inside = set()
        elif bodies & inside:
            slot += -slot % WIDTH
            inside = set()
        inside |= bodies
        places = [(HEAD + i) * STRIDE for i in bodies] + [0]
        first[slot], second[slot] = places[:2]
        slot += 1
    groups = -(-slot // WIDTH)
    return SimpleNamespace(
        first=first,
        second=second,
        group_of=np.zeros(BODIES, np.int64),
        stages=np.zeros(CONTACTS + 1, np.int64),
        counts=np.zeros(1, np.int64),
        groups=groups,
    )


@pytest.mark.parametrize("fewest", [1, 2, 3])
def test_groups_of_a_shared_stage_share_no_movable_body(
    fewest: int, rng, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(team_sweeps, "FEWEST_GROUPS", fewest)
    monkeypatch.setattr(team_sweeps, "WORTH_IT", 1)
    packed = drawn(rng)
    interpreted(team_sweeps.make_find_stages(Spec()))(packed, packed.groups * WIDTH)
    count, stages = packed.counts[0], packed.stages
    assert count > 0
    begins = [int(stage) // 2 for stage in stages[: count + 1]]
    assert (begins[0], begins[-1]) == (0, packed.groups)
    shared = [bool(stage % 2) for stage in stages[:count]]
    assert any(shared)
    for (begin, end), dealt in zip(pairwise(begins), shared, strict=True):
        slots = [range(g * WIDTH, (g + 1) * WIDTH) for g in range(begin, end)]
        movable = [
            {int(i) for k in own for i in (packed.first[k], packed.second[k]) if i} for own in slots
        ]
        if dealt:
            assert end - begin >= fewest
            assert not any(a & b for a, b in combinations(movable, 2))
    assert not any(one == other == 0 for one, other in pairwise(shared))  # several are one piece


def test_a_sweep_with_little_to_share_is_left_alone(rng) -> None:
    packed = drawn(rng)
    packed.counts[0] = 5
    interpreted(team_sweeps.make_find_stages(Spec()))(packed, WIDTH)
    assert packed.counts[0] == 0


@pytest.mark.parametrize("reach", range(7))
@pytest.mark.parametrize("size", range(2, 6))
def test_runs_side_by_side_are_far_apart_and_each_is_one_members(reach: int, size: int) -> None:
    distance = interpreted(team_sweeps._distance)(reach, size)
    assert distance > reach
    # Of `size` sweeps at once each member has one: run and sweep leave all remainders.
    assert {k * distance % size for k in range(size)} == set(range(size))
    assert not any(np.gcd(near, size) == 1 for near in range(reach + 1, distance))


@inner
def always(trials, task):
    """Share every task, whatever it takes."""
    return True


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let small scenes have what large ones have."""
    for module in (packing, sweep, team_sweeps):
        monkeypatch.setattr(module, "RUN", 2)
    monkeypatch.setattr(team_sweeps, "FEWEST_GROUPS", 2)
    monkeypatch.setattr(team_sweeps, "WORTH_IT", 4)
    monkeypatch.setattr(team_sweeps, "is_worth_it", always)


def solved(threads: int, sweeps: int, solver: str) -> tuple[bytes, Any]:
    solve = Solve(found("many towers"), solver)
    packed = packed_of(solve.workspace)
    assert packed is not None
    serve, words = partial(serve_for(BLOCKS), packed), packed.team.words

    def run() -> int:
        while words[MEMBERS] < threads - 1:
            time.sleep(1e-4)
        return solve.run(sweeps)

    for _ in range(10):
        with_team(serve, words, threads, run)
    assert not words[MEMBERS]
    return solve.impulses.tobytes() + solve.velocities.tobytes(), packed


@threaded
@pytest.mark.parametrize("kind", ["stages", "runs", "coloured"])
def test_bits_are_those_of_one_thread(kind: str, small, monkeypatch: Any) -> None:
    solver = "coloured_gauss_seidel" if kind == "coloured" else "adaptive"
    if kind == "runs":
        monkeypatch.setattr(late, "MANY", late.FEWEST_CONTACTS)
    one, alone = solved(1, 20, solver)
    assert not alone.team.claims.any()
    for threads in (2, 3, 8):
        several, packed = solved(threads, 20, solver)
        assert several == one
        assert packed.team.claims.any()  # there was a fork
