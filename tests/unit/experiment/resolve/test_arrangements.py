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


BALL = "{shape: {kind: sphere, radius: 0.1}, mass: 1}"


def test_a_row_stands_side_by_side_along_its_line() -> None:
    places = positions(
        f"{{kind: row, count: 3, origin: [1, 0, 2], along: [0, 2, 0], body: {BRICK}}}"
    )
    np.testing.assert_allclose(places, [[1, 0.2 * k, 2] for k in range(3)], atol=1e-15)


def test_a_row_may_have_a_spacing_for_each_two_neighbours() -> None:
    places = positions(f"{{kind: row, count: 4, spacing: [0.2, 0.3, 0.5], body: {BALL}}}")
    np.testing.assert_allclose(places[:, 0], [0, 0.2, 0.5, 1.0], atol=1e-15)
    even = positions(f"{{kind: row, count: 3, spacing: 0.4, body: {BALL}}}")
    np.testing.assert_allclose(even[:, 0], [0, 0.4, 0.8], atol=1e-15)


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (1, 2, -3)])
def test_a_ring_is_a_regular_polygon_about_its_axis(axis: tuple[int, int, int]) -> None:
    centre = np.array([1.0, 2.0, 3.0])
    ring = (
        f"{{kind: ring, count: 5, radius: 2, centre: [1, 2, 3], axis: {list(axis)}, body: {BALL}}}"
    )
    spokes = positions(ring) - centre
    np.testing.assert_allclose(np.linalg.norm(spokes, axis=1), 2, atol=1e-14)
    np.testing.assert_allclose(spokes @ np.array(axis, float), 0, atol=1e-14)
    following = np.roll(spokes, -1, axis=0)
    # 360/5 degrees from each to the next, right-handed about the axis
    np.testing.assert_allclose(
        (spokes * following).sum(axis=1), 4 * np.cos(2 * np.pi / 5), atol=1e-13
    )
    turning = np.cross(spokes, following) @ (np.array(axis) / np.linalg.norm(axis))
    np.testing.assert_allclose(turning, 4 * np.sin(2 * np.pi / 5), atol=1e-13)


def test_bodies_of_a_ring_may_turn_with_their_place() -> None:
    body = BALL.replace("mass", "velocity: [3, 0, 0], mass")
    found = bodies(f"{{kind: ring, count: 4, radius: 1, turned: true, body: {body}}}")
    outwards = [np.dot(one["position"], one["velocity"]) for one in found.values()]
    np.testing.assert_allclose(outwards, 3, atol=1e-14)  # each flies away from the centre
    halves = [one["orientation"][0] for one in found.values()]
    np.testing.assert_allclose(halves, np.cos(np.pi / 4 * np.arange(4)), atol=1e-15)


def test_a_rack_of_balls_touches_in_equal_triangles() -> None:
    places = positions(f"{{kind: rack, rows: 4, tip: [1, 0, 0.1], body: {BALL}}}")
    assert len(places) == 10
    assert list(places[0]) == [1, 0, 0.1]
    distances = np.linalg.norm(places[:, None] - places[None, :], axis=2)
    touching = np.abs(distances - 0.2) < 1e-15 * 8
    assert touching.sum() == 2 * 18  # 3 n (n - 1)/2 pairs of neighbours in a triangle of n rows
    assert distances[~touching & ~np.eye(10, dtype=bool)].min() > 0.3


def test_the_first_body_differs_by_its_own_keys_alone() -> None:
    first = "{velocity: [1, 0, 0], density: 1000}"
    found = bodies(f"{{kind: row, count: 3, gap: 0.1, first: {first}, body: {BALL}}}")
    one, two, three = found.values()
    assert (one["velocity"], two["velocity"]) == ([1, 0, 0], [0, 0, 0])
    assert one["mass"] == pytest.approx(1000 * 4 / 3 * np.pi * 0.001, rel=1e-15)
    assert (two["mass"], three["mass"], one["shape"]) == (1, 1, two["shape"])


def test_the_first_body_may_be_fixed() -> None:
    found = bodies(f"{{kind: row, count: 2, gap: 0.1, first: {{fixed: true}}, body: {BALL}}}")
    assert [one["fixed"] for one in found.values()] == [True, False]


def test_the_first_body_can_be_swept() -> None:
    axis = "sweep: {v: {path: scene.arrangements.pile.first.velocity.0, values: [1, 2]}}"
    row = f"{{kind: row, count: 2, gap: 0.1, first: {{velocity: [0, 0, 0]}}, body: {BALL}}}"
    cells = load(row, axis).cells()
    found = [cell.config.scene.bodies for cell in cells]
    assert [(one["pile_1"].velocity[0], one["pile_2"].velocity[0]) for one in found] == [
        (1, 0),
        (2, 0),
    ]
