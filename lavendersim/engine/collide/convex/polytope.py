"""A closed triangle mesh and a point beyond it enter; the convex mesh around both leaves.

    triangles[t]   corners i j k, turning left seen from outside; the neighbours across the edges
                   i j, j k, k i; 1 while the face is part of the mesh
    planes[t]      outward unit normal n and n . corner; infinitely far where a face has no area

The faces seen from the new corner are flooded from one of them, so what is cut out is connected
whatever rounding says of faces that lie in one plane; its rim, the horizon, is joined to the new
corner.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner

# A face whose area is below this share of its edges' product has no normal [-].
NO_AREA = 1e-12


@inner
def put_face(corners, triangles, planes, t, i, j, k):
    """Write face `t` through the corners i j k and its plane; the neighbours stay open."""
    triangles[t, 0], triangles[t, 1], triangles[t, 2], triangles[t, 6] = i, j, k, 1
    px, py, pz = corners[i, 0], corners[i, 1], corners[i, 2]
    ux, uy, uz = corners[j, 0] - px, corners[j, 1] - py, corners[j, 2] - pz
    wx, wy, wz = corners[k, 0] - px, corners[k, 1] - py, corners[k, 2] - pz
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    area = sqrt(nx * nx + ny * ny + nz * nz)
    if area <= NO_AREA * sqrt((ux * ux + uy * uy + uz * uz) * (wx * wx + wy * wy + wz * wz)):
        planes[t, 0], planes[t, 1], planes[t, 2], planes[t, 3] = 0.0, 0.0, 0.0, 1e300
        return
    nx, ny, nz = nx / area, ny / area, nz / area
    planes[t, 0], planes[t, 1], planes[t, 2] = nx, ny, nz
    planes[t, 3] = nx * px + ny * py + nz * pz


@inner
def join(triangles, t, ij, jk, ki):
    """Write the neighbours of face `t`."""
    triangles[t, 3], triangles[t, 4], triangles[t, 5] = ij, jk, ki


@inner
def nearest_face(triangles, planes, count):
    """Face whose plane is nearest to the origin, counted negative where the origin is outside."""
    chosen, nearest = 0, 1e301
    for t in range(count):
        if triangles[t, 6] and planes[t, 3] < nearest:
            chosen, nearest = t, planes[t, 3]
    return chosen


@inner
def flood(mesh, corner, start, stamp, slack):
    """Mark with `stamp` the faces joined to `start` that see `corner`; returns how many."""
    triangles, planes, visible, stack = mesh.triangles, mesh.planes, mesh.visible, mesh.stack
    visible[start] = stamp
    stack[0] = start
    count, looked = 1, 0
    while looked < count:
        t = stack[looked]
        looked += 1
        for edge in range(3):
            f = triangles[t, 3 + edge]
            if visible[f] != stamp:
                above = (
                    planes[f, 0] * corner[0]
                    + planes[f, 1] * corner[1]
                    + planes[f, 2] * corner[2]
                    - planes[f, 3]
                )
                if above > slack:
                    visible[f] = stamp
                    stack[count] = f
                    count += 1
    return count


@inner
def grow(mesh, corner, faces, seen, stamp):
    """Replace the faces in `stack[:seen]` by a cone to `corner`; returns the new face count.

    -1 when there is no room, or when the horizon touches itself (rounding in thin meshes).
    """
    corners, triangles, planes = mesh.corners, mesh.triangles, mesh.planes
    visible, stack, starts = mesh.visible, mesh.stack, mesh.starts
    for k in range(corner):
        starts[k] = -1
    first = faces
    for s in range(seen):
        t = stack[s]
        triangles[t, 6] = 0
        for edge in range(3):
            outer = triangles[t, 3 + edge]
            if visible[outer] == stamp:
                continue
            i, j = triangles[t, edge], triangles[t, (edge + 1) % 3]
            if starts[i] >= 0 or faces >= triangles.shape[0]:
                return -1
            put_face(corners, triangles, planes, faces, i, j, corner)
            visible[faces] = -1
            triangles[faces, 3] = outer
            for back in range(3):
                if triangles[outer, 3 + back] == t and triangles[outer, back] == j:
                    triangles[outer, 3 + back] = faces
            starts[i] = faces
            faces += 1
    for t in range(first, faces):
        following = starts[triangles[t, 1]]
        if following < 0:
            return -1
        triangles[t, 4] = following
        triangles[following, 5] = t
    return faces
