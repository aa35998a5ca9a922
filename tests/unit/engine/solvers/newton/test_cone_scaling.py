"""Nesterov and Todd's scaling by its definition, and the gain of a contact by dense algebra."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted

from lavendersim.engine.solvers.newton import cone_scaling
from lavendersim.engine.solvers.newton.cone_scaling import SOFTNESS
from lavendersim.engine.solvers.newton.envelope import DOF, OF_B, SCALED
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

SPEC = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")
scaling_of, unscaled = interpreted(cone_scaling.scaling_of), interpreted(cone_scaling.unscaled)
to_boundary = interpreted(cone_scaling.to_boundary)
determinant = interpreted(cone_scaling.determinant)


def inside(rng: np.random.Generator) -> Vec3:
    side = rng.normal(size=2)
    return Vec3(float(np.hypot(*side)) + rng.uniform(0.01, 1.0), *map(float, side))


def inverse_of(x: Vec3, z: Vec3, softness: float = 0.0) -> np.ndarray:
    scaling = scaling_of(x, z)
    return np.array([unscaled(scaling, softness, Vec3(*axis)) for axis in np.eye(3)]).T


@pytest.mark.parametrize("seed", range(5))
def test_the_scaling_maps_one_point_to_the_other_and_the_cone_to_itself(seed: int) -> None:
    """So it is defined: symmetric, positive definite, H x = z, and boundary goes to boundary."""
    rng = np.random.default_rng(seed)
    x, z, ray = inside(rng), inside(rng), rng.normal(size=2)
    inverse = inverse_of(x, z)
    # Both are at least 0.01 inside: at most some 1e4 of round-off.
    np.testing.assert_allclose(inverse @ z, x, rtol=1e-11)
    np.testing.assert_allclose(inverse, inverse.T, rtol=1e-11)
    assert np.linalg.eigvalsh(inverse).min() > 0.0
    image = inverse @ [np.hypot(*ray), *ray]
    assert image[0] == pytest.approx(np.hypot(*image[1:]), rel=1e-10)
    softer = np.linalg.inv(np.linalg.inv(inverse) + 0.3 * np.eye(3))
    np.testing.assert_allclose(inverse_of(x, z, 0.3), softer, rtol=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_a_step_is_as_long_as_it_stays_inside(seed: int) -> None:
    rng = np.random.default_rng(seed)
    x, d = inside(rng), Vec3(*map(float, rng.normal(size=3)))
    d = d._replace(x=-abs(d.x))
    length = to_boundary(x, d)
    for share in np.linspace(0.0, 0.999, 20):
        at = Vec3(*(np.array(x) + share * length * np.array(d)))
        assert at.x > 0.0
        assert determinant(at) > 0.0
    behind = Vec3(*(np.array(x) + 1.001 * length * np.array(d)))
    assert behind.x < 0.0 or determinant(behind) < 0.0
    assert to_boundary(x, inside(rng)) == np.inf


@pytest.mark.parametrize("share", [1.0, 0.0])
@pytest.mark.parametrize("mu", [0.3, 0.0])
def test_the_gain_is_that_of_dense_algebra(share: float, mu: float, rng) -> None:
    """T (H + softness)^-1 C^-1 T; without friction the normal alone."""
    x, z = inside(rng), inside(rng)
    t = 1.0 / mu if mu else 1.0
    contact = SimpleNamespace(
        mu=mu, scale=share, inv_k=0.5, lambda_n=t * x.x, lambda_1=x.y, lambda_2=x.z,
        velocity_n=z.x / t, velocity_1=z.y, velocity_2=z.z,
    )  # fmt: skip
    gain = interpreted(cone_scaling.make_gain(SPEC))(contact)
    softness = SOFTNESS / 0.5
    if mu:
        C = np.eye(3)
        C[0, 1:] -= share * np.array(z[1:]) / np.hypot(*z[1:])
        T = np.diag([t, 1.0, 1.0])
        expected = T @ inverse_of(x, z, softness) @ np.linalg.inv(C) @ T
    else:
        expected = np.diag([1.0 / (z.x / x.x + softness), 0.0, 0.0])
    np.testing.assert_allclose(np.reshape(gain, (3, 3)), expected, rtol=1e-10, atol=1e-12)
    rows = rng.normal(size=(9, DOF))
    for make, matrix in (
        (cone_scaling.make_scale_by_gain, expected),
        (cone_scaling.make_scale_by_gain_transposed, expected.T),
    ):
        interpreted(make(SPEC))(rows, OF_B, gain)
        scaled = rows[SCALED : SCALED + 3]
        np.testing.assert_allclose(scaled, matrix @ rows[OF_B : OF_B + 3], rtol=1e-9, atol=1e-11)
