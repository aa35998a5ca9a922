"""The benchmark of statics times a scene under both laws, in a process beside."""

from __future__ import annotations

from tests.benchmarks import statics
from tests.benchmarks.statics import SPRING, Row

BALL = Row(
    "ball",
    (statics.FLOOR, statics.body("one", "{kind: sphere, radius: 0.1}", "[0, 0, 0.1]")),
    SPRING,
    "compliance: 1e-4",
)


def test_a_row_has_both_times_and_their_ratio() -> None:
    """Of one ball, whose engines compile soonest."""
    *_, row = statics.measure(None, 2, 4, (BALL,)).splitlines()
    name, without, own, ratio = (cell.strip() for cell in row.strip("|").split("|"))
    assert name == "ball"
    assert float(without) > 0.0
    assert float(ratio) > 0.0
    assert abs(float(ratio) - float(own) / float(without)) <= 0.02 * float(ratio) + 0.005


def test_rows_against_a_commit_before_are_left_out_without_it() -> None:
    assert not statics.ROWS[0].without
    assert statics.measure(None, 1, 1, statics.ROWS[:1]).count("\n") == 1
