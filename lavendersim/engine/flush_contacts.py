"""Contacts that a body passes over as it slides or rolls across the seam of two flush faces.

Where bodies touch at an edge or a corner, the normals of their contact are a cone, and a manifold
has one of them. Of a box that slides from one tile to the next it may be the side of the next tile,
along the motion. But bodies that some direction m separates, and that do not approach along it, do
not meet. The directions looked at are the normals of what the body rests on:

    s(m) >= -FLUSH slop,   m . v >= 0        s(m): separation of the pair along m

A step higher than that is met. Tiles that a fast body is still far from as the part begins are
looked at likewise, whatever their gap does first: it is about to pass on to them, and at the middle
of the step the edge of what it lies on (`midpoint_geometry.make_look`) is not what carries it. Of
what is on that edge itself, higher than flush, the middle is the face beyond.
"""

from __future__ import annotations

from typing import Any

from .approach import CREEP, FAR, make_rate, make_slowest
from .collide.nearest_image import place_beside
from .collide.pairs import SHAPE_PAIRS
from .collide.shape_kernels import make_best_face, make_radius, make_support
from .collide.shapes import has_cavity, has_mesh
from .compile import kernel
from .contact_lists import make_list_contacts
from .effects import has_hook
from .impact_rows import FLUSH, make_keep_present
from .records import BOWL, DRUM, MESH, PLANE, ROPE, SPHERE, TOUCHING
from .row_terms import row_terms
from .spec import Spec
from .vectors import Vec3, dot, minus, plus, position

# Normals whose cosine is larger are one.
ALONG = 1.0 - 1e-12


def make_drop_flush(spec: Spec) -> Any:
    """Return `kernel(state, count, workspace, params) -> count`: without such contacts.

    Of rows with the `rate` of their gaps, none of which waits.
    None where no pair has an edge.
    """
    if not any(SHAPE_PAIRS[name].convex for name in spec.shape_pairs):
        return None
    support, radius, best_face = make_support(spec), make_radius(spec), make_best_face(spec)
    rate, slowest = make_rate(spec), make_slowest(spec)
    keep_present, list_contacts = make_keep_present(spec), make_list_contacts(spec)
    sleeps, connects = has_hook(spec, "update_sleeping"), spec.connects
    joins, cavities = row_terms(spec).bilateral, has_cavity(spec)
    meshes, beside = has_mesh(spec), place_beside(spec)

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
        m = Vec3(x, y, z)
        row = state.pairs[contact.pair]
        a, b = bodies[row.a], bodies[row.b]
        hulls = workspace.collision.hulls
        p = plus(position(a), support(a, m, hulls))
        q = plus(beside(a, b), support(b, Vec3(-x, -y, -z), hulls))
        if dot(m, minus(q, p)) - radius(a) - radius(b) < -(FLUSH * params.slop + TOUCHING):
            return False
        arm_a = minus(p, position(bodies[contact.a]))
        arm_b = minus(q, beside(bodies[contact.a], bodies[contact.b]))
        v = rate(m, motion[contact.a], motion[contact.b], arm_a, arm_b)
        return v >= -least

    passes = kernel(passes, spec)

    def is_on_edge(state, contact, i, hulls, slop):
        # Whether body i is on an edge of the other body: above its face by more than flush.
        row = state.pairs[contact.pair]
        sign, base, on_it = 1.0, row.a, row.b
        if contact.a == i:
            sign, base, on_it = -1.0, row.b, row.a
        n = Vec3(sign * contact.nx, sign * contact.ny, sign * contact.nz)
        face, outward = best_face(state.bodies[base], n, hulls)
        return face >= 0 and state.bodies[on_it].bound * (1.0 - dot(n, outward)) > FLUSH * slop

    is_on_edge = kernel(is_on_edge, spec)

    def is_movable(body):
        movable = body.inv_m > 0.0
        if sleeps:
            movable = movable or body.asleep == 1
        return movable

    is_movable = kernel(is_movable, spec)

    def rests_beside(state, contact, i, workspace, params, least):
        # Whether what body i of the contact touches besides makes the contact one to pass over.
        contacts, lists = state.contacts, workspace.contact_lists
        flush = False
        if is_movable(state.bodies[i]):
            entry = lists.first[i]
            while entry >= 0:
                c = entry // 2
                other = lists.listed[c]
                entry = lists.following[entry]
                if other.pair == contact.pair:
                    continue
                if joins:
                    if state.pairs[other.pair].kind < ROPE:  # it is no face
                        continue
                if passes(state, contact, other, workspace, params, least):
                    flush, below = True, contacts[c]
                    if not is_on_edge(state, below, i, workspace.collision.hulls, params.slop):
                        below.passed_on = 1
        return flush

    rests_beside = kernel(rests_beside, spec)

    def drop_flush(state, count, workspace, params):
        bodies, contacts, motion = state.bodies, state.contacts, state.motion
        listed, dropped = False, False
        for c in range(count):
            contact = contacts[c]
            row = state.pairs[contact.pair]
            if connects:
                if row.kind <= ROPE:
                    continue
            ajar = contact.phi > params.slop and contact.located != FAR
            ajar = ajar and not (bodies[row.a].shape == SPHERE and bodies[row.b].shape == SPHERE)
            if contact.rate >= -CREEP and not ajar:
                continue
            if cavities:
                if bodies[row.a].shape == BOWL or bodies[row.a].shape == DRUM:  # without an edge
                    continue
            if meshes:
                if bodies[row.a].shape == MESH:  # `mesh_points` tells its edges
                    continue
            if bodies[row.a].shape != PLANE and bodies[row.b].shape != PLANE:
                least = slowest(contact, bodies, motion)
                if contact.rate < -least or ajar:
                    if not listed:
                        touching = params.slop + TOUCHING
                        list_contacts(contacts, count, touching, workspace.contact_lists)
                        listed = True
                    flush = rests_beside(state, contact, contact.a, workspace, params, least)
                    if rests_beside(state, contact, contact.b, workspace, params, least):
                        flush = True
                    if flush:
                        contact.waits, dropped = 1, True
        return keep_present(contacts, count) if dropped else count

    return kernel(drop_flush, spec)
