"""Tangents are a right-handed orthonormal frame, with the same bits in kernels and of columns."""

from __future__ import annotations

import numpy as np
from numba import njit

from lavendersim.engine.block import set_tangents
from lavendersim.engine.effects.friction import tangent_x, tangent_y, tangent_z
from lavendersim.engine.tangents import first_tangent, second_tangent

EPSILON = 2.0**-52


def normals() -> np.ndarray:
    """Return unit vectors: of all directions, along the axes, and a little beside -z."""
    random = np.random.default_rng(7).normal(size=(500, 3))
    axes = np.concatenate([np.eye(3), -np.eye(3), [[1e-6, -1e-7, -1.0]]])
    all_of_them = np.concatenate([random, axes])
    return all_of_them / np.linalg.norm(all_of_them, axis=1)[:, None]


def test_the_frame_is_orthonormal_and_right_handed() -> None:
    n = normals()
    side = np.where(n[:, 2] >= 0.0, 1.0, -1.0)
    one = np.stack(first_tangent(*n.T, side), axis=-1)
    two = np.stack(second_tangent(*n.T, side), axis=-1)
    # |side + z| >= 1, so no term of the formula is above 2: each entry is right to a few roundings,
    # and n to as many of its own length.
    bound = 16 * EPSILON
    frames = np.stack([n, one, two], axis=1)
    products = np.einsum("nik,njk->nij", frames, frames)
    assert np.abs(products - np.eye(3)).max() <= bound
    assert np.abs(np.cross(n, one) - two).max() <= bound


@njit
def fill(rows):
    """Give every row the tangents that a contact gets."""
    for k in range(rows.shape[0]):
        set_tangents(rows[k])


def test_kernels_and_columns_have_the_same_bits() -> None:
    n = normals()
    names = [f"{vector}{axis}" for vector in ("n", "t1", "t2") for axis in "xyz"]
    rows = np.zeros(len(n), [(name, "f8") for name in names])
    rows["nx"], rows["ny"], rows["nz"] = n.T
    fill(rows)
    for axis, rule in zip("xyz", (tangent_x, tangent_y, tangent_z), strict=True):
        assert rows[f"t1{axis}"].tobytes() == rule(rows, None).tobytes()
