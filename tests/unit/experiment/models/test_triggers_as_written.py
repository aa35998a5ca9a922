"""States that make events happen, as a file has them: one state each, of the bodies it takes."""

from __future__ import annotations

import pytest

from lavendersim.cell import CellTimestep
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

TEXT = """\
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 1]}}
events:
  - {event}
duration: 1
"""
STATE = "{{when: {state}, body: ball, remove: true}}"


def refusals(event: str) -> list[str]:
    try:
        load_experiment_text(TEXT.format(event=event), "triggers.yaml").cells()
    except ConfigError as error:
        return [str(one).partition("error: ")[2] or str(one) for one in error.args[0].splitlines()]
    return []


def resolved(state: str):
    text = TEXT.format(event=STATE.format(state=state))
    config = load_experiment_text(text, "triggers.yaml").cells()[0].config
    assert config.events == ()
    return config.triggered[0]


def test_a_direction_is_normalised_and_upwards_by_default() -> None:
    along = resolved("{body: ball, along: [0, 3, 4], above: 2}").when
    assert (along.condition, along.bodies, along.value) == ("above", ("ball",), 2.0)
    assert along.along == pytest.approx((0.0, 0.6, 0.8), abs=2e-16)
    assert resolved("{body: ball, below: 2}").when.along == (0.0, 0.0, 1.0)
    speed = resolved("{body: ball, slower_than: 2}").when
    assert (speed.along, speed.value) == (None, 2.0)


def test_a_contact_has_two_bodies_and_no_number() -> None:
    found = resolved("{leaves: [floor, ball]}")
    assert (found.when.bodies, found.when.value) == (("floor", "ball"), None)
    assert found.event.remove
    assert not isinstance(found.event, CellTimestep)


@pytest.mark.parametrize(
    ("event", "sentence"),
    [
        ("{body: ball, remove: true}", "[s] a time, or else when: a state that makes it happen"),
        ("{at: 0.1, when: {touches: [ball, floor]}, gravity: 0}", "expected at or when"),
        ("{when: {touches: [ball, floor]}, timestep: 1/100}", "a timestep changes at a time"),
        (STATE.format(state="{touches: [ball, flor]}"), 'did you mean "floor"?'),
        (STATE.format(state="{touches: [ball, ball]}"), 'expected two bodies, found "ball" twice'),
        (
            STATE.format(state="{touches: [ball, floor], body: ball}"),
            "touches names its two bodies",
        ),
        (STATE.format(state="{faster_than: 2}"), "name of the body of faster_than"),
        (STATE.format(state="{body: ball}"), "a state, touches, leaves, faster_than, slower_than"),
        (STATE.format(state="{body: ball, above: 1, below: 0}"), "has above; expected one state"),
        (
            STATE.format(state="{body: ball, along: [1, 0, 0], faster_than: 1}"),
            "faster_than has no direction; expected above or below",
        ),
        (STATE.format(state="{body: ball, slower_than: 0}"), "above 0"),
        (STATE.format(state="{body: ball, abov: 1}"), 'did you mean "above"?'),
    ],
)
def test_what_is_no_state_is_refused_in_a_sentence(event: str, sentence: str) -> None:
    found = refusals(event)
    assert any(sentence in one for one in found), found
