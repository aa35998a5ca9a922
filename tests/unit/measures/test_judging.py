"""Claims are judged in the cells they select; none can pass by measuring nothing."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from judged import MEASURES, cell, expect, verdicts
from synthetic import SyntheticCell

from lavendersim.errors import TraceError
from lavendersim.measures import judge, judge_nodes
from lavendersim.measures.judging import TIMES
from lavendersim.measures.registration import FUNCTIONS
from lavendersim.measures.specs.states import FirstPassage, PositionAt


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


@pytest.mark.parametrize(
    ("time", "why"), [(3.0, "taken at 3 s, and the run ends at 0.03 s"), (0.03, "")]
)
def test_a_measure_behind_the_end_of_the_run_says_so(time: float, why: str) -> None:
    """Of four states of 10 ms the last is at 0.03 s; without velocities NaN has other reasons."""
    spec = PositionAt(kind="position", body="ball", along=(0.0, 0.0, 1.0), time=time)
    (verdict,) = judge({"high": spec}, [expect("high", at_most=5.0)], [cell(0.0)])
    assert verdict.passed is not bool(why)
    assert why in verdict.message
    assert "run ends" not in verdict.message or why


def test_a_number_that_a_whole_run_does_not_have_says_why() -> None:
    spec = FirstPassage(kind="first_passage", body="ball", along=(0.0, 0.0, 1.0), level=1e9)
    (verdict,) = judge({"time": spec}, [expect("time", at_most=5.0)], [cell(0.0)])
    assert not verdict.passed
    assert "never crosses that level" in verdict.message


def test_every_measure_that_can_be_no_number_says_why_it_is_none() -> None:
    """Functions of measures say of NaN when it is; a time behind the run's end has a sentence."""
    silent = [
        model.__name__
        for model, function in FUNCTIONS.items()
        if model.__module__.startswith("lavendersim.")
        and "NaN" in (function.__doc__ or "")
        and not model.NO_NUMBER
        and not set(TIMES) & set(model.model_fields)
    ]
    assert not silent
