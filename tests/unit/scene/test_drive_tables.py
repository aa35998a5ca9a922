"""Functions of time in the engine's tables, evaluated by hand against what the config says."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.scene.drive_tables import drive_tables
from lavendersim.scene.plan import plan_of
from tests.marked_config import BALL, FLOOR, config, scene

DRUM = "drum: {shape: {kind: sphere, radius: 0.1}, kinematic: true, position: [0, 0, 3], motion: [{turn: [0, 0, 1], factor: {kind: sine, frequency: 2}}]}"  # noqa: E501


def tables(*forces: str, bodies: tuple[str, ...] = (FLOOR, BALL)) -> Any:
    text = config(
        scene=scene(*bodies, forces=f"[{', '.join(forces)}]"), numerics="{timestep: 1/10}"
    )
    cell = load_experiment_text(text, "a.yaml").cells()[0].config
    return drive_tables(cell, plan_of(cell).spec, cell.clock)


def force(factor: str, more: str = "") -> str:
    return f"{{body: ball, force: [1, 2, 3], factor: {factor}{more}}}"


def value(made: Any, row: int, time: float) -> float:
    """Return the function of a record: linear between its knots, then a slope, and a sine."""
    record = made.records[row]
    first, count = int(record["first"]), int(record["count"])
    knots = [
        (float(knot[0]), float(knot[1])) for knot in made.knots[first : first + count].tolist()
    ]
    level = knots[0][1]
    for (begin, low), (end, high) in itertools.pairwise(knots):
        if begin <= time < end:
            level = low + (high - low) * (time - begin) / (end - begin)
            break
        if time >= end:
            level = high
    if time >= knots[-1][0]:
        level = knots[-1][1] + record["slope"] * (time - knots[-1][0])
    return float(level + record["amplitude"] * math.sin(record["omega"] * time + record["phase"]))


@pytest.mark.parametrize(
    ("factor", "expected"),
    [
        ("{kind: ramp, rate: 2, from: 0.5}", lambda t: 2.0 * max(t - 0.5, 0.0)),
        ("{kind: ramp, rate: 2, from: 0.5, to: 1}", lambda t: 2.0 * min(max(t - 0.5, 0.0), 0.5)),
        (
            "{kind: sine, frequency: 3, amplitude: 2, phase_degrees: 90, offset: 5}",
            lambda t: 5.0 + 2.0 * math.cos(6.0 * math.pi * t),
        ),
        ("{kind: pulse, from: 0.25, to: 0.75}", lambda t: float(0.25 <= t < 0.75)),
        (
            "{kind: table, times: [0.25, 0.5, 1], values: [1, 3, -1]}",
            lambda t: float(np.interp(t, [0.25, 0.5, 1.0], [1.0, 3.0, -1.0])),
        ),
    ],
)
def test_a_record_is_the_function_that_the_config_says(
    factor: str, expected: Callable[[float], float]
) -> None:
    made = tables(force(factor))
    for time in np.arange(0.0, 1.5, 1 / 64):
        assert value(made, 0, time) == pytest.approx(expected(time), abs=1e-12), time


def test_each_function_has_knots_of_its_own_and_its_body() -> None:
    ramp, table = "{kind: ramp, from: 0.5}", "{kind: table, times: [0, 1], values: [4, 5]}"
    made = tables(force(table), force(ramp), bodies=(FLOOR, DRUM, BALL))
    assert sorted(made.records["body"].tolist()) == [1, 2, 2]
    spans = sorted((int(one["first"]), int(one["first"] + one["count"])) for one in made.records)
    assert spans[0][0] == 0
    assert spans[-1][1] == len(made.knots)
    assert all(one[1] == other[0] for one, other in itertools.pairwise(spans))
    pushing = [k for k in range(3) if made.records["body"][k] == 2]
    found = sorted(value(made, k, 0.75) for k in pushing)
    assert found == pytest.approx([0.25, 4.75])


@pytest.mark.parametrize(
    ("more", "begin", "end"),
    [
        ("", 0, 10),
        (", from: 0.25", 3, 10),  # the first step that starts then: at 0.3 s
        (", from: 0.3, to: 0.7", 3, 7),
        (", to: 0.35", 0, 4),
    ],
)
def test_a_force_acts_from_the_first_step_that_starts_then(more: str, begin: int, end: int) -> None:
    (record,) = tables(force("{kind: ramp}", more)).records
    assert (record["begin_step"], record["end_step"]) == (begin, end)
    assert [record[f"f{axis}"] for axis in "xyz"] == [1.0, 2.0, 3.0]


def test_a_motion_is_prescribed_at_all_times() -> None:
    (record,) = tables(bodies=(FLOOR, DRUM, BALL)).records
    assert (record["begin_step"], record["end_step"]) == (0, np.iinfo(np.int64).max)


def test_an_engine_without_such_an_effect_has_no_table() -> None:
    assert tables("{body: ball, force: [1, 0, 0]}") == ()
