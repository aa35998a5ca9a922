"""Numbers by step and by contact, against loops over the rows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from synthetic import contacts, log_of, scene_of, trace_of

from lavendersim.errors import NOT_REPORTED, NotReportedError, UsageError
from lavendersim.measures import columns
from lavendersim.trace.absent import table_without

FLOOR = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.5}}
BOX = {"shape": {"kind": "box", "size": [2.0, 2.0, 2.0]}, "mass": 1.0}
BALL = {"shape": {"kind": "sphere", "radius": 0.25}, "mass": 1.0}


def test_rows_of_steps_are_those_of_a_loop() -> None:
    step = np.zeros(5, [("step", "i8")])
    step["step"] = [2, 3, 5, 8, 9]
    rows = np.zeros(6, [("step", "i8")])
    rows["step"] = [2, 2, 5, 9, 9, 9]
    expected = [list(step["step"]).index(number) for number in rows["step"]]
    assert columns.rows_of_steps(step, rows).tolist() == expected
    assert columns.rows_of_steps(step, rows[:0]).tolist() == []


def test_sums_and_depths_of_a_step_are_over_its_contacts() -> None:
    log = trace_of([0.0] * 5, [(1, 2.0, 0.1), (1, 3.0, 0.3), (3, 5.0, 0.2)])
    rows = columns.contacts_of(log, "ball", "floor")
    assert columns.summed_by_step(log, rows, "impulse_n").tolist() == [0.0, 5.0, 0.0, 5.0, 0.0]
    assert columns.deepest_by_step(log, rows).tolist() == [0.0, 0.3, 0.0, 0.2, 0.0]
    assert columns.pushing_runs(log, rows) == [(1, 1), (3, 3)]


def test_contacts_of_a_body_are_those_on_either_side() -> None:
    log = log_of(scene_of({"floor": FLOOR, "a": BALL, "b": BALL}), np.zeros((2, 3, 3)))
    log.contact = contacts([(1, 1.0, 0.0), (1, 2.0, 0.0), (1, 3.0, 0.0)])
    log.contact["body_a"], log.contact["body_b"] = [0, 0, 1], [1, 2, 2]
    assert columns.contacts_of(log, "a")["impulse_n"].tolist() == [1.0, 3.0]
    assert columns.contacts_of(log, "b", "a")["impulse_n"].tolist() == [3.0]
    assert columns.contacts_of(log, "floor", "b")["impulse_n"].tolist() == [2.0]


def test_an_impulse_is_along_its_normal_and_its_tangents() -> None:
    """n = z, t1 = x, so t2 = n x t1 = y."""
    names = ["nx", "ny", "nz", "impulse_n", "t1x", "t1y", "t1z", "impulse_t1", "impulse_t2"]
    rows = np.zeros(1, [(name, "f8") for name in names])
    for name, value in (("nz", 1.0), ("t1x", 1.0), ("impulse_n", 3.0), ("impulse_t1", 5.0), ("impulse_t2", 7.0)):  # noqa: E501  # fmt: skip
        rows[name] = value
    assert columns.impulses(rows).tolist() == [[5.0, 7.0, 3.0]]
    assert columns.impulses(rows[["nx", "ny", "nz", "impulse_n"]]).tolist() == [[0.0, 0.0, 3.0]]


@pytest.mark.parametrize("degrees", [0.0, 30.0, 45.0, 60.0])
def test_a_box_is_above_a_plane_by_its_lowest_corner(degrees: float) -> None:
    """Turned about x, a square of half edge 1 reaches |cos| + |sin| below its centre."""
    half = math.radians(degrees) / 2
    turn = [math.cos(half), math.sin(half), 0.0, 0.0]
    log = log_of(
        scene_of({"floor": FLOOR, "it": BOX}), [[[0, 0, 0], [1, 2, 5]]], [[[1, 0, 0, 0], turn]]
    )
    reach = math.cos(math.radians(degrees)) + math.sin(math.radians(degrees))
    found = columns.clearance_by_step(log, "it", "floor")
    assert found == pytest.approx([5.0 - 0.5 - reach], abs=1e-14)


def test_a_ball_is_above_a_plane_by_its_radius() -> None:
    log = log_of(scene_of({"floor": FLOOR, "it": BALL}), [[[0, 0, 0], [1, 2, 5]]])
    assert columns.clearance_by_step(log, "it", "floor").tolist() == [4.25]


@pytest.mark.parametrize("flags", ["", "0", "1", "0110", "1001", "111", "01011"])
def test_runs_are_where_a_loop_finds_them(flags: str) -> None:
    expected, start = [], None
    for place, flag in enumerate([*flags, "0"]):
        if flag == "1" and start is None:
            start = place
        elif flag == "0" and start is not None:
            expected.append((start, place - 1))
            start = None
    assert columns.runs_of(np.array([flag == "1" for flag in flags], bool)) == expected


def test_the_last_window_ends_with_the_run() -> None:
    log = trace_of([0.0] * 11)  # 0.1 s
    assert np.flatnonzero(columns.last_window(log, 0.03)).tolist() == [8, 9, 10]
    assert not columns.last_window(log, 0.11).any()
    assert columns.last_window(log, 0.1).sum() == 10


def test_the_first_step_that_ends_after_a_time() -> None:
    log = trace_of([0.0] * 4)
    assert columns.first_ending_after(log, 0.01) == 2
    assert columns.first_ending_after(log, 0.005) == 1
    assert columns.first_ending_after(log, 0.03) is None


def test_steps_of_one_length_have_it() -> None:
    log = trace_of([0.0] * 4)
    assert columns.one_timestep(log, 0, 3, "flip_time_error") == 0.01


def test_movable_bodies_are_meant_where_none_is_named() -> None:
    log = log_of(scene_of({"a": BALL, "floor": FLOOR, "b": BALL}), np.zeros((1, 3, 3)))
    assert columns.body_columns(log, ()) == [0, 2]
    assert columns.body_columns(log, ("b", "floor")) == [2, 1]


def test_energy_at_rest_is_that_on_the_plane() -> None:
    log = trace_of([1.0, 0.5, 0.25])
    # the centre of a ball of 0.1 m that lies on z = 0: m g r
    rest = columns.energy_at_rest(log, "ball", "floor", 1.0)
    assert rest == pytest.approx(2.0 * 9.81 * 0.1, rel=1e-14)
    log.resolved["events"] = [{"at": 0.01, "gravity": [0, 0, -1.0]}]
    with pytest.raises(UsageError, match="energy above that at rest"):
        columns.energy_at_rest(log, "ball", "floor", 1.0)


def test_a_column_that_an_engine_keeps_back_is_none_that_the_scene_does_without() -> None:
    log = trace_of([0.0] * 3, [])
    assert columns.step_column(log, "residual") is not None
    assert columns.step_column(log, "cone") is None
    log.step = table_without(log.step, {"cone": f"Engine {NOT_REPORTED}"})
    assert columns.step_column(log, "dissipation") is None
    with pytest.raises(NotReportedError, match="Engine does not report it"):
        columns.step_column(log, "cone")


def test_an_arrangement_stands_for_the_bodies_that_it_has_placed_and_a_body_for_itself() -> None:
    names = ["floor", "pin_1", "pin_2", "ball", "pin_4", "row"]
    bodies = {name: FLOOR if name == "floor" else BALL for name in names}
    log = log_of(scene_of(bodies), np.zeros((1, len(names), 3)))
    assert columns.body_columns(log, ["pin"]) == [1, 2]  # pin_4 is a body of its own: 3 is none
    assert columns.body_columns(log, ["ball", "pin", "row"]) == [3, 1, 2, 5]
    assert columns.body_columns(log, []) == [1, 2, 3, 4, 5]
