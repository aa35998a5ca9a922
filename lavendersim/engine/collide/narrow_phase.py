"""Pairs enter; contact rows with geometry alone (point, n, phi, feature) leave.

Only the manifolds that a scene's shapes call for are compiled in.
"""

from __future__ import annotations

from ..compile import kernel
from ..spec import Spec
from . import SHAPE_PAIRS


def make_manifold(spec: Spec, names: tuple[str, ...]):
    """Return `kernel(kind, a, b, points, normal, scratch) -> count` for these shape pairs."""
    if not names:

        def no_manifold(kind, a, b, points, normal, scratch):
            return 0

        return kernel(no_manifold, spec)
    own_kind, _, module = SHAPE_PAIRS[names[0]]
    own_manifold = module.make(spec)
    if len(names) == 1:

        def only_manifold(kind, a, b, points, normal, scratch):
            return own_manifold(a, b, points, normal, scratch)

        return kernel(only_manifold, spec)
    others = make_manifold(spec, names[1:])

    def manifold(kind, a, b, points, normal, scratch):
        if kind == own_kind:
            return own_manifold(a, b, points, normal, scratch)
        return others(kind, a, b, points, normal, scratch)

    manifold.__qualname__ += f"_{names[0]}"  # each link of the chain has a symbol of its own
    return kernel(manifold, spec)


def make(spec: Spec):
    """Return `kernel(bodies, pairs, contacts, points, normal, scratch) -> count`, -1 when full."""
    manifold = make_manifold(spec, spec.shape_pairs)

    def narrow_phase(bodies, pairs, contacts, points, normal, scratch):
        total = 0
        for p in range(pairs.shape[0]):
            i, j = pairs[p].a, pairs[p].b
            count = manifold(pairs[p].kind, bodies[i], bodies[j], points, normal, scratch)
            if total + count > contacts.shape[0]:
                return -1
            for k in range(count):
                contact = contacts[total]
                point = points[k]
                contact.pair, contact.a, contact.b = p, i, j
                contact.feature = point.feature
                contact.x, contact.y, contact.z = point.x, point.y, point.z
                contact.nx, contact.ny, contact.nz = normal[0], normal[1], normal[2]
                contact.phi = point.phi
                total += 1
        return total

    return kernel(narrow_phase, spec)
