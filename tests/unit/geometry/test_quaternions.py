"""Quaternions turn vectors, and their inverses turn them back."""

from __future__ import annotations

import pytest

from lavendersim.geometry.quaternions import inverse, product, to_body, to_world
from lavendersim.geometry.vectors import unit

Q = unit((0.9, 0.1, -0.3, 0.2))


def test_rotations_undo_each_other() -> None:
    vector = (0.3, -2.0, 0.7)
    assert to_body(Q, to_world(Q, vector)) == pytest.approx(vector, abs=1e-15)
    assert product(Q, inverse(Q)) == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=1e-15)
