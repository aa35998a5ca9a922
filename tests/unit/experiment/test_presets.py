"""The chapter preset is frozen: the chapter's checks are held against these very numbers."""

from __future__ import annotations

from fractions import Fraction

import pytest

from lavendersim.cell.numerics import Numerics
from lavendersim.experiment.models.experiment import NumericsChange
from lavendersim.experiment.resolve.cell import resolve_numerics
from lavendersim.experiment.resolve.presets import CHAPTER, PRESETS


def test_chapter_is_frozen() -> None:
    frozen = {
        "timestep": Fraction(1, 240),
        "solver": "projected_gauss_seidel",
        "sweeps": 22,
        "over_relaxation": 1.0,
        "order": "coloured",
        "tolerance": None,
        "warm_start": True,
        "stabilisation_gain": 0.02,
        "slop": 0.001,
        "projection": 0.2,
        "projection_sweeps": 22,
        "restitution_threshold": 2.0,
        "cache_distance": 0.02,
        "cache_normal_cosine": 0.95,
        "speculative": False,
        "impacts": "captured",
        "integrator": "semi_implicit_euler",
        "friction_cone": "disc",
        "sleeping": False,
        "sleep_speed": 0.005,
        "sleep_time": 0.5,
    }
    assert frozen == CHAPTER


@pytest.mark.parametrize("name", PRESETS)
def test_preset_states_every_number(name: str) -> None:
    assert set(PRESETS[name]) == set(Numerics.model_fields)
    assert set(NumericsChange.model_fields) == {*Numerics.model_fields, "preset"}
    assert dict(resolve_numerics(name)) == PRESETS[name]


def test_stated_values_replace_those_of_the_preset() -> None:
    change = NumericsChange(preset="chapter", sweeps=50, slop=None)
    changed = resolve_numerics(change)
    assert changed.sweeps == 50
    assert changed.slop == CHAPTER["slop"]
    assert changed.stabilisation_gain == CHAPTER["stabilisation_gain"]
