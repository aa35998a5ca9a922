"""Numba kernels from Python functions: the one place that knows how numba compiles.

Kernels are closures over the flags of a `Spec`. Numba removes the branches that a flag makes dead
before it types them, so a pruned kernel is as small as one that never had the effect.

Hazard: numba's symbol names carry counters of the process, of functions and of record types, and
objects cached by different processes can collide (numba issue 10486): the first one loaded is used
for both. Each kernel's qualified name therefore carries the digest of the spec it was made for, and
the parts of a kernel are no symbols of its object at all (`KernelObject`).
"""

from __future__ import annotations

import gc
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from typing import Any

import numba
from llvmlite.binding import Linkage
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.cpu import CPUTargetOptions
from numba.core.errors import NumbaExperimentalFeatureWarning
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature

from .spec import Spec

# Kernels allocate nothing, and without reference counting a sphere's step costs a third. The option
# is undocumented: a numba that does not know it compiles with counting, to the same bits.
UNDOCUMENTED = ("_nrt",)


def known(options: dict[str, Any], target_options: Any = CPUTargetOptions) -> dict[str, Any]:
    """Return `options` without the undocumented ones that numba's `target_options` do not have."""
    return {
        name: value
        for name, value in options.items()
        if name not in UNDOCUMENTED or hasattr(target_options, name)
    }


# No fastmath and no contraction: results must not depend on the optimiser's mood.
# error_model numpy: a division by zero gives inf, which the runner reports, and never raises.
# Nobody calls kernels from C.
OPTIONS: dict[str, Any] = known(
    {
        "error_model": "numpy",
        "fastmath": False,
        "nogil": True,
        "no_cfunc_wrapper": True,
        "_nrt": False,
    }
)


class LinkedKernel(JITCodeLibrary):
    """Code of a kernel that other kernels call: linked into each of them, and optimised there.

    Numba would optimise and assemble every kernel by itself as well, with all that it calls. None
    of that is ever run, and it doubles the time an engine takes to compile.
    """

    def _optimize_final_module(self) -> None:
        """Leave that to the kernel this is linked into."""

    def _finalize_final_module(self) -> None:
        """Make no machine code."""
        self._finalized = True


class KernelObject(JITCodeLibrary):
    """Code of a kernel that Python calls, with all its parts."""

    def _optimize_final_module(self) -> None:
        """Optimise: parts are called from here alone, so what is called once is merged in whole."""
        for function in self._final_module.functions:
            if function.linkage == Linkage.linkonce_odr and not function.is_declaration:
                function.linkage = Linkage.internal
        super()._optimize_final_module()


class LinkedCompiler(Compiler):
    """Numba's pipeline for a kernel that only kernels call."""

    def __init__(self, typingctx, targetctx, library, args, return_type, flags, locals):
        flags.no_compile = flags.no_cpython_wrapper = True
        part = LinkedKernel(targetctx.codegen(), "part")
        super().__init__(typingctx, targetctx, part, args, return_type, flags, locals)


class ObjectCompiler(Compiler):
    """Numba's pipeline for a kernel that Python calls; its code can be kept on disk."""

    def __init__(self, typingctx, targetctx, library, args, return_type, flags, locals):
        whole = KernelObject(targetctx.codegen(), "whole")
        whole.enable_object_caching()
        super().__init__(typingctx, targetctx, whole, args, return_type, flags, locals)


class Kernel(CPUDispatcher):
    """Compiled code of one function for each signature; a door to Python only where Python calls.

    One kernel in a hundred is called from Python; the others are parts of it. A signature that
    Python calls after all is compiled a second time.
    """

    _compiler: Any  # numba does not declare its own
    called_by_kernel = False

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Compile for a kernel that calls this one."""
        with global_compiler_lock:
            before, self.called_by_kernel = self.called_by_kernel, True
            try:
                return super().get_call_template(args, kws)
            finally:
                self.called_by_kernel = before

    def compile(self, sig: Any) -> Any:
        """Compile for the caller: a kernel, or Python, which needs the door."""
        with global_compiler_lock:
            args = tuple(normalize_signature(sig)[0])
            if not self.called_by_kernel and args in self.overloads and not self.has_door(args):
                del self.overloads[args]
            pipeline = LinkedCompiler if self.called_by_kernel else ObjectCompiler
            self._compiler.pipeline_class = pipeline
            return super().compile(sig)

    def add_overload(self, cres: Any) -> None:
        """Remember compiled code; Python's own table lists what has a door."""
        if self.called_by_kernel:
            # Numba looks code up by its door; the library stands in for that.
            cres = cres._replace(entry_point=cres.library)
            self.targetctx.insert_user_function(cres.entry_point, cres.fndesc, [cres.library])
            self.overloads[tuple(cres.signature.args)] = cres
        else:
            super().add_overload(cres)

    def has_door(self, args: tuple[Any, ...]) -> bool:
        """Whether Python can call the code compiled for these types."""
        result: Any = self.overloads[args]
        return not isinstance(result.library, LinkedKernel)


def compiler_is_off() -> bool:
    """Whether numba was set to leave functions as they are; its own do not work together then."""
    return bool(numba.config.DISABLE_JIT)  # type: ignore[attr-defined]


def inner(function: Callable[..., Any]) -> Any:
    """Compile `function`, which is the same for every `Spec`, for use inside other kernels."""
    return Kernel(function, targetoptions={"nopython": True, "boundscheck": None, **OPTIONS})


@contextmanager
def compiling() -> Iterator[None]:
    """Compile inside: without numba's remark that records share their first fields, and faster.

    A kernel compiled for one record serves records that begin with the same fields, at the same
    offsets; that is what we want, and numba calls it experimental each time. Next to nothing of
    what a compiler makes is garbage, and looking for it takes a tenth of the time.
    """
    collected = gc.isenabled()
    gc.disable()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NumbaExperimentalFeatureWarning)
            yield
    finally:
        if collected:
            gc.enable()


# Lists that want to know what is composed: (module, name of the kernel).
_listeners: list[list[tuple[str, str]]] = []


@contextmanager
def composing() -> Iterator[list[tuple[str, str]]]:
    """Note every kernel that is composed inside, by module and name; none of them is compiled."""
    composed: list[tuple[str, str]] = []
    _listeners.append(composed)
    try:
        yield composed
    finally:
        _listeners.pop()  # the innermost; lists that are equal are not the same


def kernel(function: Callable[..., Any], spec: Spec) -> Any:
    """Compile `function`, made for `spec`, for use inside other kernels."""
    for composed in _listeners:
        composed.append((function.__module__, function.__name__))
    function.__qualname__ = f"{function.__qualname__}_{spec.digest()}"
    return inner(function)


def once(make: Callable[[Spec], Any]) -> Callable[[Spec], Any]:
    """Let a factory make its kernels once a spec, however many kernels share them.

    Who listens to what is composed hears of them each time.
    """
    made: dict[Spec, tuple[Any, list[tuple[str, str]]]] = {}

    @wraps(make)
    def shared(spec: Spec) -> Any:
        if spec not in made:
            with composing() as composed:
                kernels = make(spec)
            made[spec] = kernels, composed
        else:
            for composed in _listeners:
                composed.extend(made[spec][1])
        return made[spec][0]

    return shared


def chain(kernels: Sequence[Any], spec: Spec) -> Any:
    """One kernel that calls `kernels` in order with the same arguments."""
    if not kernels:

        def nothing(*arguments):
            pass

        return kernel(nothing, spec)
    head = kernels[0]
    if len(kernels) == 1:
        return head
    tail = chain(kernels[1:], spec)

    def both(*arguments):
        head(*arguments)
        tail(*arguments)

    both.__qualname__ += f"_{len(kernels)}"  # each link of the chain has a symbol of its own
    return kernel(both, spec)
