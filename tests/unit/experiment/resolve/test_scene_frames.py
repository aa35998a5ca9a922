"""Bodies stand in their principal frames, and every point of them where the file puts it."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.cell.shapes import Box, Cylinder
from lavendersim.experiment import load_experiment_text
from lavendersim.geometry.convex_hull import Polyhedron
from lavendersim.geometry.mass_properties import Placed, Solid, homogeneous, polyhedron, together
from lavendersim.geometry.quaternions import axes, product, to_world
from lavendersim.geometry.vectors import unit

ONE = (1.0, 0.0, 0.0, 0.0)
SCENE = """\
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    thing:
      shape: {shape}
      mass: 2.0
      orientation: [0.9, 0.1, -0.3, 0.2]
      surface_velocity: [1, 2, 3]
      {start}
duration: 1.0
"""
WEDGE = "{kind: hull, points: [[0, 0, 0], [1, 0, 0], [0, 0.5, 0], [0.2, 0.1, 0.7], [1, 1, 0]]}"
HAMMER = (
    "{kind: compound, parts: [{shape: {kind: cylinder, radius: 0.1, length: 1.0}}, "
    f"{{shape: {WEDGE}, position: [0.3, 0.2, 0.5], orientation: [1, 0.2, 0.3, 0]}}, "
    "{shape: {kind: box, size: [0.2, 0.3, 0.4]}, position: [0, 0.5, 0], "
    "orientation: {axis: [1, 1, 0], degrees: 40}}]}"
)
Q = unit((0.9, 0.1, -0.3, 0.2))


def thing(shape: str, start: str = "position: [1, 2, 3]") -> dict:
    experiment = load_experiment_text(SCENE.format(shape=shape, start=start), "thing.yaml")
    return experiment.cells()[0].config.as_dict()["scene"]["bodies"]["thing"]


def matrix(q) -> np.ndarray:
    return np.array(axes(tuple(q))).T


def test_points_of_a_hull_stand_where_the_file_puts_them() -> None:
    """World points about the centre of mass: q (p - c) as written, q' p' as resolved."""
    body = thing(WEDGE)
    shape = body["shape"]
    written = np.array([[0, 0, 0], [1, 0, 0], [0, 0.5, 0], [0.2, 0.1, 0.7], [1, 1, 0]], float)
    expected = (written - shape["centre"]) @ matrix(Q).T
    found = np.array(shape["points"]) @ matrix(body["orientation"]).T
    np.testing.assert_allclose(found, expected, atol=1e-14)
    assert body["position"] == [1.0, 2.0, 3.0]
    # int x y and its like vanish in the principal frame: the moments hold for this frame
    np.testing.assert_allclose(body["orientation"], product(Q, tuple(shape["axes"])), atol=1e-15)


def test_parts_of_a_compound_stand_where_the_file_puts_them() -> None:
    body = thing(HAMMER)
    whole = body["shape"]
    turn = tuple(body["orientation"])
    places = [(0.0, 0.0, 0.0), (0.3, 0.2, 0.5), (0.0, 0.5, 0.0)]
    for part, place in zip(whole["parts"], places, strict=True):
        expected = to_world(Q, tuple(np.array(place) - whole["centre"]))
        np.testing.assert_allclose(to_world(turn, tuple(part["position"])), expected, atol=1e-14)
    wedge = whole["parts"][1]
    alone = thing(WEDGE)["shape"]
    turned = product(turn, tuple(wedge["orientation"]))
    points = np.array(wedge["shape"]["points"]) @ matrix(turned).T
    as_written = np.array(alone["points"]) @ matrix(alone["axes"]).T  # in the wedge's own axes
    q_part = product(Q, unit((1.0, 0.2, 0.3, 0.0)))
    np.testing.assert_allclose(points, as_written @ matrix(q_part).T, atol=1e-14)


@pytest.mark.parametrize("shape", [WEDGE, HAMMER])
def test_surface_velocity_turns_with_the_frame(shape: str) -> None:
    body = thing(shape)
    world = to_world(tuple(body["orientation"]), tuple(body["surface_velocity"]))
    np.testing.assert_allclose(world, to_world(Q, (1.0, 2.0, 3.0)), atol=1e-14)


@pytest.mark.parametrize("shape", [WEDGE, HAMMER])
def test_inertia_in_the_bodys_frame_is_its_moments(shape: str) -> None:
    """The resolved geometry, summed anew in the body's frame: centred there, and diagonal."""
    body = thing(shape)
    parts = body["shape"].get("parts") or [{"shape": body["shape"], "position": (0.0, 0.0, 0.0)}]
    placed = [
        Placed(
            solid_of(part["shape"]), tuple(part["position"]), tuple(part.get("orientation", ONE))
        )
        for part in parts
    ]
    whole = together(placed)
    np.testing.assert_allclose(whole.centre, 0.0, atol=1e-15)
    moments = np.diag(body["inertia"]) / body["mass"]
    np.testing.assert_allclose(whole.inertia, moments, atol=1e-15)


def solid_of(shape: dict) -> Solid:
    if shape["kind"] == "hull":
        return polyhedron(Polyhedron(tuple(map(tuple, shape["points"])), shape["faces"]))
    model = {"box": Box, "cylinder": Cylinder}[shape["kind"]]
    return homogeneous(*model.model_validate(shape, strict=False).homogeneous())


@pytest.mark.parametrize("shape", [WEDGE, HAMMER])
def test_released_body_is_as_high_as_its_lowest_point(shape: str) -> None:
    body = thing(shape, "release: {above: floor, clearance: 0.25}")
    turn = tuple(body["orientation"])
    low = []
    for part in body["shape"].get("parts", [{"shape": body["shape"], "position": (0, 0, 0)}]):
        q = product(turn, tuple(part.get("orientation", (1.0, 0.0, 0.0, 0.0))))
        centre = np.array(to_world(turn, tuple(part["position"])))
        low.append(centre[2] + lowest(part["shape"], matrix(q)))
    assert body["position"][2] + min(low) == pytest.approx(0.25, abs=1e-9)


def lowest(shape: dict, turn: np.ndarray) -> float:
    """z of the lowest point about the centre, by looking at many points of the surface."""
    if shape["kind"] == "hull":
        points = np.array(shape["points"])
    elif shape["kind"] == "box":
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        points = 0.5 * signs * shape["size"]
    else:
        around = np.linspace(0.0, 2.0 * np.pi, 200_001)  # misses the lowest by 5e-10 r at most
        ring = shape["radius"] * np.column_stack([np.cos(around), np.sin(around)])
        half = 0.5 * shape["length"]
        points = np.vstack([np.column_stack([ring, np.full(len(ring), z)]) for z in (-half, half)])
    return float((points @ turn.T)[:, 2].min())


def test_ends_of_springs_stand_where_the_file_puts_them() -> None:
    points = {"thing": (0.3, -0.2, 0.5), "ball": (0.0, 0.1, 0.2)}
    text = f"""\
scene:
  bodies:
    thing:
      shape: {WEDGE}
      mass: 2.0
      position: [0, 0, 0]
      orientation: [0.9, 0.1, -0.3, 0.2]
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1.0, position: [3, 0, 0]}}
  springs:
    - {{a: thing, b: ball, stiffness: 1.0, point_a: {list(points["thing"])},
        point_b: {list(points["ball"])}}}
    - {{a: ball, b: thing, stiffness: 1.0, point_a: {list(points["ball"])},
        point_b: {list(points["thing"])}}}
duration: 1.0
"""
    cells = load_experiment_text(text, "springs.yaml").cells()
    scene = cells[0].config.as_dict()["scene"]
    turn = tuple(scene["bodies"]["thing"]["orientation"])
    written = to_world(Q, points["thing"])
    first, second = scene["springs"]
    # two turns, a dozen roundings each of numbers below 1
    for point in (first["point_a"], second["point_b"]):
        np.testing.assert_allclose(to_world(turn, tuple(point)), written, atol=24 * 1.1e-16)
    for point in (first["point_b"], second["point_a"]):
        assert tuple(point) == points["ball"]
