"""Sweeps that follow each other run by run are the same sweeps one after the other, to the bit."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from interpreted import interpreted
from packed_scenes import BLOCKS, found

from lavendersim.engine.solvers.packed import late, packing, sweep, team_sweeps
from lavendersim.engine.solvers.packed.lanes import WIDTH
from lavendersim.engine.solvers.packed.layout import TOGETHER
from lavendersim.engine.spec import Spec
from lavendersim.engine.team import allocate_team
from tests.benchmarks.prepared_contacts import Solve

RUN = 2  # groups, here


def visit(packed: Any, at: int, slot: int, own: int, most: Any) -> Any:
    """Stand for the update of eight contacts: another order of visits gives other states."""
    for k in range(slot, slot + WIDTH):
        a, b = packed.first[k], packed.second[k]
        change = 0.7 * (packed.state[b] - packed.state[a])
        packed.state[a] += change
        packed.state[b] -= 0.9 * change
        most = max(most, abs(change))
    return most


@pytest.fixture
def together(monkeypatch: pytest.MonkeyPatch) -> Any:
    kernel = SimpleNamespace(py_func=visit)
    monkeypatch.setattr(sweep, "_make_visit", lambda spec, eight: kernel)
    monkeypatch.setattr(sweep, "RUN", RUN)
    monkeypatch.setattr(sweep, "zeros", lambda: 0.0)
    monkeypatch.setattr(sweep, "lane", lambda x, k: x)
    monkeypatch.setattr(sweep, "greater", max)
    monkeypatch.setattr(team_sweeps, "load", lambda words, at: words[at])  # there is no team
    return interpreted(sweep.make_sweep_together(Spec()))


def chain(groups: int, near: int, rng: np.random.Generator) -> SimpleNamespace:
    """Return contacts in a row of bodies, each with one of the next so many, as far as a run."""
    slots = groups * WIDTH
    first = np.sort(rng.integers(0, slots, slots))
    runs = np.arange(slots) // (WIDTH * RUN)
    second = first + rng.integers(1, near, slots)
    state = rng.normal(size=slots + near)
    reach = max(np.ptp(runs[(first == i) | (second == i)]) for i in {*first, *second})
    return SimpleNamespace(
        first=first,
        second=second,
        state=state,
        reach=np.array([reach]),
        changes=np.zeros(TOGETHER),
        team=allocate_team(0),
    )


@pytest.mark.parametrize("groups", [1, 9, 40])
@pytest.mark.parametrize("sweeps", range(1, TOGETHER + 1))
def test_the_bits_are_those_of_one_after_the_other(groups, sweeps, together, rng) -> None:
    packed = chain(groups, 30, rng)
    state, changes = packed.state.copy(), []
    alone = SimpleNamespace(**vars(packed) | {"state": state})
    for _ in range(sweeps):
        most = 0.0
        for g in range(groups):
            most = visit(alone, 0, g * WIDTH, 0, most)
        changes.append(most)
    together(packed, groups * WIDTH, sweeps)
    assert packed.state.tobytes() == state.tobytes()
    assert packed.changes[:sweeps].tolist() == changes[::-1]


def test_the_reach_is_needed(together, rng) -> None:
    """With one run less between sweeps some contact is visited before its time."""
    kept, hurried = (chain(40, 30, np.random.default_rng(1)) for _ in range(2))
    assert kept.reach[0] > 0
    hurried.reach[0] -= 1
    for packed in (kept, hurried):
        together(packed, 40 * WIDTH, TOGETHER)
    assert kept.state.tobytes() != hurried.state.tobytes()


def test_large_solves_are_packed_and_swept_together_to_the_bits_of_lanes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """From the first sweep on, and whatever number of sweeps a solve may make."""
    for module in (packing, sweep):
        monkeypatch.setattr(module, "RUN", RUN)
    monkeypatch.setattr(late, "MANY", late.FEWEST_CONTACTS)
    prepared = found("many towers")
    large, lanes = Solve(prepared, "adaptive"), Solve(prepared, "coloured_gauss_seidel")
    assert BLOCKS.order == "coloured"
    for sweeps in (1, 2, 3, 6, 20):
        large.run(sweeps)
        lanes.run(sweeps)
        assert large.sweeps == lanes.sweeps == sweeps
        assert large.impulses.tobytes() == lanes.impulses.tobytes()
        assert large.velocities.tobytes() == lanes.velocities.tobytes()
    assert large.workspace.packed.reach[0] > 0
    assert large.workspace.packed.changes.all()  # some were made together
