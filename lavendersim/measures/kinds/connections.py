"""Tension of a rope, force and torque of a joint."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

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
    return _load(spec, trace, _forces)


@measure(specs.JointTorque)
def joint_torque(spec: specs.JointTorque, trace: Trace) -> float:
    """Return the magnitude [N m] of the mean torque of the last window, or the largest of a step.

    NaN for a run shorter than the window, and of a joint between bodies that do not move.
    """
    return _load(spec, trace, _torques)


Vectors = npt.NDArray[np.float64]


def _load(
    spec: specs.JointForce | specs.JointTorque, trace: Trace, of_rows: Callable[[Any], Vectors]
) -> float:
    joints = list(holding(trace.config.scene))
    window = last_window(trace, spec.last)
    if spec.connection not in joints or not window.any():
        return float("nan")
    rows = trace.contact
    own = rows[rows["joint"] == 1 + joints.index(spec.connection)]
    steps, along = rows_of_steps(trace.step, own), of_rows(own)
    loads = np.column_stack([np.bincount(steps, one, len(trace.step)) for one in along.T])[window]
    if spec.statistic == "mean":
        return float(np.linalg.norm(loads.mean(axis=0)))
    return float(np.linalg.norm(loads, axis=1).max())


def _forces(rows: Any) -> Vectors:
    return np.asarray(rows["force_n"][:, None] * np.column_stack([rows[f"n{k}"] for k in "xyz"]))


def _torques(rows: Any) -> Vectors:
    """Return the torque of each row about the first of its step, which is where the joint is.

    That of a motor that turns is a couple.
    """
    _, first, own = np.unique(rows["step"], return_index=True, return_inverse=True)
    places = np.column_stack([rows[axis] for axis in "xyz"])
    torques: Vectors = np.cross(places - places[first][own], _forces(rows))
    if "twist_x" not in (rows.dtype.names or ()):
        return torques
    # Impulses and forces of a row have one ratio, the timestep.
    twists = np.column_stack([rows[f"twist_{axis}"] for axis in "xyz"])
    pushed = rows["impulse_n"] != 0.0
    rates = np.divide(rows["force_n"], rows["impulse_n"], out=np.zeros(len(rows)), where=pushed)
    couples: Vectors = rates[:, None] * twists
    return torques + couples
