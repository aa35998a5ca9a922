"""Velocities by which bodies stand at the middle of the step, of several passes together.

A pass takes velocities to those that its rows lead to. By themselves passes gain a constant factor
each: a tenth where a ball rolls off another, a half or nothing at all where a disc turns by as much
as its contact is wide. From the third middle on it is that of the passes before, by Anderson's
acceleration (`anderson`). Spins count times the size of their body.
"""

from __future__ import annotations

from typing import Any

from .anderson import NO_ROUND, make_bring_on
from .compile import kernel
from .records import PLANE
from .spec import Spec
from .step_terms import step_terms

# Columns before the first pass, which has no middle behind it.
NO_PASS = NO_ROUND - 1
# Numbers of a body: its velocity, and its spin where bodies turn.
WORDS = 6


def make_mix_velocities(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, rounds, columns) -> columns`, before each pass.

    rounds: their fixed point; columns: NO_PASS before the first. velocities: those of the
    last solve, and then those of the next middle.
    """
    turns, bring_on = step_terms(spec).turns, make_bring_on(spec)

    def mix_velocities(bodies, velocities, rounds, columns):
        point, defect = rounds.point, rounds.defect
        moving = bodies.shape[0]
        for i in range(moving):
            v, at = velocities[i], WORDS * i
            defect[at], defect[at + 1], defect[at + 2] = v.vx, v.vy, v.vz
            if turns:
                size = 1.0 if bodies[i].shape == PLANE else bodies[i].bound
                defect[at + 3], defect[at + 4] = size * v.wx, size * v.wy
                defect[at + 5] = size * v.wz
        numbers = WORDS * moving
        if columns == NO_PASS:
            for k in range(numbers):
                point[k] = defect[k]
            return NO_ROUND
        for k in range(numbers):
            defect[k] -= point[k]
        columns = bring_on(rounds, numbers, columns)
        if columns > 0:
            for i in range(moving):
                v, at = velocities[i], WORDS * i
                v.vx, v.vy, v.vz = point[at], point[at + 1], point[at + 2]
                if turns:
                    size = 1.0 if bodies[i].shape == PLANE else bodies[i].bound
                    v.wx, v.wy = point[at + 3] / size, point[at + 4] / size
                    v.wz = point[at + 5] / size
        return columns

    return kernel(mix_velocities, spec)
