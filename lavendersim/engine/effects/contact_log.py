"""Contact log: `/contacts`, every contact of every step as the solve left it.

What an effect adds to a contact it logs itself: CONTACT_ROW_FIELDS and `make_log` of its module.
"""

from ..compile import chain, kernel
from ..records import TOUCHING, Field
from ..residual import make_row_residual
from ..spec import Spec
from ..violations import (
    SIGNORINI_ROW,
    make_forget,
    make_log_signorini,
    make_watch_coulomb,
    make_watch_signorini,
)
from .decision import Decision, Facts

NAME = "contact_log"
STAGE = "record"
NEEDS = ("step_log",)  # its kernel sums up contacts in the row of the step
CHANNELS = ("/contacts", "/plot/force", "/plot/penetration", "/plot/log10_residual")
CONTACT_ROW_FIELDS: list[Field] = [
    *[(name, "i8") for name in ("step", "body_a", "body_b", "feature")],
    *[(name, "f8") for name in ("x", "y", "z", "nx", "ny", "nz")],
    ("separation", "f8"),  # phi [m]
    ("penetration", "f8"),  # max(-phi, 0) [m]
    ("approach_velocity", "f8"),  # v_n before the solve, negative when approaching [m/s]
    ("normal_velocity", "f8"),  # v_n after the solve [m/s]
    ("impulse_n", "f8"),  # [N s]
    ("force_n", "f8"),  # impulse / dt [N]
    ("inverse_effective_mass", "f8"),  # k_n [1/kg]
    ("target", "f8"),  # b + b_rest: the row asked v_n + target + gamma lambda_n >= 0 [m/s]
    ("residual", "f8"),  # of the row [m/s]
]
STEP_ROW_FIELDS = SIGNORINI_ROW


def wanted(facts: Facts) -> Decision:
    """On when the run is logged and something can touch."""
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    if not facts.pairs:
        return Decision(False, "nothing can touch")
    return Decision(True, "the run is logged and bodies can touch")


def make(spec: Spec, loggers):
    """Return `kernel(contacts, count, velocities, params, counters, rows)`, right after the solve.

    loggers: kernels (out, contact, va, vb) of the effects that log more of a contact. v_n and the
    residual belong to the velocities and levers of the solve; turning changes both.
    rows: (step rows, pose rows, contact rows); the caller guarantees room.
    """
    ahead = spec.has("speculative")
    rubs, moving_surface = spec.has("friction"), spec.has("surface_velocity")
    row_residual, forget = make_row_residual(spec), make_forget(spec)
    watch_signorini, watch_coulomb = make_watch_signorini(spec), make_watch_coulomb(spec)
    log_more = chain(loggers, spec)

    def log_contacts(contacts, count, velocities, params, counters, rows):
        steps, _, contact_rows = rows
        row = steps[counters.step_rows]
        force, deepest = 0.0, 0.0
        written = 0
        counters.residual_row = -1
        forget(counters)
        for c in range(count):
            contact, out = contacts[c], contact_rows[counters.contact_rows + written]
            va, vb = velocities[contact.a], velocities[contact.b]
            residual, v_n = row_residual(contact, va, vb)
            if ahead:
                # Rows made ahead that neither touch nor push are the solver's, not the scene's.
                if contact.phi > TOUCHING and contact.lambda_n == 0.0:
                    watch_signorini(counters, -1, contact, v_n)
                    continue
            watch_signorini(counters, written, contact, v_n)
            if c == counters.residual_contact:
                counters.residual_row = written
            written += 1
            out.step = counters.step + 1
            out.body_a, out.body_b, out.feature = contact.a, contact.b, contact.feature
            out.x, out.y, out.z = contact.x, contact.y, contact.z
            out.nx, out.ny, out.nz = contact.nx, contact.ny, contact.nz
            out.separation = contact.phi
            out.penetration = max(0.0 - contact.phi, 0.0)
            out.approach_velocity = contact.v_n_pre
            out.normal_velocity = v_n
            out.impulse_n = contact.lambda_n
            out.force_n = contact.lambda_n / params.dt
            out.inverse_effective_mass = contact.k_n
            out.target = contact.target
            out.residual = residual
            log_more(out, contact, va, vb)
            if rubs:
                w_1, w_2 = out.slip_t1, out.slip_t2
                if moving_surface:
                    w_1 += contact.surface_1
                    w_2 += contact.surface_2
                watch_coulomb(counters, written - 1, contact, w_1, w_2)
            force += out.force_n
            # A NaN is deeper than anything, or it would not be seen.
            if out.penetration > deepest or out.penetration != out.penetration:
                deepest = out.penetration
        row.contact_count = written
        row.total_normal_force = force
        row.max_penetration = deepest

    return kernel(log_contacts, spec)


make_step_log = make_log_signorini
