"""Bodies that fall over an edge onto a face stop there, where pushes of the face can stop them.

The edge lasts while the body turns about it, a slop deep at most, and the face meets the floor with
all of its points in one instant: one impact at e = 0. Of pushes J >= 0 at the corners of the face,
at distances d from the edge, that take all of the momentum,
    sum J = m w s,   sum J d = (I + m (s^2 + h^2)) w
s: distance of the centre of mass from the edge along the face, h: its height, I: about the axis of
the turn; friction has to take m w h of sum J, and to hold the edge before. Where there are some,
rest is what the laws of the impact have: it minimises the energy among velocities that leave the
floor alone, which is what a plastic impact does, and friction has no slip to act against.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import nnls
from shared_runs import GRAVITY, States, config, flow, plane, run_scenes

FRICTION = 0.8
SLOP = 1e-7  # [m], the default
RATES = (60, 240, 1000)  # steps a second
TILTS = (5, 20, 40)  # [degree]
R, T = 0.1, 0.02
DURATION = 0.4


class Face(NamedTuple):
    """A body of 1 kg that turns about an edge along y; its face at height -h."""

    shape: str
    corners: np.ndarray  # [m], (n, 3), of the whole body from its centre of mass
    inertia: float  # [kg m^2] about y
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)  # its centre of mass, in the shape's frame


def prism(outline: np.ndarray) -> tuple[str, np.ndarray]:
    corners = np.array([(x, y, z) for x, y in outline for z in (-T / 2, T / 2)])
    points = ", ".join(flow(corner) for corner in corners)
    return f"{{kind: hull, points: [{points}]}}", corners


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> str:
    return f"{{shape: {{kind: box, size: {flow(size)}}}, position: {flow(at)}}}"


def faces() -> dict[str, Face]:
    angles = np.arange(6) * math.pi / 3
    hexagon, corners = prism(R * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    side = R * R * (5.0 / 24.0) + T * T / 12.0  # of a regular hexagon about a diagonal, a = R
    circle = np.arange(0, 64) * math.pi / 32
    rim = np.array([(R * math.cos(t), R * math.sin(t), z) for t in circle for z in (-T / 2, T / 2)])
    # An L whose two boxes, 4 and 3 shares of its mass, have their edges in one line: a face of two.
    centre = 3.0 * 0.1 / 7.0
    parts = f"[{box((0.1, 0.4, 0.1), (0, 0, 0))}, {box((0.3, 0.1, 0.1), (0.1, 0.25, 0))}]"
    ends = [(x, y) for x in (-0.05, 0.05) for y in (-0.2, 0.2)]
    ends += [(x, y) for x in (-0.05, 0.25) for y in (0.2, 0.3)]
    angle = np.array([(x - centre, y, z) for x, y in ends for z in (-0.05, 0.05)])
    inertia = 4.0 * (0.02 / 12.0 + centre**2) + 3.0 * (0.1 / 12.0 + (0.1 - centre) ** 2)
    return {
        "coin": Face(f"{{kind: cylinder, radius: {R}, length: {T}}}", rim, R * R / 4 + T * T / 12),
        "tile": Face(hexagon, corners, side),
        "angle": Face(f"{{kind: compound, parts: {parts}}}", angle, inertia / 7.0),
    }


FACES = faces()


def text(face: Face, tilt: float, rate: int) -> str:
    """Return the scene: the body on its edge, tilted about y, so that +x is up."""
    c, s = math.cos(tilt), math.sin(tilt)
    lowest = (c * face.corners[:, 2] + s * face.corners[:, 0]).min()
    turn = flow((math.cos(tilt / 2), 0.0, -math.sin(tilt / 2), 0.0))
    body = f"position: {flow((0.0, 0.0, -lowest))}, orientation: {turn}, surface: one"
    bodies = {"floor": plane(), "body": f"{{shape: {face.shape}, mass: 1.0, {body}}}"}
    return config(bodies, rate, DURATION, f"friction: {FRICTION}", repr(GRAVITY))


@pytest.fixture(scope="module")
def runs() -> dict[str, States]:
    return run_scenes(
        {
            f"{name} {tilt} {rate}": text(face, math.radians(tilt), rate)
            for name, face in FACES.items()
            for tilt in TILTS
            for rate in RATES
        }
    )


@pytest.mark.parametrize("name", FACES)
def test_pushes_of_the_face_can_stop_it(name: str) -> None:
    face = FACES[name]
    down = face.corners[face.corners[:, 2] < 0.0]
    edge, h = down[:, 0].min(), -down[0, 2]
    s = -edge
    distances = down[:, 0] - edge
    rows = np.stack([np.ones(len(down)), distances / s])
    asked = np.array([s, (face.inertia + s * s + h * h) / s])
    _, left = nnls(rows, asked)
    assert left < 1e-12 * s
    assert h < 0.9 * FRICTION * s


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("tilt", TILTS)
@pytest.mark.parametrize("name", FACES)
def test_what_lands_on_a_face_stops_at_once(
    runs: dict[str, States], name: str, tilt: int, rate: int
) -> None:
    """But for what falls by the gaps that count as closed, ten slops: m g 10 slop."""
    run, face = runs[f"{name} {tilt} {rate}"], FACES[name]
    _, velocity, spin = run.of("body")
    energy = 0.5 * (velocity**2).sum(axis=1) + 0.5 * face.inertia * (spin**2).sum(axis=1)
    fastest = int(energy.argmax())
    assert energy[fastest] > 0.02  # it has fallen over
    # The impact is in the step after the fastest state, or in the next one.
    assert energy[fastest + 2 :].max() < GRAVITY * 10.0 * SLOP


@pytest.mark.parametrize("tilt", TILTS)
@pytest.mark.parametrize("name", FACES)
def test_an_edge_that_is_deep_by_how_far_a_step_turns_is_no_overlap(
    runs: dict[str, States], name: str, tilt: int
) -> None:
    """A coin's is 51 um deep after turns by 0.16 rad a step; impacts have their order all the same.

    Finer steps of a coin may have more impacts, of points of its rim, than a step may have parts.
    """
    assert runs[f"{name} {tilt} {RATES[0]}"].step["unordered"].max() == 0
