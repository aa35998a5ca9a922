"""Two overlapping convex cores enter; the direction that parts them soonest leaves.

Van den Bergen's expanding polytope: inside the set M of differences a - b a polytope grows. Its
face nearest to the origin, at the height d along n, asks for the support h of M along n. The depth
lies between the least d and the least h seen; they meet at a face of M. The heights are signed, so
the first polytope need not hold the origin: bodies that only just touch are no special case.
"""

from __future__ import annotations

import numpy as np

from ...compile import inner, kernel, once
from ..scratch import EPA_VERTICES
from .gjk import make_difference
from .polytope import flood, grow, join, nearest_face, put_face
from .simplex import nearest_on_triangle
from .tetrahedron import above_plane, make_tetrahedron, swap_rows

# Where least height and least support count as equal, as a share of the sizes [-]. Round cores have
# no last face: there it is this larger share, and one of the depth; `separation.ascend` does the
# rest, near the direction found.
FLAT_SIZE = 1e-13
ROUND_SIZE = 1e-5
ROUND_SHARE = 1e-3
# A corner sees a face from this share of the sizes on; beneath it lies in the face's plane.
SEEN = 1e-14
# Faces belong together when their normals' cosine is above this [-].
SAME_WAY = 0.999

# The faces of the first tetrahedron: three corners, the neighbours across the edges between them.
FIRST = np.array([[0, 1, 2, 1, 2, 3], [0, 3, 1, 3, 2, 0], [1, 3, 2, 1, 3, 0], [2, 3, 0, 2, 1, 0]])


@inner
def nearest_in_face(corners, i, j, k, x, y, z):
    """Point of the triangle i j k nearest to (x, y, z): (squared distance, three weights)."""
    px, py, pz, wi, wj, wk = nearest_on_triangle(
        corners[i, 0] - x,
        corners[i, 1] - y,
        corners[i, 2] - z,
        corners[j, 0] - x,
        corners[j, 1] - y,
        corners[j, 2] - z,
        corners[k, 0] - x,
        corners[k, 1] - y,
        corners[k, 2] - z,
    )
    return px * px + py * py + pz * pz, wi, wj, wk


@inner
def write_witness(mesh, result, faces, chosen, depth, slack):
    """Write the points of A and B where the ray along `result[:3]` leaves the polytope.

    A face of M may be several triangles: of those in the plane of the face that parts the bodies
    the one that the ray goes through is taken. chosen: corners of that face when it was found.
    """
    corners, triangles, planes = mesh.corners, mesh.triangles, mesh.planes
    nx, ny, nz = result[0], result[1], result[2]
    x, y, z = nx * depth, ny * depth, nz * depth
    i, j, k = chosen
    best, wi, wj, wk = nearest_in_face(corners, i, j, k, x, y, z)
    for t in range(faces):
        if triangles[t, 6] and abs(planes[t, 3] - depth) <= slack:
            cosine = nx * planes[t, 0] + ny * planes[t, 1] + nz * planes[t, 2]
            if cosine > SAME_WAY:
                ti, tj, tk = triangles[t, 0], triangles[t, 1], triangles[t, 2]
                distance, ui, uj, uk = nearest_in_face(corners, ti, tj, tk, x, y, z)
                if distance < best:
                    best, i, j, k, wi, wj, wk = distance, ti, tj, tk, ui, uj, uk
    for axis in range(6):
        result[4 + axis] = (
            wi * corners[i, 3 + axis] + wj * corners[j, 3 + axis] + wk * corners[k, 3 + axis]
        )


@once
def make_epa(spec):
    """Return `kernel(a, b, ox, oy, oz, count, curved, scratch)`, which fills `scratch.result`.

    `count` rows of `scratch.simplex` come from GJK; curved: whether one of the cores is round.
    """
    difference, tetrahedron = make_difference(spec), make_tetrahedron(spec)

    def epa(a, b, ox, oy, oz, count, curved, scratch):
        mesh, tables = scratch.mesh, scratch.hulls
        corners, triangles, planes = mesh.corners, mesh.triangles, mesh.planes
        size = a.bound + b.bound
        for row in range(count):
            for k in range(9):
                corners[row, k] = scratch.simplex[row, k]
        tetrahedron(a, b, ox, oy, oz, count, corners, tables)
        height, _, _, _ = above_plane(corners, 3)
        if height > 0.0:
            swap_rows(corners, 1, 2)  # the fourth corner lies behind 0 1 2
        faces = len(FIRST)
        for t in range(faces):
            i, j, k = FIRST[t, 0], FIRST[t, 1], FIRST[t, 2]
            put_face(corners, triangles, planes, t, i, j, k)
            join(triangles, t, FIRST[t, 3], FIRST[t, 4], FIRST[t, 5])
            mesh.visible[t] = -1
        result, chosen = scratch.result, (0, 1, 2)
        least, slack = 1e300, 0.0
        for corner in range(4, EPA_VERTICES):
            t = nearest_face(triangles, planes, faces)
            d = planes[t, 3]
            if d >= least - slack:
                break
            nx, ny, nz = planes[t, 0], planes[t, 1], planes[t, 2]
            new = corners[corner]
            difference(a, b, ox, oy, oz, nx, ny, nz, tables, new)
            h = nx * new[0] + ny * new[1] + nz * new[2]
            if h < least:
                least = h
                chosen = (triangles[t, 0], triangles[t, 1], triangles[t, 2])
                result[0], result[1], result[2], result[3] = nx, ny, nz, -h
                slack = FLAT_SIZE * size
                if curved:
                    slack = ROUND_SIZE * size + ROUND_SHARE * abs(least)
            if h - d <= slack:
                break
            seen = flood(mesh, new, t, corner, SEEN * size)
            grown = grow(mesh, corner, faces, seen, corner)
            if grown < 0:
                faces -= faces  # the mesh is torn: what was found so far must do
                break
            faces = grown
        write_witness(mesh, result, faces, chosen, least, slack)

    return kernel(epa, spec)
