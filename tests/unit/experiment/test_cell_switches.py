"""`effects:` as written becomes switches; a cell knows where each of them stands."""

from __future__ import annotations

import pytest
import yaml

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 1]}
duration: 1
"""
SWEPT = "sweep:\n  f: {path: effects.friction, values: [on, off]}\n"


def cells(more: str = "") -> tuple:  # type: ignore[type-arg]
    return load_experiment_text(SCENE + more, "t.yaml").cells()


def test_nothing_specified_switches_nothing() -> None:
    experiment = load_experiment_text(SCENE, "t.yaml")
    assert not experiment.switches_effects
    (cell,) = experiment.cells()
    assert cell.config.as_dict()["effects"] == {"force": False, "switches": {}}


def test_on_and_off_are_texts_in_whatever_order() -> None:
    (cell,) = cells("effects: {friction: on, force: true, drag: off}\n")
    expected = {"force": True, "switches": {"drag": "off", "friction": "on"}}
    assert cell.config.as_dict()["effects"] == expected
    # Also for readers of YAML 1.1, which take a plain `on` for true.
    assert yaml.safe_load(cell.config.as_json())["effects"] == expected


@pytest.mark.parametrize("written", ["", "effects: {drag: off}\n", "effects: {friction: off}\n"])
def test_a_sweep_reaches_every_name_written_or_not(written: str) -> None:
    experiment = load_experiment_text(SCENE + SWEPT + written, "t.yaml")
    assert experiment.switches_effects
    on, off = experiment.cells()
    assert on.config.as_dict()["effects"]["switches"]["friction"] == "on"
    assert off.config.as_dict()["effects"]["switches"]["friction"] == "off"
    assert [cell.label for cell in (on, off)] == ["f=on", "f=off"]
    assert on.digest != off.digest


def test_a_later_product_of_a_sweep_counts() -> None:
    first, second = "{path: duration, values: [1, 2]}", "{path: effects.force, values: [true]}"
    union = f"sweep:\n  - g: {first}\n  - f: {second}\n"
    assert load_experiment_text(SCENE + union, "t.yaml").switches_effects


def test_a_defect_stands_at_the_key() -> None:
    (cell,) = cells("effects:\n  drag: off\n  friction: on\n")
    assert str(cell.defect(("effects", "friction"), "why")) == "t.yaml:8:3: why"


def test_a_defect_of_a_swept_switch_stands_at_its_value() -> None:
    on, off = cells("effects: {friction: on}\n" + SWEPT)
    values = "  f: {path: effects.friction, values: [on, off]}"
    columns = [values.index("[on") + 2, values.index("off]") + 1]
    assert [str(c.defect(("effects", "friction"), "why")) for c in (on, off)] == [
        f"t.yaml:8:{column}: why" for column in columns
    ]


@pytest.mark.parametrize(("value", "instead"), [("true", "on"), ("false", "off")])
def test_true_and_false_are_refused_with_what_to_write(value: str, instead: str) -> None:
    with pytest.raises(ConfigError, match=f"expected on or off, found {value}; write {instead}$"):
        cells(f"effects: {{friction: {value}}}\n")
