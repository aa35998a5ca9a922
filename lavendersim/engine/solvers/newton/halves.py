"""Both halves of a matrix that is not symmetric, assembled and factorised (`factor`)."""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...spec import Spec
from .factor import make_entries, make_factorise_lu
from .matrix import make_assemble


def make_assemble_and_factorise(
    spec: Spec, stiffness: Any, scales: tuple[Any, Any], torques: bool = True
) -> Any:
    """Return `kernel(contacts, count, size, workspace) -> whether` there is a factor.

    Of M + J^T E' J, see `matrix.make_assemble`; scales: by E', and by E' transposed.
    """
    scale, transposed = scales
    assemble = make_assemble(spec, stiffness, torques, scale)
    assemble_transposed = make_assemble(spec, stiffness, torques, transposed)
    entries_of, factorise_lu = make_entries(spec), make_factorise_lu(spec)

    def assemble_and_factorise(contacts, count, size, workspace):
        assemble_transposed(contacts, count, size, workspace)
        for k in range(entries_of(size, workspace)):
            workspace.upper[k] = workspace.values[k]
        assemble(contacts, count, size, workspace)
        return factorise_lu(size, workspace)

    return kernel(assemble_and_factorise, spec)
