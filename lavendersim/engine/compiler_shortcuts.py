"""What numba does for any function and no kernel needs, or needs once: spared or remembered.

Nothing of it changes an instruction of a kernel. Like `part_compiler` this leans on what numba
keeps to itself.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from importlib import import_module
from typing import Any

from numba.core import errors, event, interpreter, ir, ssa, typeinfer
from numba.core.datamodel.packer import ArgPacker
from numba.core.errors import WarningsFixer  # type: ignore[attr-defined]
from numba.core.postproc import PostProcessor

from .instruction_variables import variables_of
from .kernel_typing import propagate
from .single_assignment import canonical, run_ssa

_postproc: Any = PostProcessor
_instruction: Any = ir.Inst
_warnings: Any = WarningsFixer
_events: Any = event
_typeinfer: Any = typeinfer
_ssa: Any = ssa
_inferer: Any = typeinfer.TypeInferer
_interpreter: Any = interpreter.Interpreter
if not (hasattr(_typeinfer, "new_error_context") and hasattr(_interpreter, "post_process")):
    raise ImportError("numba finds types in another way")
if not (hasattr(_instruction, "_rec_list_vars") and hasattr(_warnings, "catch_warnings")):
    raise ImportError("numba lists variables or catches warnings in another way")
# For `with` and for dictionaries, which no kernel has.
NEEDLESS_PEEPHOLES = "peep_hole_delete_with_exit", "peep_hole_fuse_dict_add_updates"


def _as_they_come(*_: Any, **__: Any) -> AbstractContextManager[None]:
    return nullcontext()


def _nothing(*_: Any, **__: Any) -> None:
    pass


@contextmanager
def shortened() -> Iterator[None]:
    """Spare kernels what numba does for any function, while they are compiled.

    Lifetimes of variables matter to generators and to counts of references. Its messages are no
    one's, where it finds types by trying, and for each in colour it would set up the terminal. For
    each constraint on a type it would set Python's filters of warnings anew, to sort what is warned
    of by line, and be ready to say what it was typing; a warning is given as it comes instead, and
    an error names its line. Nobody listens to its events.
    """
    whole = _postproc.run
    scheme = getattr(errors, "HighlightColorScheme", None)  # only where colorama is installed
    coloured = scheme and scheme._markup
    listed, caught = _instruction._rec_list_vars, _warnings.catch_warnings

    def run(self: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
        if emit_dels or self.func_ir.is_generator or not hasattr(self.func_ir.func_id, "is_kernel"):
            whole(self, emit_dels, extend_lifetimes)
        else:
            self.func_ir.blocks = canonical(self.func_ir)
            self.func_ir.generator_info = None

    asked, renamed = _inferer.propagate, _ssa._run_ssa

    def propagate_types(self: Any, raise_errors: bool = True) -> Any:
        done = hasattr(self.func_id, "is_kernel") and propagate(self)
        return None if done else asked(self, raise_errors)

    looked_over = _interpreter.post_process

    def look_over(self: Any, peepholes: Any, func_ir: Any) -> Any:
        if hasattr(self.func_id, "is_kernel"):
            peepholes = [each for each in peepholes if each.__name__ not in NEEDLESS_PEEPHOLES]
        return looked_over(self, peepholes, func_ir)

    _interpreter.post_process = look_over
    _inferer.propagate, _ssa._run_ssa = propagate_types, run_ssa
    _postproc.run = run
    _instruction._rec_list_vars = staticmethod(variables_of)
    _warnings.catch_warnings = _as_they_come
    explained, begun, ended = _typeinfer.new_error_context, _events.start_event, _events.end_event
    _typeinfer.new_error_context = _as_they_come
    if not any(_events._registered.values()):
        _events.start_event = _events.end_event = _nothing
    if scheme:
        scheme._markup = lambda self, message, *_: message
    try:
        yield
    finally:
        _interpreter.post_process = looked_over
        _inferer.propagate, _ssa._run_ssa = asked, renamed
        _postproc.run = whole
        _instruction._rec_list_vars = listed
        _warnings.catch_warnings = caught
        _typeinfer.new_error_context = explained
        _events.start_event, _events.end_event = begun, ended
        if scheme:
            scheme._markup = coloured


@contextmanager
def without_algebra() -> Iterator[None]:
    """Let numba learn its functions without a look for SciPy's, which takes longer than the rest.

    No kernel multiplies matrices; numba looks again where code of others does.
    """
    linalg = import_module("numba.np.linalg")
    looked: Any = getattr(linalg, "ensure_blas", None)
    linalg.ensure_blas = _nothing  # type: ignore[attr-defined]
    try:
        yield
    finally:
        linalg.ensure_blas = looked  # type: ignore[attr-defined]


# Calls of Python that may be inside of each other while kernels are compiled. A part is compiled
# where its caller is typed, 23 calls deeper, and an engine of all shapes and effects has more than
# forty parts in a row.
NESTED_CALLS = 5000


@contextmanager
def nested() -> Iterator[None]:
    """Let calls nest as deep as parts of kernels do, under the lock of the compiler."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, NESTED_CALLS))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


_signatures: dict[tuple[Any, ...], inspect.Signature] = {}


def with_signature(function: Any) -> Any:
    """Return a function with its signature noted, for which numba asks twice of every kernel.

    To find it is two thirds of what it takes to compose kernels. What a factory makes again, for
    another spec, has the same code, and so the same names of arguments.
    """
    defaults = function.__defaults__, tuple((function.__kwdefaults__ or {}).items())
    key = function.__code__, *defaults
    found = _signatures.get(key)
    if found is None:
        found = _signatures[key] = inspect.signature(function)
    function.__signature__ = found
    return function


def _codes(kinds: Any) -> tuple[int, ...]:
    """Return numba's numbers of types: to hash a tuple of arrays is to hash all its fields."""
    return tuple([kind._code for kind in kinds])


_packers: dict[tuple[Any, tuple[int, ...]], ArgPacker] = {}


def packer_of(models: Any) -> Callable[[Any], ArgPacker]:
    """Return what gives the packer of arguments of given types: one for all who call with them.

    Numba asks for it some four times a call, and makes it anew each time.
    """

    def packer(kinds: Any) -> ArgPacker:
        key = models, _codes(kinds)
        found = _packers.get(key)
        if found is None:
            found = _packers[key] = ArgPacker(models, kinds)
        return found

    return packer


_function_types: dict[tuple[Any, ...], Any] = {}


def function_types_of(context: Any) -> Callable[[Any, Any], Any]:
    """Return what gives LLVM's type of a function, for which numba asks twice a call."""
    conventions, models = context.call_conv, context.data_model_manager
    made = conventions.get_function_type

    def function_type(returns: Any, arguments: Any) -> Any:
        key = models, type(conventions), returns._code, _codes(arguments)
        found = _function_types.get(key)
        if found is None:
            found = _function_types[key] = made(returns, arguments)
        return found

    return function_type
