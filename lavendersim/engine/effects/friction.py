"""Friction: Coulomb's disc |lambda_t| <= mu lambda_n, in the same impulse as the normal.

Each row becomes a block of three (n, t1, t2) with its own 3x3 of the Delassus operator,
    K = (1/m_A + 1/m_B) 1 - [r_A] I_A^-1 [r_A] - [r_B] I_B^-1 [r_B],
taken in the contact frame. Bodies carry their world inverse inertia beside their velocity, because
a sweep needs both and nothing else of a body.
"""

from ..block import make_relative_velocity
from ..compile import kernel
from ..violations import COULOMB_ROW, make_log_coulomb
from .decision import Decision, Facts, PairFacts, by_pair

NAME = "friction"
STAGE = "solve"
NEEDS = ("contact_torque", "rotation")
PAIR_FIELDS = [("friction", "f8")]  # mu of the pair, the geometric mean of its surfaces' [-]
VELOCITY_FIELDS = [(f"j{axes}", "f8") for axes in ("xx", "xy", "xz", "yy", "yz", "zz")]
CONTACT_FIELDS = [
    ("mu", "f8"),
    *[(f"t{k}{axis}", "f8") for k in "12" for axis in "xyz"],  # tangents, n x t1 = t2
    *[(f"r{body}{axis}", "f8") for body in "ab" for axis in "xyz"],  # centre to own surface [m]
    ("k_n1", "f8"),  # entries of K in the frame (n, t1, t2) [1/kg]
    ("k_n2", "f8"),
    ("i_11", "f8"),  # inverse of the tangential 2x2 of K [kg]
    ("i_12", "f8"),
    ("i_22", "f8"),
    ("k_t", "f8"),  # bound on the largest eigenvalue of that 2x2 [1/kg]
    ("lambda_1", "f8"),  # accumulated impulse on B along t1, t2 [N s]
    ("lambda_2", "f8"),
]
# Of the impulse on B along t1, t2; slip: tangential velocity of B's surface relative to A's after
# the solve.
CONTACT_ROW_FIELDS = [
    ("impulse_t1", "f8"),  # [N s]
    ("impulse_t2", "f8"),
    ("slip_t1", "f8"),  # [m/s]
    ("slip_t2", "f8"),
    *[(f"t1{axis}", "f8") for axis in "xyz"],  # t2 = n x t1 [-]
    ("friction", "f8"),  # mu [-]
]
STEP_ROW_FIELDS = COULOMB_ROW
CACHE_FIELDS = [("px", "f8"), ("py", "f8"), ("pz", "f8")]  # tangential impulse, world axes [N s]


def _said(pair: PairFacts) -> str:
    if pair.friction > 0.0:
        return f"sliding {pair.friction:g}"
    return "resistance to turning acts in friction's frame" if pair.resists_turning else ""


def wanted(facts: Facts) -> Decision:
    """On when a pair that may touch has a positive coefficient, or resists turning without one."""
    if any(pair.friction > 0.0 or pair.resists_turning for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _said))
    return Decision(False, "every pair that may touch has coefficient 0")


def make_refresh(spec):
    """Return `kernel(bodies, velocities)`: world inverse inertias of the pose the step begins with.

    A round body's is the same in every frame, and is written without the round-off of turning it.
    """

    def refresh(bodies, velocities):
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            a, b, c = body.inv_ix, body.inv_iy, body.inv_iz
            if a == b and b == c:
                v.jxx, v.jyy, v.jzz = a, a, a
                v.jxy, v.jxz, v.jyz = 0.0, 0.0, 0.0
            else:
                xa, xb, xc = body.r00, body.r01, body.r02
                ya, yb, yc = body.r10, body.r11, body.r12
                za, zb, zc = body.r20, body.r21, body.r22
                v.jxx = a * xa * xa + b * xb * xb + c * xc * xc
                v.jxy = a * xa * ya + b * xb * yb + c * xc * yc
                v.jxz = a * xa * za + b * xb * zb + c * xc * zc
                v.jyy = a * ya * ya + b * yb * yb + c * yc * yc
                v.jyz = a * ya * za + b * yb * zb + c * yc * zc
                v.jzz = a * za * za + b * zb * zb + c * zc * zc

    return kernel(refresh, spec)


def make_log(spec):
    """Return `kernel(out, contact, va, vb)` that fills CONTACT_ROW_FIELDS."""
    relative_velocity = make_relative_velocity(spec)

    def log_friction(out, contact, va, vb):
        x, y, z = relative_velocity(contact, va, vb)
        out.impulse_t1, out.impulse_t2 = contact.lambda_1, contact.lambda_2
        out.slip_t1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        out.slip_t2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        out.t1x, out.t1y, out.t1z = contact.t1x, contact.t1y, contact.t1z
        out.friction = contact.mu

    return kernel(log_friction, spec)


make_step_log = make_log_coulomb
