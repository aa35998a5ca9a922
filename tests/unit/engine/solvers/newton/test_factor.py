"""Which of two factors a contact graph gets follows from its size; both have the same matrix."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import drawn, views
from interpreted import interpreted, records
from test_envelope import DOF, contacts_of
from test_matrix import FRICTIONAL, PAIRS, stiffness
from test_supernodes import SPEC, find, grid, lay_out, number, workspace_of

from lavendersim.engine.solvers.newton import factor
from lavendersim.engine.solvers.newton.envelope import allocate_envelope
from lavendersim.engine.solvers.newton.matrix import make_assemble
from lavendersim.engine.solvers.newton.minimise import make_assemble_mass
from lavendersim.engine.solvers.newton.supernodes import CHOSEN, ENTRIES

block_at = interpreted(factor.make_block_at(SPEC))
entry = interpreted(factor.entry)


@pytest.mark.parametrize(("n", "chosen"), [(5, 0), (20, 1)])
def test_an_order_is_looked_for_where_an_envelope_is_large(n: int, chosen: int) -> None:
    bodies, pairs = grid(n)
    rows = contacts_of(pairs)
    workspace = workspace_of(bodies, len(rows), 500_000)
    outcome = workspace.elimination.nodes.outcome
    size, entries, cost = interpreted(factor.make_lay_out(SPEC))(
        records(rows), len(rows), workspace
    )
    plain = allocate_envelope(bodies, len(rows), 500_000)
    _, of_envelope, work = lay_out(records(rows), len(rows), plain)
    assert size == bodies
    assert outcome[CHOSEN] == chosen
    assert (work > factor.FEWEST_MULTIPLICATIONS) == bool(chosen)
    if chosen:
        assert cost == workspace.elimination.work[0] / factor.SIDE_BY_SIDE < work
        assert entries == outcome[ENTRIES] < of_envelope
    else:
        assert (entries, cost) == (of_envelope, float(work))
        assert (workspace.position == plain.position).all()


def test_panels_have_the_matrix_that_an_envelope_has(rng) -> None:
    spec = FRICTIONAL._replace(effects=SPEC.effects)
    scene = drawn(spec, rng, PAIRS)
    scene.contacts["step_n"] = rng.uniform(-0.9, 0.9, len(PAIRS))
    bodies, _, contacts = views(scene)
    dense = []
    for chosen in (0, 1):
        workspace = records(workspace_of(6, len(PAIRS), 2000))
        workspace.values[:] = 7.0  # of the step before
        size, _, _ = lay_out(contacts, len(PAIRS), workspace)
        if chosen:
            find(size, workspace)
            number(size, workspace)
        workspace.elimination.nodes.outcome[CHOSEN] = chosen
        interpreted(make_assemble_mass(spec))(bodies, size, workspace)
        interpreted(make_assemble(spec, stiffness))(contacts, len(PAIRS), size, workspace)
        whole = np.zeros((36, 36))  # by bodies
        tied = {(int(max(p)), int(min(p))) for p in (workspace.position[[*two]] for two in PAIRS)}
        for p, q in {(k, k) for k in range(size)} | {pair for pair in tied if pair[1] >= 0}:
            block = block_at(workspace, p, q)
            a, b = DOF * int(workspace.visited[p]), DOF * int(workspace.visited[q])
            for i in range(DOF):
                for j in range(i + 1 if p == q else DOF):
                    found = workspace.values[entry(block, i, j)]
                    whole[a + i, b + j] = whole[b + j, a + i] = found
        dense.append(whole)
    # The same sums, in the order of the contacts.
    np.testing.assert_array_equal(*dense)
