"""Names of variables that are assigned more than once are those that numba gives."""

from types import SimpleNamespace

import pytest
from numba.core import ssa
from numba.core.compiler import run_frontend
from numba.core.lowering import Lower
from numba.core.transforms import canonicalize_cfg

single_assignment = pytest.importorskip("lavendersim.engine.single_assignment")


def _once(x):
    return x + 1


def _branches_and_loops(count, x):
    found = a = 0
    for k in range(count):
        if k > x:
            a, b = k, a
        elif k == 3:
            a = b = a + 1
        else:
            continue
        while b > 0:
            b -= a
            if b == 7:
                break
            found += b
    return found, a


def _perhaps_unassigned(count):
    while count > 0:
        count -= 1
        if count == 2:
            last = count
    return last


FUNCTIONS = (_once, _branches_and_loops, _perhaps_unassigned)


def _text(blocks):
    return [(label, [str(each) for each in block.body]) for label, block in blocks.items()]


@pytest.mark.parametrize("function", FUNCTIONS)
def test_each_assignment_has_the_name_that_numba_gives(function):
    before = run_frontend(function).blocks
    found = _text(single_assignment.run_ssa(before))
    assert found == _text(ssa._run_ssa(run_frontend(function).blocks))
    names = [row.split(" = ")[0] for _, rows in found for row in rows if " = " in row]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("renamed", [False, True])
@pytest.mark.parametrize("function", FUNCTIONS)
def test_local_variables_are_those_that_numba_keeps_in_no_memory(function, renamed):
    code = run_frontend(function)
    if renamed:
        code.blocks = single_assignment.run_ssa(code.blocks)
    lower = object.__new__(Lower)
    lower.func_ir, lower.blocks = code, code.blocks
    lower._find_singly_assigned_variable()
    assert single_assignment.local_variables(code.blocks) == lower._singly_assigned_vars
    assert lower._singly_assigned_vars


@pytest.mark.parametrize("function", FUNCTIONS)
def test_loops_have_one_way_back_and_are_looked_for_where_jumps_have_changed(function):
    code = run_frontend(function)
    expected = _text(canonicalize_cfg(code.blocks))
    code = SimpleNamespace(blocks=code.blocks, func_id=SimpleNamespace())
    code.blocks = single_assignment.canonical(code)
    assert _text(code.blocks) == expected
    code.blocks = single_assignment.canonical(code)
    assert single_assignment.canonical(code) is code.blocks
    changed = dict(code.blocks)
    changed[max(changed) + 1] = changed[max(changed)]
    code.blocks = changed
    assert single_assignment.canonical(code) is not changed
