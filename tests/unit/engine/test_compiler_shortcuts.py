"""What kernels are spared while they are compiled gives what numba's own code gives."""

import inspect
import warnings

import pytest
from numba.core import ir, types
from numba.core.errors import NumbaWarning
from numba.core.registry import cpu_target

shortcuts = pytest.importorskip("lavendersim.engine.compiler_shortcuts")


def test_a_packer_is_made_once_for_equal_types_and_flattens_as_a_new_one() -> None:
    context = cpu_target.target_context
    record = types.Array(types.float64, 1, "C")
    packer = shortcuts.packer_of(context.data_model_manager)
    one, again = packer((record, types.int64)), packer([record, types.int64])
    assert one is again
    assert one.argument_types == context.get_arg_packer((record, types.int64)).argument_types
    assert packer((types.int64, record)).argument_types != one.argument_types


def test_the_type_of_a_function_is_made_once_and_is_numbas() -> None:
    context = cpu_target.target_context
    rows = types.Array(types.float64, 1, "C")
    of = shortcuts.function_types_of(context)
    one, again = of(types.float64, (rows, types.int64)), of(types.float64, [rows, types.int64])
    assert one is again
    assert one == context.call_conv.get_function_type(types.float64, (rows, types.int64))
    assert of(types.int64, (rows, types.int64)) != one


def test_numba_has_its_own_back_afterwards() -> None:
    def own() -> list[object]:
        fixer = shortcuts.WarningsFixer
        return [ir.Inst._rec_list_vars, fixer.catch_warnings, shortcuts.PostProcessor.run]

    before = own()
    with shortcuts.shortened():
        assert all(now is not then for now, then in zip(own(), before, strict=True))
    assert own() == before


def test_a_warning_while_types_are_found_is_given() -> None:
    fixer = shortcuts.WarningsFixer(NumbaWarning)
    with warnings.catch_warnings(record=True) as given, shortcuts.shortened():
        warnings.simplefilter("always")
        with fixer.catch_warnings("kernel.py", 3):
            warnings.warn(NumbaWarning("slow"), stacklevel=1)
    assert [str(each.message) for each in given] == ["slow"]


def _made(scale: float, more: float):
    def kernel(rows, count, by=more, *, also=scale):
        return rows[count] * scale * by * also

    return kernel


def test_signatures_are_those_that_inspect_finds_also_with_other_defaults() -> None:
    for scale, more in ((1.0, 2.0), (3.0, 2.0), (1.0, 5.0)):
        found = shortcuts.with_signature(_made(scale, more))
        assert inspect.signature(found) == inspect.signature(_made(scale, more))
        assert found([4.0], 0) == 4.0 * scale * more * scale
    plain = shortcuts.with_signature(_made)
    assert list(inspect.signature(plain).parameters) == ["scale", "more"]


def test_kernels_of_one_code_share_a_signature() -> None:
    one, other = (shortcuts.with_signature(_made(1.0, 2.0)) for _ in range(2))
    assert one.__signature__ is other.__signature__
    assert one is not other
