"""Contact spring: a compliance is a spring at its contact, with a damper where a ratio is given.

    F = d/c + k_d d',   k_d = 2 zeta sqrt(m/c),   m = 1/k_n,   0 <= F
d is the penetration: c N at rest, and a period of 2 pi sqrt(m c). A step solves the law itself
(`contact_spring_law`): of bodies that move by the mean of the velocities at its ends
(`contact_midpoint`) by the discrete gradient of the energy that is stored, which is the trapezoidal
rule inside,
    lambda = dt (d_0 + d_1)/(2 c) + k_d (d_1 - d_0),   d_1 = d_0 - dt (v_0 + v_1)/2
and keeps the energy where surfaces meet and leave within the step, too; of order 2. Of bodies that
move by v_1 alone by the implicit Euler rule, of order 1. The restitution of surfaces with a spring
has no effect, and they are not projected.

Where impacts are in order and no accuracy is asked for, what meets on a spring that steps do not
resolve, dt^2 (1/m_A + 1/m_B) > 4 c, has an impact, which gives back what the spring and its damper
would (`stiff_springs`): exp(-2 a cot a) of the speed, cos a = zeta; no damper pulls.
"""

from math import sqrt

from ..records import INSTANT
from ..step_terms import step_terms
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Balance, Choice, Column, Effect, Fields, Hooks, kernel
from .keys import COEFFICIENT, SurfaceKey, larger

# Force of a spring, in the energy it stores by its depth: 2 of the linear law, 5/2 of Hertz's [-].
STEEPEST = 2.5


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
    from ..contact_spring_law import make_touch

    touch = make_touch(spec)

    def spring_row(contact, v, params):
        contact.spring_v = v
        touch(contact, v, params)

    return kernel(spring_row, spec)


def make(spec):
    """Return `kernel(contact, pair, params)`."""
    from ..row_terms import row_terms
    from ..stiff_springs import has_impacts, rebound
    from . import has_hook

    spring_row, curved = make_row(spec), row_terms(spec).curved
    mean, impacts = step_terms(spec).centred, has_impacts(spec)
    falls = has_hook(spec, "restitution_at")

    def spring(contact, pair, params):
        contact.spring_compliance = pair.compliance
        contact.damping_ratio = pair.damping_ratio
        if curved:
            contact.hertz_stiffness = 0.0
        instant = False
        if impacts:
            instant = params.dt <= INSTANT
        if instant:  # an impact: nothing is pressed in
            contact.spring_compliance, contact.gamma = 0.0, 0.0
            if pair.compliance > 0.0:
                contact.e = rebound(pair.damping_ratio)
                if falls:
                    contact.yield_speed = 0.0
        elif pair.compliance > 0.0:
            v = contact.v_n_pre
            if mean:
                v -= contact.dv_n
            spring_row(contact, v, params)

    return kernel(spring, spec)


def make_energy(spec):
    """Return `kernel(contacts, count, velocities, params) -> energy` after the solve [J].

    Velocities note what springs may give of it in the next step, by energy and by force.
    """
    from ..contact import make_normal_velocity
    from ..contact_spring_law import make_stored
    from ..row_terms import row_terms
    from ..tangential_springs import stretch_energy

    stored, normal_velocity = make_stored(spec), make_normal_velocity(spec)
    mean, yielding = step_terms(spec).centred, row_terms(spec).yielding

    def spring_energy(contacts, count, velocities, params):
        total = 0.0
        for i in range(velocities.shape[0]):
            velocities[i].released = 0.0
        for c in range(count):
            contact = contacts[c]
            if contact.spring_compliance > 0.0:
                v = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
                if mean:
                    v = 0.5 * (v + contact.spring_v)
                depth = -(contact.phi + params.dt * v)
                energy = stored(contact, depth)
                total += energy
                if energy > 0.0:
                    speed = sqrt(2.0 * energy * contact.k_n)
                    speed = min(speed, STEEPEST * energy / depth * contact.k_n * params.timestep)
                    a, b = velocities[contact.a], velocities[contact.b]
                    a.released, b.released = max(a.released, speed), max(b.released, speed)
                if yielding:
                    along = stretch_energy(contact)
                    total += along
                    speed = sqrt(2.0 * along * contact.k_n)
                    a, b = velocities[contact.a], velocities[contact.b]
                    a.released, b.released = max(a.released, speed), max(b.released, speed)
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
        velocity=[("released", "f8")],  # speed that a spring may give in a step [m/s]
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
