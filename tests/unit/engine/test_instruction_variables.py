"""The variables of an instruction are those that numba lists, in its order."""

from types import FunctionType

import pytest
from numba.core import ir
from numba.core.compiler import run_frontend

variables = pytest.importorskip("lavendersim.engine.instruction_variables")


def _loop(rows, count, pair):
    total = 0.0
    for index in range(count):
        first, second = pair
        if rows[index] > 0.0 and not first:
            total += min(rows[index], second, key=first)
        rows[index] = -total
    return {"total": total}, [rows, count], rows[1:count]


def _with_keywords(*many, one=1):
    if one in many:
        return max(many, default=one), {"one": one, "many": (one, many)}
    while one < 3:
        one += many[0]
    return (one, [one, one]), None


@pytest.mark.parametrize("function", [_loop, _with_keywords])
def test_variables_are_listed_as_numba_lists_them(function: FunctionType) -> None:
    blocks = run_frontend(function).blocks
    instructions = [each for block in blocks.values() for each in block.body]
    held = [each.__dict__ for each in instructions]
    found = [variables.variables_of(each) for each in held]
    assert found == [ir.Inst()._rec_list_vars(each) for each in held]
    assert sum(len(each) > 1 for each in found) > 10
