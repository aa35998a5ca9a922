"""Meshes whose tables are looked at: a box, and a flat grid of 18 triangles."""

from __future__ import annotations

from itertools import product

from lavendersim.cell import CellMesh

_LOOPS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
BOX = CellMesh(
    kind="mesh",
    vertices=tuple(product((-0.5, 0.5), repeat=3)),
    triangles=tuple((loop[0], loop[k], loop[k + 1]) for loop in _LOOPS for k in (1, 2)),
)
GRID = CellMesh(
    kind="mesh",
    vertices=tuple((float(x), float(y), 0.0) for x in range(4) for y in range(4)),
    triangles=tuple(
        triangle
        for i, j in product(range(3), repeat=2)
        for a, c in [(4 * i + j, 4 * i + j + 4)]
        for triangle in ((a, c, c + 1), (a, c + 1, a + 1))
    ),
)
