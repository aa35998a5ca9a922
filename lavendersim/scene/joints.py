"""Joints in the engine's tables: rows of their ends behind all others, and pairs before all others.

The lower of the two rows of bodies is A. Of each joint one pair a row of it: the ends of one of its
points, and a direction. They stand by the rows of their bodies, so that a broad phase finds them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lavendersim.cell import CellConfig, CellScene, Surface
from lavendersim.engine.collide.joint import DIRECTIONS, FIRST_ROW
from lavendersim.engine.effects import PairFacts, holding, turned_by_joints
from lavendersim.engine.effects.joint import BALL, Joint
from lavendersim.engine.record_layout import allocate_pairs
from lavendersim.engine.records import ROPE_END
from lavendersim.engine.spec import Spec
from lavendersim.geometry.quaternions import from_axes, inverse, product
from lavendersim.geometry.rotations import frame_along, rotation_matrix
from lavendersim.quantities.quantity import Vector3

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
            row_pairs=len(one.rows),
            off_centre=a in off_centre or b in off_centre,
        )


def with_joint_ends(spec: Spec, bodies: np.ndarray, config: CellConfig) -> np.ndarray:
    """Return the body table with the ends of joints behind it, in the order of their pairs."""
    if not spec.has("joint"):
        return bodies
    names, joints = list(config.scene.bodies), list(holding(config.scene).values())
    places = [sorted(names.index(body) for body in one.between) for one in joints]
    order = sorted(range(len(joints)), key=lambda number: (places[number], number))
    added = []
    for number in order:
        one, owners = joints[number], places[number]
        columns = frame_along(_unit(one.along))
        apart = _apart(bodies[owners]) if one.rows != BALL else 0.0
        offsets = (np.zeros(3), apart * columns[:, 2], apart * columns[:, 0])
        turn = from_axes(columns.T.tolist())
        for offset in offsets[: _points(one)]:
            ends = np.zeros(2, bodies.dtype)
            at = np.array(one.at) + offset
            for end, owner in zip(ends, owners, strict=True):
                pose = pose_of(config.scene.bodies[names[owner]])
                end["shape"], end["owner"] = ROPE_END, owner
                end["bound"] = bodies[owner]["bound"]  # how far it may go before pairs are anew
                end["px"], end["py"], end["pz"] = rotation_matrix(pose[3:]).T @ (at - pose[:3])
                end["x"], end["y"], end["z"] = at
                own, there = (1.0, 0.0, 0.0, 0.0), pose[3:]
                if one.rows != BALL:
                    own, there = product(inverse(tuple(pose[3:])), turn), np.array(turn)
                end["pqw"], end["pqx"], end["pqy"], end["pqz"] = own
                orient(end, there)
            ends["hy"], ends["hz"] = number, 1.0 if one.collide else 0.0
            added.append(ends)
    return np.concatenate([bodies, *added])


def _points(joint: Joint) -> int:
    return 1 + max(row.point for row in joint.rows)


def _unit(direction: Vector3) -> np.ndarray:
    vector = np.array(direction) / max(map(abs, direction))
    return np.asarray(vector / np.linalg.norm(vector))


def _apart(pair: np.ndarray) -> float:
    """Return how far the points of a joint are apart [m]: both bodies' radius of gyration as one.

    A force there and its opposite where the joint is turn the two as easily as it moves them: rows
    weigh alike.
    """
    turns = sum(pair[f"inv_i{axis}"].sum() for axis in "xyz") / 3.0
    return float(np.sqrt(pair["inv_m"].sum() / turns)) if turns > 0.0 else 1.0


def with_joints(
    spec: Spec, pairs: np.ndarray, bodies: np.ndarray, first: int, scene: CellScene
) -> np.ndarray:
    """Return the table of pairs with those of joints before it; first: row of the first end."""
    if not spec.has("joint") or first == len(bodies):
        return pairs
    joints_by_number, table_rows = list(holding(scene).values()), []
    while first < len(bodies):
        one = joints_by_number[int(bodies["hy"][first])]
        for k, row in enumerate(one.rows):
            end = first + 2 * row.point
            table_rows.append((end, end + 1, FIRST_ROW - (DIRECTIONS * k + row.direction)))
        first += 2 * _points(one)
    joints = allocate_pairs(spec, len(table_rows))
    joints["a"], joints["b"], joints["kind"] = np.array(table_rows).T
    before = min(0, int(pairs["key"].min())) if len(pairs) else 0
    joints["key"] = np.arange(before - len(joints), before)  # all keys ascend
    for record in joints:
        fill_surface(record, _NONE)
    return np.concatenate([joints, pairs])
