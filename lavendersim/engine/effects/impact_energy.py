"""Impact energy: where Newton's law gives an impact energy, Stronge's takes its place.

With friction, Newton's coefficient (a ratio of speeds) can make an eccentric impact gain energy.
Stronge's (`stronge`) is a ratio of the normal impulse's work in restitution and in compression and
cannot. It lowers the speed at which the surfaces leave; the friction that goes with it is that of
the row, by the slip that is left. Where several impacts meet in one step and still gain, all their
speeds are lowered by one factor until nothing is gained.

Work is counted by the slip of the surfaces, moving ones included: what a belt's drive puts into a
body is no gain of the impact, and relative to the belt friction only takes.
"""

from __future__ import annotations

from typing import Any

from ..spec import Spec
from .decision import Decision, Facts, PairFacts
from .effect import Column, Effect, Fields, Hooks, kernel

# Gain, relative to the work's own size, that is round-off.
ROUND_OFF = 1e-13
HALVINGS = 60


def gives_back(pair: PairFacts[str], facts: Facts) -> bool:
    """Whether impacts of a pair may throw back: by its restitution, or as springs by damping."""
    if pair.surface.restitution > 0.0:
        return True
    resolved = facts.compliance_law != "spring" or facts.accuracy is not None
    resolved = resolved or facts.impacts != "in_order" or facts.stabilisation_gain > 0.0
    return bool(pair.surface.compliance > 0.0 and not resolved)


def decide(facts: Facts) -> Decision:
    """On where impacts at the surface may bounce with friction."""
    if facts.impacts == "captured":
        return Decision(False, f"impacts are {facts.impacts}")
    if not any(gives_back(pair, facts) for pair in facts.pairs):
        return Decision(False, "every pair that may touch has restitution 0")
    for pair in facts.pairs:
        if pair.surface.friction > 0.0 or pair.resists_turning:
            return Decision(
                True,
                f"{pair.a} and {pair.b}: friction could make Newton's law of restitution give "
                "energy; Stronge's takes its place where it does",
            )
    return Decision(False, "nothing has friction: Newton's law of restitution gives no energy")


def make_note(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb)`: the slip before the solve."""
    from ..block import make_slip_velocity

    slip_velocity = make_slip_velocity(spec)

    def note(contact, va, vb):
        _, contact.pre_1, contact.pre_2 = slip_velocity(contact, va, vb)

    return kernel(note, spec)


def make_settle(spec: Spec, solve: Any, classify: Any) -> Any:
    """Return the kernel that `settle`s impacts; `kernel(system, motion, workspace, params,
    counters, residual_rows)`: the arguments of a solver, and `motion`.

    classify: the kernel of `integrate` that says which bodies meet in an impact, and when.

    Called after `solve`; sets counters.stronge to 1 where it took Stronge's law, and
    counts in counters.stronge_not_converged.
    """
    from ..block import make_slip_velocity
    from ..parts import make_forget_history
    from ..row_terms import row_terms
    from ..stronge import make_leave
    from ..tangential_springs import make_damper_work
    from . import has_hook

    slip_velocity = make_slip_velocity(spec)
    leave = make_leave(spec)
    some_frictionless = row_terms(spec).frictionless
    forget_history = make_forget_history(spec)
    bilateral, reverses = row_terms(spec).bilateral, has_hook(spec, "reverse_slip")
    yielding = row_terms(spec).yielding
    damper_work: Any = make_damper_work(spec) if yielding else None

    def work_of(contacts, count, velocities, motion, params):
        # Of all impulses, at each body's time of impact: before and after it forces work alone.
        classify(contacts, count, motion, params)
        dt = params.dt
        total, size = 0.0, 0.0
        for c in range(count):
            contact = contacts[c]
            if bilateral:
                if contact.bilateral == 1:  # it does no work
                    continue
            if contact.lambda_n > 0.0:
                va, vb = velocities[contact.a], velocities[contact.b]
                v, v_1, v_2 = slip_velocity(contact, va, vb)
                if reverses:
                    v_1, v_2 = v_1 - contact.reversed_1, v_2 - contact.reversed_2
                ma, mb = motion[contact.a], motion[contact.b]
                share_a, share_b = 1.0 - ma.tau / dt, 1.0 - mb.tau / dt
                x = share_b * mb.dvx - share_a * ma.dvx
                y = share_b * mb.dvy - share_a * ma.dvy
                z = share_b * mb.dvz - share_a * ma.dvz
                after_n = contact.nx * x + contact.ny * y + contact.nz * z
                after_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
                after_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
                along = contact.lambda_n * (0.5 * (contact.v_n_pre + v) - after_n)
                across = contact.lambda_1 * (0.5 * (contact.pre_1 + v_1) - after_1)
                across += contact.lambda_2 * (0.5 * (contact.pre_2 + v_2) - after_2)
                if yielding:
                    if contact.yield_k > 0.0:  # a spring gives what it stored, its damper takes
                        across = damper_work(contact)
                total += along + across
                size += abs(along) + abs(across)
        return total, size

    work_of = kernel(work_of, spec)

    def aim(contacts, count, share):
        for c in range(count):
            contact = contacts[c]
            if contact.is_impact == 1:
                contact.target = -(share * contact.separation_speed + contact.after)

    aim = kernel(aim, spec)

    def settle(system, motion, workspace, params, counters, rows):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        counters.stronge = 0
        if some_frictionless:
            frictional = False
            for c in range(count):
                if contacts[c].frictional == 1:
                    frictional = True
            if not frictional:
                return
        total, size = work_of(contacts, count, velocities, motion, params)
        if not total > ROUND_OFF * size:
            return
        gives = False
        for c in range(count):
            contact = contacts[c]
            if contact.is_impact == 1 and contact.separation_speed > 0.0:
                gives = True
                slower, ended = leave(contact, contact.pre_1, contact.pre_2)
                if not ended:
                    counters.stronge_not_converged += 1
                contact.separation_speed = min(contact.separation_speed, slower)
        if not gives:
            return
        counters.stronge = 1
        aim(contacts, count, 1.0)
        forget_history(counters, rows)
        solve(system, workspace, params, counters, rows)
        total, size = work_of(contacts, count, velocities, motion, params)
        if total <= ROUND_OFF * size:
            return
        low, high = 0.0, 1.0
        for _ in range(HALVINGS):
            share = 0.5 * (low + high)
            aim(contacts, count, share)
            forget_history(counters, rows)
            solve(system, workspace, params, counters, rows)
            total, size = work_of(contacts, count, velocities, motion, params)
            if total <= ROUND_OFF * size:
                low = share
            else:
                high = share
        aim(contacts, count, low)
        forget_history(counters, rows)
        solve(system, workspace, params, counters, rows)

    return kernel(settle, spec)


def make_step_row(spec: Spec) -> Any:
    """Return `kernel(row, bodies, counters)` that fills its columns of a step."""

    def log_stronge(row, bodies, counters):
        row.stronge = counters.stronge
        row.stronge_not_converged = counters.stronge_not_converged

    return kernel(log_stronge, spec)


EFFECT = Effect(
    name="impact_energy",
    decide=decide,
    per="contact",
    needs=("friction", "impact_time"),
    fields=Fields(
        contact=[
            ("pre_1", "f8"),  # slip before the solve [m/s]
            ("pre_2", "f8"),
        ],
    ),
    counts=("stronge_not_converged",),
    step_columns=(
        Column("stronge", "i8", "1 when Stronge's law of restitution replaced Newton's", number=19),
        Column(
            "stronge_not_converged",
            "i8",
            "impacts whose integration by Stronge's law took all its parts: they leave at 0 m/s",
            number=46,
        ),
    ),
    hooks=Hooks(note_slip=make_note, limit_impacts=make_settle, step_row=make_step_row),
)
