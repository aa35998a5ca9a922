"""What a contact solver declares of itself: kernel, workspace, columns of the contact record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..records import Field
from ..spec import Spec


def no_workspace(spec: Spec, bodies: int, contacts: int) -> Any:
    """Return the workspace of a solver that needs none."""
    return ()


@dataclass(frozen=True, kw_only=True)
class Solver:
    """One solver of the step's contact problem.

    make: (spec) -> kernel(contacts, order, count, bodies, velocities, workspace, params, counters,
        residual_rows), which changes the impulses of `contacts` and, consistent with them,
        `velocities`, and writes what the step's row reports of a solve (`sweep.make_account`).
    allocate: (spec, bodies, contacts) -> the arrays that the kernel works in, a record of arrays.
    contact_fields: columns of the contact record that the solver keeps.
    solves_matrix: whether the kernel of the operator `matrix` (`coupling`) is one, too.
    """

    name: str
    make: Callable[[Spec], Any]
    allocate: Callable[[Spec, int, int], Any] = no_workspace
    contact_fields: Sequence[Field] = ()
    solves_matrix: bool = True
