"""Cells of a sweep: which there are, what they are called, and that equal ones are equal."""

from __future__ import annotations

import itertools
import json
import pickle
from fractions import Fraction

import pytest

from lavendersim.engine.effects import SURFACE_KEYS
from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.experiment import load as loading

DROP = """\
scene:
  surfaces: {rubber: {restitution: 0.8, compliance: 1e-6}}
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: rubber
      release: {above: floor, clearance: 1.0}
    other:
      shape: {kind: sphere, radius: 0.1}
      density: 1000
      surface: rubber
      position: [3, 0, 1]
numerics: chapter
duration: 2.0
"""


def load(text: str) -> Experiment:
    return load_experiment_text(text, "drop.yaml")


def swept(axes: str) -> Experiment:
    return load(DROP + "sweep:\n" + axes)


def test_one_cell_without_a_sweep() -> None:
    (cell,) = load(DROP).cells()
    assert (cell.index, cell.coordinates, cell.label) == (0, {}, "")


def test_first_axis_varies_slowest() -> None:
    experiment = swept(
        "  e: {path: scene.surfaces.rubber.restitution, values: [0.5, 0.8]}\n"
        "  timestep: {path: numerics.timestep, values: [1/240, 0.002]}\n"
    )
    assert [cell.label for cell in experiment.cells()] == [
        "e=0.5, timestep=1/240",
        "e=0.5, timestep=0.002",
        "e=0.8, timestep=1/240",
        "e=0.8, timestep=0.002",
    ]
    assert experiment.axes == {"e": (0.5, 0.8), "timestep": (Fraction(1, 240), 0.002)}
    assert [cell.config.numerics.timestep for cell in experiment.cells()] == [
        Fraction(1, 240),
        Fraction(1, 500),  # the decimal as written, not its float
    ] * 2


def test_union_of_products_keeps_axes_apart() -> None:
    experiment = swept(
        "  - e: {path: scene.surfaces.rubber.restitution, values: [0.5, 0.8]}\n"
        "  - sweeps: {path: numerics.sweeps, values: [10]}\n"
    )
    labels = [cell.label for cell in experiment.cells()]
    assert labels == ["e=0.5", "e=0.8", "sweeps=10"]
    assert experiment.cells()[2].config.scene.bodies["ball"].surface.restitution == 0.8


def test_sweep_through_a_surface_name_leaves_other_bodies_alone() -> None:
    experiment = swept("  e: {path: scene.bodies.ball.surface.restitution, values: [0.1]}\n")
    bodies = experiment.cells()[0].config.scene.bodies
    assert bodies["ball"].surface.restitution == 0.1
    assert bodies["ball"].surface.compliance == 1e-6
    assert bodies["other"].surface.restitution == 0.8


def test_sweep_of_a_value_that_is_not_written_starts_from_the_default() -> None:
    experiment = swept("  c: {path: scene.bodies.floor.surface.compliance, values: [1e-5]}\n")
    surface = experiment.cells()[0].config.scene.bodies["floor"].surface
    assert (surface.restitution, surface.compliance) == (0.0, 1e-5)


def test_sweep_of_a_vector_and_of_one_component() -> None:
    whole = swept("  at: {path: scene.bodies.other.position, values: [[1, 2, 3], [4, 5, 6]]}\n")
    assert [c.label for c in whole.cells()] == ["at=[1, 2, 3]", "at=[4, 5, 6]"]
    assert whole.cells()[1].config.scene.bodies["other"].position == (4.0, 5.0, 6.0)
    one = swept("  z: {path: scene.bodies.other.position.2, values: [7]}\n")
    assert one.cells()[0].config.scene.bodies["other"].position == (3.0, 0.0, 7.0)


def test_resolved_leaves_nothing_open() -> None:
    resolved = load(DROP).cells()[0].config.as_dict()
    ball, other = resolved["scene"]["bodies"]["ball"], resolved["scene"]["bodies"]["other"]
    others = {key.name: key.default for key in SURFACE_KEYS}
    assert {"friction", "torsional_friction", "rolling_friction"} < others.keys()
    assert ball["surface"] == others | {"restitution": 0.8, "compliance": 1e-6}
    assert ball["position"] == [0.0, 0.0, 1.1]
    assert ball["release"]["clearance"] == 1.0
    # 4/3 pi r^3 rho
    assert other["mass"] == pytest.approx(4.18879020478639, rel=1e-15)
    assert resolved["scene"]["gravity"] == [0.0, 0.0, -9.81]
    assert resolved["numerics"]["timestep"] == "1/240"
    assert resolved["numerics"]["tolerance"] is None
    assert json.loads(json.dumps(resolved)) == resolved
    assert json.loads(load(DROP).cells()[0].config.as_json()) == resolved


def test_equal_simulations_have_equal_digests_however_they_are_written() -> None:
    other_words = DROP.replace("surface: rubber", "surface: {compliance: 1e-6, restitution: 4/5}")
    other_words = (
        "# a comment\n"
        + other_words.replace("numerics: chapter\n", "")
        + ("numerics: {preset: chapter, slop: 1e-3}\nmeasure: {n: {kind: simulated_duration}}\n")
    )
    assert load(other_words).cells()[0].digest == load(DROP).cells()[0].digest


def test_digest_tells_cells_apart() -> None:
    experiment = swept("  phase: {path: scene.bodies.ball.release.phase, values: [0, 1/16, 1/8]}\n")
    digests = [cell.digest for cell in experiment.cells()]
    assert all(one != other for one, other in itertools.combinations(digests, 2))


def test_order_of_bodies_changes_the_digest() -> None:
    # the solver visits contacts in the order of bodies
    head, floor, rest = DROP.partition("    floor: {shape: {kind: plane}}\n")
    body, numerics, tail = rest.partition("numerics")
    assert load(head + body + floor + numerics + tail).cells()[0].digest != (
        load(DROP).cells()[0].digest
    )


def test_cells_travel_to_other_processes() -> None:
    experiment = swept("  timestep: {path: numerics.timestep, values: [1/240, 1/480]}\n")
    for cell in experiment.cells():
        sent = pickle.loads(pickle.dumps(cell))
        assert (sent.digest, sent.label) == (cell.digest, cell.label)


def test_large_sweep_builds_its_cells_when_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    axes = "  n: {path: numerics.sweeps, values: [1, 2, 3]}\n"
    small = swept(axes)
    monkeypatch.setattr(loading, "MOST_CELLS_CHECKED", 2)
    large = swept(axes)
    assert [cell.digest for cell in large.cells()] == [cell.digest for cell in small.cells()]


def test_cell_beyond_the_checked_ones_refuses_at_its_value(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loading, "MOST_CELLS_CHECKED", 2)
    experiment = swept("  n: {path: numerics.sweeps, values: [1, 2, -3]}\n")
    with pytest.raises(ConfigError, match=r"drop\.yaml:18:45: sweeps: .*found -3"):
        _ = experiment.cells()[2].config


@pytest.mark.parametrize(
    ("duration", "timestep", "steps"),
    [("2.0", "1/240", 480), ("0.1", "0.1", 1), ("1", "1/3", 3), ("0.3", "0.1", 3)],
)
def test_steps_are_counted_in_exact_numbers(duration: str, timestep: str, steps: int) -> None:
    text = DROP.replace("duration: 2.0", f"duration: {duration}")
    text = text.replace("numerics: chapter", f"numerics: {{timestep: {timestep}}}")
    assert load(text).cells()[0].config.steps == steps
