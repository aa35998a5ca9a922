"""Principal moments and axes are the eigenvalues and eigenvectors of the tensor."""

from __future__ import annotations

import numpy as np

from lavendersim.geometry.principal_axes import principal
from lavendersim.geometry.quaternions import axes


def test_eigenvectors_are_those_of_lapack() -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        half = rng.normal(size=(3, 3))
        tensor = half @ half.T
        moments, turn = principal(tuple(map(tuple, tensor.tolist())))
        # Jacobi's and LAPACK's errors are a few roundings of the largest element
        limit = 1e-14 * np.abs(tensor).max()
        np.testing.assert_allclose(sorted(moments), np.linalg.eigvalsh(tensor), atol=limit)
        columns = np.array(axes(turn)).T
        np.testing.assert_allclose(columns @ np.diag(moments) @ columns.T, tensor, atol=10 * limit)


def test_diagonal_tensor_keeps_its_axes_and_their_order() -> None:
    tensor = ((3.0, 1e-16, 0.0), (1e-16, 1.0, 0.0), (0.0, 0.0, 2.0))
    assert principal(tensor) == ((3.0, 1.0, 2.0), (1.0, 0.0, 0.0, 0.0))
