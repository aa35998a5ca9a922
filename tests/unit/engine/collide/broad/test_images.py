"""The tree of a periodic cell lists each pair whose nearest images come near, once."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from interpreted import interpreted
from interpreted_steps import interpreted_bench
from laboratory import plane, planned, resolved, sphere

from lavendersim.engine.collide.broad.images import (
    ALL,
    most_images,
    periods_of,
    reaches_in,
    wrapped,
)
from lavendersim.engine.record_layout import body_dtype
from lavendersim.engine.spec import Spec

RADIUS = 0.08


def test_codes_name_every_image_once() -> None:
    found = {interpreted(periods_of)(code) for code in range(ALL)}
    assert found == {(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)}


@pytest.mark.parametrize(
    ("x", "half", "period", "image", "needed"),
    [
        (0.1, 0.2, 1.0, 1, True),
        (0.1, 0.05, 1.0, 1, False),
        (0.9, 0.2, 1.0, -1, True),
        (0.9, 0.2, 1.0, 1, False),
        (0.1, 0.2, 0.0, 1, False),
        (0.5, 0.2, 0.0, 0, True),
    ],
)
def test_an_image_counts_where_its_bounds_reach_into_the_cell(
    x: float, half: float, period: float, image: int, needed: bool
) -> None:
    assert bool(interpreted(reaches_in)(x, half, period, image)) == needed


def test_places_are_wrapped_where_there_is_a_period() -> None:
    assert interpreted(wrapped)(-0.25, 1.0) == 0.75
    assert interpreted(wrapped)(2.25, 1.0) == 0.25
    assert interpreted(wrapped)(-0.25, 0.0) == -0.25


def test_room_is_made_for_periodic_axes_alone() -> None:
    assert most_images(np.zeros(3, body_dtype(Spec()))) == 1
    bodies = np.zeros(3, body_dtype(Spec(("periodic_boundary",))))
    assert most_images(bodies) == 1
    bodies["period_x"][1:] = 2.0
    bodies["period_z"][1:] = 2.0
    assert most_images(bodies) == 9


def test_every_near_pair_has_one_row(rng) -> None:
    """Random balls, periods apart, over a plane; found by trying every pair and nearest image."""
    size = np.array([1.0, 1.5, 0.0])
    places = rng.uniform(0.0, 1.0, (40, 3)) + size * rng.integers(-2, 3, (40, 3))
    places[:, 2] += RADIUS
    bodies = {"floor": plane()}
    for k, place in enumerate(places):
        bodies[f"b{k}"] = sphere(RADIUS, place.tolist(), velocity=rng.normal(size=3).tolist())
    made = resolved(bodies)
    made["scene"]["periodic"] = {"x": [0.0, size[0]], "y": [0.0, size[1]]}
    bench = interpreted_bench(made, planned(made).spec.including("broad_phase"))
    bench.run(1)
    state = bench.engine.workspace.broad_phase.state[0]
    rows = bench.engine.state.pairs[: state["count"]]
    listed = [tuple(sorted((int(row["a"]), int(row["b"])))) for row in rows]
    assert listed == sorted(set(listed))
    near = set()
    for i, j in combinations(range(len(places)), 2):
        d = places[j] - places[i]
        d[:2] -= size[:2] * np.round(d[:2] / size[:2])
        if np.linalg.norm(d) <= 2.0 * RADIUS + 0.01:
            near.add((i + 1, j + 1))
    assert len(near) > 5
    assert near <= set(listed)
    between = [pair for pair in listed if pair[0] > 0]
    assert len(between) < 0.3 * len(places) * (len(places) - 1) / 2  # it leaves most of them out
