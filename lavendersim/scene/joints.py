"""Joints in the engine's tables: rows of their ends behind all others, and pairs before all others.

The lower of the two rows of bodies is A. Of each joint one pair a row of it: the ends of one of its
points, and a direction. They stand by the rows of their bodies, so that a broad phase finds them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from lavendersim.cell import CellConfig, CellScene, Surface
from lavendersim.engine.effects import PairFacts, holding, turned_by_joints
from lavendersim.engine.effects.joint_models import (
    ALONG,
    BALL,
    DRIVEN_POINT,
    HingeJoint,
    Joint,
    JointWithAxis,
    RowOfJoint,
    SliderJoint,
)
from lavendersim.engine.record_layout import allocate_pairs
from lavendersim.engine.records import ROPE_END
from lavendersim.engine.row_terms import row_terms
from lavendersim.engine.spec import Spec
from lavendersim.geometry.quaternions import from_axes, inverse, product
from lavendersim.geometry.rotations import frame_along, rotation_matrix
from lavendersim.quantities.quantity import Quaternion, Vector3

from .body_rows import orient, pose_of
from .pair_tables import fill_surface

_NONE = Surface()
# B's centre is on the axis where it is nearer than this share of the joint's own distance [-].
ON_AXIS = 1e-3


def joined_bodies(scene: CellScene) -> frozenset[tuple[int, int]]:
    """Return the pairs of bodies, by their rows in order, that a joint keeps from touching."""
    names = list(scene.bodies)
    return frozenset(
        tuple(sorted(names.index(body) for body in one.between))  # type: ignore[misc]
        for one in holding(scene).values()
        if not one.collide
    )


def facts_of_joints(scene: CellScene) -> Iterator[PairFacts[str]]:
    """Yield each joint as a pair, of as many rows as it has."""
    off_centre = {*turned_by_joints(scene)}
    for one in holding(scene).values():
        a, b = one.between
        yield PairFacts(
            a=a,
            b=b,
            surface=_NONE,
            shape_pair="joint",
            row_pairs=len(one.rows) + len(one.motor_row),
            off_centre=a in off_centre or b in off_centre,
        )
        if one.stop_rows:
            yield PairFacts(
                a=a,
                b=b,
                surface=_NONE,
                shape_pair="joint_stop",
                row_pairs=len(one.stop_rows),
                off_centre=True,
            )


def with_joint_ends(spec: Spec, bodies: np.ndarray, config: CellConfig) -> np.ndarray:
    """Return the body table with the ends of joints behind it, in the order of their pairs."""
    if not row_terms(spec).bilateral:
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
        for point in _points(spec, one):
            if point == DRIVEN_POINT:
                added.append(_driven_ends(_Joined(one, number, owners), bodies, config, apart))
                continue
            at = np.array(one.at) + offsets[point]
            frame = from_axes(columns.T.tolist()) if one.rows != BALL else None
            joined = _Joined(one, number, owners)
            added.append(_ends(joined, bodies, config, (at, at), frame))
    return np.concatenate([bodies, *added])


class _Joined(NamedTuple):
    """A joint, its number, and the rows of its bodies, the lower one first."""

    joint: Joint
    number: int
    owners: list[int]


def _ends(
    joined: _Joined,
    bodies: np.ndarray,
    config: CellConfig,
    places: tuple[np.ndarray, np.ndarray],
    frame: Quaternion | None,
) -> np.ndarray:
    """Return the rows of both ends of a point of a joint; frame: of both, as the run begins."""
    described = list(config.scene.bodies.values())
    ends = np.zeros(2, bodies.dtype)
    for end, owner, at in zip(ends, joined.owners, places, strict=True):
        pose = pose_of(described[owner])
        end["shape"], end["owner"] = ROPE_END, owner
        end["bound"] = bodies[owner]["bound"]  # how far it may go before pairs are anew
        end["px"], end["py"], end["pz"] = rotation_matrix(pose[3:]).T @ (at - pose[:3])
        end["x"], end["y"], end["z"] = at
        own, there = (1.0, 0.0, 0.0, 0.0), pose[3:]
        if frame is not None:
            own, there = product(inverse(tuple(pose[3:])), frame), np.array(frame)
        end["pqw"], end["pqx"], end["pqy"], end["pqz"] = own
        orient(end, there)
    ends["hy"], ends["hz"] = joined.number, 1.0 if joined.joint.collide else 0.0
    return ends


def _driven_ends(
    joined: _Joined, bodies: np.ndarray, config: CellConfig, apart: float
) -> np.ndarray:
    """Return the ends of what stops and drives it: A's on the axis, B's at the centre of B.

    Or of A, where only A moves. Of a slider both are there. x of a hinge's frame leads from the one
    to the other: angle 0.
    """
    one, _, owners = joined
    axis, described = _unit(one.along), list(config.scene.bodies.values())
    moves = owners[0] if described[owners[1]].fixed else owners[1]
    centre = pose_of(described[moves])[:3]
    columns = frame_along(axis)
    on_axis = np.array(one.at) + axis * (axis @ (centre - np.array(one.at)))
    beside, begin = centre - on_axis, centre
    if _is_about(one):
        begin, size = on_axis, float(np.linalg.norm(beside))
        if size > ON_AXIS * apart:
            x = beside / size
            columns = np.column_stack([x, np.cross(axis, x), axis])
        else:
            centre = on_axis + apart * columns[:, 0]
    frame = from_axes(columns.T.tolist())
    ends = _ends(joined, bodies, config, (begin, centre), frame)
    if isinstance(one, JointWithAxis) and one.stop_rows:
        lower, upper = _as_in_rows(one, owners, config, one.limits)
        ends["hx"] = min(lower, upper), max(lower, upper)
    return ends


def _is_about(joint: Joint) -> bool:
    """Whether it moves about its axis, not along it."""
    return any(row.direction < ALONG for row in (*joint.motor_row, *joint.stop_rows))


def _as_in_rows(
    joint: Joint, owners: list[int], config: CellConfig, numbers: Iterable[float]
) -> list[float]:
    """Return what is of the second body of a joint against the first as it is of B against A."""
    sign = 1.0 if list(config.scene.bodies)[owners[0]] == joint.between[0] else -1.0
    return [sign * number for number in numbers]


def _points(spec: Spec, joint: Joint) -> list[int]:
    """Return the points that rows of a joint are of, in order."""
    return sorted({row.point for row in _all_rows(spec, joint)})


def _all_rows(spec: Spec, joint: Joint) -> tuple[RowOfJoint, ...]:
    stops = joint.stop_rows if row_terms(spec).stopped else ()
    return (*joint.rows, *stops, *(joint.motor_row if row_terms(spec).bounded else ()))


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
    spec: Spec, pairs: np.ndarray, bodies: np.ndarray, first: int, config: CellConfig
) -> np.ndarray:
    """Return the table of pairs with those of joints before it; first: row of the first end."""
    if not row_terms(spec).bilateral or first == len(bodies):
        return pairs
    from lavendersim.engine.collide.joint import DIRECTIONS, FIRST_ROW  # late: numba

    joints_by_number = list(holding(config.scene).values())
    table_rows: list[tuple[int, int, int]] = []
    driven: dict[int, tuple[float, float]] = {}  # speed and most of motors, by rows of the table
    while first < len(bodies):
        one = joints_by_number[int(bodies["hy"][first])]
        points = _points(spec, one)
        for k, row in enumerate(_all_rows(spec, one)):
            end = first + 2 * points.index(row.point)
            if row in one.motor_row:
                driven[len(table_rows)] = _motor(
                    one, bodies["owner"][end : end + 2].tolist(), config
                )
            table_rows.append((end, end + 1, FIRST_ROW - (DIRECTIONS * k + row.direction)))
        first += 2 * len(points)
    joints = allocate_pairs(spec, len(table_rows))
    joints["a"], joints["b"], joints["kind"] = np.array(table_rows).T
    before = min(0, int(pairs["key"].min())) if len(pairs) else 0
    joints["key"] = np.arange(before - len(joints), before)  # all keys ascend
    for record in joints:
        fill_surface(record, _NONE)
    for number, (speed, most) in driven.items():
        joints["motor_speed"][number], joints["motor_most"][number] = speed, most
    return np.concatenate([joints, pairs])


def _motor(joint: Joint, owners: list[int], config: CellConfig) -> tuple[float, float]:
    """Return speed and most of a motor's row; a couple is of forces at 1 m."""
    assert isinstance(joint, HingeJoint | SliderJoint)
    assert joint.motor is not None
    (speed,) = _as_in_rows(joint, owners, config, (joint.motor.speed,))
    return speed, joint.motor.most
