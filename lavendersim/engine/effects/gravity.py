"""Gravity: v += g dt for every movable body, before contacts capture their approach velocity."""

from ..compile import kernel
from .decision import Decision, Facts

NAME = "gravity"
STAGE = "accelerate"


def wanted(facts: Facts) -> Decision:
    """On when gravity is not zero."""
    if any(facts.gravity):
        return Decision(True, "gravity is ({:g}, {:g}, {:g}) m/s^2".format(*facts.gravity))
    return Decision(False, "gravity is zero")


def make(spec):
    """Return `kernel(body, velocity, params)`."""

    def gravity(body, velocity, params):
        velocity.vx += params.gx * params.dt
        velocity.vy += params.gy * params.dt
        velocity.vz += params.gz * params.dt

    return kernel(gravity, spec)
