"""Closed forms of impacts, drops and steady penetration, from the config of a cell alone.

Nothing recorded by a run is read here, so a closed form is an independent judge.

Impact of A and B at the configured pose, n from A to B, v_n their normal velocity:
    k_n = 1/m_A + 1/m_B + n . [(I_A^-1 (r_A x n)) x r_A + (I_B^-1 (r_B x n)) x r_B]
    j   = max(0, -(1 + e) v_n / k_n),   v_n+ = v_n + k_n j
A drop from the clearance h: speed sqrt(2 g h), rebound e^2 h, impulse (1 + e) m sqrt(2 g h).

Steady penetration of a body with the load N on a compliant contact. Let D = d - slop at the start
of a step, P the projection, beta the gain. At rest the velocity repeats, so the impulse is N dt and
the row v_n + b + gamma lambda = 0 with b = -(beta/dt) D and gamma = c/dt^2 gives
    dt v_n = beta D - c N.
Integration leads to D1 = D - dt v_n = (1 - beta) D + c N, projection to (1 - P) D1. In the steady
state that is D again:
    D [1 - (1 - P)(1 - beta)] = (1 - P) c N,   so   D = c N / (beta + P/(1 - P)).
Projection off (P = 0): D = c N / beta.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from lavendersim.cell import Box, CellBody, CellConfig
from lavendersim.cell.mixing import mixed
from lavendersim.errors import UsageError
from lavendersim.geometry.bodies import (
    extent_along,
    inverse_inertia,
    inverse_mass,
    lowest_point,
    mass_of,
    rotation_of,
    vector,
)
from lavendersim.geometry.shapes import half_space
from lavendersim.measures.interfaces import Floats
from lavendersim.measures.specs.base import ClosedForm


def evaluate_form(form: ClosedForm, cell: CellConfig) -> float:
    """Return the closed form's value in a cell, SI units.

    NaN where it has none; UsageError for bodies whose contact has no closed geometry.
    """
    bodies = tuple(cell.scene.bodies[name] for name in form.bodies)
    return FORMS[form.form](cell, *bodies)


def clearance(moving: CellBody, plane: CellBody) -> float:
    """Return the gap [m] between a body's surface and a plane at the configured pose."""
    normal, offset = half_space(plane.shape)
    return float(normal @ vector(moving.position)) - offset - extent_along(moving, -normal)


def contact_geometry(a: CellBody, b: CellBody) -> tuple[Floats, Floats]:
    """Return the contact point [m] on A's side and the unit normal from A to B."""
    kinds = (a.shape.kind, b.shape.kind)
    if kinds[0] == "plane":
        normal = half_space(a.shape).normal
        return lowest_point(b, normal), normal
    if kinds == ("sphere", "sphere"):
        normal = vector(b.position) - vector(a.position)
        normal = normal / math.sqrt(float(normal @ normal))
        return vector(a.position) + extent_along(a, normal) * normal, normal
    if isinstance(a.shape, Box) and kinds[1] == "sphere":
        return _box_sphere(a, a.shape, b)
    if kinds[1] == "plane" or kinds == ("sphere", "box"):
        point, normal = contact_geometry(b, a)
        return point, -normal
    raise UsageError(f"no closed contact geometry for {kinds[0]} and {kinds[1]}")


def _box_sphere(body: CellBody, box: Box, sphere: CellBody) -> tuple[Floats, Floats]:
    half, turn = 0.5 * vector(box.size), rotation_of(body)
    local = turn.T @ (vector(sphere.position) - vector(body.position))
    nearest = np.clip(local, -half, half)
    apart = turn @ (local - nearest)
    distance = math.sqrt(float(apart @ apart))
    if distance == 0.0:
        raise UsageError("the sphere's centre lies inside the box: no closed contact geometry")
    return vector(body.position) + turn @ nearest, apart / distance


def normal_velocity(a: CellBody, b: CellBody) -> float:
    """Return v_n [m/s] of B relative to A at the configured contact."""
    point, normal = contact_geometry(a, b)
    velocity_a, velocity_b = (
        vector(one.velocity) + np.cross(one.angular_velocity, point - vector(one.position))
        for one in (a, b)
    )
    return float(normal @ (velocity_b - velocity_a))


def inverse_effective_mass(cell: CellConfig, a: CellBody, b: CellBody) -> float:
    """Return k_n [1/kg]."""
    point, normal = contact_geometry(a, b)
    total = inverse_mass(a) + inverse_mass(b)
    for one in (a, b):
        lever = np.cross(point - vector(one.position), normal)
        total += float(lever @ inverse_inertia(one) @ lever)
    return total


def newton_impulse(cell: CellConfig, a: CellBody, b: CellBody) -> float:
    """Return Newton's impulse j [N s]; exactly 0 for a pair that separates."""
    k_n = inverse_effective_mass(cell, a, b)
    before = normal_velocity(a, b)
    return max(0.0, -(1.0 + pair_restitution(a, b, -before)) * before / k_n)


def newton_separation_velocity(cell: CellConfig, a: CellBody, b: CellBody) -> float:
    """Return v_n [m/s] after the impact: -e v_n, or v_n itself for a pair that separates."""
    before = normal_velocity(a, b)
    return -pair_restitution(a, b, -before) * before if before < 0.0 else before


def impact_speed(cell: CellConfig, moving: CellBody, plane: CellBody) -> float:
    """Return the speed [m/s] of a body dropped from rest when it reaches the plane.

    NaN where it starts in the plane, or gravity pulls it away.
    """
    pull, height = _pull(cell, plane), clearance(moving, plane)
    return math.sqrt(2.0 * pull * height) if pull >= 0.0 and height >= 0.0 else math.nan


def drop_impulse(cell: CellConfig, moving: CellBody, plane: CellBody) -> float:
    """Return the impulse [N s] that turns the impact speed v into e v."""
    speed = impact_speed(cell, moving, plane)
    return (1.0 + pair_restitution(moving, plane, speed)) * mass_of(moving) * speed


def rebound_height(cell: CellConfig, moving: CellBody, plane: CellBody) -> float:
    """Return e^2 h [m], e that of the approach speed."""
    return bounce_height(cell, moving, plane, 1)


def bounce_height(cell: CellConfig, moving: CellBody, plane: CellBody, bounce: int) -> float:
    """Return the clearance [m] of a dropped body after its bounce of this number, 1 the first."""
    pair, height = mixed(moving.surface, plane.surface), clearance(moving, plane)
    if pair.yield_speed == 0.0:
        return float(pair.restitution ** (2 * bounce) * height)
    speed = impact_speed(cell, moving, plane)
    for _ in range(bounce):
        e = pair_restitution(moving, plane, speed)
        speed, height = e * speed, e * e * height
    return height


def release_height(cell: CellConfig, moving: CellBody, plane: CellBody) -> float:
    """Return the clearance h [m] a body starts from."""
    return clearance(moving, plane)


def weight(cell: CellConfig, *bodies: CellBody) -> float:
    """Return the summed weight [N] of the bodies."""
    pull = vector(cell.scene.gravity)
    return math.sqrt(float(pull @ pull)) * sum(mass_of(one) for one in bodies)


def slop(cell: CellConfig) -> float:
    """Return the penetration [m] that is left alone."""
    return cell.numerics.slop


def steady_penetration_above_slop(cell: CellConfig, moving: CellBody, plane: CellBody) -> float:
    """Return d - slop [m] at rest on a compliant contact; NaN where gravity pulls away from it."""
    left = 1.0 - cell.numerics.projection
    load = mass_of(moving) * _pull(cell, plane)
    if not load >= 0.0:
        return math.nan
    between = mixed(moving.surface, plane.surface)
    if between.hertz_stiffness > 0.0:
        return float((load / between.hertz_stiffness) ** (2.0 / 3.0) - cell.numerics.slop)
    indentation = between.compliance * load
    if cell.numerics.compliance_law == "spring" and cell.numerics.stabilisation_gain == 0.0:
        return float(indentation) - cell.numerics.slop
    back = 1.0 - left * (1.0 - cell.numerics.stabilisation_gain)
    return float(left * indentation / back) if back > 0.0 else math.nan  # nothing lifts it


def pair_restitution(a: CellBody, b: CellBody, speed: float) -> float:
    """Return e of a contact between two bodies that approach each other with a speed [m/s]."""
    pair = mixed(a.surface, b.surface)
    if 0.0 < pair.yield_speed < speed:
        return float(pair.restitution * (pair.yield_speed / speed) ** 0.25)
    return float(pair.restitution)


def _pull(cell: CellConfig, plane: CellBody) -> float:
    return -float(half_space(plane.shape).normal @ vector(cell.scene.gravity))


FORMS: Final[dict[str, Callable[..., float]]] = {
    "newton_impulse": newton_impulse,
    "newton_separation_velocity": newton_separation_velocity,
    "inverse_effective_mass": inverse_effective_mass,
    "impact_speed": impact_speed,
    "drop_impulse": drop_impulse,
    "rebound_height": rebound_height,
    "release_height": release_height,
    "weight": weight,
    "slop": slop,
    "steady_penetration_above_slop": steady_penetration_above_slop,
}
