"""A contact problem given by its Delassus matrix, as the records that a solver works on."""

from __future__ import annotations

from typing import Any

import numpy as np

from .compile import kernel
from .contact_problem import ContactProblem
from .coupling import MATRIX_CONTACT, Coupling
from .records import dtype
from .solvers.catalogue import SOLVERS
from .solvers.solver import ContactSystem
from .spec import Spec


def multiply(problem: ContactProblem, impulses: np.ndarray) -> np.ndarray:
    """Return W r, shape (n, 3) [m/s]."""
    product = np.zeros((problem.contacts, 3))
    parts = np.einsum("kij,kj->ki", problem.blocks, impulses[problem.columns])
    np.add.at(product, problem.row, parts)
    return product


def coupling_of(problem: ContactProblem) -> Coupling:
    """Return W with the scales of the problem's residual."""
    contacts = max(problem.contacts, 1)
    trace = np.trace(problem.own_blocks, axis1=1, axis2=2).sum() + problem.gamma.sum()
    norm = float(np.linalg.norm(problem.q))
    load = norm if norm > 0.0 else 1.0
    return Coupling(problem.row, problem.blocks, float(trace / (3 * contacts)), load)


def contacts_of(problem: ContactProblem, spec: Spec, impulses: np.ndarray) -> np.ndarray:
    """Return the records of a problem's contacts at given impulses (n, 3) [N s]."""
    contacts = np.zeros(
        problem.contacts,
        dtype(MATRIX_CONTACT, SOLVERS[spec.solver].contact_fields),
    )
    own = problem.own_blocks
    w = multiply(problem, impulses) + problem.free
    w[:, 0] += problem.target
    for k, axis in enumerate("n12"):
        contacts[f"lambda_{axis}"], contacts[f"w_{axis}"] = impulses[:, k], w[:, k]
    contacts["mu"], contacts["gamma"] = problem.mu, problem.gamma
    contacts["k_n"], contacts["inv_k"] = own[:, 0, 0], 1.0 / (own[:, 0, 0] + problem.gamma)
    contacts["k_n1"], contacts["k_n2"] = own[:, 1, 0], own[:, 2, 0]
    k_11, k_22 = own[:, 1, 1], own[:, 2, 2]
    k_12 = 0.5 * (own[:, 1, 2] + own[:, 2, 1])
    scale = 1.0 / (k_11 * k_22 - k_12 * k_12)
    contacts["i_11"], contacts["i_12"], contacts["i_22"] = k_22 * scale, -k_12 * scale, k_11 * scale
    half_gap = 0.5 * (k_11 - k_22)
    contacts["k_t"] = 0.5 * (k_11 + k_22) + np.sqrt(half_gap * half_gap + k_12 * k_12)
    contacts["begin"], contacts["end"] = problem.begin[:-1], problem.begin[1:]
    # No step against W that is this stiff can overshoot: Gershgorin's bound, by blocks.
    size = np.linalg.norm(problem.blocks, axis=(1, 2))
    rows = np.bincount(problem.row, size, problem.contacts)
    columns = np.bincount(problem.columns, size, problem.contacts)
    contacts["bound"] = np.maximum(rows, columns) + problem.gamma
    return contacts


def system_of(contacts: np.ndarray, coupling: Coupling) -> ContactSystem:
    """Return what a solver is given; bodies are not known, and no kernel of `matrix` reads them."""
    order = np.arange(len(contacts))
    return ContactSystem(contacts, order, len(contacts), order, coupling)


def make_solve(spec: Spec) -> Any:
    """Return `kernel(system, workspace, parameters, counters, residual_rows)`."""
    solve = SOLVERS[spec.solver].make(spec)

    def solve_matrix(system, workspace, parameters, counters, residual_rows):
        solve(system, workspace, parameters[0], counters[0], residual_rows)

    return kernel(solve_matrix, spec)
