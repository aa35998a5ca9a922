"""Events as written: what goes together, and of which bodies."""

from __future__ import annotations

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

TEXT = """\
scene:
  surfaces: {{ice: {{friction: 0.05}}}}
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 1]}}
    drum: {{shape: {{kind: sphere, radius: 0.1}}, kinematic: true, position: [0, 0, 3],
           motion: [{{turn: [0, 0, 1], factor: {{kind: sine, frequency: 2}}}}]}}
events:
  - {event}
duration: 1
"""


def refusals(event: str) -> list[str]:
    try:
        load_experiment_text(TEXT.format(event=event), "events.yaml")
    except ConfigError as error:
        return [line.split(": ", 1)[1] for line in str(error).splitlines()]
    return []


@pytest.mark.parametrize(
    "event",
    [
        "{at: 0.5, body: floor, surface: ice}",
        "{at: 0.5, body: floor, surface: {friction: 0.2}, surface_velocity: [1, 0, 0]}",
        "{at: 0.5, body: ball, orientation: [1, 1, 0, 0], velocity: [1, 0, 0], surface: ice}",
        "{at: 0.5, body: drum, surface: ice}",
        "{at: 0.5, gravity: [0, 0, 1]}",
    ],
)
def test_a_surface_may_change_on_any_body_and_gravity_on_none(event: str) -> None:
    assert refusals(event) == []


@pytest.mark.parametrize(
    ("event", "sentence"),
    [
        (
            "{at: 0.5, body: floor, orientation: [1, 1, 0, 0]}",
            'body: "floor" is a plane; expected a movable body',
        ),
        (
            "{at: 0.5, body: floor, surface: ice, teleport: [0, 0, 1]}",
            'teleport: "floor" is a plane; expected a movable body',
        ),
        (
            "{at: 0.5, body: drum, orientation: [1, 1, 0, 0]}",
            'orientation: motion says at all times where "drum" is; an event cannot change it',
        ),
        (
            "{at: 0.5, gravity: 0, timestep: 1/100}",
            "gravity: events[0] changes the timestep; a change of gravity is an event of its own",
        ),
        (
            "{at: 0.5, gravity: 0, body: ball}",
            "body: events[0] changes the gravity; what happens to a body is an event of its own",
        ),
        (
            "{at: 0.5, body: ball, orientation: [1, 1, 0, 0], contact_cache: keep}",
            "contact_cache: a new orientation always clears the body's cached contacts",
        ),
        (
            "{at: 0.5, body: ball, surface: icy}",
            'surface: no surface is called "icy"; did you mean "ice"?',
        ),
        (
            "{at: 0.5, body: ball, remove: true, surface: ice}",
            "surface: events[0] removes the body; expected no change",
        ),
    ],
)
def test_what_does_not_go_together_is_refused_in_a_sentence(event: str, sentence: str) -> None:
    (found,) = refusals(event)
    assert found == sentence
