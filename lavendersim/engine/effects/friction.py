"""Friction: Coulomb's disc |lambda_t| <= mu lambda_n, in the same impulse as the normal.

Each row becomes a block of three (n, t1, t2) with its own 3x3 of the Delassus operator,
    K = (1/m_A + 1/m_B) 1 - [r_A] I_A^-1 [r_A] - [r_B] I_B^-1 [r_B],
taken in the contact frame. Bodies carry their world inverse inertia beside their velocity, because
a sweep needs both and nothing else of a body.
"""

from ..spec import Spec
from ..step_terms import step_terms
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Column, Derived, Effect, Fields, Hooks, Kernel, kernel
from .keys import COEFFICIENT, SurfaceKey, geometric_mean


def _described(pair: PairFacts[str]) -> str:
    if pair.surface.friction > 0.0:
        return f"sliding {pair.surface.friction:g}"
    return "resistance to turning acts in friction's frame" if pair.resists_turning else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has a positive coefficient, or resists turning without one."""
    if any(pair.surface.friction > 0.0 or pair.resists_turning for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
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


def make_contact_row(spec):
    """Return `kernel(out, contact, va, vb)` that fills its columns of a contact."""
    from ..block import make_slip_velocity

    slip_velocity, centred = make_slip_velocity(spec), step_terms(spec).centred

    def log_friction(out, contact, va, vb):
        out.impulse_t1, out.impulse_t2 = contact.lambda_1, contact.lambda_2
        _, out.slip_t1, out.slip_t2 = slip_velocity(contact, va, vb)
        if centred:
            if contact.slides == 2:  # the row has the sum of both ends'
                out.slip_t1, out.slip_t2 = 0.5 * out.slip_t1, 0.5 * out.slip_t2
        out.t1x, out.t1y, out.t1z = contact.t1x, contact.t1y, contact.t1z
        out.friction = contact.mu

    return kernel(log_friction, spec)


def make_step_row(spec: Spec) -> Kernel:
    """Return `kernel(row, bodies, counters)` that fills the columns of a step."""
    from ..violations import make_log_coulomb

    return make_log_coulomb(spec)


def _first_tangent(rows):
    """Return the first tangent of logged normals; the bits are those of `block.set_tangents`."""
    import numpy as np  # late: configs are read without it

    from ..tangents import first_tangent

    side = np.where(rows["nz"] >= 0.0, 1.0, -1.0)
    return first_tangent(rows["nx"], rows["ny"], rows["nz"], side)


def tangent_x(rows, timestep):
    """Return the first tangent's x of logged contacts."""
    return _first_tangent(rows)[0]


def tangent_y(rows, timestep):
    """Return the first tangent's y of logged contacts."""
    return _first_tangent(rows)[1]


def tangent_z(rows, timestep):
    """Return the first tangent's z of logged contacts."""
    return _first_tangent(rows)[2]


NORMAL = ("nx", "ny", "nz")
SIDE = "s = 1 if nz >= 0 else -1"
TANGENT_X = Derived(f"1 + s nx nx a, a = -1 / (s + nz), {SIDE}", NORMAL, tangent_x)
TANGENT_Y = Derived(f"s (nx ny a), a = -1 / (s + nz), {SIDE}", NORMAL, tangent_y)
TANGENT_Z = Derived(f"-s nx, {SIDE}", NORMAL, tangent_z)

EFFECT = Effect(
    name="friction",
    decide=decide,
    per="contact",
    row=RowTerms(frictional=True),
    surface_keys=(
        SurfaceKey(
            name="friction",
            type=COEFFICIENT,
            default=0.0,
            doc="Coulomb coefficient mu; a pair takes the geometric mean sqrt(mu_a mu_b)",
            mix=geometric_mean,
        ),
    ),
    needs=("contact_torque", "rotation"),
    fields=Fields(
        velocity=[(f"j{axes}", "f8") for axes in ("xx", "xy", "xz", "yy", "yz", "zz")],
        pair=[("friction", "f8")],  # mu of the pair, the geometric mean of its surfaces' [-]
        contact=[
            ("mu", "f8"),
            *[(f"t{k}{axis}", "f8") for k in "12" for axis in "xyz"],  # tangents, n x t1 = t2
            # levers: from the centre of mass to the own surface [m]
            *[(f"r{body}{axis}", "f8") for body in "ab" for axis in "xyz"],
            ("k_n1", "f8"),  # entries of K in the frame (n, t1, t2) [1/kg]
            ("k_n2", "f8"),
            ("i_11", "f8"),  # inverse of the tangential 2x2 of K [kg]
            ("i_12", "f8"),
            ("i_22", "f8"),
            ("k_t", "f8"),  # bound on the largest eigenvalue of that 2x2 [1/kg]
            ("lambda_1", "f8"),  # accumulated impulse on B along t1, t2 [N s]
            ("lambda_2", "f8"),
        ],
        cache=[("px", "f8"), ("py", "f8"), ("pz", "f8")],  # tangential impulse, world axes [N s]
    ),
    contact_columns=(
        Column("impulse_t1", "f8", "tangential impulse on B along t1", "N s"),
        Column("impulse_t2", "f8", "tangential impulse on B along t2 = n x t1", "N s"),
        Column(
            "slip_t1",
            "f8",
            "slip of B's surface on A's after the solve, moving surfaces included, along t1",
            "m/s",
        ),
        Column(
            "slip_t2",
            "f8",
            "slip of B's surface on A's after the solve, moving surfaces included, along t2",
            "m/s",
        ),
        Column("t1x", "f8", "first unit tangent, world x", derived=TANGENT_X),
        Column("t1y", "f8", "first unit tangent, world y", derived=TANGENT_Y),
        Column("t1z", "f8", "first unit tangent, world z", derived=TANGENT_Z),
        Column("friction", "f8", "coefficient of the pair", "-"),
    ),
    step_columns=(
        Column(
            "cone",
            "f8",
            "largest |lambda_t| - mu lambda_n or -lambda_n of a contact",
            "N s",
            number=23,
        ),
        Column("cone_contact", "i8", "row of the contact that has it; -1 none", number=24),
        Column(
            "dissipation",
            "f8",
            "largest |lambda_t . w_t + mu lambda_n |w_t||, contacts",
            "J",
            number=25,
        ),
        Column("dissipation_contact", "i8", "row of the contact that has it; -1 none", number=26),
    ),
    hooks=Hooks(refresh_inertia=make_refresh, contact_row=make_contact_row, step_row=make_step_row),
)
