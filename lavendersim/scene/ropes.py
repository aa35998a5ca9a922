"""Ropes in the engine's tables: rows of their ends behind all bodies, and pairs before all others.

The rows of the ends of rope k are 2 k and 2 k + 1 of those behind the bodies and parts.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lavendersim.cell import CellConfig, CellScene, Surface
from lavendersim.engine.effects import PairFacts
from lavendersim.engine.effects.rope import Rope, pulling, turned
from lavendersim.engine.record_layout import allocate_pairs
from lavendersim.engine.records import ROPE, ROPE_END
from lavendersim.engine.row_terms import row_terms
from lavendersim.engine.spec import Spec
from lavendersim.geometry.rotations import rotation_matrix

from .body_rows import orient, pose_of
from .pair_tables import fill_surface


def surface_of(rope: Rope) -> Surface:
    """Return what a taut rope obeys, as if it were a contact of two surfaces."""
    return Surface(friction=0.0, restitution=rope.restitution)


def facts_of_ropes(scene: CellScene) -> Iterator[PairFacts[str]]:
    """Yield each rope as a pair that may touch."""
    off_centre = {*turned(scene)}
    for one in pulling(scene).values():
        a, b = one.between
        missed = any(
            any(point) and body in off_centre
            for body, point in zip(one.between, one.points, strict=True)
        )
        yield PairFacts(a=a, b=b, surface=surface_of(one), shape_pair="rope", off_centre=missed)


def with_ends(spec: Spec, bodies: np.ndarray, config: CellConfig) -> np.ndarray:
    """Return the body table with the ends of ropes behind it."""
    if not row_terms(spec).taut:
        return bodies
    names, ropes = list(config.scene.bodies), pulling(config.scene)
    table = np.zeros(len(bodies) + 2 * len(ropes), bodies.dtype)
    table[: len(bodies)] = bodies
    for number, one in enumerate(ropes.values()):
        ends = table[len(bodies) + 2 * number :][:2]
        for end, name, point in zip(ends, one.between, one.points, strict=True):
            pose = pose_of(config.scene.bodies[name])
            end["shape"], end["owner"] = ROPE_END, names.index(name)
            end["px"], end["py"], end["pz"] = point
            end["pqw"] = 1.0
            end["x"], end["y"], end["z"] = pose[:3] + rotation_matrix(pose[3:]) @ np.array(point)
            orient(end, pose[3:])
        length = one.length
        if length is None:
            length = float(np.linalg.norm([ends[axis][1] - ends[axis][0] for axis in "xyz"]))
        ends["hx"], ends["hy"], ends["bound"] = length, number, length
    return table


def with_ropes(spec: Spec, pairs: np.ndarray, bodies: np.ndarray, scene: CellScene) -> np.ndarray:
    """Return the table of pairs with those of ropes before it; bodies: see `with_ends`."""
    if not row_terms(spec).taut:
        return pairs
    ends = np.flatnonzero(bodies["shape"] == ROPE_END)
    ropes = allocate_pairs(spec, len(ends) // 2)
    ropes["a"], ropes["b"], ropes["kind"] = ends[::2], ends[1::2], ROPE
    ropes["key"] = np.arange(-len(ropes), 0)  # all keys ascend
    for row, one in zip(ropes, pulling(scene).values(), strict=True):
        fill_surface(row, surface_of(one))
    return np.concatenate([ropes, pairs])
