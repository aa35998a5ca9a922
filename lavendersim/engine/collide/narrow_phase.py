"""Pairs enter; contact rows with geometry alone (point, n, phi, feature) leave.

Only the manifolds that a scene's shapes call for are compiled in.
"""

from __future__ import annotations

from ..compile import kernel
from ..spec import Spec
from . import SHAPE_PAIRS


def unused(spec: Spec):
    """Stand in for a manifold no pair of the scene needs: never called, pruned with its branch."""

    def no_manifold(a, b, points, normal, scratch):
        return 0

    return kernel(no_manifold, spec)


def make(spec: Spec):
    """Return `kernel(bodies, pairs, contacts, points, normal, scratch) -> count`, -1 when full."""
    made = {
        name: module.make(spec) if spec.collides(name) else unused(spec)
        for name, (_, _, module) in SHAPE_PAIRS.items()
    }
    sphere_plane, with_sphere_plane = made["sphere_plane"], spec.collides("sphere_plane")
    box_plane, with_box_plane = made["box_plane"], spec.collides("box_plane")
    sphere_sphere, with_sphere_sphere = made["sphere_sphere"], spec.collides("sphere_sphere")
    sphere_box, with_sphere_box = made["sphere_box"], spec.collides("sphere_box")
    box_box, with_box_box = made["box_box"], spec.collides("box_box")

    def narrow_phase(bodies, pairs, contacts, points, normal, scratch):
        total = 0
        for p in range(pairs.shape[0]):
            kind = pairs[p].kind
            i, j = pairs[p].a, pairs[p].b
            a, b = bodies[i], bodies[j]
            count = 0
            if with_sphere_plane:
                if kind == 0:
                    count = sphere_plane(a, b, points, normal, scratch)
            if with_box_plane:
                if kind == 1:
                    count = box_plane(a, b, points, normal, scratch)
            if with_sphere_sphere:
                if kind == 2:
                    count = sphere_sphere(a, b, points, normal, scratch)
            if with_sphere_box:
                if kind == 3:
                    count = sphere_box(a, b, points, normal, scratch)
            if with_box_box:
                if kind == 4:
                    count = box_box(a, b, points, normal, scratch)
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
