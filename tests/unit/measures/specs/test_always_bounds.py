"""Bounds of every step: their defaults, forms and refusals, and which checks stop a run."""

from __future__ import annotations

import pytest

from lavendersim.measures.specs.always import CHECKS, FINITE, READS, STOPPING, Always
from lavendersim.quantities.readings import CONTACTS, POSES
from tests.marked_config import assert_refused, config, refusals


def test_everything_but_the_finite_stops_a_run() -> None:
    assert set(CHECKS) - set(STOPPING) == {FINITE}
    assert set(CHECKS) == {FINITE, *Always.model_fields} - {"stop"}
    assert READS.keys() <= set(CHECKS)
    assert READS["speed"] == POSES
    assert READS["penetration"] == CONTACTS


def test_defaults_are_within_round_off_and_leave_speeds_alone() -> None:
    always = Always()
    assert (always.penetration, always.speed, always.stop) == ("derived", "none", True)
    assert 0.0 < always.momentum <= 1e-9
    # the residual's is a thousand times the tolerance of the default numerics, 1e-9 m/s
    assert always.residual == pytest.approx(1000 * 1e-9)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("energy: §derived", 'energy: expected a number above 0 or none, found the text "derived"'),
        ("energy: §0", "energy: expected a number above 0, found 0"),
        ("speed: §true", "speed: expected a number above 0 [m/s] or none, found true"),
        (
            "penetration: §deep",
            "penetration: expected a number of 0 or more [m], derived or none, "
            'found the text "deep"',
        ),
        ("stop: §1", "stop: expected true or false, found 1"),
    ],
)
def test_other_bounds_are_refused_where_they_stand(words: str, sentence: str) -> None:
    assert_refused(config(always=f"{{{words}}}"), sentence)


def test_each_check_can_be_left_out_and_a_depth_may_be_zero() -> None:
    assert refusals(config(always=f"{{{', '.join(f'{c}: none' for c in STOPPING)}}}")) == []
    assert refusals(config(always="{penetration: 0, speed: 3}")) == []
