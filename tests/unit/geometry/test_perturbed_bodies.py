"""Perturbed starts: bodies stay on what they stand on, and equal seeds give equal scenes."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

DISTANCE = 1e-4
BOX = "shape: {kind: box, size: [0.2, 0.2, 0.2]}, mass: 1"
TOWER = f"""
scene:
  gravity: GRAVITY
  bodies:
    floor: {{shape: {{kind: plane}}}}
    lower: {{{BOX}, position: [0, 0, 0.1]}}
    upper: {{{BOX}, position: [0, 0, 0.3]}}
    ledge: {{shape: {{kind: sphere, radius: 1}}, fixed: true, position: [9, 0, 0]}}
  perturbation: {{seed: SEED, distance: 1e-4}}
duration: 1
"""


def shifts(seed: int, gravity: str = "9.81", more: str = "", without: str = "") -> np.ndarray:
    """Return how far every body is from where it was written [m]."""
    text = TOWER.replace("SEED", str(seed)).replace("GRAVITY", gravity)
    lines = [line for line in text.splitlines() if not (without and without in line)]
    text = "\n".join(lines).replace("  perturbation", f"{more}  perturbation")
    placed, written = (
        load_experiment_text(one, "t.yaml").cells()[0].config.scene.bodies.values()
        for one in (text, text.replace(f"seed: {seed}", "seed: 0"))
    )
    return np.array(
        [np.subtract(a.position, b.position) for a, b in zip(placed, written, strict=True)]
    )


def test_a_tower_moves_level_and_stays_on_its_floor() -> None:
    """Shares of a lattice of round-off of 0.3 m remain: 6e-17."""
    found = shifts(1)
    assert (found[[0, 3]] == 0.0).all()  # floor and ledge do not move
    assert (np.abs(found[1:3, :2]) > 0.0).all()
    assert (np.abs(found[1:3, :2]) < DISTANCE).all()
    assert np.abs(found[1:3, 2]).max() < 1e-16
    assert (found[1] != found[2])[:2].all()


def test_a_floor_keeps_its_bodies_where_gravity_leans() -> None:
    """Neither along the floor's normal nor along gravity: y alone is left."""
    found = shifts(1, "[4, 0, -9]")
    assert np.abs(found[:, [0, 2]]).max() < 1e-16
    assert np.abs(found[1:3, 1]).min() > 0.0


def test_in_a_corner_of_three_walls_nothing_is_moved() -> None:
    walls = "".join(
        f"    wall_{k}: {{shape: {{kind: plane, normal: {normal}, offset: -0.1}}}}\n"
        for k, normal in enumerate(([1, 0, 0], [0, 1, 0]))
    )
    bodies = walls.replace("    wall", "    wall")
    text = TOWER.replace("  perturbation", f"{bodies}  perturbation")
    text = text.replace("SEED", "1").replace("GRAVITY", "9.81")
    bodies_of = load_experiment_text(text, "c.yaml").cells()[0].config.scene.bodies
    np.testing.assert_allclose(bodies_of["lower"].position, [0, 0, 0.1], atol=1e-16)


def test_without_gravity_and_floor_all_directions_are_drawn_evenly() -> None:
    """200 seeds, 1200 numbers in +-1: mean 0 within 5 sigma of 1/sqrt(3 n), square 1/3 likewise."""
    drawn = np.array([shifts(seed, "0", without="floor")[:2] for seed in range(1, 201)]) / DISTANCE
    assert np.abs(drawn).max() < 1.0
    assert abs(drawn.mean()) < 5.0 / np.sqrt(3.0 * drawn.size)
    assert abs((drawn**2).mean() - 1.0 / 3.0) < 5.0 * np.sqrt(4.0 / 45.0 / drawn.size)


def test_equal_seeds_give_equal_scenes_and_others_do_not() -> None:
    assert (shifts(7) == shifts(7)).all()
    assert (shifts(7) != shifts(8)).any()


def test_a_perturbation_without_a_distance_is_refused_at_its_place() -> None:
    text = TOWER.replace("SEED", "1").replace("GRAVITY", "9.81").replace("1e-4}", "0}")
    with pytest.raises(ConfigError, match=r"t\.yaml:9:37: distance: expected"):
        load_experiment_text(text, "t.yaml")


def test_a_body_stays_at_a_wall_that_is_a_fixed_box() -> None:
    """A wall turned by 30 degrees about the vertical, its face 0.1 m from the lower box's centre
    along (cos 30, sin 30): nothing moves along that, nor up; a wall 1 mm off holds nothing.
    """
    normal = np.array([0.75**0.5, 0.5, 0.0])
    box = "{kind: box, size: [0.2, 2, 0.2]}"
    turn = "orientation: {axis: [0, 0, 1], degrees: 30}"
    moved = {}
    for gap in (0.0, 1e-3):
        # of a cube of 0.2 m the extent along the normal is 0.1 (cos 30 + sin 30)
        x, y, _ = normal * (0.1 + gap + 0.1 * (0.75**0.5 + 0.5))
        wall = f"    wall: {{shape: {box}, fixed: true, position: [{x}, {y}, 0.1], {turn}}}\n"
        moved[gap] = shifts(1, more=wall)[1:3]
    assert np.abs(moved[0.0] @ normal).max() < 1e-16
    assert np.abs(moved[0.0] @ [-0.5, 0.75**0.5, 0.0]).min() > 0.0
    assert np.abs(moved[1e-3] @ normal).min() > 1e-9
