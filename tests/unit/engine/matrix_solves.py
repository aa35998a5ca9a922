"""A solver's kernel, interpreted, on a contact problem given by its matrix."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from interpreted import interpreted, records

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.engine.matrix_problem import contacts_of, coupling_of, system_of
from lavendersim.engine.records import COUNTERS, PARAMETERS, dtype
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.spec import Spec


def matrix_spec(solver: str, tolerance: bool = True, **choices) -> Spec:
    effects = ("compliance", "friction")
    return Spec(effects, (), solver, tolerance, operator="matrix", **choices)


class Solve(NamedTuple):
    """What a solve leaves."""

    impulses: np.ndarray  # (n, 3) [N s]
    sweeps: int
    residual: float
    not_converged: int


def solve(problem: ContactProblem, spec: Spec, sweeps: int = 500, tolerance: float = 1e-9) -> Solve:
    """Solve a problem from nothing."""
    solver = SOLVERS[spec.solver]
    contacts = contacts_of(problem, spec, np.zeros((problem.contacts, 3)))
    params, counters = np.zeros(1, dtype(PARAMETERS)), np.zeros(1, dtype(COUNTERS))
    params["tolerance"], params["sweeps"], params["over_relaxation"] = tolerance, sweeps, 1.0
    system = system_of(contacts, coupling_of(problem))
    system = system._replace(contacts=records(contacts))
    workspace = solver.allocate(spec, 0, problem.contacts)
    interpreted(solver.make(spec))(
        system, workspace, records(params)[0], records(counters)[0], None
    )
    impulses = np.stack([contacts[f"lambda_{k}"] for k in "n12"], axis=1)
    row = counters[0]
    return Solve(impulses, int(row["sweeps"]), float(row["residual"]), int(row["not_converged"]))


def projected(x: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Return the nearest points (n, 3) of Coulomb's cones, by the angle of each."""
    n, t = x[:, 0], np.linalg.norm(x[:, 1:], axis=1)
    along = np.maximum((n + mu * t) / (1.0 + mu * mu), 0.0)  # on the cone's edge
    edge = np.column_stack([along, (mu * along / np.where(t > 0.0, t, 1.0))[:, None] * x[:, 1:]])
    return np.where((t <= mu * n)[:, None], x, edge)
