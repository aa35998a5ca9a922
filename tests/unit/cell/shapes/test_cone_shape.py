"""A cone's mass and centre, by sums over discs; its lowest point; what is none is refused."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from lavendersim.cell.shapes import Cone
from lavendersim.errors import LavenderError
from lavendersim.experiment import load_experiment_text

RADIUS, HEIGHT = 0.3, 0.8
CONE = Cone(kind="cone", radius=RADIUS, height=HEIGHT)


def test_mass_centre_and_moments_are_those_of_its_discs() -> None:
    """A disc has pi s^2 dz, of which <x^2> = s^2/4; midpoint sums of n: 1/n^2 of the value."""
    n = 2000
    up = (np.arange(n) + 0.5) / n
    s, z = RADIUS * (1.0 - up), HEIGHT * up - CONE.base
    mass = math.pi * s * s * HEIGHT / n
    found = CONE.homogeneous()
    assert found.volume == pytest.approx(mass.sum(), rel=1e-6)
    assert (mass * z).sum() / mass.sum() == pytest.approx(0.0, abs=1e-6 * HEIGHT)
    across = (mass * (0.25 * s * s + z * z)).sum() / mass.sum()
    along = (mass * 0.5 * s * s).sum() / mass.sum()
    assert found.moments == pytest.approx((across, across, along), rel=2e-6)


def test_its_side_its_base_its_apex_and_its_rim_are_farthest_in_turn() -> None:
    slant = math.hypot(RADIUS, HEIGHT)
    side = (HEIGHT / slant, 0.0, RADIUS / slant)
    assert CONE.farthest_point(side) == pytest.approx((RADIUS / 2.0, 0.0, HEIGHT / 4.0), abs=1e-15)
    assert CONE.farthest_point((0.0, 0.0, -1.0)) == (0.0, 0.0, -HEIGHT / 4.0)
    assert CONE.farthest_point((0.0, 0.6, 0.8)) == (0.0, 0.0, 3.0 * HEIGHT / 4.0)
    assert CONE.farthest_point((0.0, 1.0, 0.0)) == (0.0, RADIUS, -HEIGHT / 4.0)


@pytest.mark.parametrize("what", ["radius: 0, height: 1", "radius: 1, height: -1", "radius: 1"])
def test_what_spans_no_cone_is_refused_where_it_stands(what: str) -> None:
    text = f"""
scene:
  bodies:
    it: {{shape: {{kind: cone, {what}}}, mass: 1, position: [0, 0, 0]}}
duration: 1
"""
    with pytest.raises(LavenderError, match=r"a\.yaml:4:\d+: "):
        load_experiment_text(text, "a.yaml")


@pytest.mark.parametrize(("radius", "height"), [(0.3, 0.8), (1.0, 1e-6), (1.0, 1e7)])
def test_its_faces_turn_left_seen_from_outside_and_close(radius: float, height: float) -> None:
    """Each edge stands once each way; the volume is that of a pyramid on the rim's polygon."""
    cone = Cone(kind="cone", radius=radius, height=height)
    corners, faces = np.array(cone.corners()), cone.faces()
    edges = [edge for face in faces for edge in zip(face, [*face[1:], face[0]], strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    volume = sum(
        np.linalg.det(corners[[face[0], one, two]]) / 6.0
        for face in faces
        for one, two in pairwise(face[1:])
    )
    sides = len(corners) - 1
    base = 0.5 * sides * radius * radius * math.sin(2.0 * math.pi / sides)
    assert volume == pytest.approx(base * height / 3.0, rel=1e-9)
