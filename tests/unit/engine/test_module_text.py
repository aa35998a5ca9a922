"""What is written of a module is parsed to the same as what llvmlite writes."""

from typing import Any

import pytest
from llvmlite import binding, ir

module_text = pytest.importorskip("lavendersim.engine.module_text")
WORD, REAL = ir.IntType(64), ir.DoubleType()
PAIR = ir.LiteralStructType([WORD, ir.LiteralStructType([REAL, WORD])])


def _module() -> Any:
    """A function with each instruction that is written directly, and others."""
    module = ir.Module(name="a module", context=ir.Context())
    module.triple = binding.get_default_triple()
    named = module.context.get_identified_type("named")
    named.set_body(WORD, REAL)
    constant = ir.GlobalVariable(module, WORD, name='of "quotes"')
    constant.initializer = WORD(3)
    called = ir.Function(module, ir.FunctionType(REAL, [REAL]), name="called")
    kind = ir.FunctionType(REAL, [WORD, REAL, WORD.as_pointer(), named.as_pointer()])
    function = ir.Function(module, kind, name='with "quotes"')
    i, x, at, row = function.args
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    then, loop, end = (function.append_basic_block(name) for name in ("then", 'an "odd" one', ""))
    slots = builder.alloca(REAL, name="slot"), builder.alloca(WORD, WORD(4))
    slots[0].align = 16
    builder.store(x, slots[0]).align = 8
    builder.store(builder.load(at), builder.gep(slots[1], [WORD(2)], inbounds=True))
    builder.load(builder.gep(row, [WORD(0), ir.IntType(32)(1)]), align=4)
    pair = builder.insert_value(ir.Constant(PAIR, ir.Undefined), i, 0)
    pair = builder.insert_value(pair, builder.fmul(x, x, flags=["nnan", "ninf"]), [1, 0])
    less = builder.icmp_signed("<", builder.add(i, builder.load(constant), flags=["nsw"]), i)
    odd = builder.fcmp_unordered("!=", builder.extract_value(pair, [1, 0]), x, flags=["fast"])
    chosen = builder.select(builder.and_(less, odd), x, REAL(float("nan")), flags=["nsz"])
    branch = builder.cbranch(builder.not_(odd), then, loop)
    branch.set_weights([1, 99])
    builder.position_at_end(then)
    builder.switch(builder.trunc(i, ir.IntType(8)), loop).add_case(3, end)
    builder.position_at_end(loop)
    joined = builder.phi(REAL)
    joined.add_incoming(chosen, function.blocks[0])
    joined.add_incoming(REAL(-0.0), then)
    builder.load(slots[0]).set_metadata("invariant.load", module.add_metadata([]))
    builder.fsub(builder.call(called, [joined]), builder.sitofp(builder.ptrtoint(at, WORD), REAL))
    builder.branch(end)
    builder.position_at_end(end)
    builder.ret(builder.fneg(x))
    returns = ir.Function(module, ir.FunctionType(ir.VoidType(), []), name="returns")
    ir.IRBuilder(returns.append_basic_block()).ret_void()
    return module


def test_text_is_parsed_to_the_same_module() -> None:
    module = _module()
    texts = module_text.text_of(module), str(module)
    ours, theirs = (binding.parse_assembly(text, binding.create_context()) for text in texts)
    ours.verify()
    assert str(ours) == str(theirs)
    instructions = [
        each for f in module.functions for block in f.blocks for each in block.instructions
    ]
    assert {type(each) for each in instructions} >= set(module_text.WRITTEN)


def test_whether_metadata_and_unknown_instructions_are_left_to_llvmlite() -> None:
    lines = module_text.text_of(_module())
    assert "!prof" in lines
    assert "!invariant.load" in lines
    assert "switch" in lines
    assert "phi" in lines
