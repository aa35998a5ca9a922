"""Where bodies and contacts stand at the middle of the step (`effects.contact_midpoint`).

stand_midway   bodies, by the velocities found so far
look, stay     contacts: those of the manifold there, or those of the start carried along
keep_start     what the start had, to go back to
"""

from __future__ import annotations

from typing import Any

from .collide.manifold.own_normals import has_own_normals, point_normal
from .collide.manifold.point import WHOLE, manifold_normal
from .collide.narrow_phase import make_manifold
from .collide.records import UNBOUNDED, put_normal
from .collide.shapes import shapes_in
from .compile import inner, kernel
from .effects import made_once
from .joint_turn import put_mean_ends
from .overlooked_points import has_flat_faces
from .records import CONE, CYLINDER, PLANE, ROPE, TOUCHING
from .rotation import half_turn, is_round
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, length, minus, position

# Contacts are looked for at the middle up to this share of a body's size apart.
APART = 0.1
# A point of another feature that lies within this share of it is the contact's own.
NEAR = 0.02
# Least cosine of a contact's normal at the middle and at the start, if its feature is another.
AGREES = 0.5
# Cosine of a normal that has turned with what rolls off an edge onto the face beside it, at most.
ROLLED = 1.0 - 1e-8
# The points of a cap that lies are named from where it tilts to. One that is farther than this
# share of the radius from its place has the name of another: the cap has tilted to another side.
TILTED = 0.5
# Contacts of a pair from which on a cap lies; less are a rim that rolls.
LYING = 3


def make_stand_midway(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, motion, lead, poses, dt) -> missed`: bodies midway.

    velocities: at the end, as far as they are known. poses: rows of the bodies at the start. lead:
    velocities before any impulse; of uneven bodies their spin at the middle, which turns with the
    body. Those of the last middle, replaced. missed: how many bodies turned to no middle.
    """
    turns, (uneven, turn_midway) = step_terms(spec).turns, made_once(spec, "turn_midway")
    kinematic = step_terms(spec).kinematic

    def stand_midway(bodies, velocities, motion, lead, poses, dt):
        missed = 0
        for i in range(bodies.shape[0]):
            v, m, free = velocities[i], motion[i], lead[i]
            free.vx, free.vy, free.vz = m.vx, m.vy, m.vz
            body, start = bodies[i], poses[i]
            moves = start.inv_m > 0.0
            if kinematic:
                moves = moves or start.kinematic == 1
            if not moves:
                continue
            quarter = 0.25 * dt
            body.x = start.x + quarter * (m.vx + v.vx)
            body.y = start.y + quarter * (m.vy + v.vy)
            body.z = start.z + quarter * (m.vz + v.vz)
            if turns:
                even = True
                if uneven:
                    even = is_round(body)
                if even:
                    x, y, z = m.wx + v.wx, m.wy + v.wy, m.wz + v.wz
                    body.qw, body.qx, body.qy, body.qz = start.qw, start.qx, start.qy, start.qz
                    half_turn(body, 0.5 * x, 0.5 * y, 0.5 * z, dt)
                elif not turn_midway(body, start, m, free, v, dt):
                    missed += 1
        return missed

    return kernel(stand_midway, spec)


@inner
def radius_of_cap(a, b):
    """Radius of the smaller round cap of a pair, unbounded where there is none [m]."""
    radius = UNBOUNDED
    if a.shape == CYLINDER or a.shape == CONE:
        radius = a.hx
    if b.shape == CYLINDER or b.shape == CONE:
        radius = min(radius, b.hx)
    return radius


@inner
def is_beyond(contact, point, reach):
    """Whether a point is farther than `reach` from where a contact was carried to."""
    return length(minus(position(point), position(contact))) > reach


@inner
def has_rolled(contact, manifold):
    """Whether the normal has turned since the start, as of what rolls off an edge onto a face."""
    n = manifold_normal(manifold)
    return contact.at_nx * n[0] + contact.at_ny * n[1] + contact.at_nz * n[2] < ROLLED


def make_nearest(spec: Spec) -> Any:
    """Return `kernel(contact, manifold, found) -> index` of the point nearest to a contact's place.

    contact: as it was at the start. -1: the normal has turned away.
    """

    def nearest(contact, manifold, found):
        best, least = -1, UNBOUNDED
        n = manifold_normal(manifold)
        if contact.at_nx * n[0] + contact.at_ny * n[1] + contact.at_nz * n[2] < AGREES:
            return best
        for k in range(found):
            point = manifold.points[k]
            dx, dy, dz = point.x - contact.at_x, point.y - contact.at_y, point.z - contact.at_z
            squared = dx * dx + dy * dy + dz * dz
            if squared < least:
                best, least = k, squared
        return best

    return kernel(nearest, spec)


def make_renamed(spec: Spec) -> Any:
    """Return `kernel(contacts, rows, c, manifold, found, reach) -> index` of a point, or -1.

    The nearest to contact c, within `reach` [m], of those that no contact has, of a pair with the
    contacts from rows[0] on, before rows[1]. Where edges of two bodies lie above each other, as of
    bricks as wide as each other, it is round-off that says whose feature a point is.
    """

    def renamed(contacts, rows, c, manifold, found, reach):
        best, least = -1, reach * reach
        contact, n = contacts[c], manifold_normal(manifold)
        if contact.at_nx * n[0] + contact.at_ny * n[1] + contact.at_nz * n[2] < AGREES:
            return best
        for k in range(found):
            point, named = manifold.points[k], False
            for other in range(rows[0], rows[1]):
                named = named or contacts[other].feature == point.feature
            if named:
                continue
            dx, dy, dz = point.x - contact.x, point.y - contact.y, point.z - contact.z
            squared = dx * dx + dy * dy + dz * dz
            if squared < least:
                best, least = k, squared
        return best

    return kernel(renamed, spec)


def make_look(spec: Spec) -> Any:
    """Return `kernel(state, count, poses, workspace)`: contacts as they are where bodies stand.

    Flat faces that turn pass from face on face to edge on face: of a pair of them that has none of
    its features any more each contact is at the nearest new one, of another pair of them where a
    new one is as near as its own would be. So does what is round and rolls off an edge onto a face,
    if the normal has turned: that of the start would hold back what flies on. Any other point that
    the manifold no longer has stays on its two bodies: see `stay`.
    """
    manifold = make_manifold(spec, spec.shape_pairs)
    compound, place_parts = made_once(spec, "place_parts")
    swept, stay = row_terms(spec).swept, make_stay(spec)
    ordered, nearest = step_terms(spec).ordered_impacts, make_nearest(spec)
    renamed = make_renamed(spec)
    overlooks, ropes = step_terms(spec).overlooks, row_terms(spec).taut
    marks, mark_middle = made_once(spec, "mark_middle")
    arms = row_terms(spec).bilateral and row_terms(spec).levers
    own_normals = has_own_normals(spec)
    caps = any(shape.kind in (CYLINDER, CONE) for shape in shapes_in(spec))

    def look(state, count, poses, workspace):
        bodies, contacts = state.bodies, state.contacts
        scratch = workspace.collision
        points = scratch.manifold.points
        if compound:
            place_parts(bodies)
        first = 0
        while first < count:
            pair = contacts[first].pair
            last, margin, passes_on = first, TOUCHING, False
            while last < count and contacts[last].pair == pair:
                margin = max(margin, abs(contacts[last].phi))
                if ordered:
                    passes_on = passes_on or contacts[last].passed_on == 1
                last += 1
            row = state.pairs[pair]
            a, b = bodies[row.a], bodies[row.b]
            # The middle may be apart where both ends touch: by less than the bodies' sizes.
            size = a.bound if b.shape == PLANE else b.bound
            if a.shape != PLANE and b.shape != PLANE:
                size = min(a.bound, b.bound)
            found = 0
            if overlooks:
                scratch.manifold.reduction[WHOLE] = row.whole
            if not passes_on:  # beyond a seam is another's face, not its edge
                found = manifold(row.kind, a, b, margin + APART * size, scratch)
            persists, one, two = False, has_flat_faces(a), has_flat_faces(b)
            flat, rolled = found > 0 and one and two, False
            reach = UNBOUNDED
            if caps:
                if last - first >= LYING:
                    reach = TILTED * radius_of_cap(a, b)
            for c in range(first, last):
                for k in range(found):
                    persists = persists or points[k].feature == contacts[c].feature
            if found > 0 and one != two and not persists:
                for c in range(first, last):
                    rolled = rolled or has_rolled(contacts[c], scratch.manifold)
            for c in range(first, last):
                contact = contacts[c]
                stay(contact, bodies, poses)
                best = -1
                for k in range(found):
                    if points[k].feature == contact.feature:
                        best = k
                if caps:
                    if best >= 0 and is_beyond(contact, points[best], reach):
                        best = -1
                if best < 0 and (flat or rolled):
                    if persists:
                        rows = first, last
                        best = renamed(contacts, rows, c, scratch.manifold, found, NEAR * size)
                    else:
                        best = nearest(contact, scratch.manifold, found)
                if best >= 0:
                    point = points[best]
                    if ropes:
                        if row.kind == ROPE:
                            contact.span = a.hx - point.phi
                    contact.x, contact.y, contact.z = point.x, point.y, point.z
                    n = manifold_normal(scratch.manifold)
                    if own_normals:
                        n = point_normal(scratch.manifold, best)
                    put_normal(contact, n)
                    if arms:
                        if contact.bilateral == 1:
                            put_mean_ends(contact, row.kind, a, b, bodies, poses)
                    if swept:
                        contact.tangential_x, contact.tangential_y = 0.0, 0.0
                        contact.tangential_z = 0.0
            if marks:
                mark_middle(contacts, first, last, row, False)
            first = last
        if overlooks:
            scratch.manifold.reduction[WHOLE] = 0

    return kernel(look, spec)


def make_stay(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, poses)`: the contact of the start, where the bodies stand.

    Of one that does not last, or is open, each body has the lever that it had: what flies past
    another by more than its size in half a step does not reach to where that has come.
    """
    swept, coupled = row_terms(spec).swept, row_terms(spec).coupled
    joined = row_terms(spec).bilateral
    arms = joined and row_terms(spec).levers

    def stay(contact, bodies, poses):
        body, before = bodies[contact.b], poses[contact.b]
        if body.inv_m == 0.0:
            body, before = bodies[contact.a], poses[contact.a]
        contact.x = contact.at_x + (body.x - before.x)
        contact.y = contact.at_y + (body.y - before.y)
        contact.z = contact.at_z + (body.z - before.z)
        contact.nx, contact.ny, contact.nz = contact.at_nx, contact.at_ny, contact.at_nz
        if swept:
            contact.tangential_x, contact.tangential_y = contact.at_tx, contact.at_ty
            contact.tangential_z = contact.at_tz
            parts = contact.lasts == 0 or contact.phi > TOUCHING
            parts = parts and contact.inv_m_a > 0.0 and contact.inv_m_b > 0.0
            if joined:
                parts = parts and contact.bilateral == 0
            if parts:
                a, start = bodies[contact.a], poses[contact.a]
                shift = Vec3(a.x - start.x, a.y - start.y, a.z - start.z)
                contact.x, contact.y = contact.at_x + shift.x, contact.at_y + shift.y
                contact.z = contact.at_z + shift.z
                contact.tangential_x += shift.x - (body.x - before.x)
                contact.tangential_y += shift.y - (body.y - before.y)
                contact.tangential_z += shift.z - (body.z - before.z)
        if coupled:
            contact.patch_x, contact.patch_y = contact.at_patch_x, contact.at_patch_y
            contact.patch_z = contact.at_patch_z
        if arms:
            if contact.bilateral == 1:
                contact.arm_ax, contact.arm_ay = contact.at_arm_ax, contact.at_arm_ay
                contact.arm_az, contact.arm_bx = contact.at_arm_az, contact.at_arm_bx
                contact.arm_by, contact.arm_bz = contact.at_arm_by, contact.at_arm_bz

    return kernel(stay, spec)


def make_keep_start(spec: Spec) -> Any:
    """Return `kernel(contacts, count)`: keep geometry and impulses of the solve at the start."""
    swept, friction = row_terms(spec).swept, row_terms(spec).frictional
    terms = row_terms(spec)
    torsional, rolling, coupled = terms.torsional, terms.rolling, terms.coupled
    arms = terms.bilateral and terms.levers

    def keep_start(contacts, count):
        for c in range(count):
            contact = contacts[c]
            contact.at_x, contact.at_y, contact.at_z = contact.x, contact.y, contact.z
            contact.at_nx, contact.at_ny, contact.at_nz = contact.nx, contact.ny, contact.nz
            contact.kept_n = contact.lambda_n
            if friction:
                contact.kept_1, contact.kept_2 = contact.lambda_1, contact.lambda_2
            if torsional:
                contact.kept_psi_n = contact.psi_n
            if rolling:
                contact.kept_psi_1, contact.kept_psi_2 = contact.psi_1, contact.psi_2
            if swept:
                contact.at_tx, contact.at_ty = contact.tangential_x, contact.tangential_y
                contact.at_tz = contact.tangential_z
            if coupled:
                contact.at_patch_x, contact.at_patch_y = contact.patch_x, contact.patch_y
                contact.at_patch_z = contact.patch_z
            if arms:
                if contact.bilateral == 1:
                    contact.at_arm_ax, contact.at_arm_ay = contact.arm_ax, contact.arm_ay
                    contact.at_arm_az, contact.at_arm_bx = contact.arm_az, contact.arm_bx
                    contact.at_arm_by, contact.at_arm_bz = contact.arm_by, contact.arm_bz

    return kernel(keep_start, spec)


def make_take_kept(spec: Spec) -> Any:
    """Return `kernel(contact)`: the impulses of the solve at the start."""
    friction = row_terms(spec).frictional
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def take_kept(contact):
        contact.lambda_n = contact.kept_n
        if friction:
            contact.lambda_1, contact.lambda_2 = contact.kept_1, contact.kept_2
        if torsional:
            contact.psi_n = contact.kept_psi_n
        if rolling:
            contact.psi_1, contact.psi_2 = contact.kept_psi_1, contact.kept_psi_2

    return kernel(take_kept, spec)
