"""The fold of `trace.checksums` in machine code: LLVM's, made once in a process that asks for it.

It is called by its address, as C would, without the interpreter's lock.
"""

from __future__ import annotations

import ctypes
from typing import Any, Final

BLOCKS: Final = 4  # sums that are folded side by side
# Remainders of powers of x, bits reversed (Gopal et al., "bit-reflected" CRC-32): for 64 bytes on,
FAR: Final = 0x0154442BD4, 0x01C6E41596
NEAR: Final = 0x01751997D0, 0x00CCAA009E  # and for 16.


def machine_code() -> Any:
    """Return the fold compiled for this x86-64 processor; None where it has no such product."""
    from llvmlite import binding as llvm

    features = llvm.get_host_cpu_features()
    if not features.get("pclmul"):
        return None
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=features.flatten(), opt=2
    )
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(str(_module())), machine)
    engine.finalize_object()
    kind = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p)
    function: Any = kind(engine.get_function_address("fold"))
    function.engine = engine  # it owns the code
    return function


def _module() -> Any:
    """Return the function `fold(data, blocks, left)` in LLVM's language.

    blocks: a multiple of 4, at least 4. left: what goes into the first block; holds what is left.
    """
    from llvmlite import ir

    word, byte = ir.IntType(64), ir.IntType(8)
    pair = ir.VectorType(word, 2)
    module = ir.Module("checksums")
    places = [pair.as_pointer(), word, pair.as_pointer()]
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), places), "fold")
    product = ir.Function(module, ir.FunctionType(pair, [pair, pair, byte]), "llvm.x86.pclmulqdq")
    data, count, left = function.args
    begin, loop, end = (function.append_basic_block(name) for name in ("begin", "loop", "end"))

    def read(at: Any, place: Any) -> Any:
        block = at.load(place)
        block.align = 1
        return block

    def fold(at: Any, one: Any, factors: tuple[int, int], block: Any) -> Any:
        by = ir.Constant(pair, factors)
        parts = [at.call(product, [one, by, ir.Constant(byte, half)]) for half in (0x00, 0x11)]
        return at.xor(at.xor(*parts), block)

    at = ir.IRBuilder(begin)
    first = [read(at, at.gep(data, [ir.Constant(word, k)])) for k in range(BLOCKS)]
    first[0] = at.xor(first[0], read(at, left))
    step = ir.Constant(word, BLOCKS)
    at.cbranch(at.icmp_unsigned(">", count, step), loop, end)

    at = ir.IRBuilder(loop)
    number, sums = at.phi(word), [at.phi(pair) for _ in first]
    blocks = [at.gep(data, [at.add(number, ir.Constant(word, k))]) for k in range(BLOCKS)]
    further = [fold(at, one, FAR, read(at, y)) for one, y in zip(sums, blocks, strict=True)]
    following = at.add(number, step)
    at.cbranch(at.icmp_unsigned("<", following, count), loop, end)
    number.add_incoming(step, begin)
    number.add_incoming(following, loop)

    at = ir.IRBuilder(end)
    last = [at.phi(pair) for _ in first]
    for k, one in enumerate(last):
        for phi in (sums[k], one):
            phi.add_incoming(first[k], begin)
            phi.add_incoming(further[k], loop)
    whole = last[0]
    for block in last[1:]:
        whole = fold(at, whole, NEAR, block)
    at.store(whole, left).align = 1
    at.ret_void()
    return module
