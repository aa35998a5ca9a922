"""Unit length, scalar and vector product of plain floats."""

from __future__ import annotations

import math

import pytest

from lavendersim.geometry.vectors import cross, dot, minus, unit

A, B = (3.0, -2.0, 0.5), (-1.0, 4.0, 2.0)


def test_vector_product_is_normal_to_both_and_has_lagranges_length() -> None:
    normal = cross(A, B)
    assert dot(normal, A) == 0.0  # all products are of few bits: exact
    assert dot(normal, B) == 0.0
    assert dot(normal, normal) == dot(A, A) * dot(B, B) - dot(A, B) ** 2
    assert cross((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)) == (0.0, 0.0, 1.0)


def test_difference_is_from_the_second_to_the_first() -> None:
    assert minus(A, B) == (4.0, -6.0, -1.5)


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
def test_unit_length_at_every_scale(scale: float) -> None:
    # The squares of 1e300 and 1e-300 overflow and underflow.
    found = unit((3.0 * scale, 0.0, -4.0 * scale))
    assert found == pytest.approx((0.6, 0.0, -0.8), rel=4e-16)


def test_what_has_unit_length_comes_back_bit_for_bit() -> None:
    once = unit((1.0, 2.0, 3.0, 4.0))
    assert unit(once) is once
    assert math.hypot(*once) == pytest.approx(1.0, abs=1e-15)
