"""Comparisons: what counts as a difference, and how it stands in the table."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.comparison.compare import (
    CellStates,
    Comparison,
    MeasureChange,
    VerdictChange,
    _measures,
    _verdicts,
    differs,
)
from lavendersim.comparison.pairing import CellPair, Pairing
from lavendersim.comparison.states import LENGTH, NOTHING, POSES, Apart, Parting
from lavendersim.comparison.trees import ABSENT, Difference

RUN: Any = SimpleNamespace(path=Path("runs/a"))
COMPLETE = ("complete", "complete")
SAME = CellStates("e=1", Parting(NOTHING, 10), COMPLETE)
NO_PAIRING = Pairing(("e",), [], [], [])


def comparison(**changes: Any) -> Comparison:
    empty: Any = Comparison(RUN, RUN, [], [], [], [], [], NO_PAIRING, [], [], {}, [SAME])
    return empty._replace(**changes)


def test_equal_but_for_the_machine_and_its_times() -> None:
    machine = [Difference("cores", 2, 4)]
    one = comparison(machine=machine, costs={"physics_us_per_step": (1.0, 2.0)})
    assert one.equal
    assert one.table()["equal"] is True
    assert one.table()["machine"] == [{"path": "cores", "a": 2, "b": 4}]


@pytest.mark.parametrize(
    "change",
    [
        {"config": [Difference("duration", 1, 2)]},
        {"resolved": [(Difference("duration", 1, 2), 3)]},
        {"versions": [Difference("numpy", "1", "2")]},
        {"measures": [MeasureChange("e=1", "m", 1.0, 2.0)]},
        {"verdicts": [VerdictChange("n", "pass", "FAIL")]},
        {"pairing": NO_PAIRING._replace(only_a=["e=2"])},
        {"pairing": NO_PAIRING._replace(only_b=["e=2"])},
        {"states": [SAME._replace(parting=Parting(LENGTH, 10))]},
        {"states": [SAME, SAME._replace(statuses=("complete", "diverged"))]},
    ],
)
def test_everything_else_is_a_difference(change: dict[str, Any]) -> None:
    assert not comparison(**change).equal


def test_where_states_part_stands_in_plain_data() -> None:
    apart = Apart("ball", 1e-9, 0.0)
    parting = Parting(POSES, 10, 3, 0.03, (apart,), 0.03, apart)
    (state,) = comparison(states=[SAME._replace(parting=parting)]).table()["states"]
    assert state["bodies"] == [{"body": "ball", "metres": 1e-9, "radians": 0.0}]
    assert state["farthest"]["body"] == "ball"
    assert (state["cell"], state["differs"], state["step"]) == ("e=1", "poses", 3)


def test_a_number_that_json_does_not_have_is_a_text() -> None:
    one = comparison(measures=[MeasureChange("e=1", "m", float("nan"), float("inf"))])
    (row,) = one.table()["measures"]
    assert (row["a"], row["b"]) == ("nan", "inf")


def test_statuses_alone_make_a_pair_differ() -> None:
    assert not differs(SAME)
    assert differs(SAME._replace(statuses=("complete", "diverged: ball")))


def results(*rows: dict[str, Any], **checks: bool) -> Any:
    cells = [SimpleNamespace(index=place, measures=row) for place, row in enumerate(rows)]
    judged = [SimpleNamespace(node=node, passed=passed) for node, passed in checks.items()]
    return SimpleNamespace(cells=cells, checks=judged)


def pairing(*indices: tuple[int, int]) -> Pairing:
    pairs = [
        CellPair(f"cell {a}", SimpleNamespace(index=a), SimpleNamespace(index=b))  # type: ignore[arg-type]
        for a, b in indices
    ]
    return Pairing((), pairs, [], [])


def test_measures_are_compared_pair_by_pair_and_reasons_are_no_difference() -> None:
    a = results({"m": 1.0, "n": float("nan"), "why": "a.mcap: lost"}, {"m": 5.0})
    b = results({"m": 5.0}, {"m": 1.0, "n": float("nan"), "why": "b.mcap: lost", "new": 2.0})
    assert _measures(pairing((0, 1), (1, 0)), (a, b)) == [
        MeasureChange("cell 0", "new", ABSENT, 2.0)
    ]
    (changed, *_) = _measures(pairing((0, 0)), (a, b))
    assert changed == MeasureChange("cell 0", "m", 1.0, 5.0)


def test_a_reason_in_place_of_a_number_is_a_difference() -> None:
    changes = _measures(pairing((0, 0)), (results({"m": 1.0}), results({"m": "no contact"})))
    assert changes == [MeasureChange("cell 0", "m", 1.0, "no contact")]


def test_verdicts_that_changed_and_those_of_one_run_alone() -> None:
    a, b = results(first=True, second=True, gone=False), results(first=True, second=False, new=True)
    assert _verdicts(a, b) == [
        VerdictChange("second", "pass", "FAIL"),
        VerdictChange("gone", "FAIL", ABSENT),
        VerdictChange("new", ABSENT, "pass"),
    ]
