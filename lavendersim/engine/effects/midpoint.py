"""Midpoint: a body in free flight moves with the mean of its old and new velocity.

    x += dt (v_old + v_new)/2,   exact under a constant acceleration
A body that a contact holds moves with its new velocity, which is the one that respects the contact.
"""

from .decision import Decision, Facts

NAME = "midpoint"
STAGE = "integrate"
CONTACT_FIELDS = [("dv_n", "f8")]  # change of v_n by forces in this step [m/s]


def wanted(facts: Facts) -> Decision:
    """On when the numerics ask for it and something accelerates bodies between contacts."""
    if facts.integrator != "midpoint":
        return Decision(False, f"the integrator is {facts.integrator}")
    if any(facts.gravity):
        return Decision(True, "integrator is midpoint and gravity accelerates")
    pushed = [body.name for body in facts.bodies if body.force or body.drag]
    if pushed:
        return Decision(True, f"integrator is midpoint and {pushed[0]} is pushed or dragged")
    return Decision(False, "free bodies keep their velocity, any integrator moves them alike")
