"""Kernels: Python functions composed by the flags of a `Spec` and compiled by numba.

Kernels are closures over the flags of a `Spec`. Numba removes the branches that a flag makes dead
before it types them, so a pruned kernel is as small as one that never had the effect.
"""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from time import perf_counter_ns
from typing import Any

import numba
from numba.core.errors import NumbaExperimentalFeatureWarning

from lavendersim.garbage import uncollected

from . import kernel_store
from .compile_options import OPTIONS
from .identity import SEPARATE
from .spec import Spec

Kernel: Any = None
try:
    from .compiler_shortcuts import with_signature
    from .part_compiler import Kernel
except ImportError as error:
    # Numba's own symbols carry counters of the process, and the first of two with one name that is
    # loaded is used for both (numba issue 10486): only where it was made is such code safe to run.
    kernel_store.keep_nothing(f"numba {numba.__version__} compiles no parts of kernels ({error})")


def compiler_is_off() -> bool:
    """Whether numba was set to leave functions as they are; its own do not work together then."""
    return bool(numba.config.DISABLE_JIT)  # type: ignore[attr-defined]


def inner(function: Callable[..., Any]) -> Any:
    """Compile `function`, which is the same for every `Spec`, for use inside other kernels."""
    if Kernel is None:
        return numba.njit(**OPTIONS)(function)
    options = {"nopython": True, "boundscheck": None, **OPTIONS}
    return Kernel(with_signature(function), targetoptions=options)


# Whether this thread names kernels alone (`naming`), whether it compiles, and what that took.
_of_thread = threading.local()


@contextmanager
def compiling() -> Iterator[None]:
    """Compile inside: without numba's remark that records share their first fields, and faster.

    A kernel compiled for one record serves records that begin with the same fields, at the same
    offsets; that is what we want, and numba calls it experimental each time.
    """
    outer, begin = getattr(_of_thread, "compiles", False), perf_counter_ns()
    _of_thread.compiles = True
    try:
        with uncollected(), warnings.catch_warnings():
            warnings.simplefilter("ignore", NumbaExperimentalFeatureWarning)
            yield
    finally:
        _of_thread.compiles = outer
        if not outer:
            _of_thread.compiled_ns = compiled_ns() + perf_counter_ns() - begin


def compiled_ns() -> int:
    """Return what composing, compiling and loading kernels has taken this thread so far [ns]."""
    return int(getattr(_of_thread, "compiled_ns", 0))


def clock_without_compiling() -> int:
    """Return a clock of this thread [ns] that stands while it compiles kernels."""
    return perf_counter_ns() - compiled_ns()


def call(kernel: Any, *arguments: Any) -> Any:
    """Call a kernel of plain arrays; its first call compiles it.

    Afterwards to change what is warned of would take longer than a short block takes the kernel.
    """
    if kernel.overloads:
        return kernel(*arguments)
    with compiling():
        return kernel(*arguments)


# Steps of spheres take a tenth of a microsecond, and their kernels little time to compile.
ROUND = frozenset({"sphere_plane", "sphere_sphere"})


def separate(kernel: Any, spec: Spec, how: int = SEPARATE) -> Any:
    """Return a kernel that is optimised with what it calls and without its callers.

    For what is large, is called a few times a step and is the same in many plans (`separate_code`).
    how: `IN_VECTORS`, its loops are made loops of vectors, or `SELDOM`, less is merged into it
    (`optimisation`); to the same bits.
    """
    alone = how != SEPARATE or not ROUND.issuperset(spec.shape_pairs)
    if Kernel is not None and isinstance(kernel, Kernel) and alone:
        kernel.separate = how
    return kernel


# Lists that want to know what is composed: (module, name of the kernel).
_listeners: list[list[tuple[str, str]]] = []


def _are_named() -> bool:
    return getattr(_of_thread, "named", False)


@contextmanager
def composing() -> Iterator[list[tuple[str, str]]]:
    """Note every kernel that is composed inside, by module and name; none of them is compiled."""
    composed: list[tuple[str, str]] = []
    _listeners.append(composed)
    try:
        yield composed
    finally:
        _listeners.pop()  # the innermost; lists that are equal are not the same


@contextmanager
def naming() -> Iterator[list[tuple[str, str]]]:
    """Note the same of kernels that stay plain functions: who wants their names calls none.

    Most of what it takes to compose an engine is numba's objects.
    """
    before, _of_thread.named = _are_named(), True
    try:
        with composing() as composed:
            yield composed
    finally:
        _of_thread.named = before


def kernel(function: Callable[..., Any], spec: Spec) -> Any:
    """Compile `function`, made for `spec`, for use inside other kernels."""
    for composed in _listeners:
        composed.append((function.__module__, function.__name__))
    return function if _are_named() else inner(function)


def once(make: Callable[[Spec], Any]) -> Callable[[Spec], Any]:
    """Let a factory make its kernels once a spec, however many kernels share them.

    Who listens to what is composed hears of them each time.
    """
    made: dict[tuple[Spec, bool], tuple[Any, list[tuple[str, str]]]] = {}

    @wraps(make)
    def shared(spec: Spec) -> Any:
        key = spec, _are_named()
        if key not in made:
            with composing() as composed:
                kernels = make(spec)
            made[key] = kernels, composed
        else:
            for composed in _listeners:
                composed.extend(made[key][1])
        return made[key][0]

    return shared


def chain(kernels: Sequence[Any], spec: Spec) -> Any:
    """One kernel that calls `kernels` in order with the same arguments."""
    if not kernels:

        def nothing(*arguments):
            pass

        return kernel(nothing, spec)
    return _folded(kernels, spec, _both)


def either(kernels: Sequence[Any], spec: Spec) -> Any:
    """One kernel that returns whether any of `kernels` does; one at least."""
    return _folded(kernels, spec, _any_of)


def greatest(kernels: Sequence[Any], spec: Spec) -> Any:
    """One kernel that returns the greatest number of those of `kernels`, one at least."""
    return _folded(kernels, spec, _greatest_of)


def _folded(kernels: Sequence[Any], spec: Spec, of_two: Callable[[Any, Any], Any]) -> Any:
    """Return the first, with what the others are folded to; of_two: a function that calls two."""
    head, *others = kernels
    return kernel(of_two(head, _folded(others, spec, of_two)), spec) if others else head


def _both(head: Any, tail: Any) -> Any:
    def both(*arguments):
        head(*arguments)
        tail(*arguments)

    return both


def _any_of(head: Any, tail: Any) -> Any:
    def any_of(*arguments):
        return head(*arguments) or tail(*arguments)

    return any_of


def _greatest_of(head: Any, tail: Any) -> Any:
    def greatest_of(*arguments):
        return max(head(*arguments), tail(*arguments))

    return greatest_of
