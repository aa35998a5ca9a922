"""Tension of a rope, force of a joint."""

from __future__ import annotations

import numpy as np

from lavendersim.engine.effects import holding, pulling
from lavendersim.measures.columns import last_window, rows_of_steps, summed_by_step
from lavendersim.measures.interfaces import Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import connections as specs


@measure(specs.Tension)
def tension(spec: specs.Tension, trace: Trace) -> float:
    """Return the mean tension [N] of the last window, or its largest.

    NaN for a run shorter than the window, and of a rope between bodies that do not move.
    """
    ropes = list(pulling(trace.config.scene))
    window = last_window(trace, spec.last)
    if spec.connection not in ropes or not window.any():
        return float("nan")
    rows = trace.contact
    own = rows[rows["rope"] == 1 + ropes.index(spec.connection)]
    forces = summed_by_step(trace, own, "force_n")[window]
    return float(forces.mean() if spec.statistic == "mean" else forces.max())


@measure(specs.JointForce)
def joint_force(spec: specs.JointForce, trace: Trace) -> float:
    """Return the magnitude [N] of the mean force of the last window, or the largest of a step.

    NaN for a run shorter than the window, and of a joint between bodies that do not move.
    """
    joints = list(holding(trace.config.scene))
    window = last_window(trace, spec.last)
    if spec.connection not in joints or not window.any():
        return float("nan")
    rows = trace.contact
    own = rows[rows["joint"] == 1 + joints.index(spec.connection)]
    along = own["force_n"][:, None] * np.column_stack([own["nx"], own["ny"], own["nz"]])
    steps = rows_of_steps(trace.step, own)
    forces = np.column_stack([np.bincount(steps, one, len(trace.step)) for one in along.T])[window]
    if spec.statistic == "mean":
        return float(np.linalg.norm(forces.mean(axis=0)))
    return float(np.linalg.norm(forces, axis=1).max())
