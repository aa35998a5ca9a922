"""Normals of single points, of pairs whose manifold has no normal that all of its points share.

They stand behind the shared one in `Manifold.normal`, three numbers for each point. Where no pair
of an engine has them the array ends before, and nothing here is compiled.
"""

from __future__ import annotations

from typing import Any

from ...compile import inner, kernel
from ...spec import Spec
from ...vectors import Vec3
from ..shape_pair import ShapePair

SHARED = 3  # numbers of the normal that all points share


def _own(spec: Spec) -> list[ShapePair]:
    from ..pairs import SHAPE_PAIRS

    return [SHAPE_PAIRS[name] for name in spec.shape_pairs if SHAPE_PAIRS[name].own_normals]


def has_own_normals(spec: Spec) -> bool:
    """Whether a pair has points with normals of their own."""
    return bool(_own(spec))


@inner
def put_point_normal(manifold, k, n):
    """Write the normal of point k."""
    at = SHARED + 3 * k
    manifold.normal[at], manifold.normal[at + 1], manifold.normal[at + 2] = n.x, n.y, n.z


@inner
def point_normal(manifold, k):
    """Return the normal of point k; only where a pair has normals of single points."""
    at = SHARED + 3 * k
    return Vec3(manifold.normal[at], manifold.normal[at + 1], manifold.normal[at + 2])


def make_has_shared(spec: Spec) -> Any:
    """Return `kernel(kind) -> whether` all points of a pair share the manifold's normal."""
    kinds = tuple(pair.kind for pair in _own(spec))

    def has_shared(kind):
        return kind not in kinds

    return kernel(has_shared, spec)
