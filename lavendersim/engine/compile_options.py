"""How numba compiles kernels, and one hash of all else that their machine code depends on."""

from __future__ import annotations

import hashlib
import os
import platform
import re
import sys
from functools import cache
from importlib.metadata import version
from typing import Any

import numba
import numpy as np
from numba.core.cpu import CPUTargetOptions
from numba.core.registry import cpu_target

from .sources import digest, engine_sources

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
# What can be set in the environment or in a file and changes machine code. Features and name of the
# processor are asked of the code generator.
SETTINGS = (
    "OPT",
    "LOOP_VECTORIZE",
    "SLP_VECTORIZE",
    "BOUNDSCHECK",
    "DEBUGINFO_DEFAULT",
    "EXTEND_VARIABLE_LIFETIMES",
    "LLVM_REFPRUNE_PASS",
    "LLVM_REFPRUNE_FLAGS",
    "USING_SVML",
)


@cache
def _compiler_hash() -> str:
    """Return the sha256 of the sources that know numba: they say how kernels are compiled."""
    knows = re.compile(rb"^(from|import) (numba|llvmlite)", re.MULTILINE)
    return digest({path: text for path, text in engine_sources().items() if knows.search(text)})


@cache
def _llvmlite() -> str:
    return version("llvmlite")


@cache
def _processor() -> Any:
    """Return what the code generator says of the processor; asking takes a millisecond."""
    return cpu_target.target_context.codegen().magic_tuple()


def build() -> str:
    """Return eight hex digits of what all kernels depend on, whatever they do."""
    settings = tuple(getattr(numba.config, name, None) for name in SETTINGS)
    # Whatever else numba is set to: a needless compilation is cheaper than a wrong kernel.
    names = [name for name in os.environ if name.startswith("NUMBA_")]
    environment = tuple(sorted((name, os.environ[name]) for name in names))
    return _digest_of(
        _compiler_hash(),
        tuple(sorted(OPTIONS.items())),
        (numba.__version__, _llvmlite(), np.__version__, sys.version_info[:3]),
        platform.machine(),
        _processor(),
        settings,
        environment,
    )


@cache  # it is asked for with every part
def _digest_of(*parts: Any) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:8]
