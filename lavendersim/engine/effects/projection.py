"""Positional projection: a pass of its own that moves bodies apart and adds no velocity.

Pseudo-velocities u (metres and radians per step, zero at the start) are solved for by projected
Gauss-Seidel on the rows of the step:
    n . u  >=  projection * max(d_1 - slop, 0),   d_1 = -(phi + v_n dt)
In substeps (`error_control`) the share is that of their length: what a step moves bodies apart by
does not depend on their number.
d_1 is the penetration after the velocity step, to first order. A pair that does not push moves by
the mean of its old and new velocity where the integrator is `midpoint`, and v_n is that mean's: by
the new one alone it would be moved out of an overlap that it never reaches. The same holds where
contacts at the middle of the step carry its bodies, of those that push and of those that do not: a
disc that rolls on one point of its rim would be lifted for the opposite one. So would a body with
an impact within the step, which moves on its old velocity until then (`integrate`). u is added to
the poses and dropped.
With every target at zero the solution is u = 0, and the pass ends before it begins.
"""

from typing import Any

from ..records import Field
from ..spec import Spec
from ..step_terms import step_terms
from .decision import Decision, Facts
from .effect import Effect, Fields, Hooks, kernel

# What ends of a joint are apart by, or a push changes, and is left [m]: far below what turns leave.
TOGETHER = 1e-12


def decide(facts: Facts) -> Decision:
    """On when a share of the penetration is to be projected out."""
    if facts.projection > 0.0 and facts.pairs:
        return Decision(True, f"projection is {facts.projection:g} per step")
    return Decision(False, "nothing can touch" if facts.projection > 0.0 else "projection is 0")


def make_mean_rate(spec):
    """Return `kernel(contact, va, vb, ma, mb, dt) -> v_n`, its mean where a body has an impact.

    ma, mb: rows of `motion`, classified: each body's displacement is that of `integrate`.
    """
    from ..contact import make_normal_velocity
    from ..integrate import AFTERWARDS

    normal_velocity = make_normal_velocity(spec)

    def flown(m, dt):
        """Part of the velocity change by forces that its flight adds: see `integrate.displace`."""
        rest = dt - m.tau
        if m.carried == 0:
            return 0.5 * (m.tau * m.tau - rest * rest) / (dt * dt)
        if m.carried == AFTERWARDS:
            return 0.5 * m.tau * m.tau / (dt * dt)
        return 0.0

    flown = kernel(flown, spec)

    def mean_rate(contact, va, vb, ma, mb, dt):
        v_n = normal_velocity(contact, va, vb)
        mean, share_a, share_b = v_n, 0.0, 0.0
        if ma.tau < dt:
            mean += ma.tau / dt * (normal_velocity(contact, ma, vb) - v_n)
            share_a = flown(ma, dt)
        if mb.tau < dt:
            mean += mb.tau / dt * (normal_velocity(contact, va, mb) - v_n)
            share_b = flown(mb, dt)
        x = share_b * mb.dvx - share_a * ma.dvx
        y = share_b * mb.dvy - share_a * ma.dvy
        z = share_b * mb.dvz - share_a * ma.dvz
        return mean + contact.nx * x + contact.ny * y + contact.nz * z

    return kernel(mean_rate, spec)


def make_moves_by_mean(spec):
    """Return `kernel(ma, mb) -> whether` another contact carries the bodies of a row by their mean.

    What only flies does so as well, by what forces change. ma, mb: rows of `motion`, classified.
    """
    from ..integrate import LASTING

    def moves_by_mean(ma, mb):
        if ma.carried == LASTING:
            return mb.carried == LASTING or mb.carried == 0
        return ma.carried == 0 and mb.carried == LASTING

    return kernel(moves_by_mean, spec)


def make_mean_velocity(spec):
    """Return `kernel(body, v, m, out)`: the velocity that carries a body, of what springs turn."""
    from ..integrate import LASTING

    turns = step_terms(spec).turns

    def mean_velocity(body, v, m, out):
        late = 1.0
        if m.carried == 0 or m.carried == LASTING:
            late = 0.5
        out.vx, out.vy = m.vx + late * (v.vx - m.vx), m.vy + late * (v.vy - m.vy)
        out.vz = m.vz + late * (v.vz - m.vz)
        if turns:
            out.wx, out.wy = m.wx + late * (v.wx - m.wx), m.wy + late * (v.wy - m.wy)
            out.wz = m.wz + late * (v.wz - m.wz)
            if body.sprung > 0 and m.carried == 0:
                out.wx, out.wy, out.wz = body.turn_x, body.turn_y, body.turn_z

    return kernel(mean_velocity, spec)


def make(spec):
    """Return `kernel(system, motion, pseudo, workspace, params) -> sweeps made`."""
    from ..contact import make_normal_velocity
    from ..joint_projection import make_project_joints
    from ..joint_turn import make_turned_apart
    from ..row_terms import row_terms
    from ..solvers.packed.apart import make_push_apart
    from ..solvers.packed.late import FEWEST_CONTACTS, packs_late
    from ..solvers.solver import ContactSystem
    from ..spring_turn import PLACED

    normal_velocity = make_normal_velocity(spec)
    packs = packs_late(spec)
    push_apart = _make_push_apart(spec)
    push_apart_packed: Any = make_push_apart(spec) if packs else None
    torque, by_newton = row_terms(spec).levers, projects_joints(spec)
    project_joints: Any = make_project_joints(spec) if by_newton else None
    friction, midpoint = row_terms(spec).frictional, step_terms(spec).mean_flight
    bilateral, bounded = row_terms(spec).bilateral, row_terms(spec).bounded
    turned_apart: Any = make_turned_apart(spec) if bilateral else None
    centred, springs = step_terms(spec).centred, row_terms(spec).elastic
    moves_by_mean: Any = make_moves_by_mean(spec) if centred else None
    at_surface = step_terms(spec).timed_impacts
    mean_rate: Any = make_mean_rate(spec) if at_surface else None
    controlled = step_terms(spec).substeps
    joined = step_terms(spec).sprung and midpoint
    mean_velocity: Any = make_mean_velocity(spec) if joined else None

    def project_positions(system, motion, pseudo, workspace, params):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        bodies = system.bodies
        share, asked, joined_rows = params.projection, False, False
        if controlled:
            share *= params.dt / params.timestep
        for c in range(count):
            contact = contacts[c]
            v_n = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
            if midpoint:
                free = contact.lambda_n == 0.0
                if bilateral:
                    free = free and contact.bilateral == 0
                if free:
                    carried = False
                    if centred:
                        carried = moves_by_mean(motion[contact.a], motion[contact.b])
                        if carried and contact.lasts == 0:
                            # Its row is that of the start, and bends by the middle (`widen`).
                            v_n = 0.5 * (v_n + contact.begin_n)
                            v_n += contact.middle_n - contact.begin_n
                        elif carried:
                            v_n = 0.5 * (v_n + contact.middle_n)
                    if not carried:
                        v_n -= 0.5 * contact.dv_n
                elif centred:
                    if contact.lasts == 1:
                        v_n = 0.5 * (v_n + contact.middle_n)
            elif bilateral and centred:
                if contact.bilateral == 1:  # no force acts, and joints move bodies by their mean
                    v_n = 0.5 * (v_n + contact.middle_n)
            if at_surface:
                ma, mb = motion[contact.a], motion[contact.b]
                if ma.tau < params.dt or mb.tau < params.dt:
                    va, vb = velocities[contact.a], velocities[contact.b]
                    v_n = mean_rate(contact, va, vb, ma, mb, params.dt)
            if joined:
                if bodies[contact.a].sprung > 0 or bodies[contact.b].sprung > 0:
                    ua, ub = pseudo[contact.a], pseudo[contact.b]
                    mean_velocity(bodies[contact.a], velocities[contact.a], motion[contact.a], ua)
                    mean_velocity(bodies[contact.b], velocities[contact.b], motion[contact.b], ub)
                    v_n = normal_velocity(contact, ua, ub)
            excess = -(contact.phi + v_n * params.dt) - params.slop
            if springs:
                if contact.spring_compliance > 0.0:  # it rests where its force holds it
                    excess = 0.0
            if joined:
                a, b = bodies[contact.a], bodies[contact.b]
                if a.sprung >= PLACED or b.sprung >= PLACED:  # there it would do work
                    excess = 0.0
            contact.correction = share * max(excess, 0.0)
            if bilateral:
                if contact.bilateral == 1:
                    joined_rows = True
                    left = turned_apart(contact, velocities, motion, params.dt)
                    phi = contact.phi
                    if torque:
                        if (
                            contact.sliding == 0
                        ):  # in the direction of now, as all rows of the point
                            x, y = contact.apart_x, contact.apart_y
                            phi = contact.nx * x + contact.ny * y + contact.nz * contact.apart_z
                    contact.correction = -(phi + v_n * params.dt + left)
            contact.push = 0.0
            contact.inv_k_n = 1.0 / contact.k_n
            if bounded:
                if contact.motor == 1:  # it holds no place
                    contact.correction, contact.inv_k_n = 0.0, 0.0
            if contact.correction > 0.0:
                asked = True
            if bilateral:
                if abs(contact.correction) > TOGETHER:
                    asked = True
        if not asked:
            return 0
        for i in range(pseudo.shape[0]):
            u = pseudo[i]
            u.vx, u.vy, u.vz = 0.0, 0.0, 0.0
            if torque:
                u.wx, u.wy, u.wz = 0.0, 0.0, 0.0
            if friction:  # an impulse finds a body's inertia beside its velocity
                v = velocities[i]
                u.jxx, u.jxy, u.jxz = v.jxx, v.jxy, v.jxz
                u.jyy, u.jyz, u.jzz = v.jyy, v.jyz, v.jzz
        if packs:
            if count >= FEWEST_CONTACTS:
                packed = workspace.packed
                return push_apart_packed(system, packed, pseudo, params.projection_sweeps)
        made, left = push_apart(system, pseudo, params.projection_sweeps)
        if by_newton:
            if left and joined_rows:
                projected = ContactSystem(contacts, system.order, count, bodies, pseudo)
                project_joints(projected, workspace, TOGETHER)
        return made

    return kernel(project_positions, spec)


def _make_push_apart(spec):
    """Return `kernel(system, pseudo, sweeps) -> (sweeps made, whether pushes still change)`."""
    from ..contact import make_apply_impulse, make_normal_velocity
    from ..row_terms import row_terms

    normal_velocity, apply_impulse = make_normal_velocity(spec), make_apply_impulse(spec)
    bilateral = row_terms(spec).bilateral

    def push_apart(system, pseudo, sweeps):
        contacts, order = system.contacts, system.order
        made, changed = 0, False
        for _ in range(sweeps):
            changed = False
            for c in range(system.count):
                contact = contacts[order[c]]
                ua, ub = pseudo[contact.a], pseudo[contact.b]
                missing = contact.correction - normal_velocity(contact, ua, ub)
                push = max(contact.push + missing * contact.inv_k_n, 0.0)
                least = 0.0
                if bilateral:
                    if contact.bilateral == 1:
                        push = contact.push + missing * contact.inv_k_n
                        least = TOGETHER * contact.inv_k_n
                change = push - contact.push
                contact.push = push
                apply_impulse(contact, ua, ub, change)
                if not abs(change) <= least:  # a NaN is greater
                    changed = True
            made += 1
            if not changed:  # nor would anything in the sweeps that are left
                break
        return made, changed

    return kernel(push_apart, spec)


def projects_joints(spec: Spec) -> bool:
    """Whether pushes of joints go by Newton's method: torques of contacts have no part in it."""
    from ..row_terms import row_terms

    terms = row_terms(spec)
    return terms.bilateral and spec.has("newton") and not (terms.torsional or terms.rolling)


def contact_fields(spec: Spec) -> list[Field]:
    """Return what keeps the rest of a row while Newton's method has it (`joint_projection`)."""
    from ..row_terms import row_terms

    if not projects_joints(spec):
        return []
    terms, names = row_terms(spec), list[str]()
    if terms.frictional:
        names += ["own_mu", "own_1", "own_2"]
    if terms.compliant:
        names.append("own_gamma")
    if terms.bounded:
        names.append("own_most")
    return [(name, "f8") for name in names]


EFFECT = Effect(
    name="projection",
    decide=decide,
    per="contact",
    fields=Fields(
        contact=[
            ("correction", "f8"),  # asked change of separation in this step [m]
            ("push", "f8"),  # accumulated pseudo-impulse [kg m]
            ("inv_k_n", "f8"),  # 1/k_n, without compliance [kg]
        ],
        contact_with=contact_fields,
    ),
    hooks=Hooks(project=make),
)
