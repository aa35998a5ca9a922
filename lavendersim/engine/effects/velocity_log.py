"""Velocity log: `/velocities`, how fast every body moves and turns, beside each pose of `/tf`.

The row of a pose goes on with them: x y z qw qx qy qz vx vy vz wx wy wz, in world axes.
"""

from ..spec import Spec
from ..step_terms import step_terms
from .decision import Decision, Facts
from .effect import Effect, Hooks, Kernel, kernel


def decide(facts: Facts) -> Decision:
    """On when the run is logged, velocities with it."""
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    if facts.velocities:
        return Decision(True, "record.velocities is true")
    return Decision(False, "record.velocities is false")


def make(spec: Spec) -> Kernel:
    """Return `kernel(v, row)`; row: (13,), of which the last six are written; no spin reads 0."""
    turns = step_terms(spec).turns

    def log_velocity(v, row):
        row[7], row[8], row[9] = v.vx, v.vy, v.vz
        if turns:
            row[10], row[11], row[12] = v.wx, v.wy, v.wz

    return kernel(log_velocity, spec)


EFFECT = Effect(
    name="velocity_log",
    decide=decide,
    per="body",
    needs=("pose_log",),
    channels=("/velocities",),
    hooks=Hooks(log_velocity=make),
)
