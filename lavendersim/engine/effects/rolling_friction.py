"""Rolling friction: |psi_t| <= c lambda_n in the tangent plane, opposing the turning of rolling.

c is how far ahead of the contact the pressure of a deformed ground stands [m]: the torque on a
rolling body is c times its load, and a ball of radius r rests on inclines up to tan(angle) = c/r.
The limit is a disc whatever the friction's cone, and has the two steps of friction's block:
    psi_t <- psi_t - S_tt^-1 omega_t                              where that is in the disc
             proj(psi_t - omega_t / k),  |psi_t| <= c lambda_n    otherwise
psi_t: angular impulse on B [N m s]; a pair's c is the larger of its surfaces'. mu may be 0.
"""

from math import sqrt

from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Column, Effect, Fields, Hooks, kernel
from .keys import LENGTH, SurfaceKey, larger

# spin: angular velocity of B relative to A after the solve, about the tangents.


def _described(pair: PairFacts[str]) -> str:
    length = pair.surface.rolling_friction
    return f"rolling friction {length:g} m" if length > 0.0 else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has a positive coefficient."""
    if any(pair.surface.rolling_friction > 0.0 for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "every pair that may touch has rolling friction 0")


def make_complete(spec):
    """Return `kernel(contact, pair, k_11, k_12, k_22)`: entries of S along t1, t2."""

    def complete_rolling(contact, pair, k_11, k_12, k_22):
        contact.rolling = pair.rolling_friction
        scale = 1.0 / (k_11 * k_22 - k_12 * k_12)
        contact.h_11, contact.h_12, contact.h_22 = k_22 * scale, -k_12 * scale, k_11 * scale
        half_gap = 0.5 * (k_11 - k_22)
        contact.k_roll = 0.5 * (k_11 + k_22) + sqrt(half_gap * half_gap + k_12 * k_12)
        contact.psi_1, contact.psi_2 = 0.0, 0.0

    return kernel(complete_rolling, spec)


def make_solve(spec):
    """Return `kernel(contact, w1, w2) -> changes of psi_1, psi_2`; w1, w2: omega_t [rad/s]."""
    from ..cone import project_disc

    def solve_rolling(contact, w1, w2):
        limit = contact.rolling * contact.lambda_n
        old_1, old_2 = contact.psi_1, contact.psi_2
        new_1 = old_1 - contact.h_11 * w1 - contact.h_12 * w2
        new_2 = old_2 - contact.h_12 * w1 - contact.h_22 * w2
        if new_1 * new_1 + new_2 * new_2 > limit * limit:
            new_1, new_2 = old_1 - w1 / contact.k_roll, old_2 - w2 / contact.k_roll
            new_1, new_2 = project_disc(new_1, new_2, limit)
        contact.psi_1, contact.psi_2 = new_1, new_2
        return new_1 - old_1, new_2 - old_2

    return kernel(solve_rolling, spec)


def make_residual(spec):
    """Return `kernel(contact, w1, w2) -> r` [rad/s]: |k psi_t - proj(k psi_t - omega_t)|."""
    from ..cone import project_disc

    def rolling_residual(contact, w1, w2):
        scaled_1, scaled_2 = contact.k_roll * contact.psi_1, contact.k_roll * contact.psi_2
        limit = contact.k_roll * contact.rolling * contact.lambda_n
        new_1, new_2 = project_disc(scaled_1 - w1, scaled_2 - w2, limit)
        new_1, new_2 = new_1 - scaled_1, new_2 - scaled_2
        return sqrt(new_1 * new_1 + new_2 * new_2)

    return kernel(rolling_residual, spec)


def make_contact_row(spec):
    """Return `kernel(out, contact, va, vb)` that fills its columns of a contact."""

    def log_rolling(out, contact, va, vb):
        x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
        out.spin_t1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        out.spin_t2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        out.angular_impulse_t1, out.angular_impulse_t2 = contact.psi_1, contact.psi_2
        out.rolling_friction = contact.rolling

    return kernel(log_rolling, spec)


EFFECT = Effect(
    name="rolling_friction",
    decide=decide,
    per="contact",
    row=RowTerms(rolling=True),
    surface_keys=(
        SurfaceKey(
            name="rolling_friction",
            type=LENGTH,
            default=0.0,
            doc="[m] torque against rolling per normal force; a pair takes the larger",
            mix=larger,
        ),
    ),
    needs=("friction",),
    fields=Fields(
        pair=[("rolling_friction", "f8")],  # c of the pair [m]
        contact=[
            ("arm", "f8"),  # greatest distance to the centre of a movable body of the two [m]
            ("rolling", "f8"),  # c [m]
            ("h_11", "f8"),  # inverse of the tangential 2x2 of S [kg m^2]
            ("h_12", "f8"),
            ("h_22", "f8"),
            ("k_roll", "f8"),  # largest eigenvalue of that 2x2 [1/(kg m^2)]
            ("psi_1", "f8"),  # accumulated angular impulse on B about t1, t2 [N m s]
            ("psi_2", "f8"),
        ],
        cache=[("psi_x", "f8"), ("psi_y", "f8"), ("psi_z", "f8")],  # world axes [N m s]
    ),
    contact_columns=(
        Column("angular_impulse_t1", "f8", "of rolling friction on B about t1", "N m s"),
        Column("angular_impulse_t2", "f8", "of rolling friction on B about t2", "N m s"),
        Column(
            "spin_t1",
            "f8",
            "angular velocity of B relative to A after the solve, about t1",
            "rad/s",
        ),
        Column(
            "spin_t2",
            "f8",
            "angular velocity of B relative to A after the solve, about t2",
            "rad/s",
        ),
        Column("rolling_friction", "f8", "coefficient of the pair", "m"),
    ),
    hooks=Hooks(
        complete_rolling=make_complete,
        solve_rolling=make_solve,
        rolling_residual=make_residual,
        contact_row=make_contact_row,
    ),
)
