"""Pairs enter; contact rows with geometry alone (point, n, phi, feature) leave.

Only the manifolds that a scene's shapes call for are compiled in.
"""

from __future__ import annotations

from typing import Any

from ..compile import kernel
from ..effects import made_once
from ..records import TOUCHING
from ..spec import Spec
from . import SHAPE_PAIRS
from .swept import make_is_fast, make_swept_manifold


def make_manifold(spec: Spec, names: tuple[str, ...]):
    """Return `kernel(kind, a, b, points, normal, scratch, margin) -> count` for these pairs."""
    if not names:

        def no_manifold(kind, a, b, points, normal, scratch, margin):
            return 0

        return kernel(no_manifold, spec)
    own = SHAPE_PAIRS[names[0]]
    own_kind, own_manifold = own.kind, own.make(spec)
    if len(names) == 1:

        def only_manifold(kind, a, b, points, normal, scratch, margin):
            return own_manifold(a, b, points, normal, scratch, margin)

        return kernel(only_manifold, spec)
    others = make_manifold(spec, names[1:])

    def manifold(kind, a, b, points, normal, scratch, margin):
        if kind == own_kind:
            return own_manifold(a, b, points, normal, scratch, margin)
        return others(kind, a, b, points, normal, scratch, margin)

    manifold.__qualname__ += f"_{names[0]}"  # each link of the chain has a symbol of its own
    return kernel(manifold, spec)


def make(spec: Spec):
    """Return `kernel(state, listed, workspace, dt) -> count` of the step's contacts (`memory`).

    listed: rows of `pairs` in use; dt: the timestep [s]. Fast pairs get the contacts of where they
    meet, not of where they start (swept.py).
    -1 when the contact rows are full. Contacts ahead of touching are looked for as far as the two
    bodies' points can move in the step, each by itself: another contact may stop either. Two that
    cannot move make none; with `sleeping` there are such pairs.
    """
    manifold = make_manifold(spec, spec.shape_pairs)
    ahead = spec.has("speculative")
    sweeps = spec.has("fast_bodies")
    is_fast: Any = make_is_fast(spec) if sweeps else None
    swept_manifold: Any = make_swept_manifold(spec, manifold) if sweeps else None
    share = 0.5 if spec.has("midpoint") else 1.0
    compound = spec.has("compound")
    sleeps, still = made_once(spec, "is_still")

    def narrow_phase(state, listed, workspace, dt):
        bodies, motion, pairs = state.bodies, state.motion, state.pairs
        contacts, points, normal = state.contacts, workspace.points, workspace.normal
        scratch = workspace.collision
        total = 0
        margin = TOUCHING
        for p in range(listed):
            i, j = pairs[p].a, pairs[p].b
            owner_i, owner_j = i, j
            if compound:
                owner_i, owner_j = bodies[i].owner, bodies[j].owner
            if sleeps:
                if still(bodies[owner_i]) and still(bodies[owner_j]):
                    continue
            fast, met = False, 0.0
            dx, dy, dz = 0.0, 0.0, 0.0
            if ahead:
                ma, mb = motion[owner_i], motion[owner_j]
                margin = TOUCHING + ma.reach + mb.reach
            if sweeps:
                ma, mb = motion[owner_i], motion[owner_j]
                dx = (mb.vx - ma.vx + share * (mb.dvx - ma.dvx)) * dt
                dy = (mb.vy - ma.vy + share * (mb.dvy - ma.dvy)) * dt
                dz = (mb.vz - ma.vz + share * (mb.dvz - ma.dvz)) * dt
                fast = is_fast(bodies[i], bodies[j], dx, dy, dz)
                if fast:
                    count, met = swept_manifold(
                        pairs[p].kind, bodies[i], bodies[j], dx, dy, dz, points, normal, scratch,
                        margin,
                    )  # fmt: skip
            if not fast:
                count = manifold(
                    pairs[p].kind, bodies[i], bodies[j], points, normal, scratch, margin
                )
            if total + count > contacts.shape[0]:
                return -1
            for k in range(count):
                contact = contacts[total]
                point = points[k]
                contact.pair, contact.a, contact.b = p, owner_i, owner_j
                contact.key = pairs[p].key
                contact.feature = point.feature
                contact.x, contact.y, contact.z = point.x, point.y, point.z
                contact.nx, contact.ny, contact.nz = normal[0], normal[1], normal[2]
                contact.phi = point.phi
                if sweeps:
                    # Across n B's surface is met where B will be then.
                    along = dx * normal[0] + dy * normal[1] + dz * normal[2]
                    contact.beside_x = met * (dx - along * normal[0])
                    contact.beside_y = met * (dy - along * normal[1])
                    contact.beside_z = met * (dz - along * normal[2])
                total += 1
        return total

    return kernel(narrow_phase, spec)
