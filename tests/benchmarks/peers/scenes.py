"""The scenes that every engine is given. Lengths in m, masses in kg, angles in rad.

Unless said otherwise: boxes of 0.2 m and 1 kg, mu 0.5, e 0, 240 Hz, bodies start touching.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import atan, cos, pi, sin, sqrt
from typing import Final

from .description import ZERO, Body, Box, Plane, Scene, Sphere, Vector

G: Final = 9.81  # [m/s^2]
EDGE, MU = 0.2, 0.5
FLOOR: Final = Body(Plane((0.0, 0.0, 1.0), 0.0))
CUBE: Final = Box((EDGE, EDGE, EDGE))
PHASES: Final = 16
GOLDEN: Final = (sqrt(5.0) - 1.0) / 2.0
SIDE_GAP: Final = 0.1 * EDGE  # between neighbours of a row of the pyramid
RADIUS: Final = 0.1  # of the ball that drops, bounces and is thrown


def _steps(seconds: float, timestep: Fraction) -> int:
    return round(seconds / timestep)


def drop(e: float, phase: Fraction, timestep: Fraction = Fraction(1, 240)) -> Scene:
    """A ball falls 1 m; `phase` shifts the release by that share of the last step's fall."""
    clearance = 1.0 + float(phase) * sqrt(2.0 * G) * float(timestep)
    ball = Body(Sphere(RADIUS), 1.0, (0.0, 0.0, RADIUS + clearance))
    # Down, and up to the apex at e <= 1; half a second more for contacts that last that long.
    duration = (1.0 + e) * sqrt(2.0 * clearance / G) + 0.5
    return Scene((FLOOR, ball), _steps(duration, timestep), timestep, restitution=e)


def rest(shape: Sphere | Box, seconds: float = 2.0) -> Scene:
    """One body rests on the floor."""
    height = shape.radius if isinstance(shape, Sphere) else 0.5 * shape.size[2]
    return Scene(
        (FLOOR, Body(shape, 1.0, (0.0, 0.0, height))),
        _steps(seconds, Fraction(1, 240)),
        friction=MU,
    )


def tower(count: int, seconds: float) -> Scene:
    """Boxes one on the other."""
    boxes = [Body(CUBE, 1.0, (0.0, 0.0, EDGE * (k + 0.5))) for k in range(count)]
    return Scene((FLOOR, *boxes), _steps(seconds, Fraction(1, 240)), friction=MU)


def heavy_on_light(ratio: float, seconds: float = 5.0) -> Scene:
    """A cube of 0.6 m and `ratio` kg on one of 0.2 m and 1 kg."""
    light = Body(CUBE, 1.0, (0.0, 0.0, 0.5 * EDGE))
    heavy = Body(Box((0.6, 0.6, 0.6)), ratio, (0.0, 0.0, EDGE + 0.3))
    return Scene((FLOOR, light, heavy), _steps(seconds, Fraction(1, 240)), friction=MU)


def pyramid(base: int, seconds: float = 3.0) -> Scene:
    """Rows of base, base - 1, ... 1 boxes, each on two of the row below."""
    pitch = EDGE + SIDE_GAP
    boxes = [
        Body(CUBE, 1.0, ((k - 0.5 * (base - row - 1)) * pitch, 0.0, EDGE * (row + 0.5)))
        for row in range(base)
        for k in range(base - row)
    ]
    return Scene((FLOOR, *boxes), _steps(seconds, Fraction(1, 240)), friction=MU)


def _shaken() -> Iterator[float]:
    """Numbers in [-1, 1) without a pattern: multiples of the golden ratio, modulo 1."""
    value = 0.0
    while True:
        value = (value + GOLDEN) % 1.0
        yield 2.0 * value - 1.0


def pile(count: int, seconds: float = 5.0) -> Scene:
    """Spheres of 0.05 m fall into a box whose four walls stand 1 m apart."""
    radius, pitch, across, shake = 0.05, 0.108, 9, 0.003
    shift = _shaken()
    walls = [
        Body(Plane(normal, -0.5))
        for normal in ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0))
    ]
    spheres = []
    for k in range(count):
        layer, place = divmod(k, across * across)
        row, column = divmod(place, across)
        x = (column - 0.5 * (across - 1)) * pitch + shake * next(shift)
        y = (row - 0.5 * (across - 1)) * pitch + shake * next(shift)
        spheres.append(Body(Sphere(radius), 1.0, (x, y, radius + pitch * layer + shake)))
    return Scene((FLOOR, *walls, *spheres), _steps(seconds, Fraction(1, 240)), friction=MU)


def incline(share: float, azimuth: float, seconds: float = 2.0) -> Scene:
    """A box on a slope of tan = `share` * mu that falls towards `azimuth` in the box's frame.

    The plane is level and gravity leans, so that the slope meets the box and the tangents of its
    contacts under every angle.
    """
    slope = atan(share * MU)
    gravity = (G * sin(slope) * cos(azimuth), G * sin(slope) * sin(azimuth), -G * cos(slope))
    box = Body(CUBE, 1.0, (0.0, 0.0, 0.5 * EDGE))
    return Scene((FLOOR, box), _steps(seconds, Fraction(1, 240)), gravity=gravity, friction=MU)


def azimuths() -> list[float]:
    """Return the 16 directions of slope."""
    return [2.0 * pi * k / PHASES for k in range(PHASES)]


def bounces(count: int) -> Scene:
    """A ball bounces from 1 m without loss, to the apex after bounce `count`."""
    ball = Body(Sphere(RADIUS), 1.0, (0.0, 0.0, RADIUS + 1.0))
    duration = (2 * count + 0.5) * sqrt(2.0 / G)
    return Scene((FLOOR, ball), _steps(duration, Fraction(1, 240)), restitution=1.0)


def bullet(phase: Fraction) -> Scene:
    """A sphere at 100 m/s meets a wall of 20 mm at 60 Hz; `phase` is a share of a step's way."""
    dt, speed = Fraction(1, 60), 100.0
    start = -3.0 - float(phase * dt) * speed
    ball = Body(Sphere(0.05), 1.0, (start, 0.0, 0.0), velocity=(speed, 0.0, 0.0))
    wall = Body(Box((0.02, 2.0, 2.0)))
    return Scene((wall, ball), 12, dt, gravity=ZERO)


SPIN: Final[Vector] = (0.01, 5.0, 0.01)  # [rad/s]
INERTIA: Final[Vector] = (0.01, 0.02, 0.03)  # [kg m^2]


def free_rotation(seconds: float = 60.0) -> Scene:
    """A body with moments 1:2:3 turns about its middle axis, without gravity or contacts, 60 Hz.

    No solid box has these moments; the shape touches nothing and only the given inertia counts.
    """
    dt = Fraction(1, 60)
    body = Body(CUBE, 1.0, angular_velocity=SPIN, principal=INERTIA)
    return Scene((body,), _steps(seconds, dt), dt, gravity=ZERO)


THROW_E, THROW_MU = 0.5, 0.3


def _gap(speed: float, phase: Fraction) -> float:
    """Return a way [m] that takes 4 + `phase` steps at `speed` [m/s]."""
    return float((4 + phase) * Fraction(1, 240)) * speed


def thrown(velocity: Vector, spin: Vector, phase: Fraction = Fraction(1, 2)) -> Scene:
    """A ball hits the floor obliquely, without gravity, after 4 + `phase` steps."""
    height = RADIUS + _gap(-velocity[2], phase)
    ball = Body(Sphere(RADIUS), 1.0, (0.0, 0.0, height), velocity=velocity, angular_velocity=spin)
    return Scene((FLOOR, ball), 24, gravity=ZERO, friction=THROW_MU, restitution=THROW_E)


ROD: Final = Box((1.0, 0.1, 0.1))  # its upper end is never near the floor when the lower one hits
ROD_LEAN: Final = pi / 3.0  # of its length above the floor


def rod_end(phase: Fraction = Fraction(1, 2), speed: float = 3.0) -> Scene:
    """A frictionless rod falls with its lower edge, two points at once, without gravity."""
    lowest = 0.5 * (ROD.size[0] * sin(ROD_LEAN) + ROD.size[2] * cos(ROD_LEAN))
    turn = (cos(0.5 * ROD_LEAN), 0.0, sin(0.5 * ROD_LEAN), 0.0)
    rod = Body(ROD, 1.0, (0.0, 0.0, lowest + _gap(speed, phase)), turn, velocity=(0.0, 0.0, -speed))
    return Scene((FLOOR, rod), 24, gravity=ZERO, restitution=THROW_E)
