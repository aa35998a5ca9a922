"""The chapter preset is frozen: the chapter's checks are compared with these very numbers."""

from __future__ import annotations

from fractions import Fraction

import pytest

from lavendersim.cell.numerics import Numerics
from lavendersim.experiment import load_experiment_text
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
        "simultaneous_impacts": "together",
        "integrator": "semi_implicit_euler",
        "compliance_law": "regularised",
        "undetermined_forces": "as_solved",
        "accuracy": None,
        "smallest_timestep": 1e-9,
        "friction_cone": "disc",
        "sleeping": False,
        "sleep_speed": 0.005,
        "sleep_time": 0.5,
    }
    assert frozen == dict(CHAPTER)


@pytest.mark.parametrize("written", ["NAME", "{preset: NAME}", "{preset: NAME, slop: null}"])
@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_specifies_every_number(name: str, written: str) -> None:
    numerics = numerics_of(written.replace("NAME", name))
    assert numerics == PRESETS[name]
    assert set(dict(numerics)) == set(Numerics.model_fields)


def test_default_is_taken_where_no_preset_is_named() -> None:
    assert numerics_of("{}") == PRESETS["default"]


def test_specified_values_replace_those_of_the_preset() -> None:
    changed = numerics_of("{preset: chapter, sweeps: 50, slop: null}")
    assert changed == CHAPTER.model_copy(update={"sweeps": 50})


def test_null_is_a_value_of_the_tolerance_alone() -> None:
    assert numerics_of("{tolerance: null}").tolerance is None
    assert numerics_of("{solver: null}").solver == PRESETS["default"].solver


def numerics_of(written: str) -> Numerics:
    """Return the numerics of a cell of which only this is written."""
    ball = "{shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1]}"
    text = f"scene: {{bodies: {{ball: {ball}}}}}\nduration: 1\nnumerics: {written}\n"
    return load_experiment_text(text, "numerics.yaml").cells()[0].config.numerics
