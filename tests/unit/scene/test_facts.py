"""What predicates may know of a config: what turns, how fast, how large, what pushes whom."""

from __future__ import annotations

import math

from lavendersim.cell import changes_of_bodies
from lavendersim.scene.facts import facts_of
from tests.made_cells import ORIGIN, UPRIGHT, made_cell

BALL = {"kind": "sphere", "radius": 0.1}
BOX = {"kind": "box", "size": [0.2, 0.3, 0.6]}
PART = {"shape": BALL, "position": [0.0, 0.0, 1.0], "orientation": UPRIGHT}
PARTS = {"kind": "compound", "parts": [PART], "centre": ORIGIN, "axes": UPRIGHT}
PLANE = {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}


def test_bodies_by_shape_motion_and_inertia() -> None:
    cell = made_cell(
        {
            "floor": {"shape": PLANE},
            "ball": {"shape": BALL, "velocity": [3.0, 4.0, 0.0]},
            "box": {"shape": BOX, "inertia": [1.0, 1.0, 2.0], "angular_velocity": [0, 0, 1.0]},
            "parts": {"shape": PARTS},
        }
    )
    floor, ball, box, parts = facts_of(cell).bodies
    assert not floor.movable
    assert (ball.movable, ball.round, ball.spins, ball.speed, ball.size) == (
        *(True, True, False, 5.0, 0.1),
    )
    assert (box.round, box.spins) == (False, True)
    assert box.size == math.hypot(0.1, 0.15, 0.3)
    assert (parts.parts, parts.least_size, parts.size) == (1, 0.1, 1.1)


def test_an_event_may_make_a_body_fast_or_let_it_turn() -> None:
    event = {"at": 0.5, "body": "ball", "velocity": [0, 0, -7.0], "angular_velocity": [1.0, 0, 0]}
    kept = {"contact_cache": "keep", "remove": False, "scale_mass": None, "teleport": None}
    steps = {"at": 0.6, "timestep": "1/480"}
    cell = made_cell({"ball": {"shape": BALL}}, events=[{**event, **kept}, steps])
    facts = facts_of(cell)
    assert (facts.bodies[0].speed, facts.bodies[0].spins, facts.events) == (7.0, True, True)
    assert [one.body for one in changes_of_bodies(cell.events)] == ["ball"]


def test_forces_push_and_twist_those_they_name() -> None:
    force = {"from": 0.0, "to": 1.0, "torque": ORIGIN, "force": ORIGIN}
    cell = made_cell(
        {name: {"shape": BALL} for name in ("pushed", "twisted", "none")},
        forces=[
            {**force, "body": "pushed", "force": [1.0, 0, 0]},
            {**force, "body": "twisted", "torque": [1.0, 0, 0]},
            {**force, "body": "none"},
        ],
    )
    found = {body.name: (body.force, body.torque) for body in facts_of(cell).bodies}
    assert found == {"pushed": (True, False), "twisted": (False, True), "none": (False, False)}


def test_pairs_are_counted_row_by_row() -> None:
    cell = made_cell({"floor": {"shape": PLANE}, **{f"b{k}": {"shape": BALL} for k in range(5)}})
    facts = facts_of(cell)
    assert facts.pair_count == 5 + 10
    assert {pair.shape_pair: pair.row_pairs for pair in facts.pairs} == {
        "sphere_plane": 5,
        "sphere_sphere": 10,
    }
