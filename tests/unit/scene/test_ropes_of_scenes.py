"""Rows of the ends of ropes and of their pairs, as the engine takes them."""

from __future__ import annotations

import numpy as np

from lavendersim.engine.records import ROPE, ROPE_END
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of
from lavendersim.scene.ropes import facts_of_ropes, surface_of

TEXT = """
scene:
  bodies:
    post: {shape: {kind: sphere, radius: 0.01}, fixed: true, position: [0, 0, 1]}
    box:
      shape: {kind: box, size: [0.2, 0.2, 0.4]}
      mass: 1
      position: [0, 0, 0]
      orientation: {axis: [0, 0, 1], degrees: 90}
    wall: {shape: {kind: sphere, radius: 0.01}, fixed: true, position: [3, 0, 1]}
  connections:
    idle: {kind: rope, between: [post, wall]}
    line: {kind: rope, between: [post, box], points: [[0, 0, 0], [0.1, 0, 0.2]]}
    other: {kind: rope, between: [box, wall], length: 4.0, restitution: 0.25}
numerics: {timestep: 1/100}
duration: 0.1
"""
CONFIG = load_experiment_text(TEXT, "x.yaml").cells()[0].config


def test_ends_stand_behind_the_bodies_where_they_are_tied() -> None:
    scene = build(CONFIG, plan_of(CONFIG).spec)
    ends = scene.bodies[3:]
    assert (ends["shape"] == ROPE_END).all()
    assert ends["owner"].tolist() == [0, 1, 1, 2]
    assert scene.bodies["owner"][:3].tolist() == [0, 1, 2]
    places = np.column_stack([ends[axis] for axis in "xyz"])
    # x of the box is y of the world.
    expected = [(0, 0, 1), (0, 0.1, 0.2), (0, 0, 0), (3, 0, 1)]
    np.testing.assert_allclose(places, expected, atol=1e-15)
    # The first as long as it is far: sqrt(0.1^2 + 0.8^2).
    np.testing.assert_allclose(ends["hx"], [0.65**0.5, 0.65**0.5, 4.0, 4.0], rtol=1e-15)
    assert ends["hy"].tolist() == [0.0, 0.0, 1.0, 1.0]
    assert not ends["inv_m"].any()
    assert len(scene.velocities) == len(scene.bodies)
    assert len(scene.poses) == len(scene.names) == 3


def test_pairs_of_ropes_stand_first_with_a_surface_of_their_own() -> None:
    pairs = build(CONFIG, plan_of(CONFIG).spec).pairs
    ropes = pairs[:2]
    assert (ropes["kind"] == ROPE).all()
    assert not (pairs[2:]["kind"] == ROPE).any()
    assert (ropes["a"].tolist(), ropes["b"].tolist()) == ([3, 5], [4, 6])
    assert ropes["restitution"].tolist() == [0.0, 0.25]
    assert np.all(np.diff(pairs["key"]) > 0)


def test_facts_of_ropes_are_those_of_frictionless_pairs() -> None:
    line, other = facts_of_ropes(CONFIG.scene)
    assert (line.a, line.b, line.shape_pair) == ("post", "box", "rope")
    assert (line.off_centre, other.off_centre) == (True, False)
    assert other.surface == surface_of(CONFIG.scene.connections["other"])
    assert (other.surface.friction, other.surface.restitution) == (0.0, 0.25)


def test_without_ropes_no_row_is_added() -> None:
    bare = CONFIG.model_copy(update={"scene": CONFIG.scene.model_copy(update={"connections": {}})})
    scene = build(bare, plan_of(bare).spec)
    assert len(scene.bodies) == 3
    assert "owner" not in scene.bodies.dtype.names
