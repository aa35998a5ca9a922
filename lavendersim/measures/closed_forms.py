"""The resolved config of a cell and a formula's name in; the number the formula gives out.

Nothing recorded by a run is read here, so a closed form is an independent judge.

Impact of A and B at the configured pose, n from A to B, v_n their normal velocity (chapter):
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
from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from lavendersim.measures.cell_config import BodyConfig, body, gravity, numerics
from lavendersim.measures.specs.base import ClosedForm
from lavendersim.measures.views import Floats

Resolved = Mapping[str, Any]


def evaluate_form(form: ClosedForm, resolved: Resolved) -> float:
    """Return the closed form's value in the cell of this resolved config, SI units."""
    bodies = tuple(body(resolved, name) for name in form.bodies)
    return FORMS[form.form](resolved, *bodies)


def clearance(moving: BodyConfig, plane: BodyConfig) -> float:
    """Return the gap [m] between a body's surface and a plane at the configured pose."""
    normal = plane.normal
    return float(normal @ moving.position) - plane.offset - moving.extent(normal)


def contact_geometry(a: BodyConfig, b: BodyConfig) -> tuple[Floats, Floats]:
    """Return the contact point [m] on A's side and the unit normal from A to B."""
    kinds = (a.shape["kind"], b.shape["kind"])
    if kinds[0] == "plane":
        normal = a.normal
        return b.lowest(normal), normal
    if kinds == ("sphere", "sphere"):
        normal = b.position - a.position
        normal = normal / math.sqrt(float(normal @ normal))
        return a.position + a.extent(normal) * normal, normal
    if kinds == ("box", "sphere"):
        return _box_sphere(a, b)
    if kinds[1] == "plane" or kinds == ("sphere", "box"):
        point, normal = contact_geometry(b, a)
        return point, -normal
    raise ValueError(f"no closed contact geometry for {kinds[0]} and {kinds[1]}")


def _box_sphere(box: BodyConfig, sphere: BodyConfig) -> tuple[Floats, Floats]:
    half = 0.5 * np.asarray(box.shape["size"], dtype=float)
    local = box.rotation.T @ (sphere.position - box.position)
    nearest = np.clip(local, -half, half)
    apart = box.rotation @ (local - nearest)
    distance = math.sqrt(float(apart @ apart))
    if distance == 0.0:
        raise ValueError("the sphere's centre lies inside the box: no closed contact geometry")
    return box.position + box.rotation @ nearest, apart / distance


def normal_velocity(a: BodyConfig, b: BodyConfig) -> float:
    """Return v_n [m/s] of B relative to A at the configured contact."""
    point, normal = contact_geometry(a, b)
    velocity_a = a.velocity + np.cross(a.angular_velocity, point - a.position)
    velocity_b = b.velocity + np.cross(b.angular_velocity, point - b.position)
    return float(normal @ (velocity_b - velocity_a))


def inverse_effective_mass(resolved: Resolved, a: BodyConfig, b: BodyConfig) -> float:
    """Return k_n [1/kg]."""
    point, normal = contact_geometry(a, b)
    total = a.inverse_mass + b.inverse_mass
    for one in (a, b):
        lever = np.cross(point - one.position, normal)
        total += float(lever @ one.inverse_inertia @ lever)
    return total


def newton_impulse(resolved: Resolved, a: BodyConfig, b: BodyConfig) -> float:
    """Return Newton's impulse j [N s]; exactly 0 for a pair that separates."""
    k_n = inverse_effective_mass(resolved, a, b)
    return max(0.0, -(1.0 + pair_restitution(a, b)) * normal_velocity(a, b) / k_n)


def newton_separation_velocity(resolved: Resolved, a: BodyConfig, b: BodyConfig) -> float:
    """Return v_n [m/s] after the impact: -e v_n, or v_n itself for a pair that separates."""
    before = normal_velocity(a, b)
    return -pair_restitution(a, b) * before if before < 0.0 else before


def impact_speed(resolved: Resolved, moving: BodyConfig, plane: BodyConfig) -> float:
    """Return the speed [m/s] of a body dropped from rest when it reaches the plane."""
    return math.sqrt(2.0 * _pull(resolved, plane) * clearance(moving, plane))


def drop_impulse(resolved: Resolved, moving: BodyConfig, plane: BodyConfig) -> float:
    """Return the impulse [N s] that turns the impact speed v into e v."""
    speed = impact_speed(resolved, moving, plane)
    return (1.0 + pair_restitution(moving, plane)) * moving.mass * speed


def rebound_height(resolved: Resolved, moving: BodyConfig, plane: BodyConfig) -> float:
    """Return e^2 h [m]."""
    return pair_restitution(moving, plane) ** 2 * clearance(moving, plane)


def release_height(resolved: Resolved, moving: BodyConfig, plane: BodyConfig) -> float:
    """Return the clearance h [m] a body starts from."""
    return clearance(moving, plane)


def weight(resolved: Resolved, *bodies: BodyConfig) -> float:
    """Return the summed weight [N] of the bodies."""
    pull = gravity(resolved)
    return math.sqrt(float(pull @ pull)) * sum(one.mass for one in bodies)


def slop(resolved: Resolved) -> float:
    """Return the penetration [m] that is left alone."""
    return numerics(resolved, "slop")


def steady_penetration_above_slop(
    resolved: Resolved, moving: BodyConfig, plane: BodyConfig
) -> float:
    """Return d - slop [m] at rest, see the module's derivation."""
    left = 1.0 - numerics(resolved, "projection")
    load = moving.mass * _pull(resolved, plane)
    indentation = (moving.compliance + plane.compliance) * load
    return left * indentation / (1.0 - left * (1.0 - numerics(resolved, "stabilisation_gain")))


def pair_restitution(a: BodyConfig, b: BodyConfig) -> float:
    """Return e of two surfaces: the livelier one decides."""
    return max(a.restitution, b.restitution)


def _pull(resolved: Resolved, plane: BodyConfig) -> float:
    return -float(plane.normal @ gravity(resolved))


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
