"""Contact points of a manifold, and its reduction to the four that span most area.

A pair's kernel writes candidate points and returns how many; the normal is shared by the manifold.
`keep_four` chooses among them without moving any, so a resting box keeps the support polygon that
matters for its balance.
"""

from __future__ import annotations

from ...compile import inner
from ...vectors import Vec3, cross, dot, minus, position, vector_of

# Points that `keep_four` exchanges at most: three are kept beside the deepest, most fit at once.
EXCHANGES = 4
# A later point is taken where it is better by this share, or round-off would choose [-].
BETTER = 1e-9
# The deepest of points whose depths differ by less is the first of them [m].
SAME_DEPTH = 1e-9
# Entries of `Manifold.reduction`: 1 where every candidate is kept; how many were left out.
WHOLE, LEFT_OUT = 0, 1
# A fourth point that adds less than this lies in the triangle of the others [m^2].
NO_AREA = 1e-18


@inner
def place(point, p, phi, feature):
    """Write one candidate point."""
    point.x, point.y, point.z = p.x, p.y, p.z
    point.phi = phi
    point.feature = feature


@inner
def copy_point(source, target):
    """Copy a point field by field (records are references)."""
    target.x, target.y, target.z = source.x, source.y, source.z
    target.phi = source.phi
    target.feature = source.feature
    target.in_line, target.out_line = source.in_line, source.out_line


@inner
def swap_points(a, b):
    """Exchange two points."""
    p, phi, feature = position(a), a.phi, a.feature
    in_line, out_line = a.in_line, a.out_line
    copy_point(b, a)
    place(b, p, phi, feature)
    b.in_line, b.out_line = in_line, out_line


@inner
def signed_area(p, q, r, n):
    """Twice the area of triangle p q r, positive when it turns left about n [m^2]."""
    return dot(n, cross(minus(q, p), minus(r, p)))


@inner
def quadrilateral(p, q, r, s, n):
    """Twice the area spanned by four points in any order, if none lies between the others [m^2].

    The diagonals of the largest of the three loops through them: |pr x qs| and its like.
    """
    pq = signed_area(p, q, r, n) + signed_area(p, r, s, n)
    pr = signed_area(p, r, q, n) + signed_area(p, q, s, n)
    ps = signed_area(p, q, s, n) + signed_area(p, s, r, n)
    return max(abs(pq), max(abs(pr), abs(ps)))


@inner
def exchange(points, count, n):
    """Replace each of points 1..3 by one of the others while that spans more.

    A body half over an edge keeps both ends of it, so that it is carried up to the edge.
    """
    best = quadrilateral(points[0], points[1], points[2], points[3], n)
    for _ in range(EXCHANGES):
        out, chosen = -1, -1
        for k in range(1, 4):
            p = points[2 if k == 1 else 1]
            q = points[2 if k == 3 else 3]
            for i in range(4, count):
                area = quadrilateral(points[0], p, q, points[i], n)
                if area > best * (1.0 + BETTER):
                    best, out, chosen = area, k, i
        if out < 0:
            break
        swap_points(points[out], points[chosen])


@inner
def keep_four(points, count, n):
    """Order `points` so that the first four are the deepest and the largest quadrilateral with it.

    The deepest point comes first, the farthest from it second, then the one that makes the largest
    triangle, then the one that adds most area outside that triangle; last, all but the deepest are
    exchanged for better ones. Returns the new count.
    """
    if count <= 4:
        return count
    deepest = 0
    for i in range(1, count):
        # The margin keeps the choice when depths differ by round-off only.
        if points[i].phi < points[deepest].phi - SAME_DEPTH:
            deepest = i
    swap_points(points[0], points[deepest])
    best, chosen = -1.0, 1
    for i in range(1, count):
        d = minus(points[i], points[0])
        distance = dot(d, d)
        if distance > best * (1.0 + BETTER):
            best, chosen = distance, i
    swap_points(points[1], points[chosen])
    best, chosen = -1.0, 2
    for i in range(2, count):
        area = abs(signed_area(points[0], points[1], points[i], n))
        if area > best * (1.0 + BETTER):
            best, chosen = area, i
    swap_points(points[2], points[chosen])
    turn = signed_area(points[0], points[1], points[2], n)
    side = 1.0 if turn >= 0.0 else -1.0
    best, chosen = 0.0, -1
    for i in range(3, count):
        # Outside an edge of the triangle the area with that edge is negative.
        gain = 0.0
        gain = max(gain, -side * signed_area(points[0], points[1], points[i], n))
        gain = max(gain, -side * signed_area(points[1], points[2], points[i], n))
        gain = max(gain, -side * signed_area(points[2], points[0], points[i], n))
        if gain > best * (1.0 + BETTER) + NO_AREA:
            best, chosen = gain, i
    if chosen < 0:
        return 3
    swap_points(points[3], points[chosen])
    exchange(points, count, n)
    return 4


@inner
def reduce_manifold(manifold, points, count, n):
    """Put the points to keep first; returns how many: all of a whole manifold."""
    kept = count
    if manifold.reduction[WHOLE] == 0:
        kept = keep_four(points, count, n)
    manifold.reduction[LEFT_OUT] = count - kept
    return kept


@inner
def put_manifold_normal(manifold, n):
    """Write the normal that all points share."""
    manifold.normal[0], manifold.normal[1], manifold.normal[2] = n.x, n.y, n.z


@inner
def put_ball_point(manifold, n, ball, phi):
    """Write the one point of a ball B: from its centre to its surface, and on by half of phi."""
    put_manifold_normal(manifold, n)
    back = ball.hx + 0.5 * phi
    p = Vec3(ball.x - back * n.x, ball.y - back * n.y, ball.z - back * n.z)
    place(manifold.points[0], p, phi, 0)


@inner
def manifold_normal(manifold):
    """Return the normal that all points share."""
    return vector_of(manifold.normal)


@inner
def write_manifold(manifold, rows, count, n):
    """Write at most four of the first `count` candidates, and their normal; returns how many.

    Behind them stand those that are left out.
    """
    put_manifold_normal(manifold, n)
    kept = reduce_manifold(manifold, rows, count, n)
    for k in range(count):
        copy_point(rows[k], manifold.points[k])
    return kept
