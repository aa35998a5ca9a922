"""The names of the solvers, as a config states them."""

from __future__ import annotations

from typing import Literal

Solver = Literal[
    "projected_gauss_seidel",
    "block_gauss_seidel",
    "coloured_gauss_seidel",
    "nonsmooth_conjugate_gradient",
    "jacobi",
    "accelerated_projected_gradient",
    "adaptive",
]
