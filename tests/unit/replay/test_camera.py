"""The eye: far enough to see everything, on the open side of planes, beside the body it follows."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from lavendersim.errors import UsageError
from lavendersim.replay import scene
from lavendersim.replay.camera import FOLLOWED_DISTANCE, VIEW_DISTANCE, camera_of
from lavendersim.replay.layer import ALONE, Layer
from lavendersim.replay.viewpoint import SIDES, Viewpoint

ROOM = scene.Extent(np.array([-1.0, -2.0, 0.0]), np.array([3.0, 2.0, 4.0]))
SLOPE = (-0.5, 0.0, math.sqrt(0.75))
SIX_WALLS = [
    tuple(sign * float(axis == k) for k in range(3)) for axis in range(3) for sign in (1, -1)
]


def plane(*normal: float, offset: float = 0.0) -> SimpleNamespace:
    length = math.hypot(*normal)
    return SimpleNamespace(kind="plane", normal=np.array(normal) / length, offset=offset)


@pytest.mark.parametrize(
    "normals", [[], [(0, 0, 1)], [(0, 1, 0)], [SLOPE], [(0, 0, 1), (-1, 0, 0)]]
)
def test_the_eye_is_far_enough_and_on_the_open_side_of_every_plane(normals: list) -> None:
    planes = [plane(*normal) for normal in normals]
    camera = camera_of(None, planes, ROOM, Viewpoint())
    assert np.linalg.norm(camera.position - ROOM.centre) == pytest.approx(
        VIEW_DISTANCE * ROOM.diagonal
    )
    assert camera.target.tolist() == ROOM.centre.tolist()
    for one in planes:
        assert (camera.position - ROOM.centre) @ one.normal > 0.1 * ROOM.diagonal


def test_of_six_walls_around_the_bodies_those_before_the_eye_are_behind_none_else() -> None:
    """The eye is outside: three walls at most are seen from within, the others would hide all."""
    walls = [plane(*normal, offset=-5.0) for normal in SIX_WALLS]
    camera = camera_of(None, walls, ROOM, Viewpoint(camera=(20.0, -30.0, 10.0)))
    hiding = [wall.normal.tolist() for wall in walls if camera.is_behind(wall)]
    assert sorted(hiding) == [[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]


@pytest.mark.parametrize("side", SIDES)
def test_a_side_is_where_the_eye_stands(side: str) -> None:
    towards = camera_of(None, [], ROOM, Viewpoint(side)).position - ROOM.centre
    assert towards / np.linalg.norm(towards) == pytest.approx(SIDES[side], abs=1e-3)


def test_the_camera_moves_with_a_body_from_where_that_begins(two_bodies) -> None:
    bodies = scene.shapes(two_bodies.config)
    ball = next(body for body in bodies if body.name == "ball")
    start = two_bodies.pose[0, two_bodies.bodies.index("ball"), :3]
    camera = camera_of(two_bodies, bodies, ROOM, Viewpoint("front", "ball"))
    assert camera.target.tolist() == start.tolist()
    away = FOLLOWED_DISTANCE * ball.bounding_radius
    assert camera.position == pytest.approx(start - np.array([0.0, away, 0.0]))
    followed = [camera.controls(layer).tracking_entity for layer in (ALONE, Layer("B"))]
    paths = [str(one.as_arrow_array().to_pylist()[0]) for one in followed]
    assert paths == ["/bodies/ball", "/B/bodies/ball"]


@pytest.mark.parametrize("name", ["bal", "floor"])
def test_what_cannot_be_followed_is_refused_with_the_nearest_name(two_bodies, name: str) -> None:
    with pytest.raises(UsageError, match=f'--follow: .* called "{name}"; .*ball'):
        camera_of(two_bodies, scene.shapes(two_bodies.config), ROOM, Viewpoint("", name))
