"""Contact features: the face, cap or line of a body that looks along the contact normal.

    FACE_LOOP  a polyhedron's face, turned from n by less than some 18 degrees: its loop of corners
    DISC       a cylinder's cap, likewise: an inscribed octagon
    LINE       an edge, a cylinder's side or a capsule's axis, not steeper than some 17 degrees
    POINT      nothing flat looks along n

Corners are relative to A's centre, along the world's axes; loops turn left about the outward
normal. Each shape finds its own (`Shape.make_feature`).
"""

from __future__ import annotations

from ...compile import inner
from ...vectors import from_body
from ..records import put_position

# Least cosine between n and the normal of a face that counts as looking along n [-].
FACE_COSINE = 0.95
# Greatest slope of a line that counts as across n [-].
LINE_SLOPE = 0.3
# Of faces whose normals are as near to n but for this, the first is taken [-].
SAME_COSINE = 1e-9


@inner
def put_corner(body, centre, local, outline, k):
    """Write the corner at `local` in the body's frame as corner k of the outline."""
    p, corner = from_body(body, local), outline.corners[k]
    corner.x, corner.y, corner.z = centre.x + p.x, centre.y + p.y, centre.z + p.z


@inner
def put_line(outline, p, q):
    """Write the two ends of a line."""
    put_position(outline.corners[0], p)
    put_position(outline.corners[1], q)
