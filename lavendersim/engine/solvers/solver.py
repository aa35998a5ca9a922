"""What a contact solver declares of itself: kernel, workspace, columns of the contact record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..records import Field
from ..spec import Spec
from .iteration import Iteration, make_solve


class ContactSystem(NamedTuple):
    """The contact problem of one step, as a solver finds it and leaves it."""

    contacts: np.ndarray  # records; of them `count` are in use
    order: np.ndarray  # in which sweeps visit them
    count: int  # type: ignore[assignment]  # a tuple counts, too; nobody asks this one to
    bodies: np.ndarray
    velocities: Any  # of the bodies; of the operator `matrix` its `coupling.Coupling`


def no_workspace(spec: Spec, bodies: int, contacts: int) -> Any:
    """Return the workspace of a solver that needs none."""
    return ()


@dataclass(frozen=True, kw_only=True)
class Solver:
    """One solver of the step's contact problem.

    iteration: (spec) -> the kernels that are its own, see `iteration`.
    allocate: (spec, bodies, contacts) -> the arrays that the kernel works in, a record of arrays.
    contact_fields: columns of the contact record that the solver keeps.
    solves_matrix: whether the kernel of the operator `matrix` (`coupling`) is one, too.
    """

    name: str
    iteration: Callable[[Spec], Iteration]
    allocate: Callable[[Spec, int, int], Any] = no_workspace
    contact_fields: Sequence[Field] = ()
    solves_matrix: bool = True

    def make(self, spec: Spec) -> Any:
        """Return `kernel(system, workspace, params, counters, residual_rows)`.

        It changes the impulses of a ContactSystem and, consistent with them, its velocities, and
        reports the solve in the counters.
        """
        return make_solve(spec, self.name, self.iteration(spec))
