"""Axes: ranges and geometric steps, several places moved together, whole shapes by name."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import pytest

from lavendersim.experiment import Experiment, load_experiment_text

SCENE = """
scene:
  surfaces: {soft: {compliance: 0.001}, frictional: {friction: 0.5}}
  shapes: {ball: {kind: sphere, radius: 0.1}, cube: {kind: box, size: [0.2, 0.2, 0.2]}}
  bodies:
    floor: {shape: {kind: plane}}
    a: {shape: ball, mass: 1, position: [0, 0, 1]}
    b: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1]}
  arrangements:
    row: {kind: tower, count: 2, base: [5, 0, 0], body: {shape: cube, mass: 1}}
duration: 1
sweep: {x: {AXIS}}
"""


def swept(axis: str) -> Experiment:
    return load_experiment_text(SCENE.replace("AXIS", axis), "made.yaml")


def values(axis: str) -> list[object]:
    return [cell.coordinates["x"] for cell in swept(axis).cells()]


def test_a_range_has_one_value_more_than_steps_and_both_ends() -> None:
    axis = "path: scene.bodies.a.mass, range: {from: 1, to: 2, steps: 10}"
    assert values(axis) == [1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2]


def test_a_range_may_fall() -> None:
    assert values("path: scene.bodies.a.mass, range: {from: 3, to: 1, steps: 2}") == [3, 2, 1]


def test_geometric_steps_of_ratios_stay_exact() -> None:
    axis = "path: numerics.timestep, geometric: {from: 1/60, to: 1/480, steps: 3}"
    assert values(axis) == [Fraction(1, n) for n in (60, 120, 240, 480)]
    timesteps = [cell.config.numerics.timestep for cell in swept(axis).cells()]
    assert timesteps == [Fraction(1, n) for n in (60, 120, 240, 480)]


def test_geometric_steps_have_equal_factors() -> None:
    axis = "path: scene.bodies.a.mass, geometric: {from: 1, to: 2, steps: 3}"
    first, *_, last = found = [float(str(value)) for value in values(axis)]
    assert (first, last) == (1, 2)
    # twelve digits are kept
    assert [b / a for a, b in pairwise(found)] == pytest.approx([2 ** (1 / 3)] * 3, rel=1e-11)


def masses(experiment: Experiment) -> list[tuple[float | None, float | None]]:
    bodies = [cell.config.scene.bodies for cell in experiment.cells()]
    return [(one["a"].mass, one["b"].mass) for one in bodies]


def test_several_paths_take_the_same_values() -> None:
    both = swept("paths: [scene.bodies.a.mass, scene.bodies.b.mass], values: [2, 3]")
    assert masses(both) == [(2, 2), (3, 3)]


def test_several_paths_take_their_own_values_and_the_first_names_the_cells() -> None:
    own = swept("paths: {scene.bodies.a.mass: [2, 3], scene.bodies.b.mass: [5, 5]}")
    assert masses(own) == [(2, 5), (3, 5)]
    assert [cell.label for cell in own.cells()] == ["x=2", "x=3"]


def test_a_whole_shape_is_swept_by_name() -> None:
    cells = swept("path: scene.bodies.a.shape, values: [ball, cube]").cells()
    assert [cell.config.scene.bodies["a"].shape.kind for cell in cells] == ["sphere", "box"]


def test_a_whole_surface_is_swept_by_name() -> None:
    cells = swept("path: scene.bodies.a.surface, values: [soft, frictional]").cells()
    assert [cell.config.scene.bodies["a"].surface.friction for cell in cells] == [0, 0.5]


def test_a_path_through_a_named_shape_varies_the_own_copy_of_the_body() -> None:
    cell = swept("path: scene.bodies.a.shape.radius, values: [0.5]").cells()[0]
    assert cell.config.scene.bodies["a"].shape.radius == 0.5  # type: ignore[union-attr]


def test_bodies_of_an_arrangement_have_a_shape_by_name() -> None:
    cell = swept("path: duration, values: [1]").cells()[0]
    assert cell.config.scene.bodies["row_1"].shape.kind == "box"
