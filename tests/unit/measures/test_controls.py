"""Negative controls: they pass when exactly what they name fails, in each of their cells."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.measures.controls import (
    ControlTrial,
    meant_to_end_early,
    trials,
    uncontrolled,
    verdict_of,
)
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.measures.verdict import Verdict


def cell(index: int, status: str = "complete") -> Any:
    log = SimpleNamespace(step={"step": [0, 1, 7]})
    return SimpleNamespace(index=index, status=status, coordinates={"e": index}, path=Path(f"{index}.mcap"), trace=lambda: log)  # noqa: E501  # fmt: skip


def claim(name: str, *cells: Any, measured: bool = True) -> Any:
    node = f"{name} at {[one.index for one in cells]}"
    return SimpleNamespace(
        name=name, node=node, cells=cells, expectation=name if measured else None
    )


def verdict(passed: bool, follows: bool = False, node: str = "n") -> Verdict:
    return Verdict("n", node, passed, 1.5, "", "", "how it failed", "", follows)


def control(fails: str, **at: Any) -> ExpectSpec:
    return ExpectSpec(name="control", fails=fails, at=at)


CELLS = [cell(0), cell(1)]


@pytest.mark.parametrize(
    ("named", "other", "passed", "why"),
    [
        (verdict(False), verdict(True), True, ""),
        (verdict(True), verdict(True), False, "energy did not fail"),
        (verdict(False), verdict(False, node="too"), False, "it failed, and so did too"),
        (verdict(False, follows=True), verdict(True), False, "energy did not fail"),
        (verdict(False), verdict(False, follows=True), True, ""),
    ],
)
def test_exactly_what_is_named_fails(
    named: Verdict, other: Verdict, passed: bool, why: str
) -> None:
    claims = [claim("energy", CELLS[0], measured=False), claim("apex", CELLS[0])]
    raw = {claims[0].node: named, claims[1].node: other}
    found = verdict_of(ControlTrial(control("energy"), "control", (CELLS[0],)), claims, raw)
    assert found.passed is passed
    assert why in found.message
    assert found.measured == 1.5


def test_a_claim_of_other_cells_is_none_of_the_controls_business() -> None:
    claims = [claim("energy", CELLS[0]), claim("apex", CELLS[1]), claim("both", *CELLS)]
    raw = {claims[0].node: verdict(False), claims[1].node: verdict(False), claims[2].node: verdict(False)}  # noqa: E501  # fmt: skip
    trial = ControlTrial(control("energy"), "control", (CELLS[0],))
    assert verdict_of(trial, claims, raw).passed


@pytest.mark.parametrize(
    ("status", "passed"),
    [("diverged: ball", True), ("complete", False), ("beyond bounds: speed 3", False)],
)
def test_a_cell_that_must_not_complete_does_not(status: str, passed: bool) -> None:
    trial = ControlTrial(control("completes"), "control", (cell(0, status),))
    found = verdict_of(trial, [], {})
    assert found.passed is passed
    assert found.measured == 7.0  # the last step there is


def test_a_cell_that_diverged_shows_nothing_of_another_claim() -> None:
    one = cell(0, "diverged: ball")
    claims = [claim("energy", one)]
    trial = ControlTrial(control("energy"), "control", (one,))
    found = verdict_of(trial, claims, {claims[0].node: verdict(False)})
    assert not found.passed
    assert "a cell did not complete: diverged: ball" in found.message


def test_a_control_that_selects_nothing_fails() -> None:
    (trial,) = trials([], [control("energy", e=9)], CELLS)
    assert trial.cells == ()
    found = verdict_of(trial, [], {})
    assert not found.passed
    assert "selects no cell" in found.message


def test_a_control_is_tried_in_each_cell_unless_its_claim_is_across_them() -> None:
    alone = [claim("energy", one) for one in CELLS]
    assert [one.node for one in trials(alone, [control("energy")], CELLS)] == [
        "control at e=0",
        "control at e=1",
    ]
    across = [claim("trend", *CELLS)]
    assert [one.cells for one in trials(across, [control("trend")], CELLS)] == [tuple(CELLS)]


def test_a_control_takes_over_what_it_names_in_its_cells() -> None:
    claims = [claim("energy", one, measured=False) for one in CELLS]
    claims += [claim("apex", one) for one in CELLS]
    left = uncontrolled(claims, [control("energy", e=0)], CELLS, stops=False)
    assert left == claims[1:]
    # a bound that ends the cell leaves nothing to measure there
    stopped = uncontrolled(claims, [control("energy", e=0)], CELLS, stops=True)
    assert stopped == [claims[1], claims[3]]
    ended = uncontrolled(claims, [control("completes", e=0)], CELLS, stops=False)
    assert ended == [claims[1], claims[3]]


def test_which_cells_are_meant_to_end_early() -> None:
    cells = [cell(0), cell(1, "beyond bounds: energy 3"), cell(2, "beyond bounds: speed 3")]
    assert meant_to_end_early([control("energy")], cells) == {1}
    assert meant_to_end_early([control("diverges", e=(0, 2))], cells) == {0, 2}
    assert meant_to_end_early([], cells) == frozenset()
