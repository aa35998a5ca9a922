"""A bounding volume hierarchy of boxes, sorted along a Hilbert curve, and the pairs that overlap.

The tree is implicit, four to a node. Leaves are sorted by (class of size, place on the Hilbert
curve); node n of level l holds the leaves n 4^l ... (n + 1) 4^l - 1, so building it is a sort and
one pass over each level, and a walk needs no stack:

    level 2  |               0               | 1 ...      the walk of group 1 visits groups 2, 3,
    level 1  |   0   |   1   |   2   |   3   | 4 ...      then level 2: 1, ... and descends into
    leaves    0 1 2 3 4 5 6 7 8 ...                       what it overlaps

The four leaves of a level-1 node are a group; they walk together, and only over what lies behind
them, so each pair is found once. Large boxes come first: they look among the small, which then need
not look among the large. Sizes of one class differ by 16 at most, so a large box spoils no node
over small ones. (4 or 32 would cost 10 % more or less; one class for all, a third more where a
hundredth of the bodies is large.) The Hilbert curve makes no jumps: with Morton's the same walk
visits one and a half times as many nodes.
"""

from __future__ import annotations

from typing import Any

from ...compile import inner, kernel
from ...effects import has_hook
from ...records import BOWL, COMPOUND, DRUM, F8, I8, PLANE, ROPE_END, Field
from ...spec import Spec
from ..shapes import has_cavity

# Bits of a place along one axis: cells of 1e-6 of the scene, so that one body far away does not
# put all others into one cell. Classes of size have the three bits above; the last has no end.
PLACE_BITS = 20
PLACES = float(1 << PLACE_BITS)
CLASSES = 8
CLASS_RATIO = 16.0
# The sort's digits: 11 bits need 6 passes for 63 bits; their counts stay in the first cache.
DIGIT_BITS = 11
DIGITS = 1 << DIGIT_BITS
DIGIT_PASSES = 6
LEVELS = 16  # 4^16 leaves at most

BOUNDS: list[Field] = [(f"{end}{axis}", F8) for end in ("low_", "high_") for axis in "xyz"]
LEAF: list[Field] = [
    *BOUNDS,
    ("x", F8),  # a sphere that also holds what the leaf stands for: centre and radius [m]
    ("y", F8),
    ("z", F8),
    ("radius", F8),
    ("body", I8),
    ("owner", I8),  # leaves of one owner never pair
    ("still", I8),  # 1: nothing pushes it; two such leaves never pair
]


def node_count(leaves: int) -> int:
    """Return how many nodes the levels above `leaves` leaves have."""
    total = width = (leaves + 3) // 4
    while width > 1:
        width = (width + 3) // 4
        total += width
    return total


@inner
def spread(n):
    """Put two zero bits between the 20 bits of n."""
    n = (n | (n << 32)) & 0x1F00000000FFFF
    n = (n | (n << 16)) & 0x1F0000FF0000FF
    n = (n | (n << 8)) & 0x100F00F00F00F00F
    n = (n | (n << 4)) & 0x10C30C30C30C30C3
    return (n | (n << 2)) & 0x1249249249249249


@inner
def hilbert(x, y, z):
    """Place of a cell, 20 bits an axis, on the Hilbert curve through all cells, 60 bits.

    J. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707 (2004) 381, without branches.
    """
    for bit in range(PLACE_BITS - 1, 0, -1):
        below = (1 << bit) - 1
        x ^= below & -((x >> bit) & 1)
        # A set bit turns the cells below it about, a clear one exchanges axes among them.
        turned = below & -((y >> bit) & 1)
        exchanged = (x ^ y) & (below ^ turned)
        x, y = x ^ turned ^ exchanged, y ^ exchanged
        turned = below & -((z >> bit) & 1)
        exchanged = (x ^ z) & (below ^ turned)
        x, z = x ^ turned ^ exchanged, z ^ exchanged
    y ^= x
    z ^= y
    parity = z ^ (z >> 1)
    parity ^= parity >> 2
    parity ^= parity >> 4
    parity ^= parity >> 8
    parity ^= parity >> 16
    parity >>= 1  # of the bits above each bit
    return spread(x ^ parity) << 2 | spread(y ^ parity) << 1 | spread(z ^ parity)


@inner
def cell(place):
    """Cell of a place in [0, 1] along one axis; whatever is not a number is in cell 0."""
    if place > 0.0:
        return min(int(place * PLACES), (1 << PLACE_BITS) - 1)
    return 0


@inner
def size_class(size, largest):
    """0 for the largest, one more for each factor of CLASS_RATIO below."""
    limit, found = largest / CLASS_RATIO, 0
    while size < limit and found < CLASSES - 1:
        limit /= CLASS_RATIO
        found += 1
    return found


@inner
def sort_by_code(codes, order, other_codes, other_order, counts, count):
    """Sort codes (63 bits, not negative) and carry `order` along, stably; the result is in place.

    Digits that are the same in all codes cost one look. counts: DIGITS + 1.
    """
    for digit in range(DIGIT_PASSES):
        shift = digit * DIGIT_BITS
        for k in range(DIGITS + 1):
            counts[k] = 0
        for k in range(count):
            counts[((codes[k] >> shift) & (DIGITS - 1)) + 1] += 1
        if count == 0 or counts[((codes[0] >> shift) & (DIGITS - 1)) + 1] == count:
            continue
        for k in range(DIGITS):
            counts[k + 1] += counts[k]
        for k in range(count):
            bucket = (codes[k] >> shift) & (DIGITS - 1)
            place = counts[bucket]
            counts[bucket] = place + 1
            other_codes[place] = codes[k]
            other_order[place] = order[k]
        for k in range(count):
            codes[k] = other_codes[k]
            order[k] = other_order[k]


@inner
def enclose(bounds, first, last, out):
    """Write the box around rows first ... last - 1 of `bounds`."""
    row = bounds[first]
    low_x, low_y, low_z = row.low_x, row.low_y, row.low_z
    high_x, high_y, high_z = row.high_x, row.high_y, row.high_z
    for k in range(first + 1, last):
        row = bounds[k]
        low_x, low_y, low_z = min(low_x, row.low_x), min(low_y, row.low_y), min(low_z, row.low_z)
        high_x, high_y = max(high_x, row.high_x), max(high_y, row.high_y)
        high_z = max(high_z, row.high_z)
    out.low_x, out.low_y, out.low_z = low_x, low_y, low_z
    out.high_x, out.high_y, out.high_z = high_x, high_y, high_z


@inner
def build_nodes(leaves, count, nodes, starts):
    """Fill the levels above the leaves; starts[l] is where level l begins in `nodes`."""
    width, level, begin = (count + 3) // 4, 1, 0
    starts[1] = 0
    for n in range(width):
        enclose(leaves, 4 * n, min(4 * n + 4, count), nodes[n])
    while width > 1:
        below, begin_below = width, begin
        begin += width
        width, level = (width + 3) // 4, level + 1
        starts[level] = begin
        for n in range(width):
            first = begin_below + 4 * n
            last = min(first + 4, begin_below + below)
            enclose(nodes, first, last, nodes[begin + n])


@inner
def overlap(a, b):
    """Whether two boxes have a point in common; without branches, which would be mispredicted."""
    return (
        (a.low_x <= b.high_x)
        & (b.low_x <= a.high_x)
        & (a.low_y <= b.high_y)
        & (b.low_y <= a.high_y)
        & (a.low_z <= b.high_z)
        & (b.low_z <= a.high_z)
    )


@inner
def may_pair(a, b):
    """Whether two leaves may pair: boxes and spheres overlap, something may push one of them."""
    dx, dy, dz = a.x - b.x, a.y - b.y, a.z - b.z
    near = a.radius + b.radius
    if dx * dx + dy * dy + dz * dz <= near * near:
        return overlap(a, b) and a.still + b.still < 2 and a.owner != b.owner
    return False


@inner
def next_group(nodes, starts, groups, box, place):
    """First group at `place` > 0 or behind whose box overlaps `box`, or `groups` if there is none.

    Call again with one more than the result.
    """
    while place < groups:
        level = 1  # of the largest node that begins here; it has not been visited
        while place & ((1 << (2 * level)) - 1) == 0:
            level += 1
        while level > 0 and overlap(box, nodes[starts[level] + (place >> (2 * level - 2))]):
            level -= 1
        if level == 0:
            return place
        place += 1 << (2 * level - 2)
    return groups


def make_has_leaf(spec: Spec) -> Any:
    """Return `kernel(body) -> whether` a row of `bodies` has bounds that the tree holds."""
    connects, cavities = spec.connects, has_cavity(spec)

    def has_leaf(body):
        if connects:
            if body.shape == ROPE_END:
                return False
        if cavities:
            if body.shape == BOWL or body.shape == DRUM:
                return False
        return body.shape != PLANE and body.shape != COMPOUND

    return kernel(has_leaf, spec)


@inner
def sort_code(x, y, z, side, r, largest):
    """Return by what a leaf is sorted: its class of size, then its place; x, y, z: from the low."""
    place = hilbert(cell(x * side), cell(y * side), cell(z * side))
    return (size_class(max(r.ex, max(r.ey, r.ez)), largest) << (3 * PLACE_BITS)) | place


def make_complete_leaf(spec: Spec) -> Any:
    """Return `kernel(leaf, bodies, i, r)`: all else of the leaf at x, y, z of the body of row i."""
    compound, sleeps = has_hook(spec, "place_parts"), has_hook(spec, "update_sleeping")

    def complete_leaf(leaf, bodies, i, r):
        body = bodies[i]
        leaf.low_x, leaf.low_y, leaf.low_z = leaf.x - r.ex, leaf.y - r.ey, leaf.z - r.ez
        leaf.high_x, leaf.high_y, leaf.high_z = leaf.x + r.ex, leaf.y + r.ey, leaf.z + r.ez
        leaf.radius = r.radius + body.bound
        leaf.body, leaf.owner = i, i
        if compound:
            leaf.owner = body.owner
        leaf.still = 1 if bodies[leaf.owner].inv_m == 0.0 else 0
        if sleeps:  # it may wake while the list is kept
            leaf.still -= bodies[leaf.owner].asleep

    return kernel(complete_leaf, spec)
