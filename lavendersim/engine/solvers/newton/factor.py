"""The factor of a matrix over bodies: by envelope, or by supernodes where that takes less.

Both have the same unknowns, by `position`, and the same two halves, `values` below the diagonal and
`upper` above it (`envelope`, `lu`, `panels`). A factor by supernodes is an engine's own where it
has the effect; which of the two a contact graph gets follows from operations counted before any.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...compile import inner, kernel, separate
from ...identity import IN_VECTORS
from ...spec import Spec
from .envelope import DOF
from .envelope import factorise as factorise_envelope
from .envelope import lay_out as lay_out_envelope
from .envelope import solve_factorised as solve_envelope
from .lu import factorise_lu as factorise_lu_envelope
from .lu import solve_lu as solve_lu_envelope
from .panels import factorise_panels, solve_panels
from .supernodes import CHOSEN, ENTRIES, allocate_elimination, find_supernodes, number_by_supernodes

# Multiplications of an envelope below which no other order is looked for: finding it would take as
# long, and what is small keeps its bits.
FEWEST_MULTIPLICATIONS = 4e6
# A panel's multiplications go side by side: so many take the time of one of an envelope's [-].
SIDE_BY_SIDE = 3.0


def eliminates(spec: Spec) -> bool:
    """Whether an engine's factor may be one by supernodes."""
    return spec.has("supernodes") and spec.has("newton")


def allocate_factor(spec: Spec, bodies: int, contacts: int, entries: int) -> Any:
    """Return what a factor by supernodes works in, () for engines without."""
    return allocate_elimination(bodies, contacts, entries) if eliminates(spec) else ()


def make_lay_out(spec: Spec) -> Any:
    """Return `kernel(contacts, count, workspace) -> (bodies, entries, cost)`.

    It numbers the bodies and lays out the rows; cost: of a factor, in multiplications of an
    envelope.
    """
    if not eliminates(spec):

        def lay_out_alone(contacts, count, workspace):
            size, entries, work = lay_out_envelope(contacts, count, workspace)
            return size, entries, float(work)

        return kernel(lay_out_alone, spec)

    find = separate(kernel(find_supernodes.py_func, spec), spec)

    def lay_out(contacts, count, workspace):
        size, entries, work = lay_out_envelope(contacts, count, workspace)
        cost, outcome = float(work), workspace.elimination.nodes.outcome
        outcome[CHOSEN] = 0
        if cost > FEWEST_MULTIPLICATIONS:
            other = find(size, workspace) / SIDE_BY_SIDE
            if other < cost:
                outcome[CHOSEN] = 1
                number_by_supernodes(size, workspace)
                return size, outcome[ENTRIES], other
        return size, entries, cost

    return kernel(lay_out, spec)


class BlockPlace(NamedTuple):
    """Where a block is: its entry i, j at `base` + i `row` + j `column`, rows growing longer."""

    base: int
    row: int
    column: int
    growth: int  # 1: each row is one longer than the one before it; 0: they are equally long


@inner
def entry(block, i, j):
    """Return where entry i, j of a block is."""
    return block.base + i * block.row + j * block.column + block.growth * (i * (i + 1) // 2)


def make_block_at(spec: Spec) -> Any:
    """Return `kernel(workspace, p, q) -> BlockPlace`, block row p and block column q <= p."""

    def in_envelope(workspace, p, q):
        first = workspace.first[p]
        return BlockPlace(workspace.start[DOF * p] + DOF * (q - first), DOF * (p - first), 1, 1)

    in_envelope = kernel(in_envelope, spec)
    if not eliminates(spec):
        return in_envelope

    def in_panel(workspace, p, q):
        # Rows of panels are those of the upper half: block q, p is what is stored.
        nodes = workspace.elimination.nodes
        s = nodes.of[q]
        first, begin = nodes.first[s], nodes.begin[s]
        wide = DOF * (nodes.begin[s + 1] - begin)
        place = p - first
        if p >= nodes.first[s + 1]:
            low, high = begin + nodes.first[s + 1] - first, nodes.begin[s + 1] - 1
            while low < high:
                middle = (low + high) // 2
                if nodes.members[middle] < p:
                    low = middle + 1
                else:
                    high = middle
            place = low - begin
        return BlockPlace(nodes.panel[s] + DOF * (q - first) * wide + DOF * place, 1, wide, 0)

    in_panel = kernel(in_panel, spec)

    def block_at(workspace, p, q):
        if workspace.elimination.nodes.outcome[CHOSEN] == 1:
            return in_panel(workspace, p, q)
        return in_envelope(workspace, p, q)

    return kernel(block_at, spec)


def make_entries(spec: Spec) -> Any:
    """Return `kernel(size, workspace) -> how many` entries a half of the matrix has."""
    chooses = eliminates(spec)

    def entries(size, workspace):
        if chooses:
            outcome = workspace.elimination.nodes.outcome
            if outcome[CHOSEN] == 1:
                return outcome[ENTRIES]
        return workspace.start[DOF * size - 1] + DOF * size - DOF * workspace.first[size - 1]

    return kernel(entries, spec)


def make_factorise(spec: Spec) -> Any:
    """Return `kernel(size, workspace) -> whether` the matrix, L D L^T now, is positive definite."""
    if not eliminates(spec):
        return factorise_envelope
    by_panels = separate(kernel(factorise_panels.py_func, spec), spec, IN_VECTORS)

    def factorise(size, workspace):
        if workspace.elimination.nodes.outcome[CHOSEN] == 1:
            return by_panels(workspace.values, workspace.values, False, workspace)
        return factorise_envelope(size, workspace)

    return kernel(factorise, spec)


def make_solve_factorised(spec: Spec) -> Any:
    """Return `kernel(size, workspace, x)`: x enters as the right side, leaves as the solution."""
    if not eliminates(spec):
        return solve_envelope

    def solve_factorised(size, workspace, x):
        if workspace.elimination.nodes.outcome[CHOSEN] == 1:
            solve_panels(workspace.values, workspace.values, workspace, x)
        else:
            solve_envelope(size, workspace, x)

    return kernel(solve_factorised, spec)


def make_factorise_lu(spec: Spec) -> Any:
    """Return `kernel(size, workspace) -> whether` there is a factor L U, which it is now."""
    if not eliminates(spec):
        return factorise_lu_envelope
    by_panels = separate(kernel(factorise_panels.py_func, spec), spec, IN_VECTORS)

    def factorise_lu(size, workspace):
        if workspace.elimination.nodes.outcome[CHOSEN] == 1:
            return by_panels(workspace.upper, workspace.values, True, workspace)
        return factorise_lu_envelope(size, workspace)

    return kernel(factorise_lu, spec)


def make_solve_lu(spec: Spec) -> Any:
    """Return the same kernel as `make_solve_factorised`, of L U."""
    if not eliminates(spec):
        return solve_lu_envelope

    def solve_lu(size, workspace, x):
        if workspace.elimination.nodes.outcome[CHOSEN] == 1:
            solve_panels(workspace.upper, workspace.values, workspace, x)
        else:
            solve_lu_envelope(size, workspace, x)

    return kernel(solve_lu, spec)
