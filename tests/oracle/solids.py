"""The solid of a body record: its support, its surface, and a shape of the library coal for it.

Written with matrices and closed forms in numpy, apart from the engine's kernels. For any unit n

    s(n) = min over B of n . x - max over A of n . x

is no more than the distance of A and B, and -s(n) no less than their depth: a normal that comes
with its separation proves itself.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

KINDS = (
    *("plane", "sphere", "box", "capsule", "cylinder", "hull", "compound", "ellipsoid"),
    *("bowl", "drum", "mesh", "cone"),
)
CAVITIES = ("bowl", "drum")  # no solids: what is in them is judged by its farthest point


class Solid(NamedTuple):
    """A shape in the world; sizes as in the body records, corners of a hull in its frame [m]."""

    kind: str
    centre: np.ndarray
    matrix: np.ndarray
    half: np.ndarray
    offset: float
    corners: np.ndarray | None
    faces: list | None


def solid_of(row: np.void, hulls: list) -> Solid:
    """Return the solid of a body record; `hulls`: (vertices, faces) of the hull tables."""
    kind = KINDS[row["shape"]]
    corners, faces = hulls[row["hull"]] if kind == "hull" else (None, None)
    return Solid(
        kind,
        np.array([row["x"], row["y"], row["z"]]),
        np.array([[row[f"r{i}{j}"] for j in range(3)] for i in range(3)]),
        np.array([row["hx"], row["hy"], row["hz"]]),
        float(row["offset"]),
        corners,
        faces,
    )


def reach(solid: Solid, n: np.ndarray) -> float:
    """Return the largest n . x of the solid [m]."""
    local, half = solid.matrix.T @ n, solid.half
    if solid.kind == "plane":
        return solid.offset if n @ half > 0.0 else -solid.offset
    centre = float(solid.centre @ n)
    if solid.kind == "sphere":
        return centre + float(np.linalg.norm(n) * half[0])
    if solid.kind == "box":
        return centre + float(np.abs(local) @ half)
    if solid.kind == "capsule":
        return centre + float(abs(local[2]) * half[2] + np.linalg.norm(n) * half[0])
    if solid.kind == "ellipsoid":
        return centre + float(np.linalg.norm(local * half))
    if solid.kind == "cone":  # its base is half[2] below the centre, its apex thrice that above
        of_rim = np.hypot(local[0], local[1]) * half[0] - local[2] * half[2]
        return centre + float(max(of_rim, 3.0 * local[2] * half[2]))
    if solid.kind == "cylinder":
        return centre + float(abs(local[2]) * half[2] + np.hypot(local[0], local[1]) * half[0])
    return centre + float(np.max(solid.corners @ local))


def grown(solid: Solid) -> float:
    """Return the radius that a solid's core is grown by [m]."""
    if solid.kind == "ellipsoid":  # half of its least radius of curvature
        return 0.5 * float(solid.half.min() ** 2 / solid.half.max())
    return float(solid.half[0]) if solid.kind in ("sphere", "capsule") else 0.0


def separation_along(a: Solid, b: Solid, n: np.ndarray) -> float:
    """Return s(n) [m]."""
    return -reach(b, -n) - reach(a, n)


def off_surface(solid: Solid, point: np.ndarray) -> float:
    """Return the signed distance of a point to the surface, positive outside [m].

    Outside a hull: the largest height over a face, which is no more than the distance.
    """
    half = solid.half
    if solid.kind == "plane":
        return float(half @ point - solid.offset)
    local = solid.matrix.T @ (point - solid.centre)
    if solid.kind == "sphere":
        return float(np.linalg.norm(local) - half[0])
    if solid.kind == "capsule":
        local[2] -= np.clip(local[2], -half[2], half[2])
        return float(np.linalg.norm(local) - half[0])
    if solid.kind == "ellipsoid":
        return off_ellipsoid(local, half)
    if solid.kind == "cone":
        return off_cone(local, half)
    if solid.kind == "hull":
        heights = []
        for loop in solid.faces:
            p, q, r = (solid.corners[k] for k in loop[:3])
            n = np.cross(q - p, r - p)
            heights.append(n @ (local - p) / np.linalg.norm(n))
        return float(max(heights))
    if solid.kind == "cylinder":
        over = np.array([np.hypot(local[0], local[1]) - half[0], abs(local[2]) - half[2]])
    else:
        over = np.abs(local) - half
    return float(np.linalg.norm(np.maximum(over, 0.0)) + min(np.max(over), 0.0))


def off_ellipsoid(point: np.ndarray, half: np.ndarray) -> float:
    """Return the signed distance of a point to an ellipsoid about the origin [m].

    The nearest point is (a_i^2 p_i / (t + a_i^2)), where F(t) = sum (a_i p_i / (t + a_i^2))^2 = 1:
    F falls from infinity as t grows from minus the least a_i^2 (D. Eberly, Distance from a point to
    an ellipse, an ellipse or a hyperellipsoid, 2013). The root by bisection.
    """
    squares, p = half**2, np.abs(point)
    longest = float(half.max())
    low, high = -(float(half.min()) ** 2), longest * float(np.linalg.norm(p)) + longest**2
    for _ in range(200):
        t = 0.5 * (low + high)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = half * p / (t + squares)
        if np.nansum(shares**2) > 1.0:
            low = t
        else:
            high = t
    nearest = squares * p / (0.5 * (low + high) + squares)
    side = 1.0 if float(np.sum((p / half) ** 2)) > 1.0 else -1.0
    return side * float(np.linalg.norm(p - nearest))


def off_cone(point: np.ndarray, half: np.ndarray) -> float:
    """Return the signed distance of a point to a cone [m]: to the sides of a triangle, turned."""
    p = np.array([np.hypot(point[0], point[1]), point[2]])
    rim, apex, foot = np.array([half[0], -half[2]]), np.array([0.0, 3.0 * half[2]]), -half[2]
    side = apex - rim
    outward = np.array([side[1], -side[0]]) / np.linalg.norm(side)
    inside = outward @ (p - rim) < 0.0 and p[1] > foot
    nearest = []
    for a, b in ((rim, apex), (np.array([0.0, foot]), rim)):
        along = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        nearest.append(np.linalg.norm(p - a - along * (b - a)))
    return float(min(nearest)) * (-1.0 if inside else 1.0)


def middle_of(solid: Solid) -> np.ndarray:
    """Return where coal has a solid's origin: a cone's half way up its axis."""
    above = float(solid.half[2]) if solid.kind == "cone" else 0.0
    return solid.centre + above * solid.matrix[:, 2]


class Judge:
    """Signed distances by coal, of solids that are made once."""

    def __init__(self) -> None:
        import coal

        self.coal = coal
        self.request = coal.DistanceRequest()
        self.request.enable_signed_distance = True
        self.request.gjk_tolerance = self.request.epa_tolerance = 1e-10
        self.request.gjk_max_iterations, self.request.epa_max_iterations = 1000, 500

    def shape(self, solid: Solid):
        """Return coal's geometry of a solid."""
        coal, half = self.coal, solid.half
        if solid.kind == "plane":
            return coal.Halfspace(half, solid.offset)
        if solid.kind == "sphere":
            return coal.Sphere(half[0])
        if solid.kind == "box":
            return coal.Box(*(2.0 * half))
        if solid.kind == "capsule":
            return coal.Capsule(half[0], 2.0 * half[2])
        if solid.kind == "cylinder":
            return coal.Cylinder(half[0], 2.0 * half[2])
        if solid.kind == "ellipsoid":
            return coal.Ellipsoid(*half)
        if solid.kind == "cone":
            return coal.Cone(half[0], 4.0 * half[2])
        points = coal.StdVec_Vec3s()
        points.extend(list(solid.corners))
        return coal.Convex.convexHull(points, False, "Qt")

    def distance(self, a: Solid, b: Solid) -> tuple[float, np.ndarray | None]:
        """Return the signed distance and the normal from A to B; None where coal gave up."""
        transform = self.coal.Transform3s
        where_a = transform() if a.kind == "plane" else transform(a.matrix, middle_of(a))
        result = self.coal.DistanceResult()
        self.coal.distance(
            self.shape(a),
            where_a,
            self.shape(b),
            transform(b.matrix, middle_of(b)),
            self.request,
            result,
        )
        distance, normal = result.min_distance, np.array(result.normal)
        length = np.linalg.norm(normal)
        if abs(distance) > 1e100 or not 0.5 < length < 2.0:
            return distance, None
        return distance, normal / length
