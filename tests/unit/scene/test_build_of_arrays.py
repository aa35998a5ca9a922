"""The engine's arrays of a cell: parameters, velocities, windows of steps, and links."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from lavendersim.cell import CellConfig
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import Scene, build, residual_window, set_gravity, set_timestep
from lavendersim.scene.plan import plan_of
from tests.marked_config import BALL, FLOOR, config, scene

MOVING = BALL.replace("mass: 1", "mass: 1, velocity: [1, 2, 3], angular_velocity: [4, 5, 6]")
BOX = "crate: {shape: {kind: box, size: [1, 2, 3]}, mass: 2, position: [4, 0, 5], velocity: [7, 8, 9], angular_velocity: [1, 0, 0]}"  # noqa: E501


def cell_of(**sections: str) -> CellConfig:
    return load_experiment_text(config(**sections), "a.yaml").cells()[0].config


def built(**sections: str) -> Scene:
    cell = cell_of(**sections)
    return build(cell, plan_of(cell).spec)


def parameters(numerics: str = "{}", gravity: str = "[3, 0, -4]") -> np.void:
    return built(scene=scene(gravity=gravity), numerics=numerics).parameters[0]


def test_nothing_rebounds_below_what_gravity_gives_in_so_many_steps() -> None:
    p = parameters("{timestep: 1/50, restitution_threshold: 3}")
    assert (p["gx"], p["gy"], p["gz"], p["dt"]) == (3.0, 0.0, -4.0, 0.02)
    assert p["restitution_speed"] == pytest.approx(3 * 5.0 / 50, rel=1e-15)


def test_a_change_of_gravity_or_of_the_timestep_moves_that_speed() -> None:
    one = built(scene=scene(gravity="[0, 0, -10]"), numerics="{timestep: 1/100}")
    p = one.parameters[0]
    threshold = one.numerics.restitution_threshold
    set_gravity(one.parameters, one.numerics, (0.0, -3.0, 4.0))
    assert p["restitution_speed"] == pytest.approx(threshold * 5.0 * 0.01)
    set_timestep(one.parameters, one.numerics, Fraction(1, 10))
    assert p["dt"] == 0.1
    assert p["restitution_speed"] == pytest.approx(threshold * 5.0 * 0.1)


def test_what_is_left_out_is_written_as_what_never_happens() -> None:
    """A residual is never below 0, no cosine above 1, and no time of rest is infinite."""
    p = parameters("{tolerance: null, warm_start: false, sleeping: false, solver: jacobi}")
    assert p["tolerance"] < 0.0
    assert p["cache_normal_cosine"] > 1.0
    assert p["sleep_time"] == math.inf
    p = parameters("{tolerance: 1e-7, warm_start: true, sleeping: true, sleep_time: 0.75}")
    assert (p["tolerance"], p["sleep_time"]) == (1e-7, 0.75)
    assert p["cache_normal_cosine"] <= 1.0


def test_velocities_are_those_of_the_bodies_in_their_order() -> None:
    one = built(scene=scene(FLOOR, MOVING, BOX))
    assert one.names == ["floor", "ball", "crate"]
    rows = one.velocities
    assert [list(rows[k][["vx", "vy", "vz"]]) for k in (0, 1, 2)] == [
        [0, 0, 0],
        [1, 2, 3],
        [7, 8, 9],
    ]
    assert list(rows[1][["wx", "wy", "wz"]]) == [4, 5, 6]
    assert one.poses[2].tolist() == [4.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("residuals", "first", "last"),
    [
        ("none", 1, 0),
        ("all", 1, np.iinfo(np.int64).max),
        # steps end at 0.01, 0.02, ...: those that end in [0.1, 0.25] are 10 to 25
        ("{from: 0.1, to: 0.25}", 10, 25),
        ("{from: 0, to: 0.001}", 1, 0),  # none ends within
        ("{from: 1/3, to: 2/3}", 34, 66),
    ],
)
def test_sweeps_are_recorded_of_steps_that_end_in_the_window(
    residuals: str, first: int, last: int
) -> None:
    cell = cell_of(record=f"{{residuals: {residuals}}}", numerics="{timestep: 1/100}")
    assert residual_window(cell.record, cell.clock) == (first, last)
    spec = plan_of(cell).spec
    p = build(cell, spec).parameters[0]
    assert (p["residuals_from"], p["residuals_to"]) == (first, last)


def test_a_spring_joins_its_bodies_by_their_rows() -> None:
    spring = "[{a: floor, b: ball, stiffness: 100, damping: 2, rest_length: 0.5}]"
    one = built(scene=scene(FLOOR, MOVING, BOX, springs=spring))
    (link,) = one.links
    assert (link["a"], link["b"], link["active"], link["stiffness"]) == (0, 1, 1, 100.0)
    assert one.bodies["joined"][:3].tolist() == [1, 1, 0]
    assert len(built(scene=scene(FLOOR, MOVING)).links) == 0


def test_an_engine_begins_where_the_scene_does() -> None:
    one = built(scene=scene(FLOOR, MOVING))
    cell = cell_of(scene=scene(FLOOR, MOVING))
    engine = one.engine(plan_of(cell).spec, 8)
    assert engine.bodies["z"][1] == 1.0
    assert engine.velocities["vy"][1] == 2.0
