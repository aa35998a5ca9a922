"""Steady force, torque, penetration and settling time of a body that comes to rest."""

from __future__ import annotations

import numpy as np

from lavendersim.geometry.periodic_cell import nearest_images
from lavendersim.measures.columns import (
    contacts_of,
    deepest_by_step,
    impulses,
    last_window,
    rows_of_steps,
    summed_by_step,
)
from lavendersim.measures.interfaces import Floats, Rows, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import steady as specs

NAN = float("nan")


@measure(specs.SteadyForce)
def steady_force(spec: specs.SteadyForce, trace: Trace) -> float:
    """Return the mean normal force [N] of the last window, or its value furthest from the mean."""
    rows = contacts_of(trace, spec.body, spec.other)
    forces = summed_by_step(trace, rows, "force_n")[last_window(trace, spec.last)]
    if len(forces) == 0 or len(rows) == 0:
        return NAN
    mean = float(forces.mean())
    if spec.statistic == "mean":
        return mean
    return float(forces[np.argmax(np.abs(forces - mean))])


@measure(specs.SteadyTorque)
def steady_torque(spec: specs.SteadyTorque, trace: Trace) -> float:
    """Return the mean torque [N m] of the last window along an axis; NaN without contact.

    r x p + c of each contact, r from the centre as the step ends to the point, p and c its impulse
    and angular impulse on the body.
    """
    rows, window = contacts_of(trace, spec.body, spec.other), last_window(trace, spec.last)
    if not window.any() or len(rows) == 0:
        return NAN
    index, steps = list(trace.bodies).index(spec.body), rows_of_steps(trace.step, rows)
    points = np.column_stack([rows[axis] for axis in "xyz"])
    centres = trace.pose[steps, index, :3]
    levers = points - nearest_images(centres, points, trace.config.scene.periodic)
    turned = np.cross(levers, impulses(rows)) + _angular_impulses(rows)
    along = np.asarray(spec.along) / np.linalg.norm(spec.along)
    on_body = np.where(rows["body_b"] == index, 1.0, -1.0) * (turned @ along)
    by_step = np.bincount(steps, on_body, len(trace.step))
    time = trace.clock.lengths(trace.step["step"][window]).sum()
    return float(by_step[window].sum() / time)


def _angular_impulses(rows: Rows) -> Floats:
    """Return the angular impulse on B of each contact [N m s] (n, 3); 0 without columns of one."""
    names = set(rows.dtype.names or ())
    normals = np.column_stack([rows[f"n{axis}"] for axis in "xyz"])
    total: Floats = np.zeros_like(normals)
    for about_normal in ("angular_impulse_n", "patch_impulse_n"):
        if about_normal in names:
            total += normals * rows[about_normal][:, None]
    if "angular_impulse_t1" in names:
        first = np.column_stack([rows[f"t1{axis}"] for axis in "xyz"])
        total += first * rows["angular_impulse_t1"][:, None]
        total += np.cross(normals, first) * rows["angular_impulse_t2"][:, None]
    return total


@measure(specs.SteadyPenetration)
def steady_penetration(spec: specs.SteadyPenetration, trace: Trace) -> float:
    """Return the mean of the deepest penetration [m] in the last window; NaN without contact."""
    rows = contacts_of(trace, spec.body, spec.other)
    depths = deepest_by_step(trace, rows)[last_window(trace, spec.last)]
    if len(depths) == 0 or len(rows) == 0:
        return NAN
    above = trace.config.numerics.slop if spec.above_slop else 0.0
    return float(depths.mean()) - above


@measure(specs.MaxPenetration)
def max_penetration(spec: specs.MaxPenetration, trace: Trace) -> float:
    """Return the deepest penetration [m] of the whole run; NaN if nothing touches the body."""
    rows = contacts_of(trace, spec.body, spec.other)
    return float(rows["penetration"].max()) if len(rows) else NAN


@measure(specs.SettlingTime)
def settling_time(spec: specs.SettlingTime, trace: Trace) -> float:
    """Return the time [s] from first contact until the penetration stays below the threshold.

    NaN if nothing touches the body, or the penetration is still above at the end.
    """
    rows = contacts_of(trace, spec.body, spec.other)
    if len(rows) == 0:
        return NAN
    time = trace.step["time"]
    above = np.flatnonzero(deepest_by_step(trace, rows) > spec.threshold)
    if len(above) == 0:
        return 0.0
    if above[-1] + 1 == len(time):
        return NAN
    touch = np.searchsorted(trace.step["step"], rows["step"][0])
    return float(time[above[-1] + 1] - time[touch])


@measure(specs.SimulatedDuration)
def simulated_duration(spec: specs.SimulatedDuration, trace: Trace) -> float:
    """Return the simulated time [s] of the last logged step."""
    return float(trace.step["time"][-1])
