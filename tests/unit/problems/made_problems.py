"""Small contact problems made by hand or drawn at random, and where those of others are."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.problems.matrices import problem_of

FOLDER = os.environ.get("LAVENDER_CONTACT_PROBLEMS", "")
needs_outside = pytest.mark.skipif(
    not FOLDER, reason="LAVENDER_CONTACT_PROBLEMS does not say where problems of others are"
)


def outside_files() -> list[Path]:
    """Return the problem files of others, none where the folder is not given."""
    kinds = (".dat", ".hdf5", ".h5")
    return sorted(p for p in Path(FOLDER).iterdir() if p.suffix in kinds) if FOLDER else []


# Collected once: one test per file, or one that is skipped and says why.
outside = pytest.mark.parametrize(
    "file",
    outside_files() or [pytest.param(Path(), marks=needs_outside)],
    ids=lambda file: file.name or "none",
)


class Bodies(NamedTuple):
    """A problem in the global form, with full matrices."""

    mass: np.ndarray  # (m, m)
    directions: np.ndarray  # (m, 3n)
    f: np.ndarray
    w: np.ndarray
    mu: np.ndarray


def random_bodies(seed: int, bodies: int = 4, contacts: int = 5) -> Bodies:
    """Return bodies of six freedoms and contacts between two of them, or one and the world."""
    rng = np.random.default_rng(seed)
    size = 6 * bodies
    mass = np.zeros((size, size))
    for body in range(bodies):
        part = rng.normal(size=(6, 6))
        mass[6 * body : 6 * body + 6, 6 * body : 6 * body + 6] = part @ part.T + 6.0 * np.eye(6)
    directions = np.zeros((size, 3 * contacts))
    for contact in range(contacts):
        for body in rng.choice(bodies, size=2 if contact else 1, replace=False):
            block = rng.normal(size=(6, 3))
            directions[6 * body : 6 * body + 6, 3 * contact : 3 * contact + 3] = block
    return Bodies(
        mass,
        directions,
        rng.normal(size=size),
        rng.normal(size=3 * contacts),
        rng.uniform(0.1, 1.0, contacts),
    )


def random_problem(seed: int, contacts: int = 5) -> ContactProblem:
    """Return a problem with softness and targets, some contacts frictionless."""
    rng = np.random.default_rng(seed)
    bodies = random_bodies(seed, contacts=contacts)
    matrix = bodies.directions.T @ np.linalg.solve(bodies.mass, bodies.directions)
    # Not quite symmetric, as matrices of others are.
    matrix *= 1.0 + 1e-3 * rng.normal(size=matrix.shape)
    mu = np.where(np.arange(contacts) % 4 == 3, 0.0, bodies.mu)
    plain = problem_of(sparse.csc_matrix(matrix), bodies.w, mu)
    return plain._replace(
        gamma=rng.uniform(0.0, 0.1, contacts), target=rng.uniform(0.0, 0.1, contacts)
    )


def without_softness(problem: ContactProblem) -> ContactProblem:
    """Return the problem as a file can state it."""
    nothing = np.zeros(problem.contacts)
    return problem._replace(gamma=nothing, target=nothing)
