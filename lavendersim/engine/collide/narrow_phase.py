"""Narrow phase: contact points, normals and separations of the pairs that the broad phase lists.

Only the manifolds that a scene's shapes require are compiled in.
"""

from __future__ import annotations

from typing import Any

from ..compile import inner, kernel
from ..effects import has_hook, made_once
from ..overlooked_points import make_note_left_out
from ..records import ROPE, TOUCHING
from ..row_terms import make_is_soft, row_terms
from ..spec import Spec
from ..step_terms import step_terms
from ..vectors import Vec3, dot
from .joint import is_couple, is_motor, is_stop, make_joint, put_ends
from .manifold.own_normals import (
    has_own_normals,
    make_has_shared,
    point_normal,
    put_point_normal,
)
from .manifold.point import LEFT_OUT, WHOLE, manifold_normal
from .nearest_image import make_beside, make_swept_beside
from .pairs import SHAPE_PAIRS
from .records import put_normal
from .rope import make_rope
from .swept import make_is_apart, make_is_fast, make_swept_manifold

# Springs may give in a step what they store, or hit a body that does not move yet, which then
# meets others: contacts by `contact_spring_law` are looked for so many reaches of the fastest
# ahead, what springs may give it included [-].
REACHES = 4.0


@inner
def displacement(of_a, of_b, share, dt):
    """Displacement of B relative to A in the step [m], with a share of its change of velocity."""
    return Vec3(
        (of_b.vx - of_a.vx + share * (of_b.dvx - of_a.dvx)) * dt,
        (of_b.vy - of_a.vy + share * (of_b.dvy - of_a.dvy)) * dt,
        (of_b.vz - of_a.vz + share * (of_b.dvz - of_a.dvz)) * dt,
    )


def make_manifold(spec: Spec, names: tuple[str, ...]):
    """Return `kernel(kind, a, b, margin, scratch) -> count`: these pairs, ropes and joints.

    Where a pair has normals of single points, every point has one then. In a periodic cell it is
    of the image of B that is nearest to A.
    """
    return make_beside(spec, _make_manifold_in_place(spec, names))


def _make_manifold_in_place(spec: Spec, names: tuple[str, ...]):
    any_pair = _make_manifold_of_joints(spec, names)
    if not has_own_normals(spec):
        return any_pair
    has_shared = make_has_shared(spec)

    def manifold_with_normals(kind, a, b, margin, scratch):
        count = any_pair(kind, a, b, margin, scratch)
        if has_shared(kind):
            manifold = scratch.manifold
            for k in range(count + manifold.reduction[LEFT_OUT]):
                put_point_normal(manifold, k, manifold_normal(manifold))
        return count

    return kernel(manifold_with_normals, spec)


def _make_manifold_of_joints(spec: Spec, names: tuple[str, ...]):
    others = _make_manifold_of_ropes(spec, names)
    if not row_terms(spec).bilateral:
        return others
    joint = make_joint(spec)

    def manifold_or_joint(kind, a, b, margin, scratch):
        if kind < ROPE:
            return joint(kind, a, b, margin, scratch)
        return others(kind, a, b, margin, scratch)

    return kernel(manifold_or_joint, spec)


def _make_manifold_of_ropes(spec: Spec, names: tuple[str, ...]):
    of_shapes = _make_manifold_of_shapes(spec, names)
    if not row_terms(spec).taut:
        return of_shapes
    rope = make_rope(spec)

    def manifold_or_rope(kind, a, b, margin, scratch):
        if kind == ROPE:
            return rope(a, b, margin, scratch)
        return of_shapes(kind, a, b, margin, scratch)

    return kernel(manifold_or_rope, spec)


def _make_manifold_of_shapes(spec: Spec, names: tuple[str, ...]):
    if not names:

        def no_manifold(kind, a, b, margin, scratch):
            return 0

        return kernel(no_manifold, spec)
    own = SHAPE_PAIRS[names[0]]
    own_kind, own_manifold = own.kind, own.make(spec)
    if len(names) == 1:

        def only_manifold(kind, a, b, margin, scratch):
            return own_manifold(a, b, margin, scratch)

        return kernel(only_manifold, spec)
    others = _make_manifold_of_shapes(spec, names[1:])

    def manifold(kind, a, b, margin, scratch):
        if kind == own_kind:
            return own_manifold(a, b, margin, scratch)
        return others(kind, a, b, margin, scratch)

    return kernel(manifold, spec)


def make(spec: Spec):
    """Return `kernel(state, listed, workspace, dt) -> count` of the step's contacts (`memory`).

    listed: rows of the pairs in use; dt: the timestep [s]. Fast pairs get the contacts of where
    they meet, not of where they start (swept.py).
    -1 when the contact rows are full. Speculative contacts are looked for as far as the two bodies'
    points can move in the step, each by itself: another contact may stop either. Two that cannot
    move make none; with `sleeping` there are such pairs.
    """
    manifold = make_manifold(spec, spec.shape_pairs)
    speculative = step_terms(spec).ahead
    sweeps = row_terms(spec).swept
    is_fast: Any = make_is_fast(spec) if sweeps else None
    # Images of a periodic cell are nearer than bodies' own places.
    culls = sweeps and not (has_hook(spec, "find_pairs") or step_terms(spec).periodic)
    is_apart: Any = make_is_apart(spec) if culls else None
    swept_manifold: Any = None
    if sweeps:
        in_place = _make_manifold_in_place(spec, spec.shape_pairs)
        swept_manifold = make_swept_beside(spec, make_swept_manifold(spec, in_place))
    share = 0.5 if step_terms(spec).mean_flight else 1.0
    compound, ropes = has_hook(spec, "place_parts"), row_terms(spec).taut
    bilateral, levers = row_terms(spec).bilateral, row_terms(spec).levers
    bounded, stopped = row_terms(spec).bounded, row_terms(spec).stopped
    sleeps, still = made_once(spec, "is_still")
    overlooks, springs = step_terms(spec).overlooks, row_terms(spec).elastic
    own_normals = has_own_normals(spec)
    is_soft: Any = make_is_soft(spec) if springs else None
    marks, mark_middle = made_once(spec, "mark_middle")
    note_left_out: Any = make_note_left_out(spec) if overlooks else None

    def narrow_phase(state, listed, workspace, dt):
        bodies, motion, pairs, contacts = state.bodies, state.motion, state.pairs, state.contacts
        scratch = workspace.collision
        points = scratch.manifold.points
        total = 0
        margin = TOUCHING
        reduction = scratch.manifold.reduction
        if overlooks:
            workspace.overlooked.noted[0] = 0
        widest = 0.0
        if springs:
            for i in range(motion.shape[0]):
                widest = max(widest, motion[i].reach + dt * state.velocities[i].released)
            widest = TOUCHING + REACHES * widest
        for p in range(listed):
            i, j = pairs[p].a, pairs[p].b
            owner_i, owner_j = i, j
            if compound:
                owner_i, owner_j = bodies[i].owner, bodies[j].owner
            if sleeps:
                if still(bodies[owner_i]) and still(bodies[owner_j]):
                    continue
            fast, until_impact = False, 0.0
            if overlooks:
                reduction[WHOLE], reduction[LEFT_OUT] = pairs[p].whole, 0
            d = Vec3(0.0, 0.0, 0.0)
            if speculative:
                ma, mb = motion[owner_i], motion[owner_j]
                margin = TOUCHING + ma.reach + mb.reach
                if springs:
                    if is_soft(pairs[p]):
                        margin = max(margin, widest)
            if sweeps:
                d = displacement(motion[owner_i], motion[owner_j], share, dt)
                if culls:
                    if is_apart(bodies[i], bodies[j], d, margin):
                        continue
                fast = is_fast(bodies[i], bodies[j], d)
                if fast:
                    count, until_impact = swept_manifold(
                        pairs[p].kind, bodies[i], bodies[j], d, margin, scratch
                    )
            if not fast:
                count = manifold(pairs[p].kind, bodies[i], bodies[j], margin, scratch)
            if total + count > contacts.shape[0]:
                return -1
            n = manifold_normal(scratch.manifold)
            if overlooks:
                # Points of fast bodies are moved to where they meet: none is kept of the others.
                if reduction[LEFT_OUT] > 0 and not fast:
                    if not note_left_out(p, owner_i, owner_j, count, n, workspace):
                        return -1
            for k in range(count):
                contact = contacts[total]
                point = points[k]
                if own_normals:
                    n = point_normal(scratch.manifold, k)
                contact.pair, contact.a, contact.b = p, owner_i, owner_j
                contact.key = pairs[p].key
                contact.feature = point.feature
                contact.x, contact.y, contact.z = point.x, point.y, point.z
                put_normal(contact, n)
                contact.phi = point.phi
                if ropes:
                    contact.span = bodies[i].hx - point.phi if pairs[p].kind == ROPE else 0.0
                if bilateral:
                    joined = pairs[p].kind < ROPE
                    if stopped:
                        contact.stop = 1 if joined and is_stop(pairs[p].kind) else 0
                        joined = joined and contact.stop == 0
                    contact.bilateral = 1 if joined else 0
                    if bounded:
                        contact.motor = 1 if joined and is_motor(pairs[p].kind) else 0
                        contact.couple = 1 if joined and is_couple(pairs[p].kind) else 0
                    if levers and contact.bilateral == 1:
                        a, b = bodies[owner_i], bodies[owner_j]
                        put_ends(contact, pairs[p].kind, bodies[i], bodies[j], a, b)
                if sweeps:
                    # Across n B's surface is touched where B will be at the impact.
                    along = dot(d, n)
                    contact.tangential_x = until_impact * (d.x - along * n.x)
                    contact.tangential_y = until_impact * (d.y - along * n.y)
                    contact.tangential_z = until_impact * (d.z - along * n.z)
                total += 1
            if marks:
                mark_middle(contacts, total - count, total, pairs[p], True)
        if overlooks:
            reduction[WHOLE] = 0
        return total

    return kernel(narrow_phase, spec)
