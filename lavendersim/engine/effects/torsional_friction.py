"""Torsional friction: |psi_n| <= c lambda_n about the contact normal, opposing relative spin.

A disc of contact of radius R with friction mu under even pressure has c = 2/3 mu R; the contact
itself stays a point. Stick where it can, otherwise the limit against the spin:
    psi_n <- clamp(psi_n - omega_n / k, +-c lambda_n),   k = n . (I_A^-1 + I_B^-1) n
psi_n: angular impulse on B [N m s]; a pair's c [m] is the larger of its surfaces'. The limit needs
no other friction: mu may be 0, friction's block is there for its frame.
"""

from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Column, Effect, Fields, Hooks, kernel
from .keys import LENGTH, SurfaceKey, larger

# spin: angular velocity of B relative to A after the solve, about the normal.


def _described(pair: PairFacts[str]) -> str:
    length = pair.surface.torsional_friction
    return f"torsional friction {length:g} m" if length > 0.0 else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has a positive coefficient."""
    if any(pair.surface.torsional_friction > 0.0 for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "every pair that may touch has torsional friction 0")


def make_complete(spec):
    """Return `kernel(contact, pair, x, y, z)`; x, y, z: the response to a unit psi_n."""

    def complete_torsion(contact, pair, x, y, z):
        contact.torsional = pair.torsional_friction
        k = contact.nx * x + contact.ny * y + contact.nz * z
        # A joint's row of a torque alone has no normal: nothing resists there, and nothing divides.
        contact.k_torsion = k if k > 0.0 else 1.0
        contact.psi_n = 0.0

    return kernel(complete_torsion, spec)


def make_solve(spec):
    """Return `kernel(contact, spin) -> change of psi_n`; spin: omega_n [rad/s]."""

    def solve_torsion(contact, spin):
        limit = contact.torsional * contact.lambda_n
        old = contact.psi_n
        # In this order a NaN stays.
        new = min(max(old - spin / contact.k_torsion, -limit), limit)
        contact.psi_n = new
        return new - old

    return kernel(solve_torsion, spec)


def make_residual(spec):
    """Return `kernel(contact, spin) -> r` [rad/s]: |k psi_n - clamp(k psi_n - omega_n)|."""

    def torsion_residual(contact, spin):
        scaled = contact.k_torsion * contact.psi_n
        limit = contact.k_torsion * contact.torsional * contact.lambda_n
        return abs(min(max(scaled - spin, -limit), limit) - scaled)

    return kernel(torsion_residual, spec)


def make_contact_row(spec):
    """Return `kernel(out, contact, va, vb)` that fills its columns of a contact."""

    def log_torsion(out, contact, va, vb):
        x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
        out.spin_n = contact.nx * x + contact.ny * y + contact.nz * z
        out.angular_impulse_n = contact.psi_n
        out.torsional_friction = contact.torsional

    return kernel(log_torsion, spec)


EFFECT = Effect(
    name="torsional_friction",
    decide=decide,
    per="contact",
    row=RowTerms(torsional=True),
    surface_keys=(
        SurfaceKey(
            name="torsional_friction",
            type=LENGTH,
            default=0.0,
            doc="[m] torque about the normal per normal force; a pair takes the larger",
            mix=larger,
        ),
    ),
    needs=("friction",),
    fields=Fields(
        pair=[("torsional_friction", "f8")],  # c of the pair [m]
        contact=[
            ("arm", "f8"),  # greatest distance to the centre of a movable body of the two [m]
            ("torsional", "f8"),  # c [m]
            ("k_torsion", "f8"),  # inverse effective inertia about n [1/(kg m^2)]
            ("psi_n", "f8"),  # accumulated angular impulse on B about n [N m s]
        ],
        cache=[("psi_n", "f8")],
    ),
    contact_columns=(
        Column("angular_impulse_n", "f8", "of torsional friction on B about the normal", "N m s"),
        Column(
            "spin_n",
            "f8",
            "angular velocity of B relative to A after the solve, about the normal",
            "rad/s",
        ),
        Column("torsional_friction", "f8", "coefficient of the pair", "m"),
    ),
    hooks=Hooks(
        complete_torsion=make_complete,
        solve_torsion=make_solve,
        torsion_residual=make_residual,
        contact_row=make_contact_row,
    ),
)
