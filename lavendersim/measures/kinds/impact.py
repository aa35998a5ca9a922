"""Rebound, impulses, forces and velocities of an impact, from the log of a drop or collision.

NaN means "this log cannot answer": nothing touched, or the run ended too early.
"""

from __future__ import annotations

import math

import numpy as np

from lavendersim.cell import changes_of_bodies
from lavendersim.geometry.bodies import is_movable, mass_of
from lavendersim.measures.changes import constant_gravity
from lavendersim.measures.columns import (
    clearance_by_step,
    contacts_of,
    momentum,
    one_timestep,
    pushing_runs,
    runs_of,
    summed_by_step,
)
from lavendersim.measures.interfaces import Floats, Rows, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import impact as specs

NAN = float("nan")


def parabola_vertex(before: float, at: float, after: float) -> float:
    """Return the height of the vertex of the parabola through three equally spaced samples."""
    curvature = before - 2.0 * at + after
    if curvature == 0.0:
        return at
    return at - (before - after) ** 2 / (8.0 * curvature)


@measure(specs.FirstApex)
def first_apex(spec: specs.FirstApex, trace: Trace) -> float:
    """Return the clearance [m] at the first apex after the first contact.

    The apex is the vertex of the parabola through the highest sample and its neighbours: free
    flight with a constant step is exactly such a parabola, so the apex does not depend on where
    the samples fall. A body that stays on the surface rebounds 0 m; NaN if it never touches, or
    is still rising at the end. UsageError where the timestep changes among the three samples.
    """
    runs = pushing_runs(trace, contacts_of(trace, spec.body, spec.above))
    if not runs:
        return NAN
    begin = runs[0][0]
    heights = clearance_by_step(trace, spec.body, spec.above)[begin:]
    inner = heights[1:-1]
    (peaks,) = ((inner > 0.0) & (inner >= heights[:-2]) & (inner > heights[2:])).nonzero()
    if len(peaks):
        one_timestep(trace, begin + int(peaks[0]), begin + int(peaks[0]) + 2, "first_apex")
        return parabola_vertex(*(float(height) for height in heights[peaks[0] : peaks[0] + 3]))
    return 0.0 if heights[-1] <= 0.0 else NAN


@measure(specs.ImpactImpulse)
def impact_impulse(spec: specs.ImpactImpulse, trace: Trace) -> float:
    """Return the impulse [N s] of the first run of pushing steps; 0 if the contact never pushes."""
    rows = contacts_of(trace, spec.body, spec.other)
    if len(rows) == 0:
        return NAN
    runs = pushing_runs(trace, rows)
    if not runs:
        return float(np.sum(rows["impulse_n"]))
    first, last = runs[0]
    return float(summed_by_step(trace, rows, "impulse_n")[first : last + 1].sum())


@measure(specs.StepImpulse)
def step_impulse(spec: specs.StepImpulse, trace: Trace) -> float:
    """Return the impulse [N s] of one step; NaN if the step was not logged."""
    positions = np.flatnonzero(trace.step["step"] == spec.step)
    if len(positions) == 0:
        return NAN
    rows = contacts_of(trace, spec.body, spec.other)
    return float(summed_by_step(trace, rows, "impulse_n")[positions[0]])


def _of_first_contact(rows: Rows, field: str) -> float:
    return float(rows[field][0]) if len(rows) else NAN


@measure(specs.ApproachVelocity)
def approach_velocity(spec: specs.ApproachVelocity, trace: Trace) -> float:
    """Return v_n [m/s] of the first contact before the solve."""
    return _of_first_contact(contacts_of(trace, spec.body, spec.other), "approach_velocity")


@measure(specs.SeparationVelocity)
def separation_velocity(spec: specs.SeparationVelocity, trace: Trace) -> float:
    """Return v_n [m/s] of the first contact after the solve."""
    return _of_first_contact(contacts_of(trace, spec.body, spec.other), "normal_velocity")


@measure(specs.InverseEffectiveMass)
def inverse_effective_mass(spec: specs.InverseEffectiveMass, trace: Trace) -> float:
    """Return k_n [1/kg] of the first contact."""
    return _of_first_contact(contacts_of(trace, spec.body, spec.other), "inverse_effective_mass")


@measure(specs.PeakForce)
def peak_force(spec: specs.PeakForce, trace: Trace) -> float:
    """Return the largest normal force [N] on the body; NaN if nothing ever touches it."""
    rows = contacts_of(trace, spec.body, spec.other)
    return float(summed_by_step(trace, rows, "force_n").max()) if len(rows) else NAN


@measure(specs.StepsAboveForce)
def steps_above_force(spec: specs.StepsAboveForce, trace: Trace) -> float:
    """Return how many steps have more normal force on the body than the threshold."""
    rows = contacts_of(trace, spec.body, spec.other)
    if len(rows) == 0:
        return NAN
    return float(np.count_nonzero(summed_by_step(trace, rows, "force_n") > spec.threshold))


@measure(specs.ImpulseBalance)
def impulse_balance(spec: specs.ImpulseBalance, trace: Trace) -> float:
    """Return |J + M g T - (p1 - p0)| / |J| over a window of steps.

    J is the vector sum of the impulses between movable and fixed bodies (impulses between two
    movable bodies cancel), M the movable mass, p the logged momentum. NaN without any impulse,
    and where an event changes a mass or removes one.
    """
    events = changes_of_bodies(trace.events)
    bodies = trace.config.scene.bodies
    gone = [bodies[event.body] for event in events if event.remove]
    if any(event.scale_mass is not None for event in events) or any(map(is_movable, gone)):
        return NAN
    movable = np.array([is_movable(bodies[name]) for name in trace.bodies])
    rows = trace.contact
    outer = rows[movable[rows["body_a"]] != movable[rows["body_b"]]]
    first, last = 1, len(trace.step) - 1
    if spec.window == "first_impact":
        pushes = runs_of(summed_by_step(trace, outer, "impulse_n") > 0.0)
        if not pushes:
            return NAN
        first, last = pushes[0]
    impulse = _vector_impulse(trace, outer, movable, first, last)
    size = math.sqrt(float(impulse @ impulse))
    if size == 0.0:
        return NAN
    mass = sum(mass_of(one) for one in bodies.values())
    momenta = momentum(trace)
    # counted in steps: logged times are whole nanoseconds, 1e-7 of a step
    steps = trace.step["step"]
    time = float(trace.clock.elapsed(steps[first - 1], steps[last]))
    gained = momenta[last] - momenta[first - 1]
    gap = impulse + mass * time * constant_gravity(trace, "impulse_balance") - gained
    return math.sqrt(float(gap @ gap)) / size


@measure(specs.MomentumDrift)
def momentum_drift(spec: specs.MomentumDrift, trace: Trace) -> float:
    """Return the largest |p - p0| over the largest |p| of the run; NaN if nothing ever moves."""
    momenta = momentum(trace)
    largest = float(np.sqrt((momenta**2).sum(axis=1)).max())
    change = momenta - momenta[0]
    return float(np.sqrt((change**2).sum(axis=1)).max()) / largest if largest > 0.0 else NAN


def _vector_impulse(trace: Trace, rows: Rows, movable: np.ndarray, first: int, last: int) -> Floats:
    """Sum of the impulses on the movable side; impulse_n acts along n on B, against n on A."""
    steps = trace.step["step"]
    inside = rows[(rows["step"] >= steps[first]) & (rows["step"] <= steps[last])]
    signed = np.where(movable[inside["body_b"]], 1.0, -1.0) * inside["impulse_n"]
    return np.array([float((signed * inside[field]).sum()) for field in ("nx", "ny", "nz")])
