"""Arrangements: where their bodies stand, what they are called, and that they are distinct."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment, load_experiment_text

BRICK = "{shape: {kind: box, size: [0.3, 0.2, 0.1]}, mass: 1.0}"


def load(arrangement: str, more: str = "") -> Experiment:
    text = (
        "scene:\n  bodies:\n    floor: {shape: {kind: plane}}\n  arrangements:\n"
        f"    pile: {arrangement}\nduration: 1.0\n{more}"
    )
    return load_experiment_text(text, "pile.yaml")


def bodies(arrangement: str) -> dict[str, dict]:
    found = load(arrangement).cells()[0].config.as_dict()["scene"]["bodies"]
    assert next(iter(found)) == "floor"
    return {name: body for name, body in found.items() if name != "floor"}


def positions(arrangement: str) -> np.ndarray:
    return np.array([body["position"] for body in bodies(arrangement).values()])


def test_tower_stands_on_its_base_and_each_on_the_one_below() -> None:
    found = bodies(f"{{kind: tower, count: 4, base: [1, 2, 3], gap: 0.05, body: {BRICK}}}")
    assert list(found) == ["pile_1", "pile_2", "pile_3", "pile_4"]
    places = np.array([body["position"] for body in found.values()])
    # heights are products, not sums of sums: two roundings each
    expected = [[1, 2, 3 + 0.05 + 0.15 * k] for k in range(4)]
    np.testing.assert_allclose(places, expected, atol=1e-15)


def test_turned_bodies_stack_by_their_height_as_turned() -> None:
    stood = BRICK.replace("mass", "orientation: {axis: [0, 1, 0], degrees: 90}, mass")
    heights = positions(f"{{kind: tower, count: 3, body: {stood}}}")[:, 2]
    np.testing.assert_allclose(heights, [0.15, 0.45, 0.75], atol=1e-15)


def test_body_with_its_centre_of_mass_low_stacks_by_its_sides() -> None:
    """A cone-like hull of height 1: its centre is a quarter above its base."""
    cone = "{shape: {kind: hull, points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}, mass: 1.0}"
    heights = positions(f"{{kind: tower, count: 3, body: {cone}}}")[:, 2]
    np.testing.assert_allclose(heights, [0.25, 1.25, 2.25], atol=1e-14)


def test_pyramid_has_rows_half_a_place_further_in() -> None:
    places = positions(
        f"{{kind: pyramid, base_count: 3, base: [1, 0, 0], gap: 0.1, body: {BRICK}}}"
    )
    expected = [
        *((1 + x, 0, 0.05) for x in (-0.4, 0.0, 0.4)),
        *((1 + x, 0, 0.15) for x in (-0.2, 0.2)),
        (1, 0, 0.25),
    ]
    np.testing.assert_allclose(places, expected, atol=1e-15)


def test_pyramid_of_twenty_has_210() -> None:
    assert len(bodies(f"{{kind: pyramid, base_count: 20, body: {BRICK}}}")) == 210


GRID = "{kind: grid, counts: [3, 2, 2], spacing: [1, 2, 3], origin: [0.5, 0, 0]%s, body: %s}"


def test_grid_is_numbered_along_x_first() -> None:
    expected = [(0.5 + x, 2 * y, 3 * z) for z in range(2) for y in range(2) for x in range(3)]
    assert positions(GRID % ("", BRICK)).tolist() == [list(map(float, p)) for p in expected]


def test_jitter_is_bounded_even_and_the_same_for_the_same_seed() -> None:
    still = positions(GRID % ("", BRICK))
    moved = positions(GRID % (", jitter: 0.1, seed: 7", BRICK)) - still
    assert np.abs(moved).max() <= 0.1
    # 36 even draws from -0.1..0.1: standard deviation of the mean 0.1/sqrt(3 * 36)
    assert abs(moved.mean()) < 4 * 0.1 / np.sqrt(108)
    assert np.abs(moved).min() > 0
    again = positions(GRID % (", jitter: 0.1, seed: 7", BRICK)) - still
    other = positions(GRID % (", jitter: 0.1, seed: 8", BRICK)) - still
    assert again.tobytes() == moved.tobytes()
    assert not np.isclose(other, moved).any()


def test_jitter_is_that_of_the_mersenne_twister_everywhere() -> None:
    """Known numbers: the first draw of seed 0 is 0.8444218515250481 in every Python."""
    still, moved = (positions(GRID % (j, BRICK)) for j in ("", ", jitter: 1, seed: 0"))
    assert moved[0, 0] - still[0, 0] == 2 * 0.8444218515250481 - 1


def test_arranged_bodies_share_all_but_their_place() -> None:
    one, other = list(bodies(f"{{kind: tower, count: 2, body: {BRICK}}}").values())
    assert one["position"] != other["position"]
    assert {**one, "position": None} == {**other, "position": None}


def test_sweep_reaches_into_an_arrangement() -> None:
    sweep = (
        "sweep:\n"
        "  n: {path: scene.arrangements.pile.count, values: [2, 5]}\n"
        "  mu: {path: scene.arrangements.pile.body.surface.friction, values: [0.25, 0.5]}\n"
    )
    cells = load(f"{{kind: tower, count: 1, body: {BRICK}}}", sweep).cells()
    counts = [len(cell.config.as_dict()["scene"]["bodies"]) - 1 for cell in cells]
    assert counts == [2, 2, 5, 5]
    last = cells[3].config.as_dict()["scene"]["bodies"]["pile_5"]
    assert last["surface"]["friction"] == 0.5


def test_other_sections_name_the_bodies_of_an_arrangement() -> None:
    events = "events:\n  - {at: 0.5, body: pile_3, scale_mass: 2}\n"
    assert load(f"{{kind: tower, count: 3, body: {BRICK}}}", events).cells()[0].config.events
    with pytest.raises(ConfigError, match='no body is called "pile_3"'):
        load(f"{{kind: tower, count: 2, body: {BRICK}}}", events)


def test_ten_thousand_bodies_are_resolved_in_seconds() -> None:
    grid = "{kind: grid, counts: [100, 100, 1], spacing: [1, 1, 1], body: %s}" % BRICK  # noqa: UP031
    cell = load(grid).cells()[0]
    assert len(cell.config.as_dict()["scene"]["bodies"]) == 10_001
    assert len(cell.digest) == 64
