"""Contact rows enter, impulses leave; one file per solver, all with the same signature.

A solver's module has `make(spec) -> kernel` and, where it needs them, CONTACT_FIELDS
(columns per contact) and `allocate(spec, bodies, contacts)` (arrays it works in).
"""

# Effects begin: their list names files that need the blocks which solvers and effects share.
from .. import effects  # noqa: F401
from . import (
    accelerated_projected_gradient,
    adaptive,
    block_gauss_seidel,
    coloured_gauss_seidel,
    jacobi,
    nonsmooth_conjugate_gradient,
    projected_gauss_seidel,
)

SOLVERS = {
    "projected_gauss_seidel": projected_gauss_seidel,
    "block_gauss_seidel": block_gauss_seidel,
    "coloured_gauss_seidel": coloured_gauss_seidel,
    "nonsmooth_conjugate_gradient": nonsmooth_conjugate_gradient,
    "jacobi": jacobi,
    "accelerated_projected_gradient": accelerated_projected_gradient,
    "adaptive": adaptive,
}
