"""Triangles make no difference: what moves on a mesh moves as on the plane or the box it is.

Sides of triangles within a face have no contacts, so on a floor of irregular triangles steps have
the rows that they have on a plane. On a closed mesh of a box the points are found in another order
and place than those of two boxes: motion agrees as far as the solver's tolerance.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import Delaunay
from shared_runs import GRAVITY, States, config, flow, run_scenes

EDGE = 0.2  # of boxes [m]
RATE = 240
BALL = "{kind: sphere, radius: 0.1}"
BOX = "{kind: box, size: [0.2, 0.2, 0.2]}"
CAN = "{kind: cylinder, radius: 0.1, length: 0.2}"
ACROSS = "orientation: {axis: [1, 0, 0], degrees: 90}"
PLANE = "{kind: plane}"
SLAB = "{kind: box, size: [1, 1, 0.2]}"
LOOPS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def mesh(vertices, triangles) -> str:
    points = np.asarray(vertices, float).tolist()
    return f"{{kind: mesh, vertices: {points}, triangles: {np.asarray(triangles).tolist()}}}"


def irregular() -> str:
    """Return a floor 4 m wide at 0, of triangles of many sizes, thin ones among them."""
    rng = np.random.default_rng(5)
    places = np.concatenate([[(-2, -2), (2, -2), (2, 2), (-2, 2)], rng.uniform(-1.9, 1.9, (60, 2))])
    triangles = Delaunay(places).simplices
    a, b, c = (places[triangles[:, k]] for k in range(3))
    turns = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    triangles[turns < 0.0] = triangles[turns < 0.0][:, ::-1]
    return mesh(np.column_stack([places, np.zeros(len(places))]), triangles)


def slab() -> str:
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.1, 0.1)]
    return mesh(corners, [(loop[0], loop[k], loop[k + 1]) for loop in LOOPS for k in (1, 2)])


ON_FLOOR = {  # shape, position, and the rest
    "ball": (BALL, (-1.2, 0.1, 0.1), "velocity: [1.3, 0.2, 0]"),
    "box": (BOX, (-1.2, -0.3, 0.1), "velocity: [2.3, 0.4, 0], angular_velocity: [0, 0, 3]"),
    "roller": (CAN, (-1.2, 0.3, 0.1), f"velocity: [1.3, 0, 0], {ACROSS}"),
    "can": (CAN, (-1.2, 0.2, 0.1), "velocity: [2.3, 0.2, 0], angular_velocity: [0, 0, 3]"),
}
ON_SLAB = {
    "overhangs": (BOX, (0.45, 0.1, 0.1), ""),
    "tips": (BOX, (0.52, -0.3, 0.1), ""),
    "turned": (BOX, (-0.45, 0.1, 0.1), "orientation: {axis: [0, 0, 1], degrees: 30}"),
    "ball": (BALL, (0.3, 0.4, 0.1), "velocity: [0, 0.5, 0]"),
}


# A ridge 0.5 m high across a floor, and balls that pass 2 cm over it, or dive behind it: 0.2 to
# 1.8 m a step.
RIDGE = mesh(
    [(x, y, z) for y in (-2, 2) for x, z in ((-3, 0), (-0.5, 0), (0, 0.5), (0.5, 0), (40, 0))],
    [t for k in range(4) for t in ((k, k + 1, k + 6), (k, k + 6, k + 5))],
)
FAST = {
    "passes at 50 m/s": ((-1.7, 0.1, 0.62), (50.0, 0.0, 0.0)),
    "passes at 300 m/s": ((-1.7, 0.1, 0.62), (300.0, 0.0, 0.0)),
    "dives at 50 m/s": ((-1.0, 0.1, 1.7), (50.0, 0.0, -50.0)),
    "dives at 300 m/s": ((-1.0, 0.1, 1.7), (300.0, 0.0, -300.0)),
}


def fast(at: tuple[float, ...], velocity: tuple[float, ...]) -> str:
    ridge = f"{{shape: {RIDGE}, position: [0, 0, 0], surface: one}}"
    it = f"{{shape: {BALL}, mass: 1.0, position: {flow(at)}, velocity: {flow(velocity)}, "
    return config({"floor": ridge, "it": it + "surface: one}"}, RATE, 0.1, "friction: 0")


def stack() -> str:
    """Return three boxes on triangles, which pass below the lowest."""
    bodies = {"floor": f"{{shape: {irregular()}, position: [0, 0, 0], surface: one}}"}
    for k in range(3):
        at = flow((0.2 + 0.01 * k, -0.1, 0.1 + 0.2 * k))
        bodies[f"box_{k}"] = f"{{shape: {BOX}, mass: 1.0, position: {at}, surface: one}}"
    return config(bodies, RATE, 0.5, "friction: 0.4", repr(GRAVITY))


def scene(floor: str, it: tuple[str, tuple[float, ...], str], duration: float) -> str:
    shape, at, rest = it
    still = {PLANE: "", SLAB: ", position: [0, 0, -0.1], fixed: true"}.get(floor)
    if still is None:
        still = f", position: [0, 0, {0.0 if floor == irregular() else -0.1}]"
    rest = f", {rest}" if rest else ""
    bodies = {
        "floor": f"{{shape: {floor}{still}, surface: one}}",
        "it": f"{{shape: {shape}, mass: 1.0, position: {flow(at)}, surface: one{rest}}}",
    }
    return config(bodies, RATE, duration, "friction: 0.4", repr(GRAVITY))


@pytest.fixture(scope="module")
def runs() -> dict[str, States]:
    texts = {}
    for name, it in ON_FLOOR.items():
        texts[f"{name} on a plane"] = scene(PLANE, it, 1.0)
        texts[f"{name} on triangles"] = scene(irregular(), it, 1.0)
    for name, it in ON_SLAB.items():
        texts[f"{name}: box"] = scene(SLAB, it, 0.5)
        texts[f"{name}: mesh"] = scene(slab(), it, 0.5)
    texts["stack"] = stack()
    return run_scenes(texts | {name: fast(*it) for name, it in FAST.items()})


@pytest.mark.parametrize("name", ON_FLOOR)
def test_a_floor_of_triangles_moves_bodies_as_one_plane(runs, name: str) -> None:
    """Rows are the same in another order: the solver stops at 1e-10 m/s, in 240 steps."""
    on_triangles, on_plane = runs[f"{name} on triangles"], runs[f"{name} on a plane"]
    for mine, its in zip(on_triangles.of("it"), on_plane.of("it"), strict=True):
        np.testing.assert_allclose(mine, its, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(on_triangles.energy(), on_plane.energy(), rtol=0.0, atol=1e-9)
    way = on_plane.of("it")[0][:, 0]
    assert way[-1] - way[0] > 0.5  # past many sides: they are 0.3 m long in the mean


def test_a_stack_rests_on_triangles_with_its_weight(runs) -> None:
    states = runs["stack"]
    drift = np.linalg.norm(states.place[-1] - states.place[0], axis=1)
    assert drift.max() < 1e-9  # the solver's 1e-10 m/s for half a second
    rows = states.contact
    last = rows[rows["step"] == rows["step"].max()]
    on_floor = last[np.minimum(last["body_a"], last["body_b"]) == 0]
    assert on_floor["force_n"].sum() == pytest.approx(3.0 * GRAVITY, rel=1e-9)
    np.testing.assert_array_equal(on_floor["nz"], 1.0)


@pytest.mark.parametrize("name", ON_SLAB)
def test_a_closed_mesh_of_a_box_moves_bodies_as_the_box(runs, name: str) -> None:
    on_mesh, on_box = runs[f"{name}: mesh"], runs[f"{name}: box"]
    off = np.abs(on_mesh.of("it")[0] - on_box.of("it")[0]).max()
    # The solver stops at 1e-10 m/s, in 120 steps. A ball that rolls over the edge is on another
    # point of a step when its contact passes on to it: g dt^2 of 2e-4 m, to the second order.
    assert off < (1e-4 if name == "ball" else 1e-9)


def test_what_tips_and_what_rolls_has_left_the_slab(runs) -> None:
    for name in ("tips", "ball"):
        assert runs[f"{name}: mesh"].of("it")[0][-1, 2] < 0.05


@pytest.mark.parametrize("name", FAST)
def test_a_fast_ball_meets_what_is_on_its_way_and_nothing_else(runs, name: str) -> None:
    """What passes flies straight on; what dives slides on along the floor behind the ridge."""
    place, velocity, _ = runs[name].of("it")
    at, thrown = (np.array(one) for one in FAST[name])
    times = runs[name].time[:, None]
    straight = at + times * thrown
    if "dives" in name:
        straight[:, 2] = np.maximum(straight[:, 2], 0.1)
        assert velocity[-1] == pytest.approx(thrown * (1.0, 1.0, 0.0), abs=1e-9)
    # What touches may lie within the slop, 1e-5 m, of the surface.
    np.testing.assert_allclose(place, straight, rtol=0.0, atol=1e-5)
