"""Joints in the engine's tables: rows of their ends behind all others, and pairs before all others.

The lower of the two rows of bodies is A. Of each joint one pair a row of it: the same ends, one of
the world's axes. They stand by the rows of their bodies, so that a broad phase finds them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lavendersim.cell import CellConfig, CellScene, Surface
from lavendersim.engine.collide.joint import FIRST_AXIS
from lavendersim.engine.effects import PairFacts, holding, turned_by_joints
from lavendersim.engine.effects.joint import AXES
from lavendersim.engine.record_layout import allocate_pairs
from lavendersim.engine.records import ROPE_END
from lavendersim.engine.spec import Spec
from lavendersim.geometry.rotations import rotation_matrix

from .body_rows import orient, pose_of
from .pair_tables import fill_surface

_NONE = Surface()


def joined_bodies(scene: CellScene) -> frozenset[tuple[int, int]]:
    """Return the pairs of bodies, by their rows in order, that a joint keeps from touching."""
    names = list(scene.bodies)
    return frozenset(
        tuple(sorted(names.index(body) for body in one.between))  # type: ignore[misc]
        for one in holding(scene).values()
        if not one.collide
    )


def facts_of_joints(scene: CellScene) -> Iterator[PairFacts]:
    """Yield each joint as a pair, of as many rows as it has."""
    off_centre = {*turned_by_joints(scene)}
    for one in holding(scene).values():
        a, b = one.between
        yield PairFacts(
            a=a,
            b=b,
            surface=_NONE,
            shape_pair="joint",
            row_pairs=AXES,
            off_centre=a in off_centre or b in off_centre,
        )


def with_joint_ends(spec: Spec, bodies: np.ndarray, config: CellConfig) -> np.ndarray:
    """Return the body table with the ends of joints behind it, in the order of their pairs."""
    if not spec.has("joint"):
        return bodies
    names, joints = list(config.scene.bodies), list(holding(config.scene).values())
    places = [sorted(names.index(body) for body in one.between) for one in joints]
    order = sorted(range(len(joints)), key=lambda number: (places[number], number))
    table = np.zeros(len(bodies) + 2 * len(joints), bodies.dtype)
    table[: len(bodies)] = bodies
    for k, number in enumerate(order):
        at = np.array(joints[number].at)
        ends = table[len(bodies) + 2 * k :][:2]
        for end, owner in zip(ends, places[number], strict=True):
            pose = pose_of(config.scene.bodies[names[owner]])
            end["shape"], end["owner"] = ROPE_END, owner
            end["bound"] = bodies[owner]["bound"]  # how far it may go before pairs are listed anew
            end["px"], end["py"], end["pz"] = rotation_matrix(pose[3:]).T @ (at - pose[:3])
            end["pqw"] = 1.0
            end["x"], end["y"], end["z"] = at
            orient(end, pose[3:])
        ends["hy"], ends["hz"] = number, 1.0 if joints[number].collide else 0.0
    return table


def with_joints(spec: Spec, pairs: np.ndarray, bodies: np.ndarray, first: int) -> np.ndarray:
    """Return the table of pairs with those of joints before it; first: row of the first end."""
    if not spec.has("joint"):
        return pairs
    ends = np.arange(first, len(bodies))
    joints = allocate_pairs(spec, AXES * (len(ends) // 2))
    joints["a"], joints["b"] = np.repeat(ends[::2], AXES), np.repeat(ends[1::2], AXES)
    joints["kind"] = FIRST_AXIS - np.tile(np.arange(AXES), len(ends) // 2)
    before = min(0, int(pairs["key"].min())) if len(pairs) else 0
    joints["key"] = np.arange(before - len(joints), before)  # all keys ascend
    for row in joints:
        fill_surface(row, _NONE)
    return np.concatenate([joints, pairs])
