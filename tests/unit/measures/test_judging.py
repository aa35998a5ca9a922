"""Every judgement passing and failing; and that none of them can pass by measuring nothing."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from synthetic import RESIDUAL, SyntheticCell, trace_of

from lavendersim.errors import TraceError
from lavendersim.measures import Verdict, judge, judge_nodes
from lavendersim.measures.specs.convergence import FinalResidual, ResidualBySweep
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.measures.specs.impact import ImpactImpulse

MEASURES = {
    "number": ImpactImpulse(kind="impact_impulse", body="ball"),
    "row": ResidualBySweep(kind="residual_by_sweep", after=0.0),
    "limited": FinalResidual(kind="final_residual", after=0.0, at={"b": "any"}),
}


def cell(number: float | list[float], status: str = "complete", **coordinates: Any) -> Any:
    """A cell whose `number` (an impulse) or `row` (residuals) is what is given."""
    log = trace_of([0.0] * 4, status=status)
    if isinstance(number, list):
        rows = [(1, sweep, value) for sweep, value in enumerate(number)]
        log.residual = np.array(rows, RESIDUAL)
    else:
        log = trace_of([0.0] * 4, [(1, number, 0.0)], status=status)
    return SyntheticCell(coordinates, log)


def expect(measure: str = "number", **judgement: Any) -> ExpectSpec:
    return ExpectSpec.model_validate({"name": "claim", "measure": measure, **judgement})


def verdicts(expectation: ExpectSpec, *cells: Any) -> list[Verdict]:
    return judge(MEASURES, [expectation], cells)


def passed(expectation: ExpectSpec, *cells: Any) -> bool:
    found = verdicts(expectation, *cells)
    assert len(found) == 1
    return found[0].passed


NAN = float("nan")


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


@pytest.mark.parametrize(
    ("numbers", "good"),
    [
        ({(0, 0): 1.0, (1, 0): 2.0, (0, 1): 5.0, (1, 1): 6.0}, True),
        ({(0, 0): 1.0, (1, 0): 2.0, (0, 1): 6.0, (1, 1): 6.0}, False),  # equal is not a rise
        ({(0, 0): 1.0, (1, 0): NAN, (0, 1): 5.0, (1, 1): 6.0}, False),
        ({(0, 0): 1.0, (1, 0): 2.0, (0, 1): 5.0}, False),  # a group with one value only
    ],
)
def test_increasing_along_an_axis_in_every_group(numbers: Any, good: bool) -> None:
    cells = [cell(number, a=a, b=b) for (a, b), number in numbers.items()]
    assert passed(expect(increasing={"along": "a"}), *cells) is good
    assert not passed(expect(decreasing={"along": "a"}), *cells)


def test_decreasing_ignores_the_order_of_the_sweep() -> None:
    cells = [cell(1.0, a=3), cell(3.0, a=1), cell(2.0, a=2)]
    assert passed(expect(decreasing={"along": "a"}), *cells)


@pytest.mark.parametrize(
    ("fine", "coarse", "good"),
    [
        (1.0, 2.0, True),
        (2.0, 1.0, False),
        (1e-10, 1e-12, True),  # it grew, but both are nothing
        (0.0, 0.0, True),
        (1.1e-9, 1e-12, False),
        (NAN, 1.0, False),
    ],
)
def test_a_negligible_numerator_needs_no_ratio(fine: float, coarse: float, good: bool) -> None:
    ratio = {"of": {"a": 0}, "to": {"a": 1}, "at_most": 1.0, "negligible": 1e-9}
    assert passed(expect(ratio=ratio), cell(fine, a=0), cell(coarse, a=1)) is good


@pytest.mark.parametrize(
    ("numbers", "good"),
    [
        ({1.0: 3.0, 2.0: 12.0, 4.0: 48.0}, True),  # exactly 2
        ({1.0: 3.0, 2.0: 11.0, 4.0: 41.0}, False),  # log2(41/3)/2 = 1.886
        ({1.0: 3.0, 2.0: 15.0, 4.0: 60.0}, False),  # log2(60/3)/2 = 2.16
        ({1.0: 1e-12, 2.0: 0.0, 4.0: 5e-13}, True),  # round-off has no order
        ({1.0: 3.0, 2.0: NAN, 4.0: 48.0}, False),
        ({1.0: 3.0, 2.0: 0.0, 4.0: 48.0}, False),
        ({1.0: 3.0}, False),
    ],
)
def test_the_order_is_the_slope_between_logarithms(numbers: Any, good: bool) -> None:
    order = {"along": "dt", "at_least": 1.9, "at_most": 2.1, "negligible": 1e-9}
    cells = [cell(0.5 * number, dt=dt, b=b) for dt, number in numbers.items() for b in (0, 1)]
    cells += [cell(number, dt=dt, b=2) for dt, number in numbers.items()]
    assert passed(expect(order=order), *cells) is good


def test_a_ratio_reduces_the_other_axes_first() -> None:
    cells = [cell(1.0, a=0, b=0), cell(2.0, a=0, b=1), cell(8.0, a=1, b=0), cell(4.0, a=1, b=1)]

    def ratio(reduce: str, **bounds: float) -> ExpectSpec:
        return expect(ratio={"of": {"a": 1}, "to": {"a": 0}, "reduce": reduce, **bounds})

    assert passed(ratio("max", at_most=4.0, at_least=4.0), *cells)  # 8 / 2
    assert passed(ratio("min", at_most=4.0, at_least=4.0), *cells)  # 4 / 1
    assert passed(ratio("mean", at_most=4.0, at_least=4.0), *cells)  # 6 / 1.5
    assert not passed(ratio("max", at_most=3.9), *cells)
    assert not passed(ratio("max", at_least=4.1), *cells)


def test_a_ratio_for_each_value_of_an_axis() -> None:
    cells = [cell(1.0, a=0, b=0), cell(1.0, a=0, b=1), cell(8.0, a=1, b=0), cell(2.0, a=1, b=1)]
    spec = {"of": {"a": 1}, "to": {"a": 0}, "reduce": "max"}
    assert passed(expect(ratio={**spec, "at_least": 5.0}), *cells)
    assert not passed(expect(ratio={**spec, "each": ("b",), "at_least": 5.0}), *cells)


def test_rows_are_compared_number_by_number_down_to_the_floor() -> None:
    cells = [cell([20.0, 2.0, 1e-16], a=0), cell([1.0, 0.1, 1e-16], a=1)]
    spec = {"of": {"a": 0}, "to": {"a": 1}, "at_least": 15.0}
    assert passed(expect("row", ratio={**spec, "floor": 1e-13}), *cells)
    assert not passed(expect("row", ratio=spec), *cells)  # the last number is round-off


@pytest.mark.parametrize(
    ("top", "bottom"), [(NAN, 1.0), (1.0, NAN), (0.0, 0.0)], ids=["nan", "to nan", "zero"]
)
def test_a_ratio_of_nothing_fails(top: float, bottom: float) -> None:
    spec = {"of": {"a": 0}, "to": {"a": 1}, "at_least": -1.0}
    assert not passed(expect(ratio=spec), cell(top, a=0), cell(bottom, a=1))


def test_a_ratio_with_nothing_on_one_side_fails() -> None:
    spec = {"of": {"a": 0}, "to": {"a": 7}, "at_least": 0.0}
    assert not passed(expect(ratio=spec), cell(1.0, a=0), cell(1.0, a=1))


@pytest.mark.parametrize(
    ("numbers", "good"),
    [([0.0, 0.5, 1.5], True), ([0.0, 0.1, 0.2], False), ([2.0, 3.0, 4.0], False)],
)
def test_crossing_a_level_is_interpolated(numbers: list[float], good: bool) -> None:
    cells = [cell(number, a=a) for a, number in enumerate(numbers)]  # rises through 1 at a = 1.5
    spec = {"along": "a", "level": 1.0, "between": (1.49, 1.51)}
    assert passed(expect(crosses=spec), *cells) is good


def test_an_expectation_that_selects_no_cell_fails() -> None:
    (verdict,) = verdicts(expect(at={"a": 9}, at_most=1.0), cell(0.0, a=1))
    assert not verdict.passed
    assert "selects no cell" in verdict.message


def test_a_diverged_cell_fails_whatever_its_numbers() -> None:
    (verdict,) = verdicts(expect(at_most=1.0), cell(0.0, status="diverged: ball", a=1))
    assert not verdict.passed
    assert "diverged: ball" in verdict.message


def test_a_damaged_log_fails_its_own_claims_only() -> None:
    damaged = SyntheticCell({"a": 2}, TraceError("cut short"))
    first, second = verdicts(expect(at_most=1.0), cell(0.0, a=1), damaged)
    assert first.passed
    assert not second.passed
    assert "cut short" in second.message


def test_selection_by_value_list_and_any() -> None:
    cells = [cell(0.0, a=0.25, b="x"), cell(0.0, a=0.5, b="y"), cell(0.0, c=1)]
    assert len(verdicts(expect(at={"a": 0.25}, at_most=1.0), *cells)) == 1
    assert len(verdicts(expect(at={"b": ("x", "y")}, at_most=1.0), *cells)) == 2
    assert len(verdicts(expect(at={"a": "any"}, at_most=1.0), *cells)) == 2
    assert len(verdicts(expect(at_most=1.0), *cells)) == 3


def test_a_measure_is_judged_only_where_it_is_taken() -> None:
    cells = [cell(0.0, a=1, b=1), cell(0.0, a=1)]
    assert len(verdicts(expect("limited", at_most=1.0), *cells)) == 1


def test_nodes_name_the_axes_that_tell_cells_apart_and_match_the_verdicts() -> None:
    cells = [cell(0.0, e=0.8, dt=1, p=p) for p in (0, 1)]
    claims = [expect(at={"e": 0.8}, at_most=1.0), expect(increasing={"along": "p"})]
    experiment = SimpleNamespace(
        measures=MEASURES, expectations=claims, controls=(), always=None, cells=lambda: cells
    )
    nodes = judge_nodes(experiment)
    assert nodes == ["claim at e=0.8, p=0", "claim at e=0.8, p=1", "claim"]
    assert [verdict.node for verdict in judge(MEASURES, claims, cells)] == nodes


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
