"""Bodies that start so fast that they pass through others within a step, unseen.

With `speculative` contacts are made ahead of touching, so nothing is passed. Without, a contact is
found only where bodies overlap at the start of a step: two that move past each other by more than
both are thick may never do so. Planes are half-spaces: what is behind one is found there.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from lavendersim.cell import Cavity, CellBody, CellMesh, Plane
from lavendersim.errors import Defect
from lavendersim.experiment import Cell, body_path
from lavendersim.geometry.shapes import thickness


def crossing(cell: Cell) -> Iterator[Defect]:
    """Yield a defect at each velocity that may carry its body through the thinnest other one."""
    config = cell.config
    if config.numerics.speculative:
        return
    timestep = float(config.numerics.timestep)
    solids = {
        name: body
        for name, body in config.scene.bodies.items()
        if not isinstance(body.shape, Plane | Cavity | CellMesh)
    }
    thinnest = sorted(solids, key=lambda name: thickness(solids[name].shape))[:2]
    tree = cell.tree
    for name, body in solids.items():
        other = next((one for one in thinnest if one != name), None)
        if other is None or not any(body.velocity):
            continue
        moved = timestep * _relative_speed(body, solids[other])
        thick = thickness(body.shape) + thickness(solids[other].shape)
        if moved > thick:
            sentence = (
                f"velocity: {name} and {other} may pass through each other: they close by "
                f"{moved:.3g} m in a step and are {thick:.3g} m thick; speculative: true meets them"
            )
            yield cell.defect((*body_path(tree, name), "velocity"), sentence)


def _relative_speed(one: CellBody, other: CellBody) -> float:
    """Return the speed of two bodies relative to each other [m/s]."""
    return hypot(*(a - b for a, b in zip(one.velocity, other.velocity, strict=True)))
