"""Measures of laws: energies take poses where a height is taken off, and never contacts."""

from __future__ import annotations

import pytest

from lavendersim.measures.specs.laws import EnergyDrift, EnergyGain, ForceError, LawViolation
from lavendersim.quantities.readings import CONTACTS, POSES, SUMS
from tests.marked_config import BALL, FLOOR, assert_refused, config, refusals, scene


@pytest.mark.parametrize("model", [EnergyDrift, EnergyGain])
def test_an_energy_above_a_plane_takes_where_the_body_is(model: type[EnergyDrift]) -> None:
    assert model.reads({"above": "floor"}) == POSES
    assert model.reads({"body": "ball"}) == SUMS


def test_what_the_others_take() -> None:
    assert ForceError.reads({}) == CONTACTS
    assert LawViolation.reads({}) == SUMS


def test_an_energy_needs_poses_only_above_a_plane() -> None:
    record = {"record": "{poses: every 2}"}
    plain = "{e: {kind: energy_drift}}"
    assert refusals(config(measure=plain, **record)) == []
    above = "{e: {kind: §energy_drift, body: ball, above: floor}}"
    assert_refused(
        config(measure=above, **record),
        "kind: energy_drift takes the poses of every step, and record.poses is every 2; "
        "expected all",
    )


def test_a_plane_is_a_plane_and_a_part_is_one_of_four() -> None:
    box = "box: {shape: {kind: box, size: [1, 1, 1]}, fixed: true, position: [0, 0, 9]}"
    assert_refused(
        config(scene=scene(FLOOR, BALL, box), measure="{e: {kind: energy_gain, above: §box}}"),
        'above: "box" is a box, expected the name of a plane',
    )
    parts = "natural_map or signorini or cone or dissipation"
    assert_refused(
        config(measure="{e: {kind: law_violation, part: §cones}}"),
        f'part: expected {parts}, found the text "cones"; did you mean "cone"?',
    )
