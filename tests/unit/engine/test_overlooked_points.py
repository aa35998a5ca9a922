"""Points without rows are looked at once a part is solved, by how their bodies turn and fly."""

from __future__ import annotations

from math import sin, sqrt
from typing import NamedTuple

import numpy as np
import pytest

from lavendersim.engine.integrate import ALWAYS, LASTING
from lavendersim.engine.memory import Overlooked
from lavendersim.engine.overlooked_points import DEEP, make_forget_whole, make_look_over
from lavendersim.engine.record_layout import (
    allocate_bodies,
    allocate_pairs,
    allocate_parameters,
    allocate_velocities,
)
from lavendersim.engine.records import (
    BOX,
    CAPSULE,
    CYLINDER,
    HULL,
    MESH,
    MOTION,
    OVERLOOKED,
    PLANE,
    SPHERE,
    UNMADE,
    dtype,
)
from lavendersim.engine.spec import Spec

EFFECTS = ("friction", "impact_order", "impact_time", "overlooked_points", "rotation")
SPEC = Spec(effects=EFFECTS)
DT = 1.0 / 240.0
SLOP = 1e-6  # [m]
ARM = 0.1  # [m] of the point from the centre of the body, along x


class State(NamedTuple):
    """What is read of the engine's state."""

    pairs: np.ndarray
    velocities: np.ndarray
    motion: np.ndarray


class Part:
    """A plane z = 0, a body above it that turns about y, and a point of the body at x = ARM."""

    def __init__(self, gap: float, waits: int) -> None:
        bodies, velocities = allocate_bodies(SPEC, 2), allocate_velocities(SPEC, 2)
        motion = np.zeros(2, dtype(MOTION))
        pairs, point = allocate_pairs(SPEC, 1), np.zeros(1, dtype(OVERLOOKED))
        self.state = State(pairs, velocities, motion)
        self.bodies, self.pairs = bodies, pairs
        point["b"], point["x"], point["nz"], point["phi"], point["waits"] = 1, ARM, 1, gap, waits
        self.overlooked = Overlooked(point, np.ones(1, np.int64), np.zeros(1, dtype(UNMADE)))
        self.parameters = allocate_parameters()
        self.parameters["dt"] = self.parameters["timestep"] = DT

    def look(self, before: dict[str, float], after: dict[str, float]) -> float:
        for name, value in before.items():
            self.state.motion[name][1] = value
        for name, value in after.items():
            self.state.velocities[name][1] = value
        look_over = make_look_over(SPEC)
        return float(look_over(self.state, self.bodies, self.overlooked, self.parameters[0]))


@pytest.mark.parametrize("waits", [0, 1])
def test_what_ends_apart_leaves_the_part_as_it_is(waits: int) -> None:
    """At v a gap of g ends at g - v dt: apart, or less than DEEP inside."""
    for gap in (2.0 * DT, DT, DT - 0.9 * DEEP):
        part = Part(gap, waits)
        assert part.look({"vz": -1.0}, {"vz": -1.0}) == 0.0
        assert part.pairs["whole"][0] == 0


@pytest.mark.parametrize("body", [0, 1])
def test_a_point_of_a_sphere_is_not_looked_at(body: int) -> None:
    part = Part(DT - 1.1 * DEEP, 0)
    part.bodies["shape"][body] = SPHERE
    assert part.look({"vz": -1.0}, {"vz": -1.0}) == 0.0
    assert part.pairs["whole"][0] == 0


def test_a_point_left_out_that_ends_inside_makes_its_manifold_whole() -> None:
    part = Part(DT - 1.1 * DEEP, 0)
    assert part.look({"vz": -1.0}, {"vz": -1.0}) == DT
    assert part.pairs["whole"][0] == 1
    # The part that has all its points is not made again.
    assert part.look({"vz": -1.0}, {"vz": -1.0}) == 0.0
    make_forget_whole(SPEC)(part.pairs, 1)
    assert part.pairs["whole"][0] == 0


@pytest.mark.parametrize(("carried", "again"), [(0, False), (LASTING, False), (ALWAYS, True)])
def test_a_body_goes_as_it_is_carried(carried: int, again: bool) -> None:
    """By the mean of +2 and -4 DEEP a part it ends one DEEP inside, by its last velocity four."""
    part = Part(0.01 * DEEP, 1)
    part.state.motion["carried"][1] = carried
    found = part.look({"vz": 2.0 * DEEP / DT}, {"vz": -4.0 * DEEP / DT})
    assert (found > 0.0) == again


RETURNS = ({"wy": -1.0}, {"wy": 5.0})  # it rises by w ARM, and comes down five times as fast


@pytest.mark.parametrize("waits", [0, 1])
def test_a_point_that_parts_and_is_pushed_back_ends_the_part_where_it_meets(waits: int) -> None:
    """ARM t - 3 ARM t^2/dt = 0: at a third of the part; it is an impact of its own."""
    part = Part(0.0, waits)
    assert part.look(*RETURNS) == pytest.approx(DT / 3.0, rel=1e-4)  # less what turning bends
    assert part.pairs["whole"][0] == 0


@pytest.mark.parametrize("waits", [0, 1])
def test_one_that_meets_more_slowly_than_forces_change_in_a_step_is_a_contact(waits: int) -> None:
    """It meets at ARM = 0.1 m/s, and comes back at once of what forces change by 0.2 m/s."""
    part = Part(0.0, waits)
    part.state.motion["dvz"][1] = -0.2
    assert part.look(*RETURNS) == DT
    assert part.pairs["whole"][0] == 1


@pytest.mark.parametrize("off", [-1.1, 1.1])
def test_a_turn_is_followed_round(off: float) -> None:
    """A point at ARM that turns by w dt about y goes down by ARM sin(w dt), not by ARM w dt: at 100
    rad/s the two differ by 1.2 mm, 24 DEEP.
    """
    spin = {"wy": 100.0}
    gap = ARM * sin(100.0 * DT) + (off - 1.0) * DEEP
    part = Part(gap, 0)
    assert (part.look(spin, spin) > 0.0) == (off < 0.0)


def test_a_row_that_waits_ends_the_part_where_it_meets() -> None:
    """It rises at 1 m/s and ends at -3 m/s: g + t - 2 t^2/dt = 0."""
    gap = 0.2 * DT
    part = Part(gap, 1)
    due = DT * (1.0 + sqrt(1.0 + 8.0 * 0.2)) / 4.0
    assert part.look({"vz": 1.0}, {"vz": -3.0}) == pytest.approx(due, rel=1e-12)
    assert part.pairs["whole"][0] == 0


def test_a_row_that_would_meet_at_once_is_a_contact_of_the_part() -> None:
    part = Part(0.0, 1)
    assert part.look({"vz": 0.001}, {"vz": -1.0}) == DT
    assert part.pairs["whole"][0] == 1


def sinks(shape: int, gap: float, depth: float, waits: int = 0, floor: int = PLANE) -> bool:
    """Whether a part is made again that leads a point, `gap` above a plane, `depth` deep."""
    part = Part(gap, waits)
    part.bodies["shape"][0] = floor
    part.bodies["shape"][1] = shape
    part.parameters["slop"] = SLOP
    down = {"vz": -(depth + gap) / DT}
    return part.look(down, down) > 0.0


@pytest.mark.parametrize("floor", [PLANE, MESH])
@pytest.mark.parametrize("shape", [BOX, HULL])
def test_a_corner_of_a_face_that_touches_may_sink_by_the_slop(shape: int, floor: int) -> None:
    for gap in (0.0, 0.9 * SLOP):
        assert not sinks(shape, gap, 0.9 * SLOP, floor=floor)
        assert sinks(shape, gap, 1.1 * SLOP, floor=floor)


def test_one_that_is_apart_or_waits_or_of_a_rim_may_sink_deep() -> None:
    for depth, made_again in ((0.9 * DEEP, False), (1.1 * DEEP, True)):
        assert sinks(BOX, 1.1 * SLOP, depth) == made_again
        assert sinks(BOX, 0.0, depth, waits=1) == made_again
        for shape in (CAPSULE, CYLINDER):
            assert sinks(shape, 0.0, depth) == made_again
