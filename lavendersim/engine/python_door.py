"""How memory comes from Python: arrays are taken from their tuples to where kernels read them.

Numba would make one value of all arrays of an engine, some two thousand numbers, and put that down:
of what LLVM does for a new plan a sixth, each time. Like `part_compiler` this leans on what numba
keeps to itself.
"""

from __future__ import annotations

from copy import copy
from typing import Any

from llvmlite.ir import ArrayType, Constant, Function, FunctionType, IntType, IRBuilder
from numba.core import cgutils, types
from numba.core.datamodel.packer import ArgPacker
from numba.core.datamodel.registry import default_manager
from numba.core.pythonapi import NativeValue, PythonAPI
from numba.np.numpy_support import as_dtype

from .memory_references import BYTES, REFERENCES, WORD, is_memory, moved, words

READER = ".read_array"  # a function of each whole kernel's own
MISMATCH = "an array is no array of the type that the kernel was compiled for"


class _Door(PythonAPI):
    """Numba's interface to Python, with memory read to one place."""

    def __init__(self, context: Any, builder: Any) -> None:
        super().__init__(context, builder)
        self._plain = PythonAPI(context, builder)

    def to_native_value(self, typ: Any, obj: Any) -> Any:
        """Return an argument: of memory, where it lies."""
        if not is_memory(typ):
            return self._plain.to_native_value(typ, obj)
        place = cgutils.alloca_once(self.builder, ArrayType(WORD, words(typ)))
        place = self.builder.bitcast(place, BYTES)
        return NativeValue(place, is_error=self._read(typ, obj, place))

    def _read(self, kind: Any, given: Any, place: Any) -> Any:
        """Read the arrays of a tuple, and of those in it, to a place; return whether that fails."""
        failed, builder, at = cgutils.false_bit, self.builder, 0
        for index, inner in enumerate(kind):
            item, to = self.tuple_getitem(given, index), moved(builder, place, at)
            if isinstance(inner, types.Array):
                size = Constant(WORD, _size_of(inner.dtype))
                failed_here = builder.call(self._reader(), [item, to, size])
            else:
                failed_here = self._read(inner, item, to)
            failed, at = builder.or_(failed, failed_here), at + words(inner)
        return failed

    def _reader(self) -> Any:
        """Return `function(array, place, bytes of a row) -> whether that fails`, made once."""
        module = self.builder.module
        known = module.globals.get(READER)
        if known is not None:
            return known
        kind = FunctionType(IntType(1), [BYTES, BYTES, WORD])
        read = Function(module, kind, READER)
        read.linkage = "private"  # neither merged nor seen
        builder = IRBuilder(read.append_basic_block("entry"))
        array, place, size = read.args
        inside = PythonAPI(self.context, builder)
        with builder.if_then(cgutils.is_null(builder, array), likely=False):
            builder.ret(cgutils.true_bit)  # of a tuple that is too short; Python has said so
        code = inside.numba_array_adaptor(array, place)
        model = default_manager[types.Array(types.float64, 1, "C")]
        at = moved(builder, place, model.get_field_position("itemsize"))
        found = builder.load(builder.bitcast(at, WORD.as_pointer()))
        refused = cgutils.is_not_null(builder, code)
        failed = builder.or_(refused, builder.icmp_unsigned("!=", found, size))
        with builder.if_then(failed, likely=False):
            inside.err_set_string("PyExc_TypeError", MISMATCH)
        builder.ret(failed)
        return read


def _size_of(row: Any) -> int:
    return int(row.size) if isinstance(row, types.Record) else int(as_dtype(row).itemsize)


def for_python(context: Any) -> Any:
    """Return the context in which what Python calls is made: its values are numba's own."""
    context = copy(context)
    context.data_model_manager = default_manager
    context.get_arg_packer = lambda kinds: ArgPacker(REFERENCES, kinds)
    context.get_python_api = lambda builder: _Door(context, builder)
    return context
