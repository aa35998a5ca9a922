"""Contact rows enter, impulses leave; one file per solver, all with the same signature."""

from . import projected_gauss_seidel

SOLVERS = {"projected_gauss_seidel": projected_gauss_seidel}
