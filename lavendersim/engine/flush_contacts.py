"""Contacts that a body passes over as it slides or rolls across the seam of two flush faces.

Where bodies touch at an edge or a corner, the normals of their contact are a cone, and a manifold
has one of them. Of a box that slides from one tile to the next it may be the side of the next tile,
along the motion. But bodies that some direction m separates, and that do not approach along it, do
not meet. The directions looked at are the normals of what the body rests on:

    s(m) >= -FLUSH slop,   m . v >= 0        s(m): separation of the pair along m

A step higher than that is met.
"""

from __future__ import annotations

from typing import Any

from .collide.shapes import make_radius, make_support
from .compile import kernel
from .effects.impact_order import CREEP, ROUND_OFF
from .records import PLANE, TOUCHING
from .spec import Spec
from .vectors import Vec3

# Height of a step that is none, in slops.
FLUSH = 10.0
# Normals whose cosine is larger are one.
ALONG = 1.0 - 1e-12
# Contacts of a part of which each is held against each.
MOST = 512


def make_drop_flush(spec: Spec, approach: Any) -> Any:
    """Return `kernel(state, count, workspace, params) -> count`: without such contacts.

    approach: `kernel(contact, bodies, motion, left) -> (v, a)`, see `impact_order`. None where no
    pair has an edge.
    """
    if not any("plane" not in name for name in spec.shape_pairs):
        return None
    support, radius = make_support(spec), make_radius(spec)
    turns = spec.has("rotation")
    sleeps = spec.has("sleeping")

    def passes(state, contact, other, workspace, params, least):
        bodies, motion = state.bodies, state.motion
        # The normal of the other contact, as one from A to B of this pair: from what it does not
        # share with it to what it shares.
        shared_b = other.a == contact.b or other.b == contact.b
        if shared_b and bodies[contact.b].inv_m == 0.0:
            shared_b = False
        shared = contact.b if shared_b else contact.a
        sign = 1.0 if other.b == shared else -1.0
        if not shared_b:
            sign = -sign
        x, y, z = sign * other.nx, sign * other.ny, sign * other.nz
        if x * contact.nx + y * contact.ny + z * contact.nz > ALONG:
            return False
        row = state.pairs[contact.pair]
        a, b = bodies[row.a], bodies[row.b]
        hulls = workspace.collision.hulls
        p, q = support(a, Vec3(x, y, z), hulls), support(b, Vec3(-x, -y, -z), hulls)
        apart = x * (b.x + q.x - a.x - p.x)
        apart += y * (b.y + q.y - a.y - p.y)
        apart += z * (b.z + q.z - a.z - p.z)
        if apart - radius(a) - radius(b) < -(FLUSH * params.slop + TOUCHING):
            return False
        ma, mb = motion[contact.a], motion[contact.b]
        v = x * (mb.vx - ma.vx) + y * (mb.vy - ma.vy) + z * (mb.vz - ma.vz)
        if turns:
            rx, ry, rz = b.x + q.x, b.y + q.y, b.z + q.z
            body_a, body_b = bodies[contact.a], bodies[contact.b]
            rx, ry, rz = rx - body_b.x, ry - body_b.y, rz - body_b.z
            v += x * (mb.wy * rz - mb.wz * ry)
            v += y * (mb.wz * rx - mb.wx * rz)
            v += z * (mb.wx * ry - mb.wy * rx)
            rx, ry, rz = a.x + p.x - body_a.x, a.y + p.y - body_a.y, a.z + p.z - body_a.z
            v -= x * (ma.wy * rz - ma.wz * ry)
            v -= y * (ma.wz * rx - ma.wx * rz)
            v -= z * (ma.wx * ry - ma.wy * rx)
        return v >= -least

    passes = kernel(passes, spec)

    def is_movable(body):
        movable = body.inv_m > 0.0
        if sleeps:
            movable = movable or body.asleep == 1
        return movable

    is_movable = kernel(is_movable, spec)

    def drop_flush(state, count, workspace, params):
        bodies, contacts, motion = state.bodies, state.contacts, state.motion
        if count > MOST:
            return count
        kept = 0
        for c in range(count):
            contact = contacts[c]
            row = state.pairs[contact.pair]
            flush = False
            if bodies[row.a].shape != PLANE and bodies[row.b].shape != PLANE:
                far = motion[contact.a].reach + motion[contact.b].reach
                least = CREEP + ROUND_OFF * far / params.dt
                v, _ = approach(contact, bodies, motion, params.dt)
                if v < -least:
                    for o in range(count):
                        other = contacts[o]
                        if other.pair == contact.pair or other.phi > params.slop + TOUCHING:
                            continue
                        joins = other.a == contact.a or other.b == contact.a
                        joins = joins and is_movable(bodies[contact.a])
                        if not joins:
                            joins = other.a == contact.b or other.b == contact.b
                            joins = joins and is_movable(bodies[contact.b])
                        if joins and passes(state, contact, other, workspace, params, least):
                            flush = True
                            break
            contact.waits = 1 if flush else 0
        for c in range(count):
            if contacts[c].waits == 0:
                if kept < c:
                    contacts[kept] = contacts[c]
                kept += 1
        return kept

    return kernel(drop_flush, spec)
