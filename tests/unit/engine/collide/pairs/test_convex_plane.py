"""The manifold of any convex shape on a plane, where a closed form knows the answer."""

from __future__ import annotations

import numpy as np
import pytest
import solid_poses

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.records import TOUCHING
from lavendersim.engine.spec import Spec

POSES = 200
PLANES = tuple(name for name, pair in SHAPE_PAIRS.items() if "plane" in pair.shapes)


@pytest.mark.parametrize("pair", PLANES)
def test_the_lowest_point_is_that_of_the_closed_form(pair, monkeypatch):
    sample = solid_poses.random_sample(pair, POSES)
    closed = solid_poses.manifolds(sample, 0.05)
    monkeypatch.setitem(SHAPE_PAIRS, pair, SHAPE_PAIRS[pair]._replace(file="convex_plane"))
    spec = Spec(effects=("rotation", "speculative"), shape_pairs=(pair,), solver="convex planes")
    general = solid_poses.manifolds(sample, 0.05, spec)
    assert any(len(found.phi) for found in closed)
    for one, other in zip(closed, general, strict=True):
        assert (len(one.phi) == 0) == (len(other.phi) == 0)
        if len(one.phi):
            assert np.array_equal(one.normal, other.normal)
            # a corner of the feature that is not a hair higher is taken for the lowest point
            assert other.phi.min() == pytest.approx(one.phi.min(), abs=1.01 * TOUCHING)
            assert len(set(other.feature)) == len(other.feature)


@pytest.mark.parametrize("pair", ["box_plane", "cylinder_plane", "hull_plane"])
def test_a_face_rests_on_its_corners(pair, monkeypatch):
    sample = solid_poses.random_sample(pair, 1)
    body = sample.second[0]
    plane = sample.first[0]
    plane["hx"], plane["hy"], plane["hz"], plane["offset"] = 0.0, 0.0, 1.0, 0.0
    if pair == "hull_plane":
        sample.hulls[body["hull"]] = (
            np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]),
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
        )
        height, body["bound"] = 1.0, 2.0
    else:
        height = body["hz"]
    for i in range(3):
        for j in range(3):
            body[f"r{i}{j}"] = float(i == j)
    body["x"], body["y"], body["z"] = 0.0, 0.0, height
    monkeypatch.setitem(SHAPE_PAIRS, pair, SHAPE_PAIRS[pair]._replace(file="convex_plane"))
    spec = Spec(effects=("rotation", "speculative"), shape_pairs=(pair,), solver="convex planes")
    (found,) = solid_poses.manifolds(sample, 0.0, spec)
    assert len(found.phi) == 4
    assert np.abs(found.phi).max() <= 1e-15
    assert np.abs(found.points[:, 2]).max() <= 1e-15
    assert np.allclose(found.points.mean(axis=0), 0.0, atol=1e-15)
