"""The scene as written: something moves, arrangements share no names, forces act on what moves."""

from __future__ import annotations

import pytest

from tests.marked_config import BALL, FLOOR, assert_refused, config, refusals, scene

STILL = "still: {shape: {kind: sphere, radius: 1}, fixed: true, position: [0, 0, 9]}"
PILE = "{kind: tower, count: 3, body: {shape: {kind: sphere, radius: 0.1}, mass: 1}}"


def with_force(words: str, *bodies: str, **sections: str) -> str:
    return config(scene=scene(*bodies, forces=f"[{{{words}}}]"), **sections)


def test_a_scene_where_nothing_can_move_is_refused_at_its_bodies() -> None:
    nothing = "bodies: nothing can move here; expected at least one body that is not fixed"
    assert_refused(config(scene=f"{{§bodies: {{{FLOOR}, {STILL}}}}}"), nothing)
    assert_refused(
        config(scene="{bodies: §{}}"), "bodies: expected at least one movable body, found none"
    )
    assert refusals(config(scene=scene(FLOOR, arrangements=f"{{pile: {PILE}}}"))) == []


def test_a_body_of_an_arrangement_needs_a_name_of_its_own() -> None:
    named = BALL.replace("ball", "pile_3")
    assert_refused(
        config(scene=scene(FLOOR, named, arrangements=f"{{§pile: {PILE}}}")),
        'pile: its body "pile_3" has a namesake in bodies',
    )
    beside = BALL.replace("ball", "pile_4")  # of three bodies there is no fourth
    assert refusals(config(scene=scene(FLOOR, beside, arrangements=f"{{pile: {PILE}}}"))) == []


def test_arrangements_count_together() -> None:
    """60,000 + 60,000 exceed 100,000: the second is refused, by the sum."""
    many = PILE.replace("count: 3", "count: 60000")
    assert_refused(
        config(scene=scene(FLOOR, arrangements=f"{{a: {many}, §b: {many}}}")),
        "b: 120000 bodies in arrangements, expected at most 100000",
    )


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "body: §floor, force: [1, 0, 0]",
            'body: "floor" is a plane; expected a movable body',
        ),
        (
            "body: §still, force: [1, 0, 0]",
            'body: "still" is fixed; expected a movable body',
        ),
        (
            "body: ball, force: [1, 0, 0], from: 0.5, to: §0.5",
            "to: expected a time after from (0.5 s), found 0.5",
        ),
        (
            "body: ball, force: [1, 0, 0], from: §2, to: 1",
            "from: 2 s is after the end of the run, duration 1 s",
        ),
        (
            "body: §bal, force: [1, 0, 0]",
            'body: no body is called "bal"; did you mean "ball"?',
        ),
    ],
)
def test_a_force_that_cannot_act_is_refused(words: str, sentence: str) -> None:
    assert_refused(with_force(words, FLOOR, STILL, BALL), sentence)


def test_a_force_without_a_force_or_a_torque_does_nothing() -> None:
    text = with_force("body: ball", FLOOR, BALL).replace("[{body", "[§{body")
    assert_refused(text, "scene.forces[0] does nothing; expected force or torque")


def test_a_force_on_a_removed_body_ends_when_it_goes() -> None:
    gone = {"events": "[{at: 0.5, body: ball, remove: true}]"}
    last = "removed at 0.5 s by events[0]"
    assert_refused(
        with_force("body: §ball, force: [1, 0, 0]", FLOOR, BALL, STILL, **gone),
        f'body: "ball" is {last}; expected to: 0.5',
    )
    assert_refused(
        with_force("body: ball, force: [1, 0, 0], to: §0.75", FLOOR, BALL, **gone),
        f'to: "ball" is {last}',
    )
    until = with_force("body: ball, force: [1, 0, 0], to: 0.5", FLOOR, BALL, **gone)
    assert refusals(until) == []
