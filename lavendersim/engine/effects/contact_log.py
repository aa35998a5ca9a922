"""Contact log: `/contacts`, every contact of every step as the solve left it.

What an effect adds to a contact it logs itself: its `contact_columns` and its hook `contact_row`.
"""

from ..records import TOUCHING
from ..spec import Spec
from ..step_terms import step_terms
from .decision import Decision, Facts
from .effect import Column, Derived, Effect, Hooks, Kernel, kernel


def decide(facts: Facts) -> Decision:
    """On when the run is logged and something can touch."""
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    if not facts.pairs:
        return Decision(False, "nothing can touch")
    return Decision(True, "the run is logged and bodies can touch")


def make(spec: Spec, loggers):
    """Return `kernel(contacts, count, velocities, params, counters, log)`, right after the solve.

    loggers: kernels (out, contact, va, vb) of the effects that log more of a contact. v_n and the
    residual belong to the velocities and levers of the solve; turning changes both.
    log: `memory.Log`; the caller guarantees room.
    """
    from ..compile import chain
    from ..parts import has_parts
    from ..residual import make_row_residual
    from ..row_terms import row_terms
    from ..violations import make_forget, make_watch_coulomb, make_watch_signorini
    from . import effects_of

    speculative = step_terms(spec).ahead
    loads = any(effect.hooks.preload for effect in effects_of(spec))
    friction, bilateral = row_terms(spec).frictional, row_terms(spec).bilateral
    bounded = row_terms(spec).bounded
    row_residual, forget = make_row_residual(spec), make_forget(spec)
    watch_signorini, watch_coulomb = make_watch_signorini(spec), make_watch_coulomb(spec)
    log_more = chain(loggers, spec)
    in_parts = has_parts(spec)

    def log_contacts(contacts, count, velocities, params, counters, log):
        contact_rows = log.contact
        row = log.step[counters.step_rows]
        force, deepest = 0.0, 0.0
        written, most = 0, -1.0
        first, last = True, True
        if in_parts:
            first = counters.parts == 0
            last = params.dt == params.timestep - counters.elapsed
        if first:
            counters.residual_row = -1
            forget(counters)
            if bounded:
                row.motor_work = 0.0
        else:
            force, deepest = row.total_normal_force, row.max_penetration
            written, most = row.contact_count, row.residual
        for c in range(count):
            contact, out = contacts[c], contact_rows[counters.contact_rows + written]
            va, vb = velocities[contact.a], velocities[contact.b]
            residual, v_n = row_residual(contact, va, vb)
            if speculative:
                # Speculative rows that neither touch nor push are the solver's, not the scene's.
                acts = contact.lambda_n != 0.0
                if loads:
                    acts = acts or contact.loaded == 1
                # What touches without a push has a row in the part that ends the step.
                touches = contact.phi <= TOUCHING and last
                if bilateral:
                    acts = acts or contact.bilateral == 1
                if not (touches or acts):
                    watch_signorini(counters, -1, contact, v_n)
                    continue
            watch_signorini(counters, written, contact, v_n)
            if c == counters.residual_contact and counters.residual > most:
                counters.residual_row = written
            written += 1
            out.step = counters.step + 1
            out.body_a, out.body_b, out.feature = contact.a, contact.b, contact.feature
            out.x, out.y, out.z = contact.x, contact.y, contact.z
            out.nx, out.ny, out.nz = contact.nx, contact.ny, contact.nz
            out.separation = contact.phi
            if bilateral:
                if contact.bilateral == 1:  # it has no inside
                    out.separation = abs(contact.phi)
            out.penetration = max(0.0 - out.separation, 0.0)
            out.approach_velocity = contact.v_n_pre
            out.normal_velocity = v_n
            out.impulse_n = contact.lambda_n
            out.force_n = contact.lambda_n / params.timestep
            out.inverse_effective_mass = contact.k_n
            out.target = contact.target
            out.residual = residual
            log_more(out, contact, va, vb)
            if bounded:
                row.motor_work += out.motor_work
            cone = True
            if bilateral:
                cone = contact.bilateral == 0
            if friction and cone:
                watch_coulomb(counters, written - 1, contact, out.slip_t1, out.slip_t2)
            if cone:
                force += out.force_n
            # A NaN is deeper than anything, or it would not be seen.
            if out.penetration > deepest or out.penetration != out.penetration:
                deepest = out.penetration
        counters.residual = max(counters.residual, most)
        row.residual = counters.residual
        row.contact_count = written
        row.total_normal_force = force
        row.max_penetration = deepest

    return kernel(log_contacts, spec)


def make_step_row(spec: Spec) -> Kernel:
    """Return `kernel(row, bodies, counters)` that fills the columns of a step."""
    from ..violations import make_log_signorini

    return make_log_signorini(spec)


def penetration_of(rows, timestep):
    """Return the penetration [m] of logged contacts; a NaN stays, as in the kernel."""
    import numpy as np  # late: configs are read without it

    depth = 0.0 - rows["separation"]
    return np.where(depth <= 0.0, 0.0, depth)


def force_of(rows, timestep):
    """Return the normal force [N] of logged contacts."""
    return rows["impulse_n"] / timestep


EFFECT = Effect(
    name="contact_log",
    decide=decide,
    per="contact",
    needs=("step_log",),  # its kernel sums up contacts in the row of the step
    contact_columns=(
        Column("step", "i8", "index of the step"),
        Column("body_a", "i8", "index of body A in the list of bodies"),
        Column("body_b", "i8", "index of body B in the list of bodies"),
        Column("feature", "i8", "which features of the two shapes touch; stable while they do"),
        Column("x", "f8", "contact point, world x", "m"),
        Column("y", "f8", "contact point, world y", "m"),
        Column("z", "f8", "contact point, world z", "m"),
        Column("nx", "f8", "unit normal from A to B, world x"),
        Column("ny", "f8", "unit normal from A to B, world y"),
        Column("nz", "f8", "unit normal from A to B, world z"),
        Column("separation", "f8", "signed distance, negative inside", "m"),
        Column(
            "penetration",
            "f8",
            "max(-separation, 0)",
            "m",
            derived=Derived("max(0 - separation, 0)", ("separation",), penetration_of),
        ),
        Column(
            "approach_velocity", "f8", "normal velocity of B relative to A before the solve", "m/s"
        ),
        Column(
            "normal_velocity", "f8", "normal velocity of B relative to A after the solve", "m/s"
        ),
        Column("impulse_n", "f8", "normal impulse on B", "N s"),
        Column(
            "force_n",
            "f8",
            "impulse_n / timestep: the step's average",
            "N",
            derived=Derived("impulse_n / timestep", ("impulse_n",), force_of),
        ),
        Column("inverse_effective_mass", "f8", "along the normal", "1/kg"),
        Column(
            "target", "f8", "b + b_rest: the row asked v_n + target + gamma impulse_n >= 0", "m/s"
        ),
        Column("residual", "f8", "natural-map residual after the solve", "m/s"),
    ),
    step_columns=(
        Column(
            "signorini",
            "f8",
            "largest |min((k_n + gamma) lambda_n, w_n)| of a contact",
            "m/s",
            number=21,
        ),
        Column("signorini_contact", "i8", "row of the contact that has it; -1 none", number=22),
    ),
    channels=(
        *("/contacts", "/contact_columns"),
        *("/plot/force", "/plot/penetration", "/plot/log10_residual"),
    ),
    hooks=Hooks(log_contacts=make, step_row=make_step_row),
)
