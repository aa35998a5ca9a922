"""Events of a cell: what they make of a body, their order, and cells written before they had it."""

from __future__ import annotations

import json
from fractions import Fraction

import pytest

from lavendersim.cell import (
    CellEvent,
    CellGravity,
    CellTimestep,
    Surface,
    changes_of_bodies,
    changes_of_gravity,
)
from tests.oracle.laboratory import config, resolved, sphere

OLDER = {
    "at": 0.5, "body": "ball", "scale_mass": None, "teleport": None, "velocity": [1.0, 0.0, 0.0],
    "angular_velocity": None, "contact_cache": "keep", "remove": False,
}  # fmt: skip


def event(at: float = 0.5, name: str = "ball", **changes: object) -> CellEvent:
    return CellEvent.model_validate(OLDER | {"at": at, "body": name, "velocity": None} | changes)


def test_a_log_of_an_earlier_version_is_read_and_written_as_it_was() -> None:
    cell = resolved({"ball": sphere(0.1, (0, 0, 0))}) | {"events": [OLDER]}
    assert config(cell).as_dict()["events"] == [OLDER]
    assert json.loads(config(cell).as_json())["events"] == [OLDER]


@pytest.mark.parametrize(
    "written",
    [
        OLDER | {"orientation": [0.0, 1.0, 0.0, 0.0]},
        OLDER | {"surface": Surface(friction=0.25).model_dump(mode="json")},
        OLDER | {"surface_velocity": [0.0, 2.0, 0.0]},
        {"at": 0.5, "gravity": [0.0, 0.0, -1.62]},
        {"at": 0.5, "timestep": "1/480"},
    ],
)
def test_what_an_event_changes_comes_back_from_a_log(written: dict) -> None:
    cell = resolved({"ball": sphere(0.1, (0, 0, 0))}) | {"events": [written]}
    (found,) = config(cell).as_dict()["events"]
    assert found == written
    assert config(config(cell).as_dict()) == config(cell)


def test_a_body_after_an_event_differs_in_what_the_event_says_alone() -> None:
    ball = config(resolved({"ball": sphere(0.1, (0, 0, 0), friction=0.5)})).scene.bodies["ball"]
    ice = Surface(friction=0.125)
    assert event(surface=ice).after(ball) == ball.model_copy(update={"surface": ice})
    moving = event(surface_velocity=(1.0, 0.0, 0.0)).after(ball)
    assert moving == ball.model_copy(update={"surface_velocity": (1.0, 0.0, 0.0)})
    assert event(velocity=(1.0, 0.0, 0.0)).after(ball) is ball


def test_only_a_surface_changes_what_contacts_obey() -> None:
    assert event(surface=Surface()).changes_contacts
    assert event(surface_velocity=(0.0, 0.0, 0.0)).changes_contacts  # the belt stops
    assert not event(velocity=(1.0, 0.0, 0.0), orientation=(0.0, 1.0, 0.0, 0.0)).changes_contacts


def test_events_are_taken_by_their_time_and_as_written() -> None:
    late, early, same = event(2.0, "a"), event(1.0, "b"), event(1.0, "c")
    fall = CellGravity(at=1.5, gravity=(0.0, 0.0, -1.0))
    rise = CellGravity(at=0.5, gravity=(0.0, 0.0, 1.0))
    events = (
        late,
        fall,
        early,
        CellTimestep(at=0.0, timestep=Fraction(1, 2)),
        same,
        rise,
    )
    assert changes_of_bodies(events) == [early, same, late]
    assert changes_of_gravity(events) == [rise, fall]
