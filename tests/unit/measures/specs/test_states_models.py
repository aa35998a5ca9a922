"""Measures of states: of one body, of several or of all, and angles that are some."""

from __future__ import annotations

import pytest

from lavendersim.measures.specs.states import EnergyAt, FirstPassage, PositionAt, VelocityAt
from lavendersim.quantities.readings import POSES, SUMS, VELOCITIES
from tests.marked_config import assert_refused, config, refusals

GIVEN = {"kind": "position", "along": (0.0, 0.0, 2.0)}


@pytest.mark.parametrize(
    ("named", "chosen"),
    [({}, ()), ({"body": "a"}, ("a",)), ({"bodies": ("b", "a")}, ("b", "a"))],
)
def test_bodies_are_chosen_by_one_name_by_several_or_by_none(
    named: dict[str, object], chosen: tuple[str, ...]
) -> None:
    assert PositionAt.model_validate({**GIVEN, **named}).chosen == chosen


def test_one_name_beside_several_is_refused() -> None:
    words = "kind: position, along: [0, 0, 1], body: ball, bodies: [floor]"
    assert_refused(
        config(measure=f"{{p: §{{{words}}}}}"), "p: expected at most one of body, bodies"
    )


def test_what_each_takes_of_a_log() -> None:
    assert PositionAt.reads({}) == FirstPassage.reads({}) == POSES
    assert VelocityAt.reads({}) == VELOCITIES
    assert EnergyAt.reads({}) == SUMS


@pytest.mark.parametrize(
    ("degrees", "good"), [("0.1", True), ("179", True), ("0", False), ("180", False)]
)
def test_a_body_has_fallen_by_an_angle_between_none_and_half_a_turn(
    degrees: str, good: bool
) -> None:
    found = refusals(config(measure=f"{{n: {{kind: fallen_bodies, degrees: {degrees}}}}}"))
    assert (found == []) is good
