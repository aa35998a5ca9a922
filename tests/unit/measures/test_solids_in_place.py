"""The solids of a scene: their kinds and sizes, where they are, and which bounds meet."""

from __future__ import annotations

import numpy as np

from lavendersim.measures.solids import BOX, OTHER, SPHERE, kind_of, near_pairs, solids_of
from tests.made_cells import MadeShape, made_cell

CELL = made_cell(
    {
        "floor": {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": -1.0}},
        "ball": {"shape": {"kind": "sphere", "radius": 0.5}},
        "slab": {"shape": {"kind": "box", "size": [2.0, 2.0, 1.0]}, "fixed": True},
        "wall": {"shape": {"kind": "box", "size": [1.0, 1.0, 1.0]}, "fixed": True},
    }
)
NAMES = ["slab", "floor", "wall", "ball"]  # as a log may have them
# slab, floor, wall, ball
POSES = np.zeros((4, 7))
POSES[:, 3] = 1.0


def test_planes_stand_apart_and_columns_are_those_of_the_log() -> None:
    solids, planes = solids_of(CELL.scene, NAMES)
    assert solids.columns.tolist() == [0, 2, 3]
    assert solids.kind.tolist() == [BOX, BOX, SPHERE]
    assert solids.size.tolist() == [[1.0, 1.0, 0.5], [0.5, 0.5, 0.5], [0.5, 0.0, 0.0]]
    assert solids.movable.tolist() == [False, False, True]
    ((normal, offset),) = planes
    assert (np.asarray(normal).tolist(), offset) == ([0.0, 0.0, 1.0], -1.0)


def test_bounds_meet_only_where_one_can_move() -> None:
    solids, _ = solids_of(CELL.scene, NAMES)
    poses = POSES.copy()
    poses[3, 2] = 0.9  # 0.5 + 0.5 reach farther than that
    a, b = near_pairs(solids.sums, solids.placed(poses), solids.movable)
    assert sorted(zip(a.tolist(), b.tolist(), strict=True)) == [(0, 2), (1, 2)]
    poses[3, 2] = 1.1
    a, _ = near_pairs(solids.sums, solids.placed(poses), solids.movable)
    assert len(a) == 0


def test_some_of_the_solids_keep_their_places_and_sizes() -> None:
    solids, _ = solids_of(CELL.scene, NAMES)
    poses = POSES.copy()
    poses[:, 0] = [1.0, 2.0, 3.0, 4.0]
    chosen = solids.placed(poses).take([2, 0])
    assert chosen.position[:, 0].tolist() == [4.0, 1.0]
    assert chosen.size.tolist() == [[0.5, 0.0, 0.0], [1.0, 1.0, 0.5]]


def test_a_shape_of_another_kind_is_other() -> None:
    assert kind_of(MadeShape()) == OTHER  # type: ignore[arg-type]
