"""Rows of the ends of joints and of their pairs, and who touches nobody since they are joined."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine.collide.joint import DIRECTIONS, FIRST_ROW
from lavendersim.engine.records import ROPE, ROPE_END
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.facts import facts_of
from lavendersim.scene.joints import facts_of_joints, joined_bodies
from lavendersim.scene.plan import plan_of

TEXT = """
scene:
  bodies:
    post: {shape: {kind: sphere, radius: 0.01}, fixed: true, position: [0, 0, 1]}
    box:
      shape: {kind: box, size: [0.2, 0.2, 0.4]}
      mass: 1
      position: [1, 0, 0]
      orientation: {axis: [0, 0, 1], degrees: 90}
    ball: {shape: {kind: sphere, radius: 0.01}, mass: 1, position: [3, 0, 1]}
  connections:
    last: {kind: ball, between: [ball, box], at: [2, 0, 0.5], collide: true}
    rope: {kind: rope, between: [post, ball]}
    first: {kind: ball, between: [box, post], at: [1, 0, 1]}
numerics: {timestep: 1/100}
duration: 0.1
"""
CONFIG = load_experiment_text(TEXT, "x.yaml").cells()[0].config
SPEC = plan_of(CONFIG).spec
SCENE = build(CONFIG, SPEC)


def test_ends_stand_behind_those_of_ropes_by_the_rows_of_their_bodies() -> None:
    ends = SCENE.bodies[5:]
    assert (ends["shape"] == ROPE_END).all()
    assert ends["owner"].tolist() == [0, 1, 1, 2]
    # By the file the first one is `last`, number 0, of which the bodies touch.
    assert (ends["hy"].tolist(), ends["hz"].tolist()) == ([1, 1, 0, 0], [0, 0, 1, 1])
    places = np.column_stack([ends[axis] for axis in "xyz"])
    np.testing.assert_allclose(places, [[1, 0, 1]] * 2 + [[2, 0, 0.5]] * 2, atol=1e-15)
    # y of the box is -x of the world.
    own = np.column_stack([ends[f"p{axis}"] for axis in "xyz"])
    expected = [(1, 0, 0), (0, 0, 1), (0, -1, 0.5), (-1, 0, -0.5)]
    np.testing.assert_allclose(own, expected, atol=1e-15)
    assert len(SCENE.velocities) == len(SCENE.bodies)


def test_pairs_of_joints_stand_before_ropes_and_these_before_shapes() -> None:
    pairs = SCENE.pairs
    kinds = FIRST_ROW - np.arange(3) * (DIRECTIONS + 1)
    assert pairs["kind"][:7].tolist() == [*kinds, *kinds, ROPE]
    assert pairs["a"][:6].tolist() == [5, 5, 5, 7, 7, 7]
    assert np.all(np.diff(pairs["key"]) > 0)
    # Of shapes the box and the post are no pair; the box and the ball are, and ball and post.
    assert [tuple(sorted(pair)) for pair in pairs[["a", "b"]][7:].tolist()] == [(0, 2), (1, 2)]


def test_facts_have_joints_as_pairs_and_leave_out_whom_they_join() -> None:
    assert joined_bodies(CONFIG.scene) == {(0, 1)}
    last, first = facts_of_joints(CONFIG.scene)
    assert (first.a, first.b, first.shape_pair, first.row_pairs) == ("box", "post", "joint", 3)
    assert first.off_centre
    assert last.off_centre
    facts = facts_of(CONFIG)
    shapes = [pair for pair in facts.pairs if pair.shape_pair not in ("rope", "joint")]
    assert {(pair.a, pair.b) for pair in shapes} == {("post", "ball"), ("box", "ball")}
    assert facts.pair_count == 2 + 1 + 6


OTHERS = TEXT.replace("kind: ball, between: [ball, box]", "kind: fixed, between: [ball, box]")
OTHERS = OTHERS.replace("at: [1, 0, 1]}", "at: [1, 0, 1], axis: [0, 2, 0]}")
OTHERS = OTHERS.replace("kind: ball, between: [box, post]", "kind: hinge, between: [box, post]")


def test_a_hinge_has_a_second_point_along_its_axis_and_a_fixed_joint_a_third_beside_it() -> None:
    config = load_experiment_text(OTHERS, "x.yaml").cells()[0].config
    scene = build(config, plan_of(config).spec)
    ends = scene.bodies[5:]
    assert ends["owner"].tolist() == [0, 1] * 2 + [1, 2] * 3
    places = np.column_stack([ends[axis] for axis in "xyz"])
    np.testing.assert_allclose(places[::2], places[1::2], atol=1e-15)
    # Only the box moves: 1/m by the mean of 1/I is the distance squared; 12 I/m of its edges.
    apart = np.sqrt(3.0 / 12.0 / (1.0 / 0.2 + 1.0 / 0.2 + 1.0 / 0.08))
    np.testing.assert_allclose(places[2] - places[0], [0, apart, 0], atol=1e-15)
    along, beside = places[6] - places[4], places[8] - places[4]
    assert along @ beside == pytest.approx(0.0, abs=1e-15)
    assert np.linalg.norm(along) == pytest.approx(np.linalg.norm(beside), rel=1e-14)
    # The axes of both ends are those of one frame, z along the axis, however their bodies stand.
    frames = np.stack([[ends[f"r{i}{j}"] for j in range(3)] for i in range(3)]).transpose(2, 0, 1)
    np.testing.assert_allclose(frames[::2], frames[1::2], atol=1e-15)
    np.testing.assert_allclose(frames[0][:, 2], [0, 1, 0], atol=1e-15)
    rows = scene.pairs[:11]
    assert rows["a"].tolist() == [5, 5, 5, 7, 7, 9, 9, 9, 11, 11, 13]
    directions = [0, 1, 2, 3, 4]
    assert [(FIRST_ROW - kind) % DIRECTIONS for kind in rows["kind"].tolist()] == [
        *directions,
        *directions,
        4,
    ]


def test_a_scene_without_joints_has_no_rows_of_theirs_where_the_effect_is_on() -> None:
    config = load_experiment_text(TEXT.partition("  connections:")[0] + "duration: 0.1\n", "x.yaml")
    scene = build(config.cells()[0].config, SPEC)
    assert len(scene.bodies) == 3
    assert (scene.pairs["kind"] > FIRST_ROW).all()
