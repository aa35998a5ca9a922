"""What takes no instruction of its own in a part names the same value as LLVM's own way."""

from __future__ import annotations

import pytest
from llvmlite import binding, ir

light_values = pytest.importorskip("lavendersim.engine.light_values")

BYTE, WORD, NUMBER = ir.IntType(8), ir.IntType(64), ir.DoubleType()


def _function() -> tuple[ir.Module, ir.Function, ir.IRBuilder]:
    module = ir.Module()
    function = ir.Function(module, ir.FunctionType(NUMBER, [WORD.as_pointer()]), "read")
    return module, function, ir.IRBuilder(function.append_basic_block("entry"))


def test_a_pointer_of_another_type_is_the_same_pointer() -> None:
    module, function, builder = _function()
    [words] = function.args
    number = builder.load(light_values.pointing_to(builder, words, NUMBER))
    assert light_values.pointing_to(builder, words, WORD) is words
    builder.ret(number)
    text = str(module)
    assert "bitcast" not in text
    assert f"load double, double* {words.get_reference()}" in text
    binding.parse_assembly(text).verify()


def test_a_constant_is_read_once_however_late_it_is_asked_for() -> None:
    module, function, builder = _function()
    known = ir.GlobalVariable(module, NUMBER, "place")
    later = function.append_basic_block("later")
    room = light_values.slot(builder, NUMBER)
    builder.branch(later)
    builder.position_at_end(later)
    first, again = (light_values.at_entry(builder, known) for _ in range(2))
    assert first is again
    assert first.parent is room.parent is function.entry_basic_block
    builder.store(first, room)
    builder.ret(builder.load(room))
    binding.parse_assembly(str(module)).verify()
