"""What moves inside a bowl or a drum: pendulums by elliptic integrals, and statics.

A ball of radius r in a bowl of radius R swings about its centre at L = R - r, an upright cube whose
four lower corners touch as a rigid pendulum about it. With k = sin(q_0 / 2), from rest:

    q'' = -w^2 sin q,     q(t) = 2 arcsin(k cd(w t, k))
    sliding ball w^2 = g/L;   rolling ball (7/5) L w^2 = g;   rolling cylinder (3/2) L w^2 = g
    cube, edge s: d = sqrt(R^2 - s^2/2) - s/2 from the centre, w^2 = g d / (s^2/6 + d^2)
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipj
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

R, SMALL, LARGE = 0.5, 0.1, 1.2  # [m], [rad]
RADIUS = 0.1  # of balls and cylinders [m]
EDGE = 0.2  # of the cube [m]
ARM = R - RADIUS
CUBE_ARM = math.sqrt(R * R - 0.5 * EDGE * EDGE) - 0.5 * EDGE
RATES = (120, 240, 480)
DURATION = 1.0  # [s]: a swing of the slowest takes 1.5 s from 0.1 rad, 1.6 s from 1.2 rad
SQUARED = {  # w^2 [1/s^2], and the distance of the centre [m]
    "sliding": (GRAVITY / ARM, ARM),
    "rolling": (GRAVITY / (1.4 * ARM), ARM),
    "capsule": (GRAVITY / ARM, ARM),
    "cylinder": (GRAVITY / (1.5 * ARM), ARM),
    "cube": (GRAVITY * CUBE_ARM / (EDGE * EDGE / 6.0 + CUBE_ARM**2), CUBE_ARM),
}
SHAPES = {
    "sliding": f"{{kind: sphere, radius: {RADIUS}}}",
    "rolling": f"{{kind: sphere, radius: {RADIUS}}}",
    "capsule": f"{{kind: capsule, radius: {RADIUS}, length: 0.3}}",
    "cylinder": f"{{kind: cylinder, radius: {RADIUS}, length: 0.3}}",
    "cube": f"{{kind: box, size: [{EDGE}, {EDGE}, {EDGE}]}}",
}
ROUGH = {"rolling", "cylinder"}
TURN = {"capsule": (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)}  # their axes along y, as the drum's
TURN["cylinder"] = TURN["capsule"]
BOWL = f"{{shape: {{kind: bowl, radius: {R}}}, position: [0, 0, 0], surface: one}}"
DRUM = (
    f"{{shape: {{kind: drum, radius: {R}}}, position: [0, 0, 0], surface: one, "
    f"orientation: {flow((math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0))}}}"
)


def released(motion: str, angle: float, rate: int) -> str:
    place = SQUARED[motion][1]
    at = flow((place * math.sin(angle), 0.0, -place * math.cos(angle)))
    turn = TURN.get(motion)
    if motion == "cube":
        turn = (math.cos(0.5 * angle), 0.0, -math.sin(0.5 * angle), 0.0)
    turned = f", orientation: {flow(turn)}" if turn else ""
    it = f"{{shape: {SHAPES[motion]}, mass: 2.0, position: {at}{turned}, surface: one}}"
    wall = {"drum": DRUM} if motion in TURN else {"bowl": BOWL}
    surface = f"friction: {20.0 if motion in ROUGH else 0.0}"
    text = config(wall | {"it": it}, rate, DURATION, surface, repr(GRAVITY))
    return text.replace("timestep:", "integrator: midpoint_contact, timestep:")


def swung(motion: str, angle: float, times: np.ndarray) -> np.ndarray:
    k, w = math.sin(0.5 * angle), math.sqrt(SQUARED[motion][0])
    _, cn, dn, _ = ellipj(w * times, k * k)
    return 2.0 * np.arcsin(k * cn / dn)


def angles(states: States) -> np.ndarray:
    place, _, _ = states.of("it")
    return np.arctan2(place[:, 0], -place[:, 2])
