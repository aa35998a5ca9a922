"""A grid of several engines: what each declares as swept, and fragments that give one back."""

from __future__ import annotations

from fractions import Fraction
from math import prod

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.sweeps.cost_grid import fragment_of, over_the_grid, settings_of
from lavendersim.experiment.sweeps.engine_grid import paths_of, section_of, variants_of
from lavendersim.peers.catalogue import PEERS

STEPS = (Fraction(1, 60), Fraction(1, 240))
GRID = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 1]}
duration: 0.1
sweep:
  height: {path: scene.bodies.ball.position.2, values: [1, 2, 3]}
measure:
  apex: {kind: max_penetration, body: ball}
cost:
  error: {measure: apex}
  solvers: [projected_gauss_seidel]
  timesteps: [1/60, 1/240]
  sweeps: [2]
  warm_start: [true]
"""


@pytest.mark.parametrize("name", PEERS)
def test_every_engine_is_swept_over_each_timestep_its_own_defaults_among_them(name: str) -> None:
    peer = PEERS[name]
    found = list(variants_of(name, STEPS))
    count = sum(prod(map(len, one.values.values())) for one in peer.swept)
    assert len(set(found)) == len(found) == len(STEPS) * count
    kinds = {one.name for one in peer.settings}
    for variant, own, timestep in found:
        assert variant in peer.variants
        assert {key for key, _ in own} <= kinds
        assert timestep in STEPS
    assert name in {variant for variant, _, _ in found}  # its defaults, or one knob from them


def test_of_a_variant_its_own_settings_are_swept_and_one_that_declares_none_stands_as_it_is() -> (
    None
):
    assert {variant for variant, _, _ in variants_of("mujoco-cg", STEPS)} == {"mujoco-cg"}
    assert list(variants_of("mujoco-rk4", STEPS)) == [("mujoco-rk4", (), step) for step in STEPS]


def test_each_setting_of_the_grid_is_the_cell_that_its_fragment_gives() -> None:
    experiment = load_experiment_text(GRID, "ball.yaml")
    settings = settings_of(experiment, ("lavender", "mujoco"))
    cells = over_the_grid(experiment, settings).cells()
    assert len(cells) == 3 * len(settings)
    for place in range(0, len(cells), 3):
        setting, cell = settings[place // 3], cells[place].config
        text = GRID + fragment_of(experiment, setting)
        alone = load_experiment_text(text, "ball.yaml").cells()[0].config
        assert cell.engine == alone.engine
        assert cell.numerics == alone.numerics
        assert (cell.engine.name if cell.engine else "lavender") == setting.engine


def test_without_lavender_its_settings_are_left_out_but_for_the_truth() -> None:
    text = GRID.replace("measure: apex}", "measure: apex, truth: finest}")
    settings = settings_of(load_experiment_text(text, "ball.yaml"), ("bullet",))
    assert {one.engine for one in settings[:-1]} == {one.variant for one in PEERS["bullet"].swept}
    assert (settings[-1].role, settings[-1].engine) == ("truth", "lavender")


def test_an_engine_has_its_settings_under_its_name_and_lavender_none() -> None:
    assert paths_of("lavender", ()) == {}
    assert paths_of("mujoco-cg", (("iterations", 3),)) == {
        "engine": ("engine", "mujoco-cg"),
        "mujoco_iterations": ("engines.mujoco.iterations", 3),
    }
    assert section_of("rapier", ()) == {"engine": "rapier"}


@pytest.mark.parametrize(
    ("axis", "reported"),
    [
        ("which: {path: engine, values: [lavender, mujoco]}", "cost --engine"),
        ("mujoco_mass: {path: scene.bodies.ball.mass, values: [1, 2]}", "rename this one"),
    ],
)
def test_a_sweep_leaves_engines_and_their_names_to_the_grid(axis: str, reported: str) -> None:
    text = GRID.replace("measure:\n", f"  {axis}\nmeasure:\n", 1)
    with pytest.raises(ConfigError, match=reported):
        load_experiment_text(text, "ball.yaml")
