"""Bodies that rest on faces, caps and lines touch in the points that carry them.

Each case stands along z, overlaps by 1 um and is turned to a random direction with its world. Only
edges that lie along each other are 1 um apart: overlapping, they part soonest along a face.
"""

from __future__ import annotations

from typing import NamedTuple

import convex
import numpy as np
import pytest
import solid_poses

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.shapes.cylinder import LEVEL
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import TOUCHING

DEPTH = 1e-6
CUBE = (
    np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]),
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]],
)
# A roof upside down: its ridge, of length 1, lies 0.5 below the origin.
RIDGE = (
    np.array(
        [[x, 0.0, -0.5] for x in (-0.5, 0.5)]
        + [[x, y, 0.3] for y in (-0.4, 0.4) for x in (-0.5, 0.5)]
    ),
    [[0, 2, 4], [1, 5, 3], [2, 3, 5, 4], [0, 1, 3, 2], [0, 4, 5, 1]],
)
HULLS = [CUBE, RIDGE]
LYING = convex.matrix_of([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0])  # local z along x
CROSSWISE = convex.matrix_of([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])  # local z along -y
DIAMOND = convex.matrix_of([np.cos(np.pi / 8), np.sin(np.pi / 8), 0.0, 0.0])  # on edge, along x
R, H, S = 0.3, 0.4, np.sqrt(0.5)
BOX, WIDE, SLIM = (0.5, 0.5, 0.5), (2.0, 2.0, 0.5), (0.2, 1.0, 0.5)


class Case(NamedTuple):
    """Two bodies, how high the upper one's centre is when they touch, and the points expected."""

    pair: str
    lower: dict
    upper: dict
    height: float
    expected: list  # x, y of the points, in any order
    beside: tuple = (0.0, 0.0)  # x, y of the upper body's centre
    gap: float = -DEPTH  # [m]

    @property
    def margin(self) -> float:
        """How far contacts are looked for [m]."""
        return TOUCHING + max(self.gap, 0.0)


def of(half=(1.0, 1.0, 1.0), matrix=None, hull=0):
    return {"half": half, "matrix": np.eye(3) if matrix is None else matrix, "hull": hull}


CYLINDER, CAPSULE = (R, 0.0, H), (R, 0.0, H)
SQUARE = [(R, 0.0), (0.0, R), (-R, 0.0), (0.0, -R)]
CORNERS = [(x, y) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
SHIFTED = [(x, y) for x in (-0.3, 0.5) for y in (-0.4, 0.5)]
ENDS = [(-H, 0.0), (H, 0.0)]
EDGE = [(-0.5, 0.0), (0.5, 0.0)]
CASES = {
    "cylinder stands on a box": Case("cylinder_box", of(WIDE), of(CYLINDER), 0.5 + H, SQUARE),
    "cylinder stands on its like": Case(
        "cylinder_cylinder", of(CYLINDER), of(CYLINDER), 2 * H, SQUARE
    ),
    "cylinder stands on a wider one": Case(
        "cylinder_cylinder", of((1.0, 0.0, H)), of(CYLINDER), 2 * H, SQUARE
    ),
    "wide cylinder stands on a narrower one": Case(
        "cylinder_cylinder", of(CYLINDER), of((1.0, 0.0, H)), 2 * H, SQUARE
    ),
    "cylinder stands on a hull": Case("cylinder_hull", of(), of(CYLINDER), 0.5 + H, SQUARE),
    "cylinder lies on a box": Case("cylinder_box", of(WIDE), of(CYLINDER, LYING), 0.5 + R, ENDS),
    "cylinder lies across a slim box": Case(
        "cylinder_box", of(SLIM), of(CYLINDER, LYING), 0.5 + R, [(-0.2, 0.0), (0.2, 0.0)]
    ),
    "cylinder lies on a hull": Case("cylinder_hull", of(), of(CYLINDER, LYING), 0.5 + R, ENDS),
    "cylinder lies on a cap": Case(
        "cylinder_cylinder", of((1.0, 0.0, H)), of(CYLINDER, LYING), H + R, ENDS
    ),
    "cylinder lies along another": Case(
        "cylinder_cylinder",
        of(CYLINDER, LYING),
        of(CYLINDER, LYING),
        2 * R,
        [(0.1 - H, 0.0), (H, 0.0)],
        (0.1, 0.0),
    ),
    "cylinder lies across another": Case(
        "cylinder_cylinder", of(CYLINDER, LYING), of(CYLINDER, CROSSWISE), 2 * R, [(0.0, 0.0)]
    ),
    "cylinder lies along the edge of a box": Case(
        "cylinder_box", of(BOX, DIAMOND), of(CYLINDER, LYING), S + R, ENDS
    ),
    "cylinder lies across the edge of a box": Case(
        "cylinder_box", of(BOX, DIAMOND), of(CYLINDER, CROSSWISE), S + R, [(0.0, 0.0)]
    ),
    "capsule lies on a box": Case("capsule_box", of(WIDE), of(CAPSULE, LYING), 0.5 + R, ENDS),
    "capsule stands on a box": Case("capsule_box", of(WIDE), of(CAPSULE), 0.5 + H + R, [(0, 0)]),
    "capsule lies along the edge of a box": Case(
        "capsule_box", of(BOX, DIAMOND), of(CAPSULE, LYING), S + R, ENDS
    ),
    "capsule lies on a hull": Case("capsule_hull", of(), of(CAPSULE, LYING), 0.5 + R, ENDS),
    "capsule lies on a cap": Case(
        "capsule_cylinder", of((1.0, 0.0, H)), of(CAPSULE, LYING), H + R, ENDS
    ),
    "capsule lies along a cylinder": Case(
        "capsule_cylinder", of(CYLINDER, LYING), of(CAPSULE, LYING), 2 * R, ENDS
    ),
    "capsule lies along another": Case(
        "capsule_capsule", of(CAPSULE, LYING), of(CAPSULE, LYING), 2 * R, ENDS
    ),
    "capsule lies across another": Case(
        "capsule_capsule", of(CAPSULE, LYING), of(CAPSULE, CROSSWISE), 2 * R, [(0.0, 0.0)]
    ),
    "hull stands on a box": Case("hull_box", of(WIDE), of(), 1.0, CORNERS),
    "hull stands on a shifted hull": Case("hull_hull", of(), of(), 1.0, SHIFTED, (0.2, 0.1)),
    "hull stands on its ridge on a box": Case("hull_box", of(WIDE), of(hull=1), 1.0, EDGE),
    "ridge of a hull along the edge of a box": Case(
        "hull_box", of(BOX, DIAMOND), of(hull=1), 0.5 + S, EDGE, gap=DEPTH
    ),
    "box stands on a box": Case("box_box", of(WIDE), of(BOX), 1.0, CORNERS),
}


def placed(case: Case, turns: np.ndarray, nudge=None) -> solid_poses.Sample:
    """Return the case in worlds turned by each of `turns`; nudge: (n, 3) of the upper body [m]."""
    count = len(turns)
    bodies = [allocate_bodies(solid_poses.EVERY_SHAPE, count) for _ in range(2)]
    kinds = SHAPE_PAIRS[case.pair].shapes
    for i, turn in enumerate(turns):
        upper = np.array([*case.beside, case.height + case.gap])
        if nudge is not None:
            upper = upper + nudge[i]
        for row, kind, body, centre in zip(
            (bodies[0][i], bodies[1][i]),
            kinds,
            (case.lower, case.upper),
            ([0, 0, 0], upper),
            strict=True,
        ):
            solid_poses.put(
                row,
                kind,
                body["half"],
                turn @ np.asarray(centre, float),
                turn @ body["matrix"],
                hull=body["hull"],
                corners=HULLS[body["hull"]][0],
            )
    return solid_poses.Sample(case.pair, bodies[0], bodies[1], HULLS)


def turned(rng, count: int) -> np.ndarray:
    return np.array([np.eye(3), *(convex.random_rotation(rng) for _ in range(count - 1))])


@pytest.mark.parametrize("name", CASES)
def test_the_points_that_carry_the_body_are_found_in_every_direction(name, rng):
    case = CASES[name]
    turns = turned(rng, 20)
    for turn, manifold in zip(
        turns, solid_poses.manifolds(placed(case, turns), case.margin), strict=True
    ):
        assert len(manifold.phi) == len(case.expected)
        # Coordinates of a few metres turned by a matrix, and cuts that reach TOUCHING outside.
        np.testing.assert_allclose(manifold.normal, turn[:, 2], atol=1e-9)
        np.testing.assert_allclose(manifold.phi, case.gap, atol=2e-9)
        seen = manifold.points @ turn  # back to the case's own directions
        for place in case.expected:
            # Nearly parallel lines and tilted caps stay in place to some 1e-9 as well.
            assert np.linalg.norm(seen[:, :2] - np.array(place), axis=1).min() < 5e-9


# Round-off of a pose at rest, and the tilt of a tower's top by slow creep.
@pytest.mark.parametrize("size", [1e-16, 1e-10])
@pytest.mark.parametrize("name", CASES)
def test_the_points_keep_their_names_in_noise_and_in_a_slow_slide(name, size, rng):
    case = CASES[name]
    nudge = rng.normal(size=(40, 3)) * size
    turns = np.repeat(np.eye(3)[None], 40, axis=0)
    turns[:, 0, 2] = rng.normal(size=40) * size
    found = solid_poses.manifolds(placed(case, turns, nudge), case.margin + 10 * size)
    assert {frozenset(manifold.feature) for manifold in found} == {frozenset(found[0].feature)}


def test_edges_that_overlap_along_each_other_part_along_a_face_beside_them(rng):
    """s(n) = -DEPTH cos(angle of n to z), largest at the box's faces, 45 degrees beside z."""
    case = CASES["ridge of a hull along the edge of a box"]._replace(gap=-DEPTH)
    turns = turned(rng, 20)
    for turn, manifold in zip(
        turns, solid_poses.manifolds(placed(case, turns), TOUCHING), strict=True
    ):
        normal = manifold.normal @ turn
        np.testing.assert_allclose([normal[0], abs(normal[1]), normal[2]], [0, S, S], atol=1e-9)
        np.testing.assert_allclose(manifold.phi, -S * DEPTH, atol=2e-9)
        ends = np.sort((manifold.points @ turn)[:, 0])
        np.testing.assert_allclose(ends, [-0.5, 0.5], atol=5e-9)


def test_a_cylinder_half_over_an_edge_is_carried_up_to_the_edge(rng):
    """The part of its octagon over the box: chords of the edge x = 0.5, 0.1 beyond its centre."""
    case = Case("cylinder_box", of(BOX), of(CYLINDER), 0.5 + H, [], (0.4, 0.0))
    manifold = solid_poses.manifolds(placed(case, np.eye(3)[None]), TOUCHING)[0]
    assert len(manifold.phi) == 4
    assert manifold.points[:, 0].max() == pytest.approx(0.5, abs=5e-9)
    at_edge = manifold.points[manifold.points[:, 0] > 0.4999]
    assert len(at_edge) == 2
    # The octagon's side leads from (R, 0) to (R, R) sqrt(1/2): at x = 0.1 from the centre the sides
    # from (R S, R S) to (0, R) are met.
    width = R + 0.1 * (R * S - R) / (R * S)
    np.testing.assert_allclose(np.sort(at_edge[:, 1]), [-width, width], atol=5e-9)


@pytest.mark.parametrize("tilt", [1e-7, 1e-5, 1e-3, 0.1, 0.3])
@pytest.mark.parametrize("pair", ["cylinder_box", "cylinder_plane", "cylinder_cylinder"])
def test_a_tilted_cylinder_touches_in_the_lowest_point_of_its_rim(pair, tilt, rng):
    """Lower than the octagon by at most LEVEL r (1 - cos(pi/8)) while that is kept."""
    count = 30
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    bodies = [allocate_bodies(solid_poses.EVERY_SHAPE, count) for _ in range(2)]
    kind = SHAPE_PAIRS[pair].shapes[0]
    half = {"box": WIDE, "plane": (0.0, 0.0, 1.0), "cylinder": (2.0, 0.0, 0.5)}[kind]
    for i in range(count):
        solid_poses.put(bodies[0][i], kind, half, offset=0.5)
        half_turn = 0.5 * tilt
        turn = convex.matrix_of(
            [
                np.cos(half_turn),
                np.sin(half_turn) * np.cos(angle[i]),
                np.sin(half_turn) * np.sin(angle[i]),
                0.0,
            ]
        )
        height = 0.5 + H * np.cos(tilt) + R * np.sin(tilt) - DEPTH
        solid_poses.put(bodies[1][i], "cylinder", CYLINDER, (0.0, 0.0, height), turn)
    sample = solid_poses.Sample(pair, *bodies, [])
    kept = LEVEL * R * (1.0 - np.cos(np.pi / 8))
    for manifold in solid_poses.manifolds(sample, TOUCHING):
        assert manifold.phi.min() == pytest.approx(-DEPTH, abs=2e-9 + kept)
        if pair != "cylinder_plane":
            np.testing.assert_allclose(manifold.normal, [0.0, 0.0, 1.0], atol=2e-7)
