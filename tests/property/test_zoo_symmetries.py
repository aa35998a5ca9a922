"""Whoever looks, turned, moving, or with another list of bodies, sees the same motion.

Worlds of all shapes, frictional and bouncing, default numerics but solved to 1e-13 m/s: what is
left between two runs is round-off, which impacts amplify. Ten steps have some three impacts one
after the other; each turns an error of position into one of velocity by at most the relative speed
over the curvature (15 m/s over 0.1 m) and hands it on times the ratio of masses (100), and levers
make of it (1 + r^2 m/I < 7): 1e-16 m may become 1e-10 m/s.
Round rims are met by iterations that end when they turn the normal by less than 1e-6 a time
(`separation.ascend`, for cores that overlap): an impact's 2 * 15 m/s is known to
2 * 15 * 7 * 1e-6 = 2e-4 m/s, two of them to 4e-4. Of such worlds only pairs: among several bodies
one is thrown into the next, and how deep it gets makes its normal known worse.
Projection is swept until nothing changes: what a few sweeps leave depends on the order.
"""

from __future__ import annotations

import copy
from fractions import Fraction
from typing import Any

import convex
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from laboratory import body
from zoo import GRAVITY, NOWHERE, NUMERICS, SHAPES, SOME, bench, impulses, run, unit, vector, zoos

STEPS = 10
SOLVED = {"tolerance": 1e-13, "sweeps": 3000, "projection_sweeps": 5000}
# Kinds of bodies, at most how many, and to what their velocities are known after ten steps [m/s].
FLAT = (("sphere", "box", "capsule", "hull", "compound"), 5, 1e-9)
CURVED = (SHAPES, 2, 4e-4)
SMOOTH = st.just(0.0)
EITHER = pytest.mark.parametrize(("kinds", "most", "known"), [FLAT, CURVED], ids=["flat", "curved"])


def moved(bodies: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """Return a copy in which the named vectors of all bodies but planes are changed."""
    copied = copy.deepcopy(bodies)
    for described in copied.values():
        if described["shape"]["kind"] != "plane":
            for name, change in changes.items():
                described[name] = list(change(np.array(described[name])))
    return copied


def turned(bodies: dict[str, Any], quaternion: np.ndarray, matrix: np.ndarray) -> dict[str, Any]:
    """Return the world turned about the origin."""

    def turn(described: np.ndarray) -> np.ndarray:
        return matrix @ described

    def product(q: np.ndarray) -> np.ndarray:
        w, axis = quaternion[0], quaternion[1:]
        part = w * q[1:] + q[0] * axis + np.cross(axis, q[1:])
        return np.array([w * q[0] - axis @ q[1:], *part])

    changes = dict.fromkeys(("position", "velocity", "angular_velocity"), turn)
    return moved(bodies, **changes, orientation=product)


def motion(bodies: dict[str, Any], gravity: Any = NOWHERE, order: Any = None) -> np.ndarray:
    """Return velocities and spins after the run, one row per body in `order` of the list."""
    world = bench(bodies, gravity, **SOLVED)
    world.run(STEPS)
    movable = [i for i, b in enumerate(bodies.values()) if b["mass"] is not None]
    rows = movable if order is None else order
    return np.hstack([world.velocity[rows], world.spin[rows]])


@EITHER
@given(st.data())
@SOME
def test_a_moving_observer_sees_two_bodies_meet_alike(kinds, most, known, data):
    """Two: what Stronge's law, in 256 parts, makes of round-off grows when handed to a third."""
    check_moving(data.draw(zoos(kinds, (2, 2))), data.draw(vector), known)


@EITHER
@given(st.data())
@SOME
def test_a_moving_observer_sees_smooth_bodies_meet_alike(kinds, most, known, data):
    check_moving(data.draw(zoos(kinds, (2, most), friction=SMOOTH)), data.draw(vector), known)


def check_moving(bodies, way, known):
    speed = 3.0 * np.array(way)
    still = motion(bodies)
    seen = motion(moved(bodies, velocity=lambda v: v + speed))
    np.testing.assert_allclose(seen[:, :3] - speed, still[:, :3], atol=known)
    np.testing.assert_allclose(seen[:, 3:], still[:, 3:], atol=known / 0.1)


def test_a_moving_observer_sees_a_row_of_three_balls_meet_alike():
    """The second is pushed into the third, which nothing shows while both are at rest."""

    def speeds(observer):
        bodies = {}
        for i, speed in enumerate((5.0, 0.0, 0.0)):
            bodies[f"body_{i}"] = body(
                {"kind": "sphere", "radius": 0.1},
                (0.201 * i, 0.0, 0.0),
                velocity=(speed + observer, 0.0, 0.0),
            )
        world = bench(bodies, **SOLVED)
        world.run(1)
        return world.velocity[:, 0] - observer

    np.testing.assert_allclose(speeds(10.0), speeds(0.0), atol=1e-9)


@EITHER
@given(st.data())
@SOME
def test_a_world_without_gravity_moves_alike_however_it_is_turned(kinds, most, known, data):
    bodies = data.draw(zoos(kinds, (2, most)))
    quaternion = np.array([1.0, *data.draw(vector)])
    check_turned(bodies, quaternion, NOWHERE, known)


@EITHER
@given(st.data())
@SOME
def test_a_world_on_a_floor_moves_alike_turned_about_gravity(kinds, most, known, data):
    bodies = data.draw(zoos(kinds, (2, most), floor=True))
    quaternion = np.array([data.draw(unit), 0.0, 0.0, 1.0])
    check_turned(bodies, quaternion, GRAVITY, known)


@EITHER
@given(st.data())
@SOME
def test_a_world_in_a_cavity_moves_alike_however_it_is_turned(kinds, most, known, data):
    """Nothing draws the axis of a drum and its normals but where it stands."""
    bodies = data.draw(zoos(kinds, (2, most), cavity=True))
    check_turned(bodies, np.array([1.0, *data.draw(vector)]), NOWHERE, known)


@EITHER
@given(st.data())
@SOME
def test_a_world_in_a_cavity_moves_in_a_mirror_as_its_image(kinds, most, known, data):
    check_mirrored(data.draw(zoos(kinds, (2, most), cavity=True)), GRAVITY, known)


@EITHER
@given(st.data())
@SOME
def test_a_world_on_triangles_moves_alike_however_it_is_turned(kinds, most, known, data):
    bodies = data.draw(zoos(kinds, (2, most), ground=True))
    check_turned(bodies, np.array([1.0, *data.draw(vector)]), NOWHERE, known)


def check_turned(bodies, quaternion, gravity, known):
    quaternion = quaternion / np.linalg.norm(quaternion)
    matrix = convex.matrix_of(quaternion)
    plain = motion(bodies, gravity)
    seen = motion(turned(bodies, quaternion, matrix), gravity)
    np.testing.assert_allclose(seen[:, :3], plain[:, :3] @ matrix.T, atol=known)
    np.testing.assert_allclose(seen[:, 3:], plain[:, 3:] @ matrix.T, atol=known / 0.1)


@EITHER
@pytest.mark.parametrize("floor", [False, True], ids=["free", "on a floor"])
@given(st.data())
@SOME
def test_the_order_of_bodies_in_the_file_changes_no_motion(kinds, most, known, floor, data):
    bodies = data.draw(zoos(kinds, (2, most), floor=floor))
    names = data.draw(st.permutations(list(bodies)))
    listed = [names.index(name) for name in bodies if bodies[name]["mass"] is not None]
    gravity = GRAVITY if floor else NOWHERE
    plain = motion(bodies, gravity)
    other = motion({name: bodies[name] for name in names}, gravity, listed)
    np.testing.assert_allclose(other[:, :3], plain[:, :3], atol=known)
    np.testing.assert_allclose(other[:, 3:], plain[:, 3:], atol=known / 0.1)


@EITHER
@given(st.data())
@SOME
def test_two_bodies_listed_the_other_way_round_get_opposite_impulses(kinds, most, known, data):
    """Sums over the contacts of a step: those of a manifold may share a load in several ways."""
    bodies = data.draw(zoos(kinds, (2, 2)))
    plain = run(bodies, STEPS, **SOLVED)
    other = run(dict(reversed(bodies.items())), STEPS, **SOLVED)

    def on_row_one(rows):
        contacts = rows.contact
        sign = np.where(contacts["body_b"] == 1, 1.0, -1.0)
        pushed = impulses(contacts) * sign[:, None]
        return [pushed[contacts["step"] == k].sum(axis=0) for k in range(1, STEPS + 1)]

    # velocities of the lighter body are known to `known`, its impulses to mass times that
    lighter = min(described["mass"] for described in bodies.values())
    np.testing.assert_allclose(
        on_row_one(other), -np.array(on_row_one(plain)), atol=2.0 * lighter * known
    )


MIRROR = np.array([-1.0, 1.0, 1.0])  # across x
# What turns is seen turning as before about x, and the other way about y and z.
TURNED = -MIRROR


def mirrored_turn(quaternion: Any) -> list[float]:
    """Return an orientation as a mirror shows it, of a frame that is seen in it, too."""
    return [float(quaternion[0]), *(TURNED * np.array(quaternion[1:])).tolist()]


def mirrored_shape(described: dict[str, Any]) -> dict[str, Any]:
    """Return a resolved shape in the mirror; its principal frame is that of the image."""
    if described["kind"] == "hull":
        points = [(MIRROR * np.array(point)).tolist() for point in described["points"]]
        # Counter-clockwise from outside is clockwise in the mirror.
        faces = [list(reversed(face)) for face in described["faces"]]
        return {**described, "points": points, "faces": faces}
    if described["kind"] != "compound":
        return described
    parts = [
        {
            "shape": mirrored_shape(part["shape"]),
            "position": (MIRROR * np.array(part["position"])).tolist(),
            "orientation": mirrored_turn(part["orientation"]),
        }
        for part in described["parts"]
    ]
    return {**described, "parts": parts}


def mirrored(bodies: dict[str, Any]) -> dict[str, Any]:
    """Return the world that a mirror shows."""
    seen = moved(
        bodies,
        position=lambda x: MIRROR * x,
        velocity=lambda v: MIRROR * v,
        angular_velocity=lambda w: TURNED * w,
        orientation=mirrored_turn,
    )
    for described in seen.values():
        described["shape"] = mirrored_shape(described["shape"])
    return seen


@EITHER
@pytest.mark.parametrize("floor", [False, True], ids=["free", "on a floor"])
@given(st.data())
@SOME
def test_a_world_in_a_mirror_moves_as_its_image(kinds, most, known, floor, data):
    """No turn of the world shows a cross product of the wrong hand; a mirror does."""
    bodies = data.draw(zoos(kinds, (2, most), floor=floor))
    check_mirrored(bodies, GRAVITY if floor else NOWHERE, known)


def check_mirrored(bodies, gravity, known):
    plain, image = motion(bodies, gravity), motion(mirrored(bodies), gravity)
    np.testing.assert_allclose(image[:, :3], MIRROR * plain[:, :3], atol=known)
    np.testing.assert_allclose(image[:, 3:], TURNED * plain[:, 3:], atol=known / 0.1)


LENGTHS = (
    "radius",
    "length",
    "size",
    "semi_axes",
    "height",
    "points",
    "position",
    "offset",
)  # of shapes [m]


def scaled(value: Any, factor: float) -> Any:
    """Return a number, or what is nested of numbers, times a factor."""
    if isinstance(value, list | tuple):
        return [scaled(one, factor) for one in value]
    return factor * value


def scaled_shape(described: dict[str, Any], length: float) -> dict[str, Any]:
    """Return a shape so many times as large."""
    return {
        key: [{**scaled_shape(part, length), "shape": scaled_shape(part["shape"], length)}
              for part in value] if key == "parts"
        else scaled(value, length) if key in LENGTHS else value
        for key, value in described.items()
    }  # fmt: skip


def in_units(bodies: dict[str, Any], mass: float, length: float, time: float) -> dict[str, Any]:
    """Return a world whose numbers are those of units so many times smaller."""
    seen = moved(
        bodies,
        position=lambda x: length * x,
        velocity=lambda v: length / time * v,
        angular_velocity=lambda w: w / time,
    )
    for described in seen.values():
        described["shape"] = scaled_shape(described["shape"], length)
        if described["mass"] is not None:
            described["mass"] *= mass
            described["inertia"] = scaled(described["inertia"], mass * length**2)
    return seen


SPEEDS = ("tolerance", "restitution_threshold", "sleep_speed")  # keys of numerics [m/s]


def numerics_in_units(length: float, time: float) -> dict[str, Any]:
    """Return the numerics of the runs in other units."""
    plain = {**NUMERICS, **SOLVED}
    changed = {key: length / time * plain[key] for key in SPEEDS}
    changed |= {key: length * plain[key] for key in ("slop", "cache_distance")}
    changed["timestep"] = str(Fraction(plain["timestep"]) * Fraction(time))
    return {**plain, **changed}


def motion_in_units(bodies: Any, gravity: Any, units: tuple[float, float, float]) -> np.ndarray:
    """Return velocities and spins after the run in other units, in those of the plain one."""
    mass, length, time = units
    seen = in_units(bodies, mass, length, time)
    numerics = numerics_in_units(length, time)
    world = bench(seen, scaled(list(gravity), length / time**2), **numerics)
    world.run(STEPS)
    movable = [i for i, b in enumerate(bodies.values()) if b["mass"] is not None]
    return np.hstack([world.velocity[movable] / (length / time), world.spin[movable] * time])


@EITHER
@pytest.mark.parametrize("floor", [False, True], ids=["free", "on a floor"])
@given(st.data())
@SOME
def test_masses_in_other_units_change_no_bit_of_the_motion(kinds, most, known, floor, data):
    """By a power of two, which rounds nothing: no mass stands in the engine as a number."""
    bodies = data.draw(zoos(kinds, (2, most), floor=floor))
    gravity = GRAVITY if floor else NOWHERE
    exponent = data.draw(st.integers(-20, 20))
    seen = motion_in_units(bodies, gravity, (2.0**exponent, 1.0, 1.0))
    np.testing.assert_array_equal(seen, motion(bodies, gravity))


@EITHER
@given(st.data())
@SOME
def test_masses_in_other_units_change_no_bit_inside_a_cavity(kinds, most, known, data):
    bodies = data.draw(zoos(kinds, (2, most), cavity=True))
    exponent = data.draw(st.integers(-20, 20))
    seen = motion_in_units(bodies, GRAVITY, (2.0**exponent, 1.0, 1.0))
    np.testing.assert_array_equal(seen, motion(bodies, GRAVITY))


@EITHER
@pytest.mark.parametrize("floor", [False, True], ids=["free", "on a floor"])
@given(st.data())
@SOME
def test_lengths_and_times_in_other_units_show_the_same_motion(kinds, most, known, floor, data):
    """TOUCHING [m] and the ends of fixed points [m/s] stay what they are, up to eight times others.

    A gap so small that only one of the two worlds takes it for none is not among those drawn.
    """
    bodies = data.draw(zoos(kinds, (2, most), floor=floor))
    gravity = GRAVITY if floor else NOWHERE
    length, time = (2.0 ** data.draw(st.integers(-3, 3)) for _ in range(2))
    seen, plain = motion_in_units(bodies, gravity, (1.0, length, time)), motion(bodies, gravity)
    # Normals are known to a share of 1e-8 of lengths that differ by 8: of speeds up to 30 m/s,
    # where several bodies are thrown about.
    known = max(known, 3e-6)
    np.testing.assert_allclose(seen[:, :3], plain[:, :3], atol=known)
    np.testing.assert_allclose(seen[:, 3:], plain[:, 3:], atol=known / 0.1)
