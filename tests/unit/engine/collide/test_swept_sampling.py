"""Random pairs meet when sampling their way finely says so, and those that pass are not stopped."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from sweeps import DT, Pair

from lavendersim.engine.records import TOUCHING
from tests.thorough import THOROUGH

ROUND_OFF = 1e-13  # of lengths of some metres [m]
ANY = 100.0  # margin [m]: whatever comes however near


def separation_of(name: str, pair: Pair, half_b, turn_a, turn_b, centre: np.ndarray) -> float:
    """Signed separation with B at `centre`, by the oracle; for boxes right in sign only."""
    a = np.array([pair.bodies[0][axis] for axis in ("hx", "hy", "hz")])
    if name == "sphere_sphere":
        return float(np.linalg.norm(centre)) - a[0] - half_b[0]
    box = convex.Box(np.zeros(3), turn_a, a)
    if name == "sphere_box":
        return convex.sphere_box_separation(box, centre, half_b[0])
    return convex.box_box_separation(box, convex.Box(centre, turn_b, np.array(half_b)))


@pytest.mark.parametrize(
    ("name", "count"),
    [("sphere_sphere", 300), ("sphere_box", 300), ("box_box", 60 if THOROUGH else 30)],
)
def test_meetings_are_those_of_fine_sampling(rng, name, count):
    """Random sizes, turns and ways of up to 3 m. Of 400 samples the first that overlaps lies behind
    the time found, the one before it ahead; a pair that never overlaps in a sample, and comes no
    nearer than half of what lies between two samples, has no contact."""
    samples, met, passed = np.arange(401) / 400, 0, 0
    for _ in range(count):
        half_a = np.exp(rng.uniform(-4.0, 0.0, 3)) if name != "sphere_sphere" else (0.3,)
        half_b = np.exp(rng.uniform(-3.0, -1.0, 3 if name == "box_box" else 1))
        turn_a, turn_b = convex.random_rotation(rng), convex.random_rotation(rng)
        start, aim = rng.normal(size=3), 0.4 * rng.normal(size=3)
        way = (aim - start) * rng.uniform(0.8, 3.0)
        pair = Pair(name, half_a, half_b, start, turn_a, turn_b).moves(1, way / DT)
        gaps = np.array(
            [separation_of(name, pair, half_b, turn_a, turn_b, start + t * way) for t in samples]
        )
        if gaps[0] <= 0.0:
            continue
        found, between = pair.sweep(), np.linalg.norm(way) / 400
        if (gaps < 0.0).any():
            met += 1
            first = int(np.argmax(gaps < 0.0))
            assert samples[first - 1] * DT - 1e-12 <= found.time <= samples[first] * DT + 1e-12
            gap = found.phi + found.v_n * found.time
            assert gap.min() <= 2.0 * TOUCHING
            assert gap.min() >= -TOUCHING
            assert found.v_n < 0.0
            assert found.phi.min() > 0.0
        elif gaps.min() > between:
            passed += 1
            assert len(found.phi) == 0
            kept = pair.sweep(ANY)
            assert len(kept.phi) > 0
            assert (kept.phi + kept.v_n * DT >= -ROUND_OFF).all()
            assert (kept.phi > 0.0).all()
    assert met > 0.2 * count
    assert passed > 0.2 * count
