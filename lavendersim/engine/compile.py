"""Python functions enter, numba kernels leave. The one place that knows numba's options.

Kernels are closures over the flags of a `Spec`. Numba removes the branches that a flag makes dead
before it types them, so a pruned kernel is as small as one that never had the effect.

Hazard: numba's symbol names carry a counter of the process, and objects cached by different
processes can collide (numba issue 10486). Each kernel's qualified name therefore carries the digest
of the spec it was made for.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numba
from numba.core.cpu import CPUTargetOptions
from numba.core.errors import NumbaExperimentalFeatureWarning

from .spec import Spec

# Kernels allocate nothing, and without reference counting a sphere's step costs a third. The option
# is undocumented: a numba that does not know it compiles with counting, to the same bits.
UNDOCUMENTED = ("_nrt",)


def known(options: dict[str, Any], target_options: Any = CPUTargetOptions) -> dict[str, Any]:
    """Return `options` without the undocumented ones that numba's `target_options` lack."""
    return {
        name: value
        for name, value in options.items()
        if name not in UNDOCUMENTED or hasattr(target_options, name)
    }


# No fastmath and no contraction: results must not depend on the optimiser's mood.
# error_model numpy: a division by zero gives inf, which the runner reports, and never raises.
OPTIONS: dict[str, Any] = known(
    {"error_model": "numpy", "fastmath": False, "nogil": True, "_nrt": False}
)


@contextmanager
def compiling() -> Iterator[None]:
    """Compile inside: numba's remark that records share their first fields is not passed on.

    A kernel compiled for one record serves records that begin with the same fields, at the same
    offsets; that is what we want, and numba calls it experimental each time.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NumbaExperimentalFeatureWarning)
        yield


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
        _listeners.remove(composed)


def kernel(function: Callable[..., Any], spec: Spec) -> Any:
    """Compile `function`, made for `spec`, for use inside other kernels."""
    for composed in _listeners:
        composed.append((function.__module__, function.__name__))
    function.__qualname__ = f"{function.__qualname__}_{spec.digest()}"
    return numba.njit(**OPTIONS)(function)


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
