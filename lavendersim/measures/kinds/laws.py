"""Balance and conservation of a log, the laws of its contacts, and steps that did not converge."""

from __future__ import annotations

import math

import numpy as np

from lavendersim.geometry.bodies import is_movable, mass_of
from lavendersim.measures import changes
from lavendersim.measures.columns import (
    angular_momentum,
    clearance_by_step,
    contact_parts,
    energy_at_rest,
    impulses,
    last_window,
    mechanical_energy,
    rows_of_steps,
    step_column,
)
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import laws as specs

NAN = float("nan")


@measure(specs.ForceError)
def force_error(spec: specs.ForceError, trace: Trace) -> float:
    """Return the largest |F/(m g) - 1| of any step in the last window, F against gravity.

    Of one body all contacts count, and m is its mass as configured; of the scene those between
    movable and fixed bodies, since the others cancel, and m is what can move in that step. NaN
    without gravity or a movable body, and for a run shorter than the window; UsageError where
    an event changes gravity within it.
    """
    bodies = trace.config.scene.bodies
    names = [spec.body] if spec.body else [name for name, one in bodies.items() if is_movable(one)]
    carried = np.array([name in names for name in trace.bodies])
    rows = np.flatnonzero(last_window(trace, spec.last))
    if len(rows) == 0:
        return NAN
    gravity = changes.constant_gravity(trace, "force_error", int(rows[0]))
    pull = math.sqrt(float(gravity @ gravity))
    masses = changes.masses(trace)[rows]
    weight = pull * (np.full(len(rows), mass_of(bodies[spec.body])) if spec.body else masses)
    if not np.all(weight > 0.0):
        return NAN
    forces = np.zeros(len(trace.step))
    for contacts in contact_parts(trace):
        late = contacts[np.searchsorted(contacts["step"], trace.step["step"][rows[0]]) :]
        outer = late[carried[late["body_a"]] != carried[late["body_b"]]]
        sign = np.where(carried[outer["body_b"]], 1.0, -1.0)
        lift = sign * (impulses(outer) @ (-gravity / pull)) / trace.clock.lengths(outer["step"])
        np.add.at(forces, rows_of_steps(trace.step, outer), lift)
    return float(np.max(np.abs(forces[rows] / weight - 1.0)))


@measure(specs.EnergyDrift)
def energy_drift(spec: specs.EnergyDrift, trace: Trace) -> float:
    """Return the largest |E/E0 - 1| over the run; NaN for a run that starts without energy."""
    change = _energy_change(spec, trace)
    return float(np.max(np.abs(change)))


@measure(specs.EnergyGain)
def energy_gain(spec: specs.EnergyGain, trace: Trace) -> float:
    """Return the largest E/E0 - 1 over the run; NaN for a run that starts without energy."""
    return float(np.max(_energy_change(spec, trace)))


def _energy_change(spec: specs.EnergyDrift | specs.EnergyGain, trace: Trace) -> Floats:
    energy = mechanical_energy(trace)
    if spec.body is not None and spec.above is not None:
        height = float(clearance_by_step(trace, spec.body, spec.above)[0])
        energy = energy - energy_at_rest(trace, spec.body, spec.above, height)
    return energy / energy[0] - 1.0 if energy[0] != 0.0 else np.array([NAN])


@measure(specs.AngularMomentumDrift)
def angular_momentum_drift(spec: specs.AngularMomentumDrift, trace: Trace) -> float:
    """Return the largest |L - L0| / |L0| over the run; NaN for a scene that does not turn."""
    momentum = angular_momentum(trace)
    size = math.sqrt(float(momentum[0] @ momentum[0]))
    change = momentum - momentum[0]
    return float(np.sqrt((change**2).sum(axis=1)).max()) / size if size > 0.0 else NAN


@measure(specs.LawViolation)
def law_violation(spec: specs.LawViolation, trace: Trace) -> float:
    """Return the largest violation in any step; NaN without a step after the time.

    Also where the log does without it: nothing could touch, or nothing has friction.
    """
    column = step_column(trace, "residual" if spec.part == "natural_map" else spec.part)
    late = trace.step["time"] > spec.after
    if column is None or not late.any():
        return NAN
    return float(np.max(column[late]))


@measure(specs.NotConvergedSteps)
def not_converged_steps(spec: specs.NotConvergedSteps, trace: Trace) -> float:
    """Return how many steps ended above the tolerance asked for; NaN where none was asked for."""
    column = step_column(trace, "not_converged")
    return NAN if column is None else float(np.count_nonzero(column))
