"""Time of impact of two bodies on their shapes: Newton's method on their separation, safeguarded.

Newton's method on the separation phi(t) of a contact's features, at the poses of free motion:
    x(t) = x + v t + a t^2/2,    q(t): turned for t,    t <- t - phi / (d phi / dt)
a: by forces, or of what contacts hold as in the last part of a step (`approach.make_expect`).
From before a meeting of convex bodies it does not pass it; one that only grazes or misses ends
where the surfaces part. Where they overlap and part, the middle of the time between is tried.
Bodies that part and turn may meet with any of their features: they are followed from the start, as
far at a time as none of their points can move.
Source of the idea: conservative advancement (B. Mirtich, 1996).
"""

from __future__ import annotations

from typing import Any

from .approach import (
    ELSEWHERE,
    GUESSED,
    NEVER,
    make_approach,
    make_change_ahead,
    make_nearest_rate,
    relative_velocity,
)
from .body_turn import make_free_turn
from .collide.manifold.own_normals import has_own_normals, point_normal
from .collide.manifold.point import WHOLE, manifold_normal
from .collide.narrow_phase import make_manifold
from .collide.records import put_normal
from .compile import kernel, separate
from .effects import has_hook, made_once
from .records import INSTANT, PLANE, TOUCHING
from .spec import Spec
from .step_terms import step_terms
from .vectors import length

# Looks at the pair: Newton's steps find a meeting in some five; those of bodies that are followed
# are 1/STRIDE at most, and halving a step of 1 s down to what INSTANT tells apart takes 40.
PASSES = 80
# Shortest, of what is left of the step, in which bodies that part are looked at again.
STRIDE = 1.0 / 32.0
# A stride in which bodies move by more than this share of the smaller could pass all of a meeting
# that glances: it ends where surfaces that near each other would meet [-].
PASSED = 0.1
# Earliest meeting [s]: a part of the step before it takes time, or what forces do in it is lost.
SOONEST = 2.0 * INSTANT
# They meet where they are nearer than this [m]: inside of TOUCHING, so that the part that ends
# there finds them touching, whatever round-off its own look at them has.
MET = 0.25 * TOUCHING
# Rows of `memory.Trial`: the two bodies that move, and the rows that collide (parts of them).
A, B, PART_A, PART_B = range(4)


def make_locate(spec: Spec) -> Any:
    """Return `kernel(state, count, contact, workspace, params) -> when` they meet [s], or NEVER.

    contact: one ahead of the first `count`, with a first guess in `due`. The rows of the bodies are
    left as they were. What is not found after PASSES is where it was looked for last, and counted
    in the scratch of collisions.
    """
    manifold, approach = make_manifold(spec, spec.shape_pairs), make_approach(spec)
    change_ahead, nearest_rate = make_change_ahead(spec), make_nearest_rate(spec)
    turns, compound = step_terms(spec).turns, has_hook(spec, "place_parts")
    turn: Any = make_free_turn(spec)
    overlooks, own_normals = step_terms(spec).overlooks, has_own_normals(spec)
    _, place_part = made_once(spec, "place_part")

    def displace(body, velocity, m, t, left):
        share = 0.5 * t * t / left
        body.x += m.vx * t + share * m.ahead_x
        body.y += m.vy * t + share * m.ahead_y
        body.z += m.vz * t + share * m.ahead_z
        if turns:
            velocity.wx, velocity.wy, velocity.wz = m.wx, m.wy, m.wz
            turn(body, velocity, t)

    displace = kernel(displace, spec)

    def touches(contacts, count, pair, feature):
        # Whether a feature of the pair touches as the part begins.
        for c in range(count):
            contact = contacts[c]
            if contact.pair == pair and contact.feature == feature:
                return contact.phi <= TOUCHING
        return False

    touches = kernel(touches, spec)

    def deepest_new(contacts, count, pair, points, found):
        # Of the points found the deepest that does not touch as the part begins; -1: none.
        deepest = -1
        for k in range(found):
            if deepest < 0 or points[k].phi < points[deepest].phi:
                if not touches(contacts, count, pair, points[k].feature):
                    deepest = k
        return deepest

    deepest_new = kernel(deepest_new, spec)

    def locate(state, count, ahead, workspace, params):
        bodies, velocities, motion = state.bodies, state.velocities, state.motion
        trial = workspace.trial
        kept, spun = trial.bodies, trial.velocities
        touching = workspace.collision.manifold
        points = touching.points
        row = state.pairs[ahead.pair]
        i, j = row.a, row.b
        owner_i, owner_j = i, j
        if compound:
            owner_i, owner_j = bodies[i].owner, bodies[j].owner
        ma, mb = motion[owner_i], motion[owner_j]
        kept[A], kept[B] = bodies[owner_i], bodies[owner_j]
        kept[PART_A], kept[PART_B] = bodies[i], bodies[j]
        speed, size = length(relative_velocity(ma, mb)), bodies[j].bound
        if bodies[i].shape != PLANE:
            size = min(bodies[i].bound, size)
        spun[A], spun[B] = velocities[owner_i], velocities[owner_j]
        left = params.dt
        margin = TOUCHING + ma.reach + mb.reach
        t, when, late = ahead.due, NEVER, False
        marches, own = ahead.located == ELSEWHERE, ahead.located == GUESSED
        others = False  # of its pair another point meets before it
        # What overlaps as the part begins, and parts, has not met yet.
        first = marches or ahead.phi < -MET
        low, high = 0.0, NEVER  # apart, overlapping
        if overlooks:
            touching.reduction[WHOLE] = row.whole
        contact = trial.contact[0]
        contact.a, contact.b = owner_i, owner_j
        for _ in range(PASSES):
            bodies[owner_i], bodies[owner_j] = kept[A], kept[B]
            displace(bodies[owner_i], spun[A], ma, t, left)
            displace(bodies[owner_j], spun[B], mb, t, left)
            if compound:
                place_part(bodies, i)
                place_part(bodies, j)
            found = manifold(row.kind, bodies[i], bodies[j], margin, workspace.collision)
            if found == 0:
                when = NEVER
                break
            least = 0
            for k in range(1, found):
                if points[k].phi < points[least].phi:
                    least = k
            seen = least
            if own:
                lost = True
                for k in range(found):
                    if points[k].feature == ahead.feature:
                        seen, lost = k, False
                if lost:  # renamed, as points of a rim are: what lasts is not what is ahead
                    met = deepest_new(state.contacts, count, ahead.pair, points, found)
                    if met >= 0:
                        seen = met
                if abs(points[seen].phi) <= MET:
                    # Has another of the pair met already? What it stands on has not: it lasts.
                    met = deepest_new(state.contacts, count, ahead.pair, points, found)
                    if met >= 0 and points[met].phi < -TOUCHING:
                        own, others, first, seen, low = False, True, True, met, 0.0
            elif others:
                met = deepest_new(state.contacts, count, ahead.pair, points, found)
                if met >= 0:
                    seen = met
            point = points[seen]
            contact.x, contact.y, contact.z = point.x, point.y, point.z
            n = manifold_normal(touching)
            if own_normals:
                n = point_normal(touching, seen)
            put_normal(contact, n)
            phi = point.phi
            dv = change_ahead(contact, motion)
            v = approach(contact, bodies, motion) + dv * t / left
            if abs(phi) <= MET:
                # Newton's next step has twice as many digits: no friction with a lever of its own.
                when = t - phi / v if v < 0.0 else NEVER
                if when < NEVER or not marches:
                    break
            if phi < -MET and not (first and v >= 0.0):
                high = t
            else:
                low = t
            first = first and phi < -MET
            if marches and high == NEVER:
                when = NEVER
                if t >= left:
                    break
                rate = abs(dv) - nearest_rate(contact, bodies, motion)
                stride = STRIDE * left
                if rate * stride < phi:
                    stride = phi / rate if rate * left > phi else left
                elif v < 0.0 and stride * speed > PASSED * size:
                    stride = min(stride, -phi / v)
                t = min(t + stride, left)
                continue
            before = t
            if v < 0.0:
                t -= phi / v
            elif high == NEVER:
                # They part: never met, unless they turn and meet in the rest.
                if not turns or late:
                    when = NEVER
                    break
                t, late = left, True
                continue
            if v >= 0.0 or not low < t < high:
                t = 0.5 * (low + high) if high < NEVER else t
            t = when = min(t, left)
            if t == before:
                when = NEVER if phi > TOUCHING else t
                break
        else:
            workspace.collision.not_converged[0].impact += 1
        bodies[owner_i], bodies[owner_j] = kept[A], kept[B]
        bodies[i], bodies[j] = kept[PART_A], kept[PART_B]
        if overlooks:
            touching.reduction[WHOLE] = 0
        return max(when, SOONEST)

    return separate(kernel(locate, spec), spec)
