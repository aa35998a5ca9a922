"""Rotation: orientations change; something turns at the start or a contact exerts a torque."""

from ..compile import kernel
from ..records import ANGULAR_VELOCITY, ORIENTED_BODY
from ..rotation import turn
from .decision import Decision, Facts, named

NAME = "rotation"
STAGE = "integrate"
BODY_FIELDS = [*ORIENTED_BODY, ("inv_ix", "f8"), ("inv_iy", "f8"), ("inv_iz", "f8")]
VELOCITY_FIELDS = ANGULAR_VELOCITY


def wanted(facts: Facts) -> Decision:
    """On when a body spins at the start, is twisted, or can be turned by its contacts."""
    spinning = [body.name for body in facts.bodies if body.movable and body.spins]
    if spinning:
        return Decision(True, f"{named(spinning)}: initial angular velocity")
    twisted = [body.name for body in facts.bodies if body.movable and body.torque]
    if twisted:
        return Decision(True, f"{named(twisted)}: a torque from the config")
    levered = [body.name for body in facts.bodies if body.movable and body.shape != "sphere"]
    if levered and facts.pairs:
        return Decision(True, f"{named(levered)}: a contact off the centre of mass exerts a torque")
    for pair in facts.pairs:
        if pair.friction > 0.0:
            return Decision(True, f"{pair.a} and {pair.b}: friction exerts a torque")
        if pair.resists_turning:
            return Decision(True, f"{pair.a} and {pair.b}: their contact resists turning")
    turning = [body.name for body in facts.bodies if body.kinematic and body.spins]
    if turning:
        return Decision(True, f"{named(turning)}: kinematic and turning")
    movable = [body.name for body in facts.bodies if body.movable]
    return Decision(
        False,
        f"{named(movable)}: nothing turns at the start and no frictionless contact of it can exert "
        "a torque",
    )


def make(spec):
    """Return `kernel(body, velocity, dt) -> solved`: turn by omega dt; omega stays."""

    def integrate_rotation(body, velocity, dt):
        wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
        # What does not turn keeps its quaternion to the bit.
        if wx != 0.0 or wy != 0.0 or wz != 0.0:
            turn(body, wx * dt, wy * dt, wz * dt)
        return True

    return kernel(integrate_rotation, spec)
