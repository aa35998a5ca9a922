"""How far a shape reaches against a direction: by its turned frame, and by a compound's parts."""

from __future__ import annotations

import math

import pytest

from lavendersim.cell.shapes import Box, CellCompound, CellPart, Sphere
from lavendersim.geometry.quaternions import IDENTITY, from_axis_angle
from lavendersim.geometry.support import extent_against

UP = (0.0, 0.0, 1.0)
CUBE = Box(kind="box", size=(2.0, 2.0, 2.0))
BALL = Sphere(kind="sphere", radius=0.5)


def test_cube_reaches_its_half_edge_lying_and_half_a_diagonal_on_an_edge() -> None:
    assert extent_against(CUBE, IDENTITY, UP) == 1.0
    on_edge = from_axis_angle((1.0, 0.0, 0.0), 45.0)
    assert extent_against(CUBE, on_edge, UP) == pytest.approx(math.sqrt(2.0), rel=1e-15)


def dumbbell() -> CellCompound:
    """A ball 1 m above and a cube 2 m below the centre."""
    return CellCompound(
        kind="compound",
        parts=(
            CellPart(shape=BALL, position=(0.0, 0.0, 1.0), orientation=IDENTITY),
            CellPart(shape=CUBE, position=(0.0, 0.0, -2.0), orientation=IDENTITY),
        ),
        centre=(0.0, 0.0, 0.0),
        axes=IDENTITY,
    )


def test_compound_reaches_as_far_as_its_farthest_part() -> None:
    upside_down = from_axis_angle((1.0, 0.0, 0.0), 180.0)
    assert extent_against(dumbbell(), IDENTITY, UP) == 3.0  # the cube, 2 + 1
    assert extent_against(dumbbell(), upside_down, UP) == pytest.approx(1.5, rel=1e-15)


def test_a_part_turns_with_its_compound() -> None:
    # Tilted by 45 degrees about x the cube stands at 2 cos 45 below, on an edge.
    tilted = from_axis_angle((1.0, 0.0, 0.0), 45.0)
    below = 2.0 * math.cos(math.pi / 4.0) + math.sqrt(2.0)
    assert extent_against(dumbbell(), tilted, UP) == pytest.approx(below, rel=1e-15)
