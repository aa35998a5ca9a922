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
# And lines with all that is merged into it, of what is called more than once: the solve of a round
# scene is 250 lines that call a solver of 25,000, from six places.
MOST: Final = 5000
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
        is_part = function.name in parts or function.linkage == Linkage.linkonce_odr
        if is_part and not function.is_declaration:
            function.linkage = Linkage.internal
        if function.linkage == Linkage.internal:
            inner.append(function)
    level = min(LEVEL, config.OPT)  # type: ignore[attr-defined]
    if vectors or not level:
        passes, builder = codegen._module_pass_manager(opt=level)
        passes.run(module, builder)
        return
    merged = merged_in(str(module), {function.name for function in inner}, short)
    for function in inner:
        if function.name in merged:
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


def merged_in(text: str, inner: set[str], short: int) -> set[str]:
    """Return which of a module's inner functions are merged into their callers.

    Those that are called once; and those shorter than `short`, but for what is so long in them that
    they have MOST lines.
    """
    called, lengths = counted(text)
    calls = sum(called.values(), Counter[str]())
    whole: dict[str, int] = {}  # lines of each with what is merged into it
    merged: set[str] = set()

    def decide(name: str) -> None:
        length = lines = whole[name] = lengths[name]
        for other, times in called[name].items():
            if other in lengths and other not in whole:
                decide(other)
            if other in merged:
                lines += times * whole[other]
        if length < short and calls[name] > 1:
            own = [one for one in called[name] if one in merged and calls[one] == 1]
            for other in sorted(own, key=lambda one: (-whole[one], one)):
                if lines >= MOST:
                    merged.remove(other)
                    lines -= whole[other]
        whole[name] = lines
        if name in inner and (calls[name] == 1 or (length < short and lines < MOST)):
            merged.add(name)

    for name in lengths:
        if name not in whole:
            decide(name)
    return merged


def counted(text: str) -> tuple[dict[str, Counter[str]], dict[str, int]]:
    """Return of a module's text how often each function calls which, and how long each one is."""
    bodies = {found[1].strip('"'): found[2] for found in _FUNCTION.finditer(text)}
    called = {
        name: Counter(symbol.strip('"') for symbol in _CALL.findall(body))
        for name, body in bodies.items()
    }
    return called, {name: body.count("\n") for name, body in bodies.items()}
