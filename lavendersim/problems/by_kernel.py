"""A solver's kernel of the engine, run on a contact problem that has no scene.

The kernels are composed for the operator `matrix` (`engine.coupling`); nothing else differs from
what they do in a scene.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from lavendersim.engine.compile import compiling
from lavendersim.engine.contact_problem import ContactProblem, Solution
from lavendersim.engine.effects import row_fields
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.matrix_problem import contacts_of, coupling_of, make_solve, system_of
from lavendersim.engine.records import COUNTERS, PARAMETERS, dtype
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.spec import Spec

from .residual import judged


def spec_of(solver: str, history: bool = False, friction_cone: str = "disc") -> Spec:
    """Return the structure of a solver that runs by itself."""
    effects = ("compliance", "friction", *(("residual_log",) if history else ()))
    return Spec(effects, (), solver, True, friction_cone, "matrix")


@cache
def _kernel(spec: Spec) -> Any:
    return cached(make_solve, spec)


def solve_by_kernel(
    solver: str,
    problem: ContactProblem,
    tolerance: float = 1e-8,
    sweeps: int = 10_000,
    start: np.ndarray | None = None,
    history: bool = False,
    *,
    friction_cone: str = "disc",
    over_relaxation: float = 1.0,
) -> Solution:
    """Solve a problem by a kernel of `engine.solvers`.

    tolerance: `scaled` residual at which it stops [-], below 0: never; start: impulses (n, 3) to
    begin at [N s]; history: keep the residual at the start and after every sweep; over_relaxation:
    factor on the changes that sweeps make, 0 to 2 [-].
    The kernel's own residual carries the round-off of all its sweeps; the residual that is
    returned is computed from the impulses alone.
    """
    spec = spec_of(solver, history, friction_cone)
    spec = spec._replace(over_relaxation=over_relaxation != 1.0)
    first = np.zeros((problem.contacts, 3)) if start is None else start
    contacts = contacts_of(problem, spec, first)
    params, counters = np.zeros(1, dtype(PARAMETERS)), np.zeros(1, dtype(COUNTERS))
    params["tolerance"], params["sweeps"] = tolerance, sweeps
    params["over_relaxation"] = over_relaxation
    params["residuals_from"] = params["residuals_to"] = 1
    rows = np.zeros(sweeps + 1 if history else 0, dtype(row_fields(spec, "residual")))
    workspace = SOLVERS[solver].allocate(spec, 0, problem.contacts)
    with compiling():
        system = system_of(contacts, coupling_of(problem))
        _kernel(spec)(system, workspace, params, counters, rows)
    impulses = np.stack([contacts[f"lambda_{k}"] for k in "n12"], axis=1)
    residuals = rows["residual"][: int(counters["residual_rows"][0])].copy()
    made = int(counters["sweeps"][0])
    return judged(problem, impulses, max(tolerance, 0.0), made, residuals)
