"""A plane is drawn as a thin box; its top face must be the plane, wherever its body is posed."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from numpy.typing import NDArray

from lavendersim.trace.urdf import PLANE_THICKNESS, robot_description
from tests.made_cells import made_body

Vector = NDArray[np.float64]


def test_a_planes_box_has_its_top_face_in_the_plane() -> None:
    # a slope of 30 degrees, its body posed anywhere: the drawn top must not move with that pose
    slope = {"kind": "plane", "normal": [0.5, 0.0, np.sqrt(0.75)], "offset": 0.3}
    half = np.sqrt(0.5)
    for pose in ([0, 0, 0, 1, 0, 0, 0], [0.15, 2, 1, half, 0, half, 0]):
        poses = np.array([pose], float)
        robot = ET.fromstring(robot_description({"slope": made_body(slope)}, poses))
        origin = next(robot.iter("origin"))
        xyz, rpy = (np.array(origin.attrib[key].split(), float) for key in ("xyz", "rpy"))
        local = _rotation(*rpy)
        w, x, y, z = poses[0, 3:]
        body = np.column_stack([_turn(w, np.array([x, y, z]), axis) for axis in np.eye(3)])
        top = poses[0, :3] + body @ (xyz + local @ [0, 0, PLANE_THICKNESS / 2])
        # a dozen roundings of numbers of order one
        assert np.allclose(body @ local @ [0, 0, 1], slope["normal"], atol=1e-14)
        assert abs(np.dot(slope["normal"], top) - slope["offset"]) < 1e-14


@pytest.mark.parametrize("special", list("&<>\"'\n\r\t"))
def test_a_name_comes_back_as_it_is(special: str) -> None:
    name = f"a{special}b"
    poses = np.array([[0.0, 0, 0, 1, 0, 0, 0]])
    shape = {"kind": "sphere", "radius": 1.0}
    robot = ET.fromstring(robot_description({name: made_body(shape)}, poses))
    assert name in {link.attrib["name"] for link in robot.iter("link")}


def _turn(w: float, u: Vector, v: Vector) -> Vector:
    """Rotate v by the quaternion (w, u), by Rodrigues' formula."""
    t = 2 * np.cross(u, v)
    return v + w * t + np.cross(u, t)


def _rotation(roll: float, pitch: float, yaw: float) -> Vector:
    """Return Rz(yaw) Ry(pitch) Rx(roll), URDF's convention."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(a), np.sin(a)) for a in (roll, pitch, yaw))
    rx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    ry = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    rz = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return rz @ ry @ rx
