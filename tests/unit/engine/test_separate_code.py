"""A separate part does as one that is merged into its caller, and is optimised once for all."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.engine import separate_code
from lavendersim.engine.compile import Kernel, inner, separate
from lavendersim.engine.identity import identity
from lavendersim.engine.kernel_parts import STORE
from lavendersim.engine.spec import Spec

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")
BOXES = Spec(shape_pairs=("box_box",))


def sum_up(rows, unread, scale):
    total = 0.0
    for i in range(rows.shape[0]):
        total += scale * rows[i]
        rows[i] = total
    return total


def make_caller(part: Any, offset: float = 0.1) -> Any:
    """Return a kernel that calls a part several times, by values and by what it computes."""

    def caller(rows, unread, scale):
        first = part(rows, unread, scale)
        return first + part(rows, rows, first * scale) + part(unread, rows, offset)

    return inner(caller)


def run(kernel: Any) -> bytes:
    rows, unread = np.linspace(-0.7, 1.9, 11), np.array([0.3, -0.0, np.inf])
    total = kernel(rows, unread, 0.37)
    return np.float64(total).tobytes() + rows.tobytes() + unread.tobytes()


def apart(function: Any) -> Any:
    return separate(inner(function), BOXES)


def parts_of(kernel: Any) -> list[Any]:
    return [linked.part for linked in kernel.linked.values()]


@pytest.fixture
def optimised(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the separate parts that are optimised while a test runs, with a store of its own."""
    found: list[str] = []
    whole = separate_code._compiled

    def noted(part: Any, *other: Any) -> Any:
        found.append(part.symbol)
        return whole(part, *other)

    monkeypatch.setattr(separate_code, "_compiled", noted)
    for table in ("_parts", "_codes"):
        monkeypatch.setattr(STORE, table, {})
    for table in ("_new", "_new_codes"):
        monkeypatch.setattr(STORE, table, set())
    monkeypatch.setattr("lavendersim.engine.kernel_store._why_not", "a test keeps nothing")
    return found


def test_separate_and_merged_parts_give_the_same_bits(optimised):
    alone = apart(sum_up)
    assert (
        run(make_caller(alone))
        == run(make_caller(inner(sum_up)))
        == run(make_caller(sum_up).py_func)
    )
    assert len(optimised) == 1
    assert [part.separate for part in parts_of(alone)] == [True]


def test_it_is_optimised_once_for_all_its_callers(optimised):
    for offset in (1.0, 2.0, 3.0):
        run(make_caller(apart(sum_up), offset))
    assert len(optimised) == 1


def test_only_arguments_that_it_reads_are_handed_over(optimised):
    alone = apart(sum_up)
    run(make_caller(alone))
    [code] = STORE._codes.values()
    # Where the value returned goes; of the rows their address and their count; the scale. There are
    # an address for exceptions and another array, too.
    assert len(code.types) == 2 + 2 + 2 + 1
    assert len(code.read) == 4


def test_a_separate_part_calls_another(optimised):
    def make_chain(within: Any) -> Any:
        low = within(sum_up)

        def middle(rows, unread, scale):
            return 2.0 * low(rows, unread, scale) + low(rows, rows, 0.5)

        return make_caller(within(middle))

    assert run(make_chain(apart)) == run(make_chain(inner))
    assert len(optimised) == 2


def test_its_exception_reaches_python(optimised):
    def refuse(x):
        if x < 0.0:
            raise ValueError("negative")
        return 2.0 * x

    part = apart(refuse)

    def through(x):
        return part(x)

    called = inner(through)
    assert called(3.0) == 6.0
    with pytest.raises(ValueError, match="negative"):
        called(-1.0)


def test_whether_a_part_is_separate_belongs_to_what_it_is():
    assert identity(apart(sum_up)).digest != identity(inner(sum_up)).digest
    assert identity(apart(sum_up)).digest == identity(apart(sum_up)).digest


def test_kernels_of_spheres_are_merged_whole():
    spheres = Spec(shape_pairs=("sphere_plane", "sphere_sphere"))
    assert not separate(inner(sum_up), spheres).separate
    assert separate(inner(sum_up), BOXES).separate
