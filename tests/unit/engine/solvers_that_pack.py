"""What holds of solvers that pack contacts where they can: elsewhere they sweep plainly."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from matrix_solves import matrix_spec, solve
from problems_in_blocks import random_problem

from lavendersim.engine.compile import composing
from lavendersim.engine.solvers import projected_gauss_seidel
from lavendersim.engine.solvers.packed.layout import stride
from lavendersim.engine.spec import Spec

BODIES, CONTACTS = 5, 7


def blocks(solver: str) -> Spec:
    """Return an engine whose contacts are all a normal and a disc."""
    return Spec(("contact_torque", "friction", "rotation"), ("box_box",), solver)


def unpacked(solver: str) -> dict[str, Spec]:
    """Return engines whose contacts are swept as they are."""
    spec = blocks(solver)
    return {
        "pyramid": spec._replace(friction_cone="pyramid"),
        "over-relaxed": spec._replace(over_relaxation=True),
        "there and back": spec._replace(order="symmetric"),
        "rolling": spec.including("rolling_friction"),
        "frictionless": spec.without("friction"),
    }


def _kernels(module: ModuleType, spec: Spec) -> set[str]:
    with composing() as composed:
        module.make(spec)
    return {name for _, name in composed}


def check_packs(module: ModuleType, eight: bool) -> None:
    """It packs blocks, and has the rows for it."""
    spec = blocks(module.SOLVER.name)
    assert "sweep_in_order" not in _kernels(module, spec)
    assert len(module.allocate(spec, BODIES, CONTACTS).rows) == CONTACTS * stride(spec, eight=eight)


def check_sweeps_plainly(module: ModuleType, name: str) -> None:
    """It has the kernels of the plain sweeps, and no arrays."""
    spec = unpacked(module.SOLVER.name)[name]
    assert _kernels(module, spec) == _kernels(projected_gauss_seidel, spec)
    assert module.allocate(spec, BODIES, CONTACTS) == ()


def check_matrix(module: ModuleType, rng: np.random.Generator) -> None:
    """Through a matrix its sweeps are the plain ones to the bit."""
    problem = random_problem(rng, 5)
    one = solve(problem, matrix_spec(module.SOLVER.name))
    other = solve(problem, matrix_spec("projected_gauss_seidel"))
    np.testing.assert_array_equal(one.impulses, other.impulses)
    assert one.sweeps == other.sweeps
