"""Judgements in one cell: each passing and failing, margins, and formulas of the cell's axes."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from judged import NAN, cell, expect, passed, verdicts

from lavendersim.measures.cell_judgements import room


@pytest.mark.parametrize(
    ("judgement", "good", "bad"),
    [
        ({"between": (1.0, 2.0)}, [1.0, 1.5, 2.0], [0.999, 2.001, NAN]),
        ({"at_most": 2.0}, [2.0, 0.5], [2.001, NAN]),
        ({"at_least": 2.0}, [2.0, 3.0], [1.999, NAN]),
        ({"exactly": 0.0}, [0.0], [1e-300, NAN]),
        ({"equals": {"value": 4.0, "relative": 0.25}}, [3.0, 5.0], [2.99, 5.01, NAN]),
        ({"equals": {"value": 4.0, "absolute": 0.5}}, [3.5, 4.5], [3.4, 4.6, NAN]),
        # weight of the ball: 19.62 N, within 1 %
        (
            {"equals": {"closed_form": {"form": "weight", "bodies": ("ball",)}, "relative": 0.01}},
            [19.62, 19.8],
            [19.9, 19.4, NAN],
        ),
    ],
)
def test_a_number_in_one_cell(judgement: dict[str, Any], good: Any, bad: Any) -> None:
    for number in good:
        assert passed(expect(**judgement), cell(number)), number
    for number in bad:
        assert not passed(expect(**judgement), cell(number)), number


def test_every_number_of_a_row_is_held() -> None:
    assert passed(expect("row", at_most=2.0), cell([1.0, 2.0, 0.5]))
    assert not passed(expect("row", at_most=2.0), cell([1.0, 2.1, 0.5]))
    assert not passed(expect("row", at_most=2.0), cell([1.0, NAN, 0.5]))


@pytest.mark.parametrize(
    ("direction", "row", "good"),
    [
        ("increasing", [1.0, 2.0, 3.0], True),
        ("increasing", [1.0, 2.0, 2.0], False),
        ("increasing", [1.0, NAN, 3.0], False),
        ("increasing", [1.0], False),
        ("decreasing", [3.0, 2.0, 1.0], True),
        ("decreasing", [1.0, 2.0], False),
    ],
)
def test_a_row_that_rises_or_falls(direction: str, row: list[float], good: bool) -> None:
    assert passed(expect("row", row=direction), cell(row)) is good


def test_the_message_shows_measured_expected_tolerance_and_log() -> None:
    claim = expect(equals={"value": 4.0, "relative": 0.25})
    (verdict,) = verdicts(claim, cell(5.5))
    for text in ("5.5", "4.0", "0.25 relative", "some-cell.mcap", "FAILED"):
        assert text in verdict.message


@pytest.mark.parametrize(
    ("claim", "value", "margin"),
    [
        ({"at_most": 2.0}, 0.5, 0.75),
        ({"at_most": 2.0}, 3.0, -0.5),
        ({"at_least": 2.0}, 3.0, 0.5),
        ({"between": (0.0, 4.0)}, 1.0, 0.5),
        ({"equals": {"value": 4.0, "relative": 0.25}}, 4.5, 0.5),
    ],
)
def test_the_margin_is_the_share_of_the_bound_that_is_left(
    claim: dict[str, object], value: float, margin: float
) -> None:
    (verdict,) = verdicts(expect(**claim), cell(value))
    assert verdict.margin == pytest.approx(margin)


LAW = {"equals": "2 * $m + 0.5", "absolute": 0.25}


def test_a_formula_is_the_expected_number_of_each_cell() -> None:
    assert passed(expect(**LAW), cell(4.5, m=2))
    assert not passed(expect(**LAW), cell(4.5, m=3))
    found = verdicts(expect(**LAW), cell(2.5, m=1), cell(9.0, m=4), cell(6.5, m=Fraction(3)))
    assert [one.passed for one in found] == [True, False, True]
    assert found[1].expected == "8.5 (2 * $m + 0.5)"


def test_a_formula_of_an_axis_that_the_cell_lacks_fails() -> None:
    (verdict,) = verdicts(expect(**LAW), cell(4.5))
    assert not verdict.passed
    assert "the cell has no number for axis $m" in verdict.message


def test_a_formula_without_a_value_in_a_cell_fails_there() -> None:
    law = {"equals": "1 / ($m - 1)", "relative": 0.1}
    found = verdicts(expect(**law), cell(1.0, m=1), cell(1.0, m=2))
    assert [one.passed for one in found] == [False, True]
    assert "divides by zero" in found[0].message


@pytest.mark.parametrize(
    ("claim", "value", "left"),
    [
        ({"at_most": 2.0}, 0.5, 1.5),
        ({"between": (0.0, 4.0)}, 1.0, 1.0),
        ({"at_least": 2.0}, 1.5, 0.5),  # by as much the verdict is missed
        ({"exactly": 2.0}, 2.0, 0.0),
        ({"equals": {"value": -8.0, "relative": 0.25, "absolute": 1.0}}, -7.0, 2.0),
        ({"equals": "2 * $m", "absolute": 0.5}, 4.0, None),  # the cell has no such axis
        ({"row": "increasing"}, 1.0, None),
    ],
)
def test_room_is_the_change_of_a_value_that_may_change_the_verdict(
    claim: dict[str, Any], value: float, left: float | None
) -> None:
    assert room(expect(**claim), value, cell(value)) == left


def test_of_a_row_the_nearest_number_has_the_least_room() -> None:
    assert room(expect("row", at_most=2.0), [0.0, 1.75, 3.0], cell([0.0])) == 0.25
