"""Pairs of a small scene stand in a table; a broad phase has what it writes by classes of rows."""

from __future__ import annotations

import numpy as np

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import NO_PAIR
from lavendersim.engine.spec import Spec
from lavendersim.scene.colliders import colliders
from lavendersim.scene.pair_tables import PAIRS_PER_BODY, pair_tables
from tests.made_cells import made_body

BALL = {"kind": "sphere", "radius": 0.1}
PLANE = {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}
ROWS = colliders(
    [
        made_body(PLANE, surface={"friction": 0.9}),
        made_body(BALL, surface={"friction": 0.4}),
        made_body(BALL, surface={"friction": 0.4}),
    ]
)
SPEC = Spec(("friction", "rotation"), ("sphere_plane", "sphere_sphere"))


def test_pairs_have_their_kind_and_what_their_surfaces_mix_to() -> None:
    pairs, templates, _ = pair_tables(SPEC, ROWS, allocate_bodies(SPEC, 3))
    assert sorted(zip(*np.sort([pairs["a"], pairs["b"]], axis=0), strict=True)) == [
        *((0, 1), (0, 2), (1, 2)),
    ]
    assert pairs["key"].tolist() == [0, 1, 2]
    kinds = {SHAPE_PAIRS[name].kind for name in SPEC.shape_pairs}
    assert set(pairs["kind"]) == kinds
    by_kind = dict(zip(pairs["kind"], pairs["friction"], strict=True))
    assert np.isclose(by_kind[SHAPE_PAIRS["sphere_plane"].kind], 0.6, rtol=1e-15)
    assert "restitution" not in pairs.dtype.names
    assert templates.shape == (0, 0)


def test_a_broad_phase_has_a_template_for_each_two_classes() -> None:
    spec = SPEC.including("broad_phase")
    bodies = allocate_bodies(spec, 3)
    pairs, templates, _ = pair_tables(spec, ROWS, bodies)
    assert len(pairs) == 3 * PAIRS_PER_BODY
    assert bodies["material"].tolist() == [0, 1, 1]
    assert templates["kind"][0, 0] == NO_PAIR  # two planes
    assert templates["kind"][0, 1] == templates["kind"][1, 0] == SHAPE_PAIRS["sphere_plane"].kind
    assert templates["swap"][0, 1] != templates["swap"][1, 0]
    assert templates["kind"][1, 1] == SHAPE_PAIRS["sphere_sphere"].kind


def test_what_a_body_becomes_by_an_event_has_a_class_before_any_row_has() -> None:
    """Ice on wood: sqrt(0.9 * 0) is 0; the plane, the balls, and a ball of ice."""
    spec = SPEC.including("broad_phase")
    bodies = allocate_bodies(spec, 3)
    later = [made_body(BALL, surface={"friction": 0.0})]
    _, templates, classes = pair_tables(spec, ROWS, bodies, later)
    assert bodies["material"].tolist() == [0, 1, 1]
    assert [one.surface.friction for one in classes] == [0.9, 0.4, 0.0]
    assert templates["kind"][0, 2] == SHAPE_PAIRS["sphere_plane"].kind
    assert templates["friction"][0, 2] == 0.0
