"""Cohesion: a contact that is closed draws its two bodies together with a bounded force F [N].

While a contact is closed at the start of a step, the impulse F dt along the normal pulls A and B
together before the solve, at the contact's own levers; the contact's laws then hold for lambda_n,
which presses against it, so that no solver knows of cohesion:
    net impulse on B along n = lambda_n - F dt,   0 <= lambda_n,   |lambda_t| <= mu lambda_n
A contact at rest holds tensions up to F and opens above; its friction is Coulomb's with the force
of cohesion added to the net load, mu (N + F). F is a contact's: a box on a floor has four.

Closed: nearer than the slop, the distance within which contacts rest where they are (at least
TOUCHING). Of two surfaces F is the geometric mean: a surface without cohesion sticks to nothing.
"""

from ..records import TOUCHING
from ..spec import Spec
from ..step_terms import step_terms
from ..terms import StepTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Balance, Column, Effect, Fields, Hooks, Kernel, kernel
from .keys import FORCE, SurfaceKey, geometric_mean


def _reason(pair: PairFacts[str]) -> str:
    force = pair.surface.cohesion
    return f"cohesion {force:g} N a contact" if force > 0.0 else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch draws together."""
    if any(_reason(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _reason))
    return Decision(False, "every pair that may touch has cohesion 0")


def make_is_drawn(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, params) -> whether` it is closed, and draws together."""

    def is_drawn(contact, pair, params):
        return pair.cohesion > 0.0 and contact.phi <= max(params.slop, TOUCHING)

    return kernel(is_drawn, spec)


def make_capture(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, params)`: the impulse of this step, 0 where it is open."""
    is_drawn = make_is_drawn(spec)

    def capture_cohesion(contact, pair, params):
        contact.adhesion, contact.loaded = 0.0, 0
        if is_drawn(contact, pair, params):
            contact.adhesion = pair.cohesion * params.dt

    return kernel(capture_cohesion, spec)


def make_preload(spec: Spec) -> Kernel:
    """Return `kernel(contact, velocities, motion)`: draw the two bodies together.

    In a step in which nothing presses, they fly, and the pull is a force like any other (`dv`).
    """
    from ..contact import make_apply_impulse
    from ..integrate import keeps_motion

    apply_impulse, keeps = make_apply_impulse(spec), keeps_motion(spec)
    forced = step_terms(spec).timed_impacts or step_terms(spec).mean_flight

    def draw_together(contact, velocities, motion):
        p = contact.adhesion
        if p > 0.0:
            contact.loaded = 1
            apply_impulse(contact, velocities[contact.a], velocities[contact.b], -p)
            if keeps:
                a, b = motion[contact.a], motion[contact.b]
                a.dvx += p * contact.inv_m_a * contact.nx
                a.dvy += p * contact.inv_m_a * contact.ny
                a.dvz += p * contact.inv_m_a * contact.nz
                b.dvx -= p * contact.inv_m_b * contact.nx
                b.dvy -= p * contact.inv_m_b * contact.ny
                b.dvz -= p * contact.inv_m_b * contact.nz
            if forced:
                contact.dv_n -= p * contact.k_n

    return kernel(draw_together, spec)


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its columns of a contact."""

    def log_cohesion(out, contact, va, vb):
        out.adhesive_impulse = contact.adhesion

    return kernel(log_cohesion, spec)


EFFECT = Effect(
    name="cohesion",
    decide=decide,
    per="contact",
    surface_keys=(
        SurfaceKey(
            name="cohesion",
            type=FORCE,
            default=0.0,
            doc="[N] largest tension that a contact holds; a pair takes the geometric mean",
            mix=geometric_mean,
        ),
    ),
    step=StepTerms(bounces_vary=True),
    fields=Fields(
        pair=[("cohesion", "f8")],  # F [N]
        contact=[("adhesion", "f8"), ("loaded", "i8")],  # F dt where it is closed [N s]
    ),
    contact_columns=(
        Column(
            "adhesive_impulse",
            "f8",
            "draws the bodies together; net normal impulse on B: impulse_n - adhesive_impulse",
            "N s",
        ),
    ),
    balance=Balance(pull="adhesive_impulse"),
    hooks=Hooks(
        capture=make_capture,
        preload=make_preload,
        contact_row=make_contact_row,
        is_drawn=make_is_drawn,
    ),
)
