"""Distance of one free or colliding body from closed forms of rigid motion."""

from __future__ import annotations

import math

import numpy as np

from lavendersim.cell import CellBody
from lavendersim.geometry.bodies import (
    is_movable,
    mass_of,
    principal_inertia,
    rotation_of,
    vector,
)
from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.geometry.shapes import bounding_radius
from lavendersim.measures.columns import angular_momentum, momentum, one_timestep
from lavendersim.measures.free_rotation import FreeRotation, free_rotation
from lavendersim.measures.impact_forms import velocities_after
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import spinning as specs

NAN = float("nan")


@measure(specs.VelocityError)
def velocity_error(spec: specs.VelocityError, trace: Trace) -> float:
    """Return the larger of |v - v*| and rho |omega - omega*| [m/s] at the end of the run.

    v and omega follow from the logged momenta and pose. NaN where another body can move, or the
    impact has no closed form.
    """
    moving = trace.config.scene.bodies[spec.body]
    time = float(times(trace)[-1])
    ideal = velocities_after(trace.config, spec.body, spec.other, time)
    if ideal is None or not _alone(trace, moving):
        return NAN
    turn = rotation_matrices(_pose(trace, spec.body)[-1:, 3:])[0]
    omega = body_rates(trace, spec.body)[-1] @ turn.T
    return max(
        math.dist(momentum(trace)[-1] / mass_of(moving), ideal.velocity),
        bounding_radius(moving.shape) * math.dist(omega, ideal.angular_velocity),
    )


@measure(specs.AngularVelocityError)
def angular_velocity_error(spec: specs.AngularVelocityError, trace: Trace) -> float:
    """Return the largest |omega - omega*| / |omega(0)|, in body axes, over the run or until a time.

    NaN where another body can move or the body does not turn.
    """
    moving = trace.config.scene.bodies[spec.body]
    if not _alone(trace, moving) or not any(moving.angular_velocity):
        return NAN
    time = times(trace)
    rows = time <= (spec.until if spec.until is not None else math.inf)
    exact = exact_rotation(moving).angular_velocity(time[rows])
    omega = vector(moving.angular_velocity)
    # both in a power of two of their size: squares of a spin of 1e200 rad/s are no numbers
    size = -math.frexp(float(np.max(np.abs(omega))))[1]
    omega = np.ldexp(omega, size)
    gaps = np.ldexp(body_rates(trace, spec.body)[rows] - exact, size)
    first = math.sqrt(float(omega @ omega))
    return float(np.sqrt((gaps**2).sum(axis=1)).max()) / first


@measure(specs.FlipTimeError)
def flip_time_error(spec: specs.FlipTimeError, trace: Trace) -> float:
    """Return the largest |t - t*| [s] of the first flips; NaN if the run has fewer.

    Between two samples of opposite sign the middle component of omega is the cubic through them and
    their neighbours, whose root is found by bisection. UsageError where the timestep changes.
    """
    moving = trace.config.scene.bodies[spec.body]
    if not _alone(trace, moving) or not any(moving.angular_velocity):
        return NAN
    exact = exact_rotation(moving)
    rate = body_rates(trace, spec.body)[:, exact.middle_axis]
    ideal = exact.flip_times(spec.flips)
    length = one_timestep(trace, 0, len(rate) - 1, "flip_time_error")
    found = crossings(rate)[: spec.flips] * length
    if len(found) < spec.flips or len(ideal) < spec.flips:
        return NAN
    return float(np.max(np.abs(found - ideal)))


def crossings(values: Floats) -> Floats:
    """Return where samples change their sign, in samples, by the cubic through four of them."""
    places = []
    for k in np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1])):
        first = min(max(int(k) - 1, 0), len(values) - 4)
        cubic = np.polyfit(np.arange(4.0), values[first : first + 4], 3)
        low, high = float(k - first), float(k - first + 1)
        rising = values[k + 1] > values[k]
        while True:
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            if (np.polyval(cubic, middle) > 0.0) == rising:
                high = middle
            else:
                low = middle
        places.append(first + low)
    return np.array(places)


def exact_rotation(moving: CellBody) -> FreeRotation:
    """Return Jacobi's solution that starts as the config says."""
    omega = rotation_of(moving).T @ vector(moving.angular_velocity)
    return free_rotation(principal_inertia(moving), omega)


def times(trace: Trace) -> Floats:
    """Return the time [s] of every state, counted in steps (logged times are whole nanoseconds)."""
    return trace.clock.elapsed(trace.step["step"][0], trace.step["step"])


def body_rates(trace: Trace, body: str) -> Floats:
    """Return omega in a body's own axes [rad/s] (n, 3), from angular momentum and pose."""
    pose = _pose(trace, body)
    spin = angular_momentum(trace) - np.cross(pose[:, :3], momentum(trace))
    rates: Floats = np.einsum("nji,nj->ni", rotation_matrices(pose[:, 3:]), spin)
    return rates / principal_inertia(trace.config.scene.bodies[body])


def _pose(trace: Trace, body: str) -> Floats:
    pose: Floats = trace.pose[:, list(trace.bodies).index(body)]
    return pose


def _alone(trace: Trace, moving: CellBody) -> bool:
    bodies = trace.config.scene.bodies.values()
    return is_movable(moving) and sum(map(is_movable, bodies)) == 1
