"""Pose log: `/tf`, where every body is after every step, and `/robot_description` to draw it by."""

from ..step_terms import step_terms
from .decision import Decision, Facts
from .effect import Effect, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the run is logged."""
    if facts.record:
        return Decision(True, "the run is logged")
    return Decision(False, "nothing of the run is logged")


def make(spec):
    """Return `kernel(body, row)`; row: (7,) x y z qw qx qy qz, as it was where nothing turns."""
    turns = step_terms(spec).turns

    def log_pose(body, row):
        row[0], row[1], row[2] = body.x, body.y, body.z
        if turns:
            row[3], row[4], row[5], row[6] = body.qw, body.qx, body.qy, body.qz

    return kernel(log_pose, spec)


EFFECT = Effect(
    name="pose_log",
    decide=decide,
    per="body",
    overhead_with="step_log",
    channels=("/robot_description", "/tf"),
    hooks=Hooks(log_pose=make),
)
