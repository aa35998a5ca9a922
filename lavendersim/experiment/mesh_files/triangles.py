"""Triangles of a file while it is read: vertices by place, welded where equal to the last bit."""

from __future__ import annotations

import math
import re
from typing import Final

from lavendersim.experiment.text.parse import MOST_VALUES
from lavendersim.quantities.found import quoted
from lavendersim.quantities.quantity import Vector3

# A config holds them with its other values: a list and three numbers for each vertex and triangle.
MOST_OF_BOTH: Final = MOST_VALUES // 4
_NUMBER: Final = re.compile(rb"[-+]?(\d{1,400}\.?\d{0,400}|\.\d{1,400})([eE][-+]?\d{1,9})?")


class MeshFileError(ValueError):
    """What is wrong with a file; `line` is counted from 1, 0 in one without lines."""

    def __init__(self, sentence: str, line: int = 0) -> None:
        super().__init__(sentence)
        self.line = line


class FileTriangles:
    """V vertices [the file's unit] and T triangles, with the line of each; 0 without lines."""

    def __init__(self) -> None:
        self.vertices: list[Vector3] = []
        self.vertex_lines: list[int] = []
        self.triangles: list[tuple[int, int, int]] = []
        self.triangle_lines: list[int] = []
        self._rows: dict[Vector3, int] = {}

    def add_vertex(self, place: Vector3, line: int) -> int:
        """Return the row of a new vertex; raises MeshFileError where it is one too many."""
        x, y, z = place
        self.vertices.append((x + 0.0, y + 0.0, z + 0.0))  # no -0.0, which is at the same place
        self.vertex_lines.append(line)
        self._check_room(line)
        return len(self.vertices) - 1

    def weld_vertex(self, place: Vector3, line: int) -> int:
        """Return the row of the vertex at this place, to the last bit, or of a new one."""
        row = self._rows.get(place)
        if row is None:
            row = self._rows[place] = self.add_vertex(place, line)
        return row

    def add_triangle(self, corners: tuple[int, int, int], line: int) -> None:
        """Add a triangle by rows of vertices; raises MeshFileError where it is one too many."""
        self.triangles.append(corners)
        self.triangle_lines.append(line)
        self._check_room(line)

    def _check_room(self, line: int) -> None:
        if len(self.vertices) + len(self.triangles) > MOST_OF_BOTH:
            raise MeshFileError(too_many(), line)


def too_many() -> str:
    """Return the sentence for more vertices and triangles than a config holds."""
    return f"expected at most {MOST_OF_BOTH} vertices and triangles together, found more"


def coordinate(word: bytes, line: int) -> float:
    """Return a number of a text; raises MeshFileError where it is none, or not finite."""
    value = float(word) if _NUMBER.fullmatch(word) else math.nan
    if not math.isfinite(value):
        raise MeshFileError(f"expected a number, found {shown(word)}", line)
    return value


def shown(word: bytes) -> str:
    """Return a word of a file for a sentence, whatever its bytes are."""
    text = word.decode("latin-1")
    return quoted(
        "".join(one if one.isprintable() else "\N{REPLACEMENT CHARACTER}" for one in text)
    )
