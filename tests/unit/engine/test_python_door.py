"""Arrays are read from the tuples that Python gives, and what is none of the type is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, inner
from tests.unit.engine.test_memory_references import Inside, Memory, Twice, make_walk, memory

if Kernel is None:
    pytest.skip("this numba compiles kernels whole", allow_module_level=True)

from lavendersim.engine.python_door import MISMATCH


def entry() -> Any:
    """Return the compiled code of a kernel that takes memory: it asks for no types before."""
    walk = make_walk(inner)
    walk(memory(), 1.5)
    (compiled,) = walk.overloads.values()
    return compiled.entry_point


@pytest.mark.parametrize(
    "given",
    [
        memory()._replace(rows=np.zeros(4, np.int8)),
        memory()._replace(inside=memory().inside._replace(numbers=[1, 2])),
        memory()._replace(twice=Twice(np.zeros(3), np.zeros(2, "f4"))),
    ],
    ids=["row of another size", "no array", "the last one"],
)
def test_what_is_no_such_array_is_refused(given: Memory):
    with pytest.raises(TypeError, match=MISMATCH):
        entry()(given, 1.5)


def test_a_tuple_that_is_too_short_is_refused():
    given: Any = memory()._replace(twice=(np.zeros(3),))  # type: ignore[arg-type]
    with pytest.raises(IndexError):
        entry()(given, 1.5)


def test_every_call_has_memory_of_its_own():
    def call_within(first, second, other):
        first[0] += other.numbers[0]
        return second.square[0, 1]

    kernel, one, two = inner(call_within), memory(), memory()
    changed: Inside = two.inside._replace(square=two.inside.square + 1.0)
    assert kernel(one.inside.numbers, changed, one.inside) == 2.0
    assert kernel(one.inside.numbers, one.inside, changed) == 1.0
    # 100 and itself, and 100 of the other: both begin with 100
    assert one.inside.numbers[0] == 300
