"""Motor: drives a hinge's spin, or a slider's speed, to its own, by no more than it has.

    w = s_AB - speed = 0   where |lambda| < most dt;   w and lambda of opposite signs at its most
s_AB: spin of B against A about the axis, or speed along it. A row of the joint whose impulse has a
bound of either sign: clamped by sweeps, a projection for Newton's method. That of a hinge is a
couple, without a force: its n is 0, and both levers are the axis, 1 m long, so that w is a speed
[m/s] and lambda an impulse [N s] as those of all rows.
Speed 0 is friction of a joint: it holds up to its most, and beyond takes what it can. Where contact
is at the middle of the step a part ends when it has its speed (`engine.motor_reach`).

Its work in a step, lambda (s_0 + s_1)/2 at the pose of the solve, is what enters the balance of
energy; lambda s_1 where bodies move by the velocity that the step ends with.
"""

from __future__ import annotations

from ..spec import Spec
from ..step_terms import step_terms
from ..terms import RowTerms
from .decision import Decision, Facts, named
from .effect import Balance, Column, Effect, Fields, Hooks, Kernel, kernel
from .joint_models import holding

_TWIST = "angular impulse on B of a motor that turns, world"


def decide(facts: Facts) -> Decision:
    """On when a joint that holds a body that moves has a motor."""
    joints = holding(facts.scene) if facts.scene is not None else {}
    driven = [one.name_of_pair for one in joints.values() if one.motor_row]
    if driven:
        return Decision(True, f"{named(driven)}: a motor drives the joint")
    return Decision(False, "no motor drives a joint")


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its columns of a contact."""
    from ..contact import make_frictionless_velocity

    normal_velocity, centred = make_frictionless_velocity(spec), step_terms(spec).centred

    def log_motor(out, contact, va, vb):
        out.motor_work, out.twist_x, out.twist_y, out.twist_z = 0.0, 0.0, 0.0, 0.0
        if contact.motor == 1:
            v = normal_velocity(contact, va, vb)
            if centred:
                if contact.lasts == 1:
                    v = 0.5 * (contact.driven + v)
            out.motor_work = contact.lambda_n * v
            if contact.couple == 1:
                out.twist_x = contact.lambda_n * contact.lever_bx
                out.twist_y = contact.lambda_n * contact.lever_by
                out.twist_z = contact.lambda_n * contact.lever_bz

    return kernel(log_motor, spec)


EFFECT = Effect(
    name="motor",
    decide=decide,
    per="contact",
    needs=("joint",),
    row=RowTerms(bounded=True),
    balance=Balance(work="motor_work"),
    fields=Fields(
        body=[("drive_rate", "f8")],  # of B's end: of the row's speed in the last part [m/s^2]
        pair=[
            ("motor_speed", "f8"),  # of B's end from A's, of a spin at 1 m [m/s]
            ("motor_most", "f8"),  # by which it pushes at most, of a torque at 1 m [N]; others: 0
        ],
        contact=[
            ("motor", "i8"),  # 1: a motor's row
            ("couple", "i8"),  # 1: and one that turns
            ("most", "f8"),  # impulse of the part, of either sign, at most [N s]
            ("driven", "f8"),  # its speed as the part begins, by the levers of the row [m/s]
        ],
    ),
    contact_columns=(
        Column("motor_work", "f8", "work of a motor in the step", "J"),
        Column("twist_x", "f8", f"{_TWIST} x", "N m s"),
        Column("twist_y", "f8", f"{_TWIST} y", "N m s"),
        Column("twist_z", "f8", f"{_TWIST} z", "N m s"),
    ),
    step_columns=(Column("motor_work", "f8", "work of motors in the step", "J", number=61),),
    hooks=Hooks(contact_row=make_contact_row),
)
