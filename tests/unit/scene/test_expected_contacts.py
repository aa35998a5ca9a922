"""How many contacts a scene is expected to have: counted by hand, and by the law of falling."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.cell import CellConfig
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.expected_contacts import expected_contacts

SCENE = """\
question: How many?
scene:
  gravity: {gravity}
  bodies:
    floor: {{shape: {{kind: plane}}}}
  arrangements:
    part: {arrangement}
numerics: chapter
duration: {duration}
"""
BOX = "body: {shape: {kind: box, size: [0.2, 0.2, 0.2]}, mass: 1}"
BALL = "body: {shape: {kind: sphere, radius: 0.1}, mass: 1}"


def config(arrangement: str, gravity: float = 9.81, duration: float = 1.0) -> CellConfig:
    text = SCENE.format(arrangement=arrangement, gravity=gravity, duration=duration)
    (cell,) = load_experiment_text(text, "made.yaml").cells()
    return cell.config


def grid(counts: list[int], spacing: float, height: float, body: str = BALL) -> str:
    place = f"spacing: {[spacing] * 3}, origin: [0, 0, {height}]"
    return f"{{kind: grid, counts: {counts}, {place}, {body}}}"


def test_a_tower_has_four_contacts_a_storey() -> None:
    assert expected_contacts(config(f"{{kind: tower, count: 7, {BOX}}}")) == 4 * 7


def test_spheres_touch_in_a_point_and_only_where_they_touch() -> None:
    """Three layers of 3 x 2 of diameter 0.2: 9 on the floor would be more than there are."""
    # neighbours along x, y, z: 2 2 3 + 3 1 3 + 3 2 2 = 33, and 6 on the floor
    close = config(grid([3, 2, 3], 0.2, 0.1), gravity=0.0)
    assert expected_contacts(close) == 2 * 2 * 3 + 3 * 1 * 3 + 3 * 2 * 2 + 3 * 2
    # diagonal neighbours: their boxes overlap and they do not
    assert expected_contacts(config(grid([3, 2, 3], 0.21, 0.2), gravity=0.0)) == 0


@pytest.mark.parametrize("duration", [0.1, 0.3, 1.0, 10.0])
def test_what_falls_lands_by_the_law_of_falling(duration: float) -> None:
    """Four spheres a layer, evenly above each other; those below g t^2 / 2 have landed."""
    layers, spacing = 20, 0.3
    height = (layers - 1) * spacing + 0.2
    times = (np.arange(100_000) + 0.5) / 100_000 * duration
    landed = np.minimum(1.0, 9.81 * times**2 / 2 / height).mean()
    found = expected_contacts(config(grid([2, 2, layers], spacing, 0.3), duration=duration))
    settled = 2 * 4 * layers  # two contacts each: four neighbours, each shared by two
    assert found == pytest.approx(landed * settled, rel=1e-6)


def test_bodies_that_do_not_move_have_no_contacts_with_each_other() -> None:
    block = "shape: {kind: box, size: [1, 1, 1]}, fixed: true"
    bodies = f"  bodies:\n    one: {{{block}, position: [0, 0, 0]}}\n"
    bodies += f"    other: {{{block}, position: [0.5, 0, 0]}}\n"
    text = SCENE.format(arrangement=grid([1, 1, 1], 1.0, 9.0), gravity=0.0, duration=1)
    (cell,) = load_experiment_text(text.replace("  bodies:\n", bodies), "made.yaml").cells()
    assert expected_contacts(cell.config) == 0
