"""Contact solvers, one file each: the list of their names. Loads without numba.

A solver is a file of this folder that ends with `SOLVER = Solver(...)` (`solver`), and its name
here; nothing else names it. `catalogue` has the declarations.
"""

from typing import Final, Literal, get_args

SolverName = Literal[
    "projected_gauss_seidel",
    "block_gauss_seidel",
    "coloured_gauss_seidel",
    "nonsmooth_conjugate_gradient",
    "jacobi",
    "accelerated_projected_gradient",
    "adaptive",
]
SOLVER_NAMES: Final[tuple[SolverName, ...]] = get_args(SolverName)
