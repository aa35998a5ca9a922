"""Records of collision detection: what GJK and EPA find, features seen along the normal, points.

Scalar fields only; lengths in metres. Points of two bodies are relative to the centre of body A,
along the world's axes, so that the distance of the origin costs no digits.
"""

from __future__ import annotations

from typing import NamedTuple

from ..compile import inner
from ..records import F8, I8, Field
from ..vectors import Vec3

VECTOR: list[Field] = [("x", F8), ("y", F8), ("z", F8)]

# A vertex w = a - b of the Minkowski difference A - B, with the support points it is made of.
VERTEX: list[Field] = [
    *VECTOR,
    *[(f"{body}{axis}", F8) for body in "ab" for axis in "xyz"],
]

# The separation of two cores (`shape`) and where it is.
SEPARATION: list[Field] = [
    ("nx", F8),  # unit normal from A to B
    ("ny", F8),
    ("nz", F8),
    ("distance", F8),  # signed: minus the depth where they overlap
    *[(f"{body}{axis}", F8) for body in "ab" for axis in "xyz"],  # witness points
]

# A face of the expanding polytope.
FACE: list[Field] = [
    ("nx", F8),  # outward unit normal
    ("ny", F8),
    ("nz", F8),
    ("offset", F8),  # n . x of its points; infinitely far where it has no area
    ("alive", I8),  # 1 while it is part of the polytope
    ("seen_by", I8),  # the last vertex that saw it from outside
]

# Calls that took all their iterations, since they were counted last (`iteration_limits`).
NOT_CONVERGED: list[Field] = [
    *[("gjk", I8), ("epa", I8)],
    ("ascent", I8),  # of a depth (`convex.separation`)
    ("advance", I8),  # to where fast bodies meet (`swept`)
    ("impact", I8),  # in time (`impact_location`)
]

# The plane of a face or cap.
PLANE_OF_FEATURE: list[Field] = [
    ("nx", F8),  # outward unit normal
    ("ny", F8),
    ("nz", F8),
    *VECTOR,  # a point of it, a cap's centre
    ("radius", F8),  # of a cap
]

# Kinds of features, by what they are seen along the normal.
POINT, LINE, FACE_LOOP, DISC = 0, 1, 2, 3


class Feature(NamedTuple):
    """The part of a body that looks along the normal; its corners are in an `Outline`."""

    kind: int  # POINT, LINE, FACE_LOOP or DISC
    corners: int  # how many
    name: int  # equal while the same face, edge or cap looks along the normal


NO_FEATURE = Feature(POINT, 0, 0)


class Frame(NamedTuple):
    """A right-handed orthonormal frame t1, t2, n."""

    t1: Vec3
    t2: Vec3
    n: Vec3


# Farther than anything: nothing has been compared yet [m, or m^2].
UNBOUNDED = 1e300


@inner
def normal_of(record):
    """Return the fields nx, ny, nz of a record."""
    return Vec3(record.nx, record.ny, record.nz)


@inner
def put_arms(contact, a, b):
    """Write the levers of a joint's row: of A and of B [m]."""
    contact.arm_ax, contact.arm_ay, contact.arm_az = a.x, a.y, a.z
    contact.arm_bx, contact.arm_by, contact.arm_bz = b.x, b.y, b.z


@inner
def put_normal(record, n):
    """Write the fields nx, ny, nz of a record."""
    record.nx, record.ny, record.nz = n.x, n.y, n.z


@inner
def put_position(record, p):
    """Write the fields x, y, z of a record."""
    record.x, record.y, record.z = p.x, p.y, p.z


@inner
def copy_vertex(source, target):
    """Copy a vertex of the Minkowski difference field by field (records are references)."""
    target.x, target.y, target.z = source.x, source.y, source.z
    copy_witness(source, target)


@inner
def copy_witness(source, target):
    """Copy the points of A and B."""
    target.ax, target.ay, target.az = source.ax, source.ay, source.az
    target.bx, target.by, target.bz = source.bx, source.by, source.bz


@inner
def copy_separation(source, target):
    """Copy a separation."""
    target.nx, target.ny, target.nz = source.nx, source.ny, source.nz
    target.distance = source.distance
    copy_witness(source, target)
