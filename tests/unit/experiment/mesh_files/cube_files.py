"""A cube of edge 1 m as YAML, OBJ and STL: vertices in the order in which triangles name them."""

from __future__ import annotations

import struct

# Two triangles a face, counter-clockwise seen from outside; a bit of a corner's number is one of
# its coordinates.
_LOOPS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
_CORNERS = [(loop[0], loop[k], loop[k + 1]) for loop in _LOOPS for k in (1, 2)]
_ORDER = list(dict.fromkeys(corner for triangle in _CORNERS for corner in triangle))
PLACES = [tuple((corner >> k & 1) - 0.5 for k in range(3)) for corner in _ORDER]
TRIANGLES = [tuple(map(_ORDER.index, triangle)) for triangle in _CORNERS]
IN_YAML = f"vertices: {list(map(list, PLACES))}, triangles: {list(map(list, TRIANGLES))}"


def as_obj() -> bytes:
    lines = [f"v {x} {y} {z}" for x, y, z in PLACES]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in TRIANGLES]
    return "\n".join(lines).encode() + b"\n"


def as_text_stl() -> bytes:
    lines = ["solid cube"]
    for triangle in TRIANGLES:
        corners = [f"vertex {x:e} {y:e} {z:e}" for x, y, z in map(PLACES.__getitem__, triangle)]
        lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid cube"]).encode() + b"\n"


def as_binary_stl() -> bytes:
    facets = (sum((PLACES[row] for row in triangle), ()) for triangle in TRIANGLES)
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *numbers, 0) for numbers in facets)
    return b"solid of 80 bytes".ljust(80) + struct.pack("<I", len(TRIANGLES)) + body


FILES = {"cube.obj": as_obj(), "text.stl": as_text_stl(), "binary.STL": as_binary_stl()}
