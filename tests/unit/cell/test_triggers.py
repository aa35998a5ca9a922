"""Events of triggers happen at the time of the state that met them, and none to what is gone."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from lavendersim.cell import (
    CellConfig,
    CellEvent,
    CellGravity,
    CellTrigger,
    CellTriggeredEvent,
    happened,
    met_after,
)
from lavendersim.clock import Clock
from lavendersim.quantities.scalars import exact
from tests.oracle.laboratory import config, resolved, sphere

CLOCK = Clock(Fraction(1, 7))
TOUCH = CellTrigger(condition="touches", bodies=("ball", "floor"))


def change(body: str = "ball", at: float = 0.0, **values: object) -> CellEvent:
    """Return an event that sets a velocity, or what else is given."""
    nothing = dict.fromkeys(("scale_mass", "teleport", "velocity", "angular_velocity"))
    kept = {"contact_cache": "keep", "remove": False, "body": body, "at": at}
    return CellEvent.model_validate(nothing | kept | values)


def triggered(event: CellEvent | CellGravity) -> CellTriggeredEvent:
    """Return an event that a touch makes happen."""
    return CellTriggeredEvent(when=TOUCH, event=event)


@pytest.mark.parametrize("done", range(60))
def test_it_acts_before_the_step_after_the_one_that_met_it(done: int) -> None:
    """Whatever its time is as a double: the clock takes it for the same step."""
    (event,) = happened((), [triggered(change())], {0: done}, CLOCK)
    assert CLOCK.steps_until(exact(event.at)) == done
    assert event.at == pytest.approx(done / 7, rel=3e-16)


def test_what_was_not_met_has_not_happened() -> None:
    timed = change(at=0.5)
    found = happened([timed], [triggered(change()), triggered(change("floor"))], {1: 2}, CLOCK)
    assert [(one.body, one.at) for one in found] == [("ball", 0.5), ("floor", 2 / 7)]


def test_nothing_happens_to_a_body_that_is_removed() -> None:
    gone = triggered(change(remove=True))
    later, sooner, other = change(at=0.9), change(at=0.1), change("floor", at=0.9)
    gravity = CellGravity(at=0.9, gravity=(0.0, 0.0, 1.0))
    found = happened([sooner, later, other, gravity], [gone], {0: 4}, CLOCK)
    assert found[:3] == (sooner, other, gravity)
    assert found[3].remove
    assert len(found) == 4


def test_steps_of_triggers_are_read_from_the_bits_of_their_rows() -> None:
    rows = np.zeros(6, [("step", "i8"), ("triggered", "i8")])
    rows["step"] = np.arange(3, 9)
    rows["triggered"][[1, 4]] = [0b101, 1 << 62]
    assert met_after([rows[:2], rows[2:]]) == {0: 4, 2: 4, 62: 7}
    assert met_after([rows[["step"]]]) == {}


@pytest.mark.parametrize(
    ("trigger", "text"),
    [
        (TOUCH, "ball touches floor"),
        (
            CellTrigger(condition="faster_than", bodies=("ball",), value=2.5),
            "ball is faster than 2.5 m/s",
        ),
        (
            CellTrigger(condition="below", bodies=("ball",), along=(0.0, 0.0, 1.0), value=-1.0),
            "ball is below -1 m along [0, 0, 1]",
        ),
    ],
)
def test_a_state_is_said_in_words(trigger: CellTrigger, text: str) -> None:
    assert trigger.text == text


def test_a_cell_without_triggers_is_written_as_by_earlier_versions() -> None:
    plain = config(resolved({"ball": sphere(0.1, (0, 0, 1))}))
    assert "triggered" not in plain.as_dict()
    with_one = plain.model_copy(update={"triggered": (triggered(change()),)})
    assert CellConfig.from_dict(with_one.as_dict()) == with_one
    assert with_one.planned_events == (change(),)
