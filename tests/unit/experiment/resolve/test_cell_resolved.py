"""A resolved cell is complete: its data says every default, and is read back as the same cell."""

from __future__ import annotations

from fractions import Fraction

import pytest

from lavendersim.cell import CellConfig
from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.resolve.presets import PRESETS
from tests.marked_config import config


def resolved(**sections: str) -> CellConfig:
    return load_experiment_text(config(**sections), "cell.yaml").cells()[0].config


@pytest.mark.parametrize("preset", ["default", "chapter"])
def test_numerics_are_those_of_the_preset_and_what_differs(preset: str) -> None:
    values = {**dict(PRESETS[preset]), "timestep": Fraction(1, 77), "slop": 0.003}
    found = resolved(numerics=f"{{preset: {preset}, timestep: 1/77, slop: 0.003}}")
    assert {key: getattr(found.numerics, key) for key in values if key != "preset"} == {
        key: value for key, value in values.items() if key != "preset"
    }


def test_sections_stand_as_they_are_written() -> None:
    found = resolved(
        numerics="chapter",
        duration="2.5",
        record="{contacts: every 3, residuals: {from: 0, to: 1}}",
        effects="{sleeping: on, drag: off, force: true}",
        study="{mistake: capture_in_sweeps}",
        events="[{at: 1, body: ball, velocity: [0, 0, 2]}, {at: 2, body: ball, remove: true}]",
    )
    assert found.duration == 2.5
    assert found.record.contacts == "every 3"
    assert (found.record.residuals.begin, found.record.residuals.end) == (0.0, 1.0)
    assert found.effects.force
    assert list(found.effects.switches.items()) == [("drag", "off"), ("sleeping", "on")]
    assert found.study.mistake == "capture_in_sweeps"
    assert [event.at for event in found.events] == [1.0, 2.0]


def test_the_cell_says_all_of_itself() -> None:
    found = resolved(numerics="{timestep: 1/7}", record="{velocities: true}")
    again = CellConfig.from_dict(found.as_dict())
    assert again == found
    assert again.numerics.timestep == Fraction(1, 7)


def test_order_of_switches_makes_no_other_cell() -> None:
    one = resolved(effects="{sleeping: on, drag: off}")
    assert one.as_dict() == resolved(effects="{drag: off, sleeping: on}").as_dict()
