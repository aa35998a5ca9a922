"""External forces and torques, from the config: constant within a step, changed between steps.

    v += F dt / m,   omega += I^-1 T dt
Both act on the centre of mass, in world axes.
"""

from .decision import Decision, Facts, named
from .effect import Effect, Fields, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when a force or a torque acts on a movable body at some time."""
    constant = (
        [one.body for one in facts.scene.forces if one.constant_at_centre] if facts.scene else []
    )
    pushed = [body.name for body in facts.bodies if body.movable and body.name in constant]
    if pushed:
        return Decision(True, f"{named(pushed)}: a force or torque from the config")
    return Decision(False, "no force or torque is specified")


def make(spec):
    """Return `kernel(body, velocity, params)`."""
    from ..applied_force import make_apply_force
    from ..vectors import Vec3

    apply_force = make_apply_force(spec)

    def external_force(body, velocity, params):
        force = Vec3(body.fx, body.fy, body.fz)
        torque = Vec3(body.tx, body.ty, body.tz)
        apply_force(body, velocity, force, torque, params.dt)

    return kernel(external_force, spec)


def make_pushes(spec):
    """Return `kernel(body) -> whether` a force or a torque acts on it now."""

    def external_force_acts(body):
        force = body.fx != 0.0 or body.fy != 0.0 or body.fz != 0.0
        return force or body.tx != 0.0 or body.ty != 0.0 or body.tz != 0.0

    return kernel(external_force_acts, spec)


EFFECT = Effect(
    name="external_force",
    decide=decide,
    per="body",
    fields=Fields(
        body=[
            *[(f"f{axis}", "f8") for axis in "xyz"],  # [N] world axes
            *[(f"t{axis}", "f8") for axis in "xyz"],  # [N m]
        ],
    ),
    hooks=Hooks(accelerate=make, pushes=make_pushes),
)
