"""Contact points of a mesh A and a convex body B: on faces, over sharp edges, over corners.

    faces      B against the plane of the face; of its points those over the face
    edges      what lies across a convex or free edge, along the normals of its faces (a box half
               over a table's edge); B against the segment, where no direction within the face
               leads nearer to it:  n . m1 <= 0,  n . m2 <= 0
    corners    likewise, where  n . d <= 0  for all sides d that end in the corner

                    \\ n /                 n1    n2      m1, m2: across the edge, into its faces
             n1 |    \\ /    | n2            \\  /
                |     e     |              __\\/__
          _________m1/ \\m2_________       beyond a concave edge its two faces are all that touches

So a normal is that of a face, or lies between those of the faces around its edge or corner: where
the distance to the surface is least. Edges inside of a face, and concave ones, have no points. The
outside is where normals point. A body whose centre is behind a face's plane does not touch it.
A point of B that is inside (h < 0) touches of two faces at a convex edge the one it is less deep
under, of those that B's centre is in front of; of two at a concave edge both, near that edge.
"""

from __future__ import annotations

from typing import Any

from ...compile import inner, kernel
from ...records import BOX, MESH, TOUCHING
from ...spec import Spec
from ...vectors import (
    Vec3,
    dot,
    from_body,
    into_body,
    minus,
    negative,
    plus,
    plus_scaled,
    position,
)
from ..mesh_tables import CONCAVE, CONVEX
from ..records import POINT, put_position
from ..shape_kernels import make_feature, make_half_extents, make_radius
from .own_normals import put_point_normal
from .patch import FEATURE_BITS, LINE_BITS, contact_patch, frame_along
from .point import (
    LEFT_OUT,
    WHOLE,
    copy_point,
    keep_four,
    manifold_normal,
    put_manifold_normal,
    swap_points,
)

# Names of points: of what, its row of the table, and the name that the body's part has there.
FACE, SECOND_FACE, EDGE, CORNER = 1 << 61, 1 << 60, 1 << 59, 3 << 60
NAME_BITS = 32
EDGE_BITS = FEATURE_BITS + 2 * LINE_BITS  # below the name of an edge
# A normal is across an edge where the sine between is less, else one at its end [-].
ACROSS = 1e-6
# And is none of a cone where it is outside by more [-].
OUTSIDE = 1e-9
# Cosine to a face's normal from which a normal is the face's [-].
ALONG = 1.0 - 1e-12
# How much deeper what lies across an edge may be than the edge itself, in the bounding radius [-].
LEVEL = 1e-3
# How far from a point of B, in its bounding radius, faces are looked for that it may be inside [-].
NEAR = 0.05
KEPT, LEFT = 0, 1  # rows of `MeshTables.counts`


@inner
def into_mesh(mesh, p):
    """Return a point of the world in the mesh's frame."""
    return into_body(mesh, minus(p, position(mesh)))


@inner
def meets(node, centre, half):
    """Whether a node's box meets a box."""
    return (
        node.low_x <= centre.x + half.x
        and node.high_x >= centre.x - half.x
        and node.low_y <= centre.y + half.y
        and node.high_y >= centre.y - half.y
        and node.low_z <= centre.z + half.z
        and node.high_z >= centre.z - half.z
    )


@inner
def is_within(side, p, h, centre, near):
    """Whether a point at height h over a triangle's plane is on its side of one of its sides.

    Beyond a concave side it still is within `near` [m], where it is inside the face there. centre:
    of the body; a face yields to none that it is behind, which would not touch it.
    """
    from_side = minus(p, Vec3(side.x, side.y, side.z))
    inward = dot(Vec3(side.mx, side.my, side.mz), from_side)
    if side.kind == CONVEX and h < 0.0:
        beyond, own = Vec3(side.nx, side.ny, side.nz), minus(centre, Vec3(side.x, side.y, side.z))
        if dot(beyond, own) > 0.0:
            return h >= dot(beyond, from_side) - TOUCHING
    if side.kind == CONCAVE and -TOUCHING - near <= inward < -TOUCHING:
        return dot(Vec3(side.nx, side.ny, side.nz), from_side) <= TOUCHING
    return inward >= -TOUCHING


@inner
def is_over(mesh, tables, group, p, h, of_body):
    """Whether a point in the mesh's frame at height h over a group's plane is over its triangles.

    of_body: its centre in this frame, and how far beyond a triangle a point of it may be and still
    be inside of it [m].
    """
    centre, near = of_body
    face = tables.groups[group]
    n = Vec3(face.nx, face.ny, face.nz)
    foot = plus_scaled(p, face.offset - dot(n, p), n)
    point, reach = plus_scaled(foot, h, n), TOUCHING + near
    half = Vec3(reach, reach, reach)
    k = mesh.first_node
    while k < mesh.last_node:
        node = tables.nodes[k]
        if not meets(node, foot, half):
            k = node.skip
            continue
        t = node.triangle
        if t >= 0 and tables.triangles[t].group == group:
            inside = True
            for s in range(3 * t, 3 * t + 3):
                inside = inside and is_within(tables.sides[s], point, h, centre, near)
            if inside:
                return True
        k += 1
    return False


@inner
def put(tables, point, n, feature):
    """Put a point with its normal and name behind those there are, while there is room.

    One that is left out gives its place up.
    """
    k = tables.counts[KEPT]
    if k < tables.points.shape[0]:
        if k + tables.counts[LEFT] == tables.points.shape[0]:
            tables.counts[LEFT] -= 1
        copy_point(point, tables.points[k])
        tables.points[k].feature = feature
        tables.normals[3 * k], tables.normals[3 * k + 1], tables.normals[3 * k + 2] = n
        tables.counts[KEPT] = k + 1


@inner
def put_left_out(tables, point, n, feature):
    """Put a point that the manifold leaves out, from the end, while there is room."""
    k = tables.points.shape[0] - 1 - tables.counts[LEFT]
    if k >= tables.counts[KEPT]:
        copy_point(point, tables.points[k])
        tables.points[k].feature = feature
        tables.normals[3 * k], tables.normals[3 * k + 1], tables.normals[3 * k + 2] = n
        tables.counts[LEFT] += 1


@inner
def has_name(tables, feature):
    """Whether a point of this name is there."""
    found = False
    for k in range(tables.counts[KEPT]):
        found = found or tables.points[k].feature == feature
    return found


def make_put_face(spec: Spec, touch_plane: Any) -> Any:
    """Return `kernel(mesh, body, group, margin, scratch)`: points over the face of a group."""
    radius = make_radius(spec)

    def put_face(mesh, body, group, margin, scratch):
        tables, manifold = scratch.meshes, scratch.manifold
        points, reduction = manifold.points, manifold.reduction
        face, row = tables.groups[group], tables.row[0]
        n = from_body(mesh, Vec3(face.nx, face.ny, face.nz))
        offset = face.offset + dot(n, position(mesh))
        if not dot(n, position(body)) > offset:
            return
        row.hx, row.hy, row.hz, row.offset = n.x, n.y, n.z, offset
        reduction[LEFT_OUT] = 0
        found = touch_plane(row, body, margin, scratch)
        total = found + reduction[LEFT_OUT]
        grown, near = radius(body), NEAR * body.bound
        of_body = into_mesh(mesh, position(body)), near
        inside, kept = 0, 0
        for k in range(total):
            if k == found:
                kept = inside
            point = points[k]
            h = point.phi + grown
            if is_over(mesh, tables, group, into_mesh(mesh, position(point)), h, of_body):
                if inside < k:
                    swap_points(points[inside], points[k])
                inside += 1
        if found == total:
            kept = inside
        # Of a box the corners of the lower face came first: no upper one takes a lower one's place.
        chosen = body.shape == BOX and kept > 0
        if kept < found and not chosen and reduction[WHOLE] == 0:
            kept = keep_four(points, inside, n)
        for k in range(inside):
            point = points[k]
            name = FACE | group << NAME_BITS | point.feature
            if k < kept:
                put(tables, point, n, name)
            else:
                put_left_out(tables, point, n, name)

    return kernel(put_face, spec)


def make_put_crossing(spec: Spec) -> Any:
    """Return `kernel(edge, body, n, name, within, scratch)` along the normal n of its face.

    Points where what looks at the face lies across its edge; edge: its row as a segment. within:
    the least separation and the margin [m]: what is deeper lies beside the edge, not over it.
    """
    feature, radius = make_feature(spec), make_radius(spec)

    def put_crossing(edge, body, n, name, within, scratch):
        tables, rows, (least, margin) = scratch.meshes, scratch.polygon, within
        offset = minus(position(body), position(edge))
        if not dot(n, offset) > 0.0:
            return
        origin = Vec3(0.0, 0.0, 0.0)
        of_b = feature(body, offset, negative(n), scratch.hulls, scratch.outline_b)
        if of_b.kind == POINT:
            return
        of_a = feature(edge, origin, n, scratch.hulls, scratch.outline_a)
        frame = frame_along(n)
        start, total = contact_patch(of_a, of_b, 0.0, radius(body), frame, scratch)
        for k in range(start, start + total):
            row = rows[k]
            if least <= row.phi <= margin:
                p = plus_scaled(position(edge), row.x, frame.t1)
                p = plus_scaled(plus_scaled(p, row.y, frame.t2), row.z, n)
                put_position(row, p)
                put(tables, row, n, row.feature | name)

    return kernel(put_crossing, spec)


@inner
def is_normal_of_edge(edge, n):
    """Whether no way into its faces leads nearer to what lies along n."""
    if dot(n, Vec3(edge.m1x, edge.m1y, edge.m1z)) > OUTSIDE:
        return False
    if edge.free == 1:
        return dot(n, Vec3(edge.n1x, edge.n1y, edge.n1z)) > 0.0
    return dot(n, Vec3(edge.m2x, edge.m2y, edge.m2z)) <= OUTSIDE


@inner
def is_normal_of_corner(tables, corner, n):
    """Whether no side that ends in the corner leads nearer to what lies along n."""
    for k in range(corner.first, corner.last):
        spoke = tables.spokes[k]
        if dot(n, Vec3(spoke.x, spoke.y, spoke.z)) > OUTSIDE:
            return False
    return corner.free == 0 or dot(n, Vec3(corner.nx, corner.ny, corner.nz)) > 0.0


def make_put_edge(spec: Spec, touch_edge: Any, pointed: bool) -> Any:
    """Return `kernel(mesh, body, edge, margin, scratch)`: points over a sharp edge and its ends.

    pointed: bodies have nothing flat or straight that could lie across it.
    """
    put_crossing: Any = None if pointed else make_put_crossing(spec)
    lies_across = not pointed

    def put_edge(mesh, body, number, margin, scratch):
        tables, manifold = scratch.meshes, scratch.manifold
        edge, row = tables.edges[number], tables.row[0]
        half = from_body(mesh, Vec3(edge.hx, edge.hy, edge.hz))
        middle = from_body(mesh, Vec3(edge.x, edge.y, edge.z))
        put_position(row, plus(middle, position(mesh)))
        row.hx, row.hy, row.hz, row.bound = half.x, half.y, half.z, edge.length
        row.shape, row.first_node = MESH, number
        away = minus(position(body), position(row))
        along = dot(away, half) / (edge.length * edge.length)
        away = plus_scaled(away, -min(max(along, -1.0), 1.0), half)
        reach = body.bound + margin
        if dot(away, away) > reach * reach:
            return
        whole = manifold.reduction[WHOLE]
        manifold.reduction[WHOLE] = 1
        found = touch_edge(row, body, margin, scratch)
        manifold.reduction[WHOLE] = whole
        if found == 0:
            return
        n, least = manifold_normal(manifold), manifold.points[0].phi
        local = into_body(mesh, n)
        slope = dot(local, Vec3(edge.hx, edge.hy, edge.hz)) / edge.length
        if abs(slope) > ACROSS:
            number = edge.end if slope > 0.0 else edge.start
            name = CORNER | number
            if is_normal_of_corner(tables, tables.corners[number], local):
                if not has_name(tables, name):
                    put(tables, manifold.points[0], n, name)
        elif is_normal_of_edge(edge, local):
            n1, n2 = Vec3(edge.n1x, edge.n1y, edge.n1z), Vec3(edge.n2x, edge.n2y, edge.n2z)
            between = dot(local, n1) < ALONG and (edge.free == 1 or dot(local, n2) < ALONG)
            if between or not lies_across:
                for k in range(found):
                    part = manifold.points[k].feature & ((1 << EDGE_BITS) - 1)
                    name = EDGE | SECOND_FACE | number << EDGE_BITS | part
                    put(tables, manifold.points[k], n, name)
                return
        if lies_across:
            within = least - LEVEL * body.bound, margin
            n1 = from_body(mesh, Vec3(edge.n1x, edge.n1y, edge.n1z))
            put_crossing(row, body, n1, EDGE, within, scratch)
            if edge.free == 0:
                n2 = from_body(mesh, Vec3(edge.n2x, edge.n2y, edge.n2z))
                put_crossing(row, body, n2, SECOND_FACE, within, scratch)

    return kernel(put_edge, spec)


def make_mesh_manifold(spec: Spec, touch_plane: Any, touch_edge: Any, pointed: bool) -> Any:
    """Return `kernel(mesh, body, margin, scratch) -> count`, which writes `scratch.manifold`.

    touch_plane, touch_edge: manifolds of the body and a plane, and a segment as A.
    """
    half_extents = make_half_extents(spec)
    put_face, put_edge = make_put_face(spec, touch_plane), make_put_edge(spec, touch_edge, pointed)

    def mesh_manifold(mesh, body, margin, scratch):
        tables, manifold = scratch.meshes, scratch.manifold
        counts = tables.counts
        counts[KEPT], counts[LEFT] = 0, 0
        tables.stamp[0] += 1
        stamp = tables.stamp[0]
        centre, e = into_mesh(mesh, position(body)), half_extents(body)
        half = Vec3(
            abs(mesh.r00) * e.x + abs(mesh.r10) * e.y + abs(mesh.r20) * e.z + margin,
            abs(mesh.r01) * e.x + abs(mesh.r11) * e.y + abs(mesh.r21) * e.z + margin,
            abs(mesh.r02) * e.x + abs(mesh.r12) * e.y + abs(mesh.r22) * e.z + margin,
        )
        k = mesh.first_node
        while k < mesh.last_node:
            node = tables.nodes[k]
            if not meets(node, centre, half):
                k = node.skip
                continue
            t = node.triangle
            if t >= 0:
                group = tables.triangles[t].group
                if tables.groups[group].seen != stamp:
                    tables.groups[group].seen = stamp
                    put_face(mesh, body, group, margin, scratch)
                for s in range(3 * t, 3 * t + 3):
                    number = tables.sides[s].edge
                    if number >= 0 and tables.edges[number].seen != stamp:
                        tables.edges[number].seen = stamp
                        put_edge(mesh, body, number, margin, scratch)
            k += 1
        kept, left, last = counts[KEPT], counts[LEFT], tables.points.shape[0] - 1
        for k in range(kept + left):
            row = k if k < kept else last - (k - kept)
            copy_point(tables.points[row], manifold.points[k])
            at = 3 * row
            n = Vec3(tables.normals[at], tables.normals[at + 1], tables.normals[at + 2])
            put_point_normal(manifold, k, n)
            if k == 0:
                put_manifold_normal(manifold, n)
        manifold.reduction[LEFT_OUT] = left
        return kept

    return kernel(mesh_manifold, spec)
