"""Two convex bodies enter; their signed separation, normal and nearest points leave.

    s(n) = min over B of n . x - max over A of n . x,      separation = max over unit n of s(n)

is the distance when they are apart (GJK) and minus the depth when they overlap (EPA). Where a core
is round, EPA's answer is improved by `ascend`; last, the normal of a face that separates no less is
taken instead of the one found, so that resting faces have their exact normal.

`scratch.result` as in gjk.py. Its points lie on the cores; a capsule's or sphere's radius is the
caller's to add.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...records import BOX, CAPSULE, CYLINDER, PLANE, SPHERE
from ...rotation import to_body, to_world
from .epa import make_epa
from .gjk import FARTHER, OVERLAPPING, make_gjk
from .support import make_radius, make_support, shapes_in

# A face may separate less than the normal found by this share of the shapes' sizes [-].
FACE_SHARE = 1e-10
# Rounds of `ascend`. With the depth d and the radius of curvature r of A - B a round leaves a share
# of some 1.25 d / (r + d / 4) of the error: two or three rounds but for the deepest overlaps.
ASCENTS = 30
# How far B is moved clear of A, as a share of the sizes [-]. Larger: slower; smaller: round-off of
# 1e-16 of the sizes shows in the normal.
CLEARANCE = 1e-4


@once
def make_best_face(spec):
    """Return `kernel(body, nx, ny, nz, tables) -> (face, x, y, z)`, -1 where none looks along n.

    The flat face whose outward normal (x, y, z) is nearest to n, in world axes. Faces of a box: row
    of the unit box; of a cylinder: 0 the lower cap, 1 the upper.
    """
    shapes = shapes_in(spec)
    polyhedra, hulls = not shapes.isdisjoint({"box", "hull"}), "hull" in shapes
    boxes, cylinders = "box" in shapes, "cylinder" in shapes

    def best_face(body, nx, ny, nz, tables):
        if body.shape == SPHERE or body.shape == CAPSULE:
            return -1, 0.0, 0.0, 0.0
        if cylinders:
            if body.shape == CYLINDER:
                along = body.r02 * nx + body.r12 * ny + body.r22 * nz
                s = 1.0 if along >= 0.0 else -1.0
                return 1 if along >= 0.0 else 0, body.r02 * s, body.r12 * s, body.r22 * s
        if polyhedra:
            starts, normals = tables.face_start, tables.normals
            row = starts.shape[0] - 2
            if hulls:
                if not boxes or body.shape != BOX:
                    row = body.hull
            lx, ly, lz = to_body(body, nx, ny, nz)
            best, chosen = -2.0, starts[row]
            for f in range(starts[row], starts[row + 1]):
                cosine = lx * normals[f, 0] + ly * normals[f, 1] + lz * normals[f, 2]
                # The margin keeps the choice when two faces look along n equally.
                if cosine > best + 1e-9:
                    best, chosen = cosine, f
            x, y, z = to_world(body, normals[chosen, 0], normals[chosen, 1], normals[chosen, 2])
            return chosen, x, y, z
        return -1, 0.0, 0.0, 0.0

    return kernel(best_face, spec)


@once
def make_separation_along(spec):
    """Return `kernel(a, b, ox, oy, oz, nx, ny, nz, tables) -> s(n)` of the cores [m]."""
    support = make_support(spec)

    def separation_along(a, b, ox, oy, oz, nx, ny, nz, tables):
        ax, ay, az = support(a, nx, ny, nz, tables)
        bx, by, bz = support(b, -nx, -ny, -nz, tables)
        return nx * (ox + bx - ax) + ny * (oy + by - ay) + nz * (oz + bz - az)

    return kernel(separation_along, spec)


@once
def make_ascend(spec):
    """Return `kernel(a, b, ox, oy, oz, scratch)`: improve the normal of overlapping cores.

    B is moved out along n until it is clear of A; the normal m of the distance there has
    s(m) + t n . m >= s(n) + t, hence s(m) >= s(n): each round separates more, and stops at a
    direction that no other near it beats.
    """
    gjk, separation_along = make_gjk(spec), make_separation_along(spec)

    def ascend(a, b, ox, oy, oz, scratch):
        result, found = scratch.result, scratch.nearest
        size = a.bound + b.bound
        for axis in range(6):
            found[axis] = result[4 + axis]
        nx, ny, nz, best = result[0], result[1], result[2], result[3]
        for _ in range(ASCENTS):
            t = 1.25 * max(-best, 0.0) + CLEARANCE * size
            status, _ = gjk(a, b, ox + t * nx, oy + t * ny, oz + t * nz, 1e300, scratch)
            if status == OVERLAPPING:
                break
            mx, my, mz = result[0], result[1], result[2]
            s = separation_along(a, b, ox, oy, oz, mx, my, mz, scratch.hulls)
            if s < best:
                break
            for axis in range(6):
                found[axis] = result[4 + axis]
            found[3] -= t * nx
            found[4] -= t * ny
            found[5] -= t * nz
            moved = abs(mx - nx) + abs(my - ny) + abs(mz - nz)
            gain = s - best
            nx, ny, nz, best = mx, my, mz, s
            if moved < 1e-6 or gain <= 1e-15 * size:
                break
        result[0], result[1], result[2], result[3] = nx, ny, nz, best
        for axis in range(6):
            result[4 + axis] = found[axis]

    return kernel(ascend, spec)


@once
def make_separate(spec):
    """Return `kernel(a, b, ox, oy, oz, reach, scratch) -> apart by no more than reach`.

    Cores only, `reach` [m] as well. When it returns True `scratch.result` is filled.
    """
    gjk, epa, ascend = make_gjk(spec), make_epa(spec), make_ascend(spec)
    best_face, separation_along = make_best_face(spec), make_separation_along(spec)
    round_cores = "cylinder" in shapes_in(spec)

    def separate(a, b, ox, oy, oz, reach, scratch):
        status, count = gjk(a, b, ox, oy, oz, reach, scratch)
        if status == FARTHER:
            return False
        if status == OVERLAPPING:
            curved = False
            if round_cores:
                curved = a.shape == CYLINDER or b.shape == CYLINDER
            epa(a, b, ox, oy, oz, count, curved, scratch)
            if round_cores:
                if curved:
                    ascend(a, b, ox, oy, oz, scratch)
        result = scratch.result
        if result[3] > reach:
            return False
        least = result[3] - FACE_SHARE * (a.bound + b.bound)
        for which in range(2):
            sign = -1.0 if which else 1.0
            face, x, y, z = best_face(
                b if which else a,
                sign * result[0],
                sign * result[1],
                sign * result[2],
                scratch.hulls,
            )
            if face >= 0:
                x, y, z = sign * x, sign * y, sign * z
                s = separation_along(a, b, ox, oy, oz, x, y, z, scratch.hulls)
                # B's face must be better than A's by more than round-off, or they would alternate.
                if s > least:
                    result[0], result[1], result[2], result[3] = x, y, z, s
                    least = s + FACE_SHARE * (a.bound + b.bound)
        return True

    return kernel(separate, spec)


def make_separation(spec):
    """Return `kernel(kind, a, b, scratch) -> (distance, nx, ny, nz)` for any pair of `spec`.

    The true distance between the surfaces and the unit normal from A to B. Where the cores overlap
    (or touch) the distance is minus the radii that the cores are grown by and the normal zero.
    """
    gjk, support, radius = make_gjk(spec), make_support(spec), make_radius(spec)
    planes = "plane" in shapes_in(spec)

    def separation(kind, a, b, scratch):
        if planes:
            if a.shape == PLANE:
                nx, ny, nz = a.hx, a.hy, a.hz
                x, y, z = support(b, -nx, -ny, -nz, scratch.hulls)
                height = nx * (b.x + x) + ny * (b.y + y) + nz * (b.z + z)
                return height - a.offset - radius(b), nx, ny, nz
        status, _ = gjk(a, b, b.x - a.x, b.y - a.y, b.z - a.z, 1e300, scratch)
        reach = radius(a) + radius(b)
        if status == OVERLAPPING:
            return -reach, 0.0, 0.0, 0.0
        result = scratch.result
        return result[3] - reach, result[0], result[1], result[2]

    return kernel(separation, spec)
