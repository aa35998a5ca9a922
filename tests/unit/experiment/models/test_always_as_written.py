"""`always` as written: a check whose terms are not in the log is refused where it is asked for."""

from __future__ import annotations

import pytest

from tests.marked_config import FLOOR, assert_refused, config, refusals, scene

DRAGGED = (
    "ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1], drag: {linear: 0.1}}"
)
DRAG = 'what the drag of "ball" takes is not in the log'
SLEEPS = "what falling asleep takes is not in the log"
POSES = "it takes the poses of every step, and record.poses is every 4"


def test_every_default_is_taken_where_the_log_has_it_all() -> None:
    assert refusals(config(always="{}")) == []


def test_a_default_is_refused_at_the_section_and_a_bound_at_its_value() -> None:
    slept = {"numerics": "{sleeping: true}"}
    whole = f"momentum: {SLEEPS}; specify momentum: none"
    assert_refused(config(**slept).replace("scene", "§always: {}\nscene"), whole)
    assert_refused(config(**slept, always="{momentum: §1e-9}"), whole)
    assert refusals(config(**slept, always="{momentum: none}")) == []


def test_momentum_that_a_medium_takes_is_in_no_log() -> None:
    dragged = scene(FLOOR, DRAGGED)
    assert_refused(
        config(scene=dragged).replace("scene", "§always: {}\nscene", 1),
        f"momentum: {DRAG}; specify momentum: none",
    )
    idle = dragged.replace("linear: 0.1", "linear: 0")
    assert refusals(config(scene=idle, always="{}")) == []


@pytest.mark.parametrize("later", ["events: [{at: 0.5, body: ball, velocity: [0, 0, 1]}]", ""])
def test_energy_needs_the_poses_of_every_step_where_events_act(later: str) -> None:
    """An event's work is found from where the bodies are; without one `/step` has all of it."""
    text = config(record="{poses: every 4}", always="{energy: §1e-9, penetration: none}")
    assert_refused(
        text + later if later else text.replace("§", ""),
        *([f"energy: {POSES}; specify energy: none"] if later else []),
    )
