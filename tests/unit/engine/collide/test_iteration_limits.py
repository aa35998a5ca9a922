"""GJK and EPA that run out of iterations are counted, and only those."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import solid_poses

from lavendersim.engine.collide import SHAPE_PAIRS, narrow_phase
from lavendersim.engine.collide.convex import epa, gjk
from lavendersim.engine.collide.convex.hull_geometry import hull_geometry
from lavendersim.engine.collide.iteration_limits import (
    has_advance,
    has_ascent,
    has_epa,
    has_gjk,
    has_limits,
)
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.compile import composing
from lavendersim.engine.spec import Spec

EVERYWHERE = 1e3  # margin [m] that leaves out no pose
AHEAD = ("speculative", "midpoint", "fast_bodies")
POSES = 300


@pytest.mark.parametrize("effects", [(), AHEAD[:1], AHEAD])
@pytest.mark.parametrize("pair", sorted(SHAPE_PAIRS))
def test_an_engine_counts_what_it_is_composed_of(pair: str, effects: tuple[str, ...]) -> None:
    spec = Spec(effects, (pair,))
    with composing() as composed:
        narrow_phase.make(spec)
    kernels = {name for _, name in composed}
    assert (has_gjk(spec), has_epa(spec)) == ("gjk" in kernels, "epa" in kernels)
    curved = not {"cylinder", "ellipsoid", "cone"}.isdisjoint(
        SHAPE_PAIRS[pair].shapes
    )  # of their cores
    assert has_ascent(spec) == (curved and "ascend" in kernels)
    assert has_advance(spec) == ("find_impact" in kernels)
    assert has_limits(spec) == any((has_gjk(spec), has_epa(spec), has_advance(spec)))


def counted(sample: Any, spec: Spec) -> tuple[list[Any], np.ndarray]:
    """Return the manifold of every pose, and for each how often (GJK, EPA) ran out."""
    found, counts = [], []
    for i in range(len(sample.first)):
        one = sample._replace(first=sample.first[i : i + 1], second=sample.second[i : i + 1])
        scratch = allocate_scratch(hull_geometry(sample.hulls))
        found += solid_poses.manifolds(one, EVERYWHERE, spec, scratch)
        row = scratch.not_converged[0]
        counts.append((int(row["gjk"]), int(row["epa"])))
    return found, np.array(counts)


@pytest.mark.parametrize("pair", [name for name in solid_poses.PAIRS if has_epa(Spec((), (name,)))])
def test_none_of_drawn_poses_runs_out(pair: str) -> None:
    for spread in (0.3, 1.3):  # deep in one another, and apart
        sample = solid_poses.random_sample(pair, POSES, spread=spread)
        scratch = allocate_scratch(hull_geometry(sample.hulls))
        solid_poses.manifolds(sample, EVERYWHERE, scratch=scratch)
        counts = scratch.not_converged[0]
        assert not any(int(counts[name]) for name in ("gjk", "epa"))
        # Ascents leave a share of 1.25 d/(r + d/4) a round: of deep overlaps some do not end.


@pytest.mark.parametrize(
    ("module", "budget", "few", "place", "spread"),
    [(gjk, "ROUNDS", 5, 0, 1.3), (epa, "EPA_VERTICES", 8, 1, 0.3)],
)
def test_who_runs_out_of_a_small_budget_is_counted_and_nobody_else(
    module: Any, budget: str, few: int, place: int, spread: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Who is not counted ended by the tolerance: a larger budget changes no bit of its manifold.

    Who is counted has found other points or another depth, but for the few that were done and
    would have known it in one more iteration.
    """
    sample = solid_poses.random_sample("hull_hull", 100, spread=spread)
    pair = Spec(("rotation",), ("hull_hull",))
    whole, none = counted(sample, pair._replace(solver="all iterations"))
    assert not none.any()
    monkeypatch.setattr(module, budget, few)
    found, counts = counted(sample, pair._replace(solver=f"few {budget}"))
    ran_out = counts[:, place] > 0
    assert not counts[:, 1 - place].any()
    assert 0 < ran_out.sum() < len(ran_out)  # a test of both
    equal = [
        np.array_equal(one.points, other.points) and np.array_equal(one.phi, other.phi)
        for one, other in zip(whole, found, strict=True)
    ]
    assert all(same for same, out in zip(equal, ran_out, strict=True) if not out)
    assert not all(same for same, out in zip(equal, ran_out, strict=True) if out)
