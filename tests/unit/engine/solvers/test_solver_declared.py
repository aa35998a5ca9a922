"""A solver is a kernel of its name, its arrays and its columns; a system keeps what it is given."""

from __future__ import annotations

import pytest

from lavendersim.engine.compile import composing
from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.solvers import SOLVER_NAMES
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.solvers.solver import ContactSystem, no_workspace
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize("name", SOLVER_NAMES)
def test_the_kernel_is_called_as_the_solver_and_its_columns_are_in_contacts(name: str) -> None:
    solver, spec = SOLVERS[name], Spec(("friction",), (), name)
    with composing() as composed:
        kernel = solver.make(spec)
    assert solver.name == name
    assert kernel.py_func.__name__ == name
    assert name in {kernel for _, kernel in composed}
    assert {field for field, _ in solver.contact_fields} <= set(contact_dtype(spec).names)


def test_columns_of_one_solver_are_not_in_contacts_of_another() -> None:
    own = {field for field, _ in SOLVERS["nonsmooth_conjugate_gradient"].contact_fields}
    plain = contact_dtype(Spec(("friction",), (), "projected_gauss_seidel")).names
    assert own
    assert not own & set(plain)


def test_a_solver_without_arrays_has_none_and_a_system_counts_its_contacts_in_use() -> None:
    assert no_workspace(Spec(), 100, 100) == ()
    system = ContactSystem([1, 2, 3], [2, 1, 0], 2, "bodies", "velocities")
    assert system.count == 2
    assert system._fields == ("contacts", "order", "count", "bodies", "velocities")
