"""Contact spring: a compliance is a spring at its contact, with a damper where a ratio is given.

    F = d/c + k_d d',   k_d = 2 zeta sqrt(m/c),   m = 1/k_n,   0 <= F
d is the penetration: c N at rest, and a period of 2 pi sqrt(m c). By the trapezoidal rule, of
bodies that move by the mean of the velocities at the step's ends (`contact_midpoint`),
    lambda = dt (d_0 + d_1)/(2 c) + k_d (d_1 - d_0),   d_1 = d_0 - dt (v_0 + v_1)/2
it is a row v_1 + target + gamma lambda >= 0 with
    gamma = 4 c/(dt^2 + 2 dt c k_d),   target = v_0 - gamma dt d_0/c
which is of order 2 and keeps the energy while the contact lasts. Of bodies that move by v_1 alone
it is, by the implicit Euler rule, a row with
    gamma = c/(dt^2 + dt c k_d),   target = -gamma dt d_0/c
A contact with a spring has no impact, so its restitution has no effect, and it is not projected.
"""

from math import sqrt
from typing import Any

from ..step_terms import step_terms
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Balance, Choice, Column, Effect, Fields, Hooks, kernel
from .keys import COEFFICIENT, SurfaceKey, larger

# dt^2/(m c) above which steps do not resolve a swing, as in `spring_midpoint`.
FAST = 4.0


def _described(pair: PairFacts[str]) -> str:
    c = pair.surface.compliance
    if c > 0.0:
        return f"a spring of {c:g} m/N"
    return "a spring that stiffens" if pair.is_soft else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch is compliant, and its law is the spring."""
    if not any(pair.is_soft for pair in facts.pairs):
        return Decision(False, "every pair that may touch has compliance 0")
    if facts.compliance_law != "spring":
        return Decision(False, f"compliance_law is {facts.compliance_law}")
    if facts.stabilisation_gain > 0.0:
        return Decision(False, "stabilisation_gain pushes in place of a spring")
    return Decision(True, by_pair(facts.pairs, _described))


def make_row(spec):
    """Return `kernel(contact, v, params)`: target and gamma; v: v_n as the step begins [m/s]."""
    from ..hertz_law import make_touch
    from ..row_terms import row_terms

    linear_row = _make_linear_row(spec)
    if not row_terms(spec).curved:
        return linear_row
    touch = make_touch(spec)

    def spring_row(contact, v, params):
        if contact.hertz_stiffness > 0.0:
            contact.spring_v = v
            touch(contact, v, params)
        else:
            linear_row(contact, v, params)

    return kernel(spring_row, spec)


def _make_linear_row(spec):
    mean = step_terms(spec).centred

    def linear_row(contact, v, params):
        dt, c = params.dt, contact.spring_compliance
        damping = 2.0 * contact.damping_ratio / sqrt(contact.k_n * c)
        contact.spring_v = v
        if mean and damping > 0.0 and dt * dt * contact.k_n > FAST * c:
            # See `spring_midpoint`: a damper more where the step does not resolve the spring.
            more = min(1.0, 0.25 * damping * contact.k_n * dt) * dt * dt / c
            both = 0.25 * dt * dt / c + 0.5 * damping * dt
            contact.gamma = 1.0 / (both + 0.75 * more)
            contact.target = (both + 0.25 * more) * contact.gamma * v
            contact.target += contact.gamma * dt * contact.phi / c
        elif mean:
            contact.gamma = 4.0 * c / (dt * (dt + 2.0 * c * damping))
            contact.target = v + contact.gamma * dt * contact.phi / c
        else:
            contact.gamma = c / (dt * (dt + c * damping))
            contact.target = contact.gamma * dt * contact.phi / c

    return kernel(linear_row, spec)


def make(spec):
    """Return `kernel(contact, pair, params)`."""
    linear_row = _make_linear_row(spec)
    mean = step_terms(spec).centred

    def spring(contact, pair, params):
        contact.spring_compliance = pair.compliance
        contact.damping_ratio = pair.damping_ratio
        if pair.compliance > 0.0:
            v = contact.v_n_pre
            if mean:
                v -= contact.dv_n
            linear_row(contact, v, params)

    return kernel(spring, spec)


def make_energy(spec):
    """Return `kernel(contacts, count, velocities, params) -> energy` after the solve [J]."""
    from ..contact import make_normal_velocity
    from ..hertz_law import make_stored
    from ..row_terms import row_terms

    curved = row_terms(spec).curved
    stored: Any = make_stored(spec) if curved else None
    normal_velocity = make_normal_velocity(spec)
    mean = step_terms(spec).centred

    def spring_energy(contacts, count, velocities, params):
        total = 0.0
        for c in range(count):
            contact = contacts[c]
            if contact.spring_compliance > 0.0:
                v = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
                if mean:
                    v = 0.5 * (v + contact.spring_v)
                depth = max(-(contact.phi + params.dt * v), 0.0)
                energy = 0.5 * depth * depth / contact.spring_compliance
                if curved:
                    if contact.hertz_stiffness > 0.0:
                        energy = stored(contact, depth)
                total += energy
        return total

    return kernel(spring_energy, spec)


def make_contact_row(spec):
    """Return `kernel(out, contact, va, vb)` that fills its columns of a contact."""

    def log_spring(out, contact, va, vb):
        out.gamma = contact.gamma

    return kernel(log_spring, spec)


def make_step_row(spec):
    """Return `kernel(row, bodies, counters)` that fills its columns of a step."""

    def log_energy(row, bodies, counters):
        row.contact_energy = counters.contact_energy

    return kernel(log_energy, spec)


EFFECT = Effect(
    name="contact_spring",
    decide=decide,
    per="contact",
    needs=("compliance",),
    chosen_by=Choice("compliance_law"),
    surface_keys=(
        SurfaceKey(
            name="damping_ratio",
            type=COEFFICIENT,
            default=0.0,
            doc="of critical damping, of a contact with compliance; a pair takes the larger",
            mix=larger,
            needs="compliance",
        ),
    ),
    row=RowTerms(elastic=True),
    fields=Fields(
        pair=[("damping_ratio", "f8")],  # zeta of the pair [-]
        contact=[
            ("spring_compliance", "f8"),  # c; 0: a rigid contact [m/N]
            ("damping_ratio", "f8"),  # zeta [-]
            ("spring_v", "f8"),  # v_n as the step begins [m/s]
        ],
    ),
    contact_columns=(Column("gamma", "f8", "what impulse_n is multiplied by in its row", "1/kg"),),
    step_columns=(
        Column("contact_energy", "f8", "energy that springs of contacts store", "J", number=35),
    ),
    balance=Balance(stored="contact_energy"),
    hooks=Hooks(
        capture=make,
        spring_row=make_row,
        contact_energy=make_energy,
        contact_row=make_contact_row,
        step_row=make_step_row,
    ),
)
