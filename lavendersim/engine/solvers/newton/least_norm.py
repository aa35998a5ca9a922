"""Impulses of least norm among all that give a solved step its velocities: equal compliances.

Where contacts are redundant, the velocities v* of a solve are unique and its impulses are not: any
on the faces of their cones (`faces`) with J^T lambda = J^T lambda* serve. The one of least sum of
squares, along normals and tangents alike, is the limit of contacts that all give way alike, by 1/E:
    lambda(v) = proj(-E J (v - v*)),    M (v - v*) = J^T (lambda(v) - lambda*),    E -> infinity
There is one, so it has the symmetry of the scene, and it does not depend on how the solve went.

The first step takes every closed contact to carry a load, what sticks in the inside of its cone.
Mostly that is the end of it. A round with one stiff E for all rows is SOFT off the limit; further
rounds of the augmented Lagrangian, around the impulses found, take the violation lambda/E away.
Their changes lie in the span of J, as the least norm does.

What v* violates the laws by, within the tolerance of its solve, stays; so do torques of contacts.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...residual import make_residual
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import DOF, OF_A, OF_B, T1, T2
from .faces import (
    OPEN,
    SLIDES,
    SPENT,
    make_face_impulse,
    make_face_stiffness,
    make_find_face,
    make_turn_friction,
)
from .factor import make_factorise, make_lay_out, make_solve_factorised
from .matrix import make_assemble
from .method import make_restore, make_set_impulse
from .minimise import make_assemble_mass, make_body_of, make_descend, make_directional_derivative
from .response import make_fill_rows
from .torques import make_limits_torque

# Softness of all rows, relative to the one that gives way least [-].
SOFT = 1e-6
# Rounds at most.
ROUNDS = 30
# Friction that changes by more than this share from a round to the next is found first, around no
# impulse [-].
TURNING = 1e-3
# A residual may grow by so much [m/s].
SHARP = 1e-11
# Rounds end when their violation is this share of the fastest contact's velocity [-], and this
# share of SHARP: above it the residual would grow by more than it may, and the choice be lost.
ENDS, WITHIN = 1e-12, 0.5
# Impulses stay that sweeps have changed by no more since they were chosen: share of the largest
# then, both as velocities [-].
DRIFT = 1e-6
# A round's impulses may be this share of SHARP, squared, off the minimum's [-].
EXACTNESS = 0.01


def make_begin(spec: Spec, stiffness: Any) -> Any:
    """Return `kernel(contacts, count, size, workspace, stiff, load) -> slope`.

    The first step, from v* on, to where all closed contacts carry; `change` and the contacts'
    `velocity` have it. slope: along the step [J], 0 where there is none. stiff: E [kg]; load: what
    contacts are taken to carry [N s].
    """
    terms = row_terms(spec)
    friction, compliant, bilateral = terms.frictional, terms.compliant, terms.bilateral
    fill_rows, body_of = make_fill_rows(spec), make_body_of(spec)
    assemble = make_assemble(spec, stiffness, torques=False)
    factorise, solve_factorised = make_factorise(spec), make_solve_factorised(spec)
    directional_derivative = make_directional_derivative(spec, torques=False)

    def lean(contact, stiff, load):
        # Its response to nothing is `load`, around no impulse.
        contact.scale = 1.0
        if compliant:
            contact.scale = 1.0 / (1.0 + stiff * contact.gamma)
        contact.stiff_n = stiff * contact.scale
        contact.best_n = 0.0
        if friction:
            contact.stiff_t = stiff
            contact.best_1, contact.best_2 = 0.0, 0.0
            contact.velocity_1, contact.velocity_2 = 0.0, 0.0
            if contact.face != SLIDES:
                contact.velocity_1 = contact.start_1 / stiff
                contact.velocity_2 = contact.start_2 / stiff
        contact.velocity_n = contact.start_n / stiff - load / contact.stiff_n

    lean = kernel(lean, spec)

    def gather_load(contacts, count, size, workspace):
        # gradient = J^T lambda*, less what compliant rows would have by themselves
        gradient, rows = workspace.gradient, workspace.rows
        for r in range(DOF * size):
            gradient[r] = 0.0
        for c in range(count):
            contact = contacts[c]
            loaded = contact.face != OPEN and contact.start_n > 0.0
            if bilateral:
                loaded = loaded or contact.bilateral == 1
            loaded = loaded and contact.face != SPENT
            if loaded:
                fill_rows(contact, rows)
                for own in (OF_A, OF_B):
                    p = body_of(contact, workspace, own)
                    if p >= 0:
                        for i in range(DOF):
                            total = contact.scale * contact.start_n * rows[own, i]
                            if friction and contact.face != SLIDES:
                                total += contact.start_1 * rows[own + T1, i]
                                total += contact.start_2 * rows[own + T2, i]
                            gradient[DOF * p + i] += total

    gather_load = kernel(gather_load, spec)

    def begin(contacts, count, size, workspace, stiff, load):
        for c in range(count):
            lean(contacts[c], stiff, load)
        assemble(contacts, count, size, workspace)
        if not factorise(size, workspace):
            return 0.0
        gather_load(contacts, count, size, workspace)
        for r in range(DOF * size):
            workspace.step[r] = -workspace.gradient[r]
        solve_factorised(size, workspace, workspace.step)
        slope = 0.0
        for r in range(DOF * size):
            workspace.change[r] = workspace.step[r]
            slope += workspace.step[r] * workspace.gradient[r]
        directional_derivative(contacts, count, workspace)
        for c in range(count):
            contact = contacts[c]
            contact.velocity_n = contact.start_n / stiff + contact.step_n
            if compliant:
                contact.velocity_n -= contact.gamma * contact.start_n
            contact.step_n = 0.0
            if friction:
                contact.velocity_1 += contact.step_1
                contact.velocity_2 += contact.step_2
                contact.step_1, contact.step_2 = 0.0, 0.0
        return slope

    return kernel(begin, spec)


def make_least_norm(spec: Spec) -> Any:
    """Return `kernel(system, workspace, params, counters)`: the impulses, velocities with them.

    Of a step that is solved. Impulses stay as they are where they are the only ones, where they
    were chosen and have hardly changed, and where the residual would grow. Those that are not found
    in ROUNDS are counted in counters.least_norm_not_converged.
    """
    friction, bilateral = row_terms(spec).frictional, row_terms(spec).bilateral
    spins, limits_torque = resists_turning(spec), make_limits_torque(spec)
    residual, assemble_mass = make_residual(spec), make_assemble_mass(spec)
    find_face, face_impulse = make_find_face(spec), make_face_impulse(spec)
    stiffness, turn_friction = make_face_stiffness(spec), make_turn_friction(spec)
    begin = make_begin(spec, stiffness)
    descend = make_descend(spec, face_impulse, stiffness, torques=False)
    set_impulse, lay_out = make_set_impulse(spec), make_lay_out(spec)
    restore_best = make_restore(spec, "best", set_impulse, torques=False)
    restore_start = make_restore(spec, "start", set_impulse, torques=False)

    def turn(contacts, count):
        # Friction follows; returns the largest change, as a velocity [m/s].
        largest = 0.0
        for c in range(count):
            contact = contacts[c]
            largest = max(largest, contact.k_t * turn_friction(contact))
        return largest

    turn_all: Any = kernel(turn, spec) if friction else None

    def go_round(contacts, count, stiff):
        # The next round is around the impulses of this one; returns its largest violation [m/s].
        largest = 0.0
        for c in range(count):
            contact = contacts[c]
            n, one, two = face_impulse(contact, 0.0)
            change = (n - contact.best_n) / stiff
            contact.velocity_n -= change
            contact.best_n = n
            largest = max(largest, abs(change))
            if friction and contact.face != SLIDES:
                change_1, change_2 = (one - contact.best_1) / stiff, (two - contact.best_2) / stiff
                contact.velocity_1 -= change_1
                contact.velocity_2 -= change_2
                contact.best_1, contact.best_2 = one, two
                largest = max(largest, abs(change_1), abs(change_2))
            if friction and contact.face == SLIDES:
                contact.best_1, contact.best_2 = one, two
        return largest

    go_round = kernel(go_round, spec)

    def least_norm(system, workspace, params, counters):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        if not counters.unchosen > DRIFT * counters.chosen:
            return
        least, most, fastest, load, loaded = contacts[0].k_n, 0.0, 0.0, 0.0, 0
        for c in range(count):
            contact = contacts[c]
            # Limits of torques follow normal impulses, and torques would stay as they are.
            if spins:
                if limits_torque(contact):
                    return
            least, most = min(least, contact.k_n), max(most, contact.k_n)
            n = contact.lambda_n
            if bilateral:
                n = abs(n)
            fastest = max(fastest, contact.k_n * n)
            load += n
            loaded += 1 if n > 0.0 else 0
        counters.unchosen, counters.chosen = 0.0, fastest
        if loaded == 0:
            return
        size, entries, _ = lay_out(contacts, count, workspace)
        # As many contacts as bodies: each body has one of its own.
        if count <= size or entries > workspace.values.shape[0]:
            return
        before, _ = residual(contacts, count, velocities)
        assemble_mass(system.bodies, size, workspace)
        stiff, still = 1.0 / (SOFT * least), before + SHARP
        for c in range(count):
            contact = contacts[c]
            find_face(contact, velocities[contact.a], velocities[contact.b], still)
        slope = begin(contacts, count, size, workspace, stiff, load / loaded)
        enough = EXACTNESS * SOFT * SHARP * SHARP / most
        found, ends = slope < 0.0, not slope < 0.0
        for _ in range(ROUNDS):
            if found:
                made, found = descend(contacts, count, size, workspace, enough, slope)
                counters.newton_steps += made
            if found:
                turned = 0.0
                if friction:
                    turned = turn_all(contacts, count)
                if turned <= TURNING * fastest:
                    left = max(go_round(contacts, count, stiff), turned)
                    if left <= min(ENDS * fastest, WITHIN * SHARP):
                        ends = True
                        break
        if not ends:
            counters.least_norm_not_converged += 1
        if not found:
            return
        restore_best(contacts, count, velocities)
        largest, worst = residual(contacts, count, velocities)
        if not largest <= still:
            restore_start(contacts, count, velocities)
            return
        counters.residual, counters.residual_contact = largest, worst

    return kernel(least_norm, spec)
