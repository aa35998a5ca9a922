"""Bodies that start so fast that they pass through others within a step, unseen.

With `speculative` contacts are made ahead of touching, so nothing is passed. Without, a contact is
found only where bodies overlap at the start of a step: two that move past each other by more than
both are thick may never do so. Planes are half-spaces: what is behind one is found there. A mesh is
touched only while a body's centre is in front of it: that is half the body's thickness.
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
    meshes = {
        name: body for name, body in config.scene.bodies.items() if isinstance(body.shape, CellMesh)
    }
    tree = cell.tree
    for name, body in solids.items():
        if not any(body.velocity):
            continue
        path = (*body_path(tree, name), "velocity")
        other = next((one for one in thinnest if one != name), None)
        if other is not None:
            moved = timestep * _relative_speed(body, solids[other])
            thick = thickness(body.shape) + thickness(solids[other].shape)
            if moved > thick:
                sentence = (
                    f"velocity: {name} and {other} may pass through each other: they close by "
                    f"{moved:.3g} m in a step and are {thick:.3g} m thick; speculative: true meets "
                    "them"
                )
                yield cell.defect(path, sentence)
                continue
        for mesh, surface in meshes.items():
            moved = timestep * _relative_speed(body, surface)
            half = 0.5 * thickness(body.shape)
            if moved > half:
                sentence = (
                    f"velocity: {name} may pass through {mesh}: they close by {moved:.3g} m in a "
                    f"step and half of {name} is {half:.3g} m thick; speculative: true meets it"
                )
                yield cell.defect(path, sentence)
                break


def _relative_speed(one: CellBody, other: CellBody) -> float:
    """Return the speed of two bodies relative to each other [m/s]."""
    return hypot(*(a - b for a, b in zip(one.velocity, other.velocity, strict=True)))
