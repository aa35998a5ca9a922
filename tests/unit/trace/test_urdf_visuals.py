"""What the URDF draws of a body stands where the resolved shape has it, in the body's own frame."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from lavendersim.geometry.rotations import rotation_matrix
from lavendersim.trace import urdf
from lavendersim.trace.urdf import robot_description
from lavendersim.trace.urdf_visuals import roll_pitch_yaw, visuals
from tests.made_cells import MadeShape, made_body

Vector = NDArray[np.float64]
POSE = np.array([[0.3, 2.0, 1.0, 0.5, 0.5, -0.5, 0.5]])  # that of the body says nothing here
PRINCIPAL = {"centre": [0.0, 0.0, 0.0], "axes": [1.0, 0.0, 0.0, 0.0]}
TETRA = {
    "kind": "hull",
    "points": [
        [-0.25, -0.25, -0.25],
        [0.75, -0.25, -0.25],
        [-0.25, 0.75, -0.25],
        [-0.25, -0.25, 0.75],
    ],
    "faces": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    **PRINCIPAL,
}


def described(shape: dict[str, Any], **body: Any) -> ET.Element:
    return ET.fromstring(robot_description({"thing": made_body(shape, **body)}, POSE))


def drawn(shape: dict[str, Any]) -> list[tuple[str, dict[str, str], Vector, Vector]]:
    """Primitive, its sizes, centre and rotation, of each visual."""
    found = []
    for visual in described(shape).iter("visual"):
        origin, (primitive,) = visual.find("origin"), list(visual.find("geometry"))
        xyz, rpy = (np.array(origin.attrib[key].split(), float) for key in ("xyz", "rpy"))
        found.append((primitive.tag, primitive.attrib, xyz, matrix_of(rpy)))
    return found


def matrix_of(rpy: Vector) -> Vector:
    """Return Rz(yaw) Ry(pitch) Rx(roll), URDF's convention."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    rx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    ry = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    rz = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return rz @ ry @ rx


@pytest.mark.parametrize("q", [*np.random.default_rng(0).normal(size=(20, 4)), np.ones(4)])
def test_angles_give_their_rotation_back(q: Vector) -> None:
    turn = rotation_matrix(q / np.linalg.norm(q))
    np.testing.assert_allclose(matrix_of(np.array(roll_pitch_yaw(turn))), turn, atol=4e-15)


@pytest.mark.parametrize("down", [-1.0, 1.0])
@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_angles_of_an_upright_turn(down: float, angle: float) -> None:
    """Pitch of 90 degrees: roll and yaw are one turn, which must not be lost."""
    upright = np.array([0.0, 0.5 * np.pi * down, angle])
    turn = matrix_of(upright)
    np.testing.assert_allclose(matrix_of(np.array(roll_pitch_yaw(turn))), turn, atol=1e-15)


def test_capsule_is_a_cylinder_between_two_balls() -> None:
    bar, *balls = drawn({"kind": "capsule", "radius": 0.1, "length": 0.6})
    assert bar[:2] == ("cylinder", {"radius": "0.1", "length": "0.6"})
    assert [ball[0] for ball in balls] == ["sphere", "sphere"]
    assert [ball[2].tolist() for ball in balls] == [[0, 0, -0.3], [0, 0, 0.3]]


def test_cylinder_is_one() -> None:
    (only,) = drawn({"kind": "cylinder", "radius": 0.1, "length": 0.6})
    assert only[:2] == ("cylinder", {"radius": "0.1", "length": "0.6"})
    assert only[2].tolist() == [0, 0, 0]


def test_edges_of_a_hull_end_in_its_corners() -> None:
    edges = drawn(TETRA)
    assert len(edges) == 6
    ends = set()
    for tag, size, centre, turn in edges:
        assert tag == "cylinder"
        half = 0.5 * float(size["length"]) * turn[:, 2]
        ends |= {tuple(np.round(end, 12) + 0.0) for end in (centre - half, centre + half)}
    assert ends == {tuple(point) for point in TETRA["points"]}


def test_a_shape_without_a_form_of_its_own_is_drawn_by_its_corners() -> None:
    edges = visuals(MadeShape(), POSE[0], 1.0)
    ends = set()
    for edge in edges:
        half = 0.5 * float(edge.geometry.split('length="')[1].split('"')[0]) * edge.rotation[:, 2]
        ends |= {tuple(np.round(edge.position + side * half, 12) + 0.0) for side in (-1.0, 1.0)}
    assert len(edges) == 6
    assert ends == set(MadeShape().corners())


def test_parts_of_a_compound_are_placed_in_it() -> None:
    turn = np.array([0.5, 0.5, 0.5, 0.5])  # x to y, y to z, z to x
    rod = {"kind": "capsule", "radius": 0.1, "length": 0.6}
    sphere = {"kind": "sphere", "radius": 0.2}
    parts = [
        {"shape": sphere, "position": [1, 2, 3], "orientation": [1, 0, 0, 0]},
        {"shape": rod, "position": [0, 0, 1], "orientation": turn.tolist()},
    ]
    ball, bar, low, high = drawn(
        {"kind": "compound", "parts": parts, "centre": [0, 0, 0], "axes": [1, 0, 0, 0]}
    )
    assert ball[2].tolist() == [1, 2, 3]
    np.testing.assert_allclose(bar[3] @ [0, 0, 1], [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(low[2], [-0.3, 0, 1], atol=1e-15)
    np.testing.assert_allclose(high[2], [0.3, 0, 1], atol=1e-15)


def test_every_visual_of_a_link_has_a_name_of_its_own() -> None:
    robot = described(TETRA)
    names = [visual.attrib["name"] for visual in robot.iter("visual")]
    assert len(set(names)) == len(names) == 6


def test_kinematic_body_is_free_to_move() -> None:
    ball = {"kind": "sphere", "radius": 0.1}
    joint = [described(ball, fixed=True, kinematic=k).find("joint").attrib for k in (False, True)]
    assert [one["type"] for one in joint] == ["fixed", "floating"]


def test_hulls_beyond_the_limit_have_no_visual(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(urdf, "MOST_VISUALS", 7)
    names = ["one", "two", "ball"]
    ball = made_body({"kind": "sphere", "radius": 0.1})
    bodies = {"one": made_body(TETRA), "two": made_body(TETRA), "ball": ball}
    robot = ET.fromstring(robot_description(bodies, np.repeat(POSE, 3, axis=0)))
    counts = {link.attrib["name"]: len(link.findall("visual")) for link in robot.iter("link")}
    assert [counts[name] for name in names] == [6, 0, 1]


@pytest.mark.parametrize("kind", ["bowl", "drum"])
def test_a_cavity_is_drawn_by_bars_between_points_of_its_wall(kind: str) -> None:
    bars = drawn({"kind": kind, "radius": 2.0})
    assert len(bars) == (140 if kind == "bowl" else 60)
    for tag, size, centre, turn in bars:
        assert tag == "cylinder"
        for end in (-0.5, 0.5):
            place = centre + turn @ (0.0, 0.0, end * float(size["length"]))
            away = np.linalg.norm(place if kind == "bowl" else place[:2])
            assert away == pytest.approx(2.0, abs=1e-14)


def test_a_mesh_is_drawn_by_the_sides_of_its_triangles() -> None:
    corners = [[0, 0, 0], [3, 0, 0], [3, 4, 0], [0, 4, 0]]
    bars = drawn({"kind": "mesh", "vertices": corners, "triangles": [[0, 1, 2], [0, 2, 3]]})
    assert {tag for tag, *_ in bars} == {"cylinder"}
    assert sorted(float(size["length"]) for _, size, *_ in bars) == [3, 3, 4, 4, 5]
    middles = sorted(tuple(centre[:2]) for _, _, centre, _ in bars)
    assert middles == [(0.0, 2.0), (1.5, 0.0), (1.5, 2.0), (1.5, 4.0), (3.0, 2.0)]
