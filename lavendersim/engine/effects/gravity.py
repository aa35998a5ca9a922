"""Gravity: v += g dt for every movable body, before contacts capture their approach velocity."""

from .decision import Decision, Facts
from .effect import Effect, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when gravity is not zero."""
    if any(facts.gravity):
        return Decision(True, "gravity is ({:g}, {:g}, {:g}) m/s^2".format(*facts.gravity))
    for later in facts.later_gravity:
        if any(later):
            vector = "({:g}, {:g}, {:g}) m/s^2".format(*later)
            return Decision(True, f"gravity is zero at first, and {vector} later")
    return Decision(False, "gravity is zero")


def make(spec):
    """Return `kernel(body, velocity, params)`."""

    def gravity(body, velocity, params):
        velocity.vx += params.gx * params.dt
        velocity.vy += params.gy * params.dt
        velocity.vz += params.gz * params.dt

    return kernel(gravity, spec)


EFFECT = Effect(
    name="gravity",
    decide=decide,
    per="body",
    hooks=Hooks(accelerate=make),
)
