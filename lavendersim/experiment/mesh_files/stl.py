"""STL (3D Systems): facets of three corners each, as text or in 50 bytes; corners are welded.

A binary file has 80 bytes of any text, the number of its facets, and of each twelve numbers of 32
bits, little-endian: a normal, which is not read, as corners have it, and these; and two bytes.
"""

from __future__ import annotations

import math
import struct
from codecs import BOM_UTF8
from collections.abc import Iterator
from typing import Final

from lavendersim.experiment.mesh_files.triangles import (
    MOST_OF_BOTH,
    FileTriangles,
    MeshFileError,
    coordinate,
    shown,
    too_many,
)
from lavendersim.quantities.quantity import Vector3

HEADER: Final = 84  # [byte] with the number of facets, at 80
_FACET: Final = struct.Struct("<12x9f2x")
_LOOP: Final = ("facet normal", "outer loop", "vertex", "vertex", "vertex", "endloop", "endfacet")


def read_stl(raw: bytes) -> FileTriangles:
    """Return the triangles of a file's bytes; raises MeshFileError at what is wrong.

    It is binary where its length is what the number of facets says, whatever its text begins with.
    """
    count = int.from_bytes(raw[80:HEADER], "little") if len(raw) >= HEADER else None
    if count is not None and len(raw) == HEADER + count * _FACET.size:
        return _of_bytes(raw, count)
    text = raw.removeprefix(BOM_UTF8)
    if text.lstrip()[:5].lower() == b"solid":
        return _of_text(text)
    if count is None:
        sentence = f"expected the word solid, or {HEADER} bytes or more, found {len(raw)} bytes"
        raise MeshFileError(sentence)
    expected = f"{count} facets, declared at byte 80, are {HEADER + count * _FACET.size} bytes"
    raise MeshFileError(f"{expected}; found {len(raw)}")


def _of_bytes(raw: bytes, count: int) -> FileTriangles:
    if count > MOST_OF_BOTH:
        raise MeshFileError(too_many())
    read = FileTriangles()
    for facet, numbers in enumerate(_FACET.iter_unpack(raw[HEADER:])):
        if not all(map(math.isfinite, numbers)):
            at = HEADER + facet * _FACET.size
            raise MeshFileError(f"facet {facet}, at byte {at}: expected finite numbers")
        a, b, c = (read.weld_vertex(numbers[k : k + 3], 0) for k in (0, 3, 6))
        read.add_triangle((a, b, c), 0)
    return read


def _of_text(raw: bytes) -> FileTriangles:
    read = FileTriangles()
    lines = _lines(raw)
    for line, words in lines:
        if words[0].lower() != b"solid":
            raise MeshFileError(f"expected solid, found {shown(words[0])}", line)
        _read_solid(lines, read, line)
    return read


def _lines(raw: bytes) -> Iterator[tuple[int, list[bytes]]]:
    for number, text in enumerate(raw.splitlines(), start=1):
        if words := text.split():
            yield number, words


def _read_solid(lines: Iterator[tuple[int, list[bytes]]], read: FileTriangles, line: int) -> None:
    """Read facets up to the end of a solid, which begins in this line."""
    for line, words in lines:
        if words[0].lower() == b"endsolid":
            return
        corners = [_read_line(_LOOP[0], line, words)]
        for expected in _LOOP[1:]:
            inside, words = next(lines, (0, []))
            if not words:
                raise MeshFileError(f"the file ends in the facet of line {line}", line)
            corners.append(_read_line(expected, inside, words))
        a, b, c = (read.weld_vertex(place, line) for place in corners if place is not None)
        read.add_triangle((a, b, c), line)
    raise MeshFileError("the file ends without endsolid", line)


def _read_line(expected: str, line: int, words: list[bytes]) -> Vector3 | None:
    """Return the place of a vertex; None where the line has no place, as it is expected."""
    names = expected.encode().split()
    if [word.lower() for word in words[: len(names)]] != names:
        raise MeshFileError(f"expected {expected}, found {shown(b' '.join(words))}", line)
    if expected != "vertex":
        return None
    if len(words) != 4:
        raise MeshFileError(f"expected vertex x y z, found {len(words) - 1} numbers", line)
    x, y, z = (coordinate(word, line) for word in words[1:])
    return x, y, z
