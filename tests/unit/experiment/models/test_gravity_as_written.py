"""Gravity as written, of a scene and of an event: three forms, and what is none of them."""

from __future__ import annotations

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

TEXT = """\
scene:
  gravity: {gravity}
  bodies: {{ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 1]}}}}
events: [{{at: 0.5, gravity: {later}}}]
duration: 1
"""


def refusal(gravity: str = "9.81", later: str = "0") -> str:
    with pytest.raises(ConfigError) as caught:
        load_experiment_text(TEXT.format(gravity=gravity, later=later), "fall.yaml")
    return str(caught.value)


@pytest.mark.parametrize("form", ["0", "1.62", "[0, 0, -1.62]", "{slope: 0.5}", "{magnitude: 3}"])
def test_every_form_stands_in_a_scene_and_in_an_event(form: str) -> None:
    text = TEXT.format(gravity=form, later=form)
    config = load_experiment_text(text, "fall.yaml").cells()[0].config
    (event,) = config.events
    assert event.gravity == config.scene.gravity


@pytest.mark.parametrize("key", ["gravity", "later"])
def test_what_is_no_gravity_is_refused_where_it_stands(key: str) -> None:
    line = {"gravity": "2:12", "later": "4:29"}[key]
    assert f"{line}: gravity: expected a number" in refusal(**{key: '"down"'})
    assert "keep one" in refusal(**{key: "{slope: 0.5, tilt_degrees: 30}"})
    assert "expected a number of 0 or more [m/s^2]" in refusal(**{key: "-9.81"})
