"""How a module of kernels is optimised: what is called once or short is merged, then each function.

LLVM's own pipeline takes each function through its passes, merges it into its callers where an
estimate says so, and takes these through them in turn: of a hundred parts that end in one function
each is looked at a dozen times. Here what is merged is known beforehand, and what remains is taken
through LLVM's passes for functions once: two thirds of the time, and as more is merged, steps of
small scenes take 4 to 15 % less. Nothing is made a loop of vectors; lanes of contacts say what they
are by their types (`solvers/packed/lanes`). Separate parts that live by such loops, as dense panels
of a factor, go through LLVM's own pipeline.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import Any, Final

from llvmlite.binding import Linkage, create_new_module_pass_manager
from numba.core import config

# LLVM's first level takes two thirds of the time of its third, and kernels are as fast.
LEVEL: Final = 1
# Lines of LLVM text of a function that is merged wherever it is called. A stack of six takes 7.1 us
# a step with 60, 6.0 with 200, and a pile of balls 3 % less with 260 than with 200; from 320 on
# modules take twice the time, for nothing.
SHORT: Final = 260
SELDOM_SHORT: Final = 42  # of what is seldom called: half as long, and compiled in half the time
_SYMBOL = r'@("[^"]*"|[-\w.$]+)\('
_CALL = re.compile(r"call [^@\n]*" + _SYMBOL)
_FUNCTION = re.compile(r"^define [^@\n]*" + _SYMBOL + r".*?\n(.*?)^}", re.MULTILINE | re.DOTALL)


def optimise(
    module: Any, parts: set[str], codegen: Any, *, short: int = SHORT, vectors: bool = False
) -> None:
    """Optimise a module once, with parts of these symbols in it.

    short: lines of what is merged wherever it is called; vectors: its loops are made loops of
    vectors, where LLVM can.

    Parts are called from here alone. Numba would optimise twice, so that counts of references meet
    in one function; kernels count none.
    """
    inner = []
    for function in module.functions:
        merged = function.name in parts or function.linkage == Linkage.linkonce_odr
        if merged and not function.is_declaration:
            function.linkage = Linkage.internal
        if function.linkage == Linkage.internal:
            inner.append(function)
    level = min(LEVEL, config.OPT)  # type: ignore[attr-defined]
    if vectors or not level:
        passes, builder = codegen._module_pass_manager(opt=level)
        passes.run(module, builder)
        return
    calls, lengths = counted(str(module))
    for function in inner:
        if calls[function.name] == 1 or lengths[function.name] < short:
            function.add_function_attribute("alwaysinline")
    builder = codegen._pass_builder(opt=level)
    merging = create_new_module_pass_manager()
    merging.add_always_inliner_pass()
    merging.add_global_dead_code_eliminate_pass()
    merging.run(module, builder)
    passes = builder.getFunctionPassManager()
    for function in module.functions:
        if not function.is_declaration:
            passes.run(function, builder)


def counted(text: str) -> tuple[Counter[str], dict[str, int]]:
    """Return of a module's text how often each function is called, and how long each one is."""
    calls = Counter(symbol.strip('"') for symbol in _CALL.findall(text))
    lengths = {found[1].strip('"'): found[2].count("\n") for found in _FUNCTION.finditer(text)}
    return calls, lengths
