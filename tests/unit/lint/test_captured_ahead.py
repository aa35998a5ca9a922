"""Captured restitution of contacts made ahead is pointed at, unless that is written."""

from __future__ import annotations

import pytest

from tests.unit.lint.scenes import CLAIM, config, found

BALL = (
    "ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1], "
    "surface: {restitution: 1}}"
)


def with_numerics(numerics: str, body: str = BALL, rest: str = CLAIM, surfaces: str = "") -> str:
    return config(body, rest=f"numerics: {numerics}\n{rest}", surfaces=surfaces)


def test_it_is_pointed_at_where_impacts_are_said_to_be_captured() -> None:
    text = with_numerics("{timestep: 1/240, impacts: captured}")
    (defect,) = found(text)
    assert text.splitlines()[defect.line - 1][defect.column - 1 :].startswith("impacts: captured")
    assert "speculative: false" in defect.message


@pytest.mark.parametrize(
    "numerics",
    [
        "{impacts: in_order}",
        "{impacts: captured, speculative: false}",
        "{impacts: captured, speculative: true}",
        "{preset: chapter, impacts: captured}",
        "chapter",
    ],
)
def test_what_is_written_is_meant_and_contacts_that_touch_capture_their_impacts(numerics) -> None:
    assert found(with_numerics(numerics)) == []


def test_without_restitution_there_is_nothing_to_capture() -> None:
    dull = BALL.replace("restitution: 1", "restitution: 0")
    assert found(with_numerics("{impacts: captured}", dull)) == []


def test_named_surfaces_pairs_and_swept_numerics_count() -> None:
    named = BALL.replace("{restitution: 1}", "rubber")
    surfaces = "  surfaces: {rubber: {restitution: 0.5}}\n"
    assert len(found(with_numerics("{impacts: captured}", named, surfaces=surfaces))) == 1
    swept = "sweep: {how: {path: numerics.impacts, values: [in_order, captured]}}\nalways: {}\n"
    assert len(found(with_numerics("{timestep: 1/240}", rest=swept))) == 1
