"""OBJ (Wavefront): vertices `v x y z`, polygons `f a b c ...` by their numbers from 1.

A negative number counts back from the last vertex. Of a corner `1/2/3` the first is the vertex, the
others texture and normal, which a surface of triangles does not have.
"""

from __future__ import annotations

import re
from codecs import BOM_UTF8
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

from lavendersim.experiment.mesh_files.triangles import (
    FileTriangles,
    MeshFileError,
    coordinate,
    shown,
)
from lavendersim.geometry.vectors import cross, dot, minus
from lavendersim.quantities.quantity import Vector3

# What is no part of the surface: texture and normals, names, materials, smoothing, points, lines.
_BESIDE: Final = frozenset(b"vt vn vp g o s mg usemtl mtllib usemap maplib p l".split())
_CORNER: Final = re.compile(rb"([-+]?\d{1,9})(/[-+]?\d*){0,2}")


def read_obj(raw: bytes) -> FileTriangles:
    """Return the triangles of a file's bytes; polygons that are convex are cut into them.

    Raises MeshFileError at the line of what is wrong.
    """
    read, raw = FileTriangles(), raw.removeprefix(BOM_UTF8)
    for line, (word, *values) in _statements(raw):
        if word == b"v":
            read.add_vertex(_place(values, line), line)
        elif word == b"f":
            corners = [_row(one, len(read.vertices), line) for one in values]
            for triangle in _cut(corners, read.vertices, line):
                read.add_triangle(triangle, line)
        elif word not in _BESIDE:
            raise MeshFileError(f"expected v or f, found {shown(word)}", line)
    return read


def _statements(raw: bytes) -> Iterator[tuple[int, list[bytes]]]:
    """Yield the number of each line with words, and those; a backslash leads into the next one."""
    words: list[bytes] = []
    for number, text in enumerate(raw.splitlines(), start=1):
        before, comment, _ = text.partition(b"#")
        goes_on = not comment and before.endswith(b"\\")
        words += (before[:-1] if goes_on else before).split()
        if words and not goes_on:
            yield number, words
            words = []
    if words:
        raise MeshFileError("the file ends within a statement", raw.count(b"\n") + 1)


def _place(values: Sequence[bytes], line: int) -> Vector3:
    """Return x, y, z; behind them may stand a weight of 1, and a colour."""
    if len(values) not in (3, 4, 6, 7):
        raise MeshFileError(f"expected v x y z, found {len(values)} numbers", line)
    x, y, z, *rest = (coordinate(one, line) for one in values)
    if len(values) in (4, 7) and rest[0] != 1.0:
        raise MeshFileError(f"expected a weight of 1, found {rest[0]:g}", line)
    return x, y, z


def _row(word: bytes, count: int, line: int) -> int:
    match = _CORNER.fullmatch(word)
    if match is None:
        raise MeshFileError(f"expected the number of a vertex, found {shown(word)}", line)
    number = int(match[1])
    row = number - 1 if number > 0 else count + number
    if number == 0 or not 0 <= row < count:
        raise MeshFileError(f"there are {count} vertices above, from 1; found {number}", line)
    return row


def _cut(
    corners: Sequence[int], vertices: Sequence[Vector3], line: int
) -> Iterator[tuple[int, int, int]]:
    """Yield the triangles of a convex polygon, all from its first corner."""
    if len(corners) < 3:
        raise MeshFileError(f"expected three vertices or more, found {len(corners)}", line)
    if len(corners) > 3:
        _check_convex([vertices[row] for row in corners], line)
    first, *others = corners
    yield from ((first, one, other) for one, other in pairwise(others))


def _check_convex(points: Sequence[Vector3], line: int) -> None:
    """Raise unless every corner turns the same way, once around: along the normal of the area.

    The normal is the sum of those of the triangles from the first corner (Newell's). Each triangle
    that is cut off has to lie along it, too, which a star does not keep.
    """
    ways = [minus(point, points[0]) for point in points[1:]]
    parts = [cross(one, other) for one, other in pairwise(ways)]
    x, y, z = (sum(along) for along in zip(*parts, strict=True))
    sides = [minus(other, one) for one, other in zip(points, (*points[1:], points[0]), strict=True)]
    turns = [cross(one, other) for one, other in zip(sides, (*sides[1:], sides[0]), strict=True)]
    if not all(dot(turn, (x, y, z)) > 0.0 for turn in (*parts, *turns)):
        sentence = f"a polygon of {len(points)} corners is not convex; expected triangles there"
        raise MeshFileError(sentence, line)
