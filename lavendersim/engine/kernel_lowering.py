"""LLVM's instructions for a kernel: the common ones directly, all others by numba's own lowering.

Nine of ten instructions of a kernel are sums and comparisons of scalars, fields of records, rows of
arrays, constants and calls of other kernels. Numba looks each of them up among all that could be
meant, and writes it out as a text for its log; that was half the time of a new plan. Here each has
its instruction at hand, the same that numba chooses. Like `part_compiler` this leans on what numba
keeps to itself.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant
from numba.core import cgutils, config, ir, types
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.typed_passes import NativeLowering

from . import field_places
from .compile_options import OPTIONS
from .field_places import FIELDS
from .kernel_expressions import ShortExpressions
from .matrix_cells import INDICES, WORD
from .python_door import for_python
from .range_loops import RANGE
from .single_assignment import local_variables

# Constants of these types are never read: what they stand for is known by their type.
NAMES = types.Dispatcher, types.Function, types.Module, types.NumberClass, types.NamedTupleClass

_constants: dict[tuple[Any, str], Any] = {}


class KernelLower(ShortExpressions):
    """Numba's lowering with a short way for what kernels are made of."""

    def lower_block(self, block: Any) -> None:
        """Lower a block; numba would note each instruction's text for an error."""
        self.pre_block(block)
        for inst in block.body:
            self.loc = inst.loc
            self.lower_inst(inst)
        self.post_block(block)

    def lower_inst(self, inst: Any) -> None:
        """Lower an instruction."""
        if isinstance(inst, ir.Assign):
            target = inst.target.name
            self.storevar(self.lower_assign(self.typeof(target), inst), target)
        elif isinstance(inst, ir.Jump):
            self.builder.branch(self.blkmap[inst.target])
        elif isinstance(inst, ir.Branch) and self.typeof(inst.cond.name) == types.boolean:
            ways = self.blkmap[inst.truebr], self.blkmap[inst.falsebr]
            self.builder.cbranch(self.loadvar(inst.cond.name), *ways)
        elif not self._stored(inst):
            if not isinstance(inst, ir.Return):
                self.refuse_records(inst)
            super().lower_inst(inst)

    def _stored(self, inst: Any) -> bool:
        """Store what an instruction stores: a field of a record, a number, or a whole record."""
        if isinstance(inst, ir.SetAttr):
            return self._set_field(inst, inst.attr)
        if isinstance(inst, ir.StaticSetItem) and isinstance(inst.index, str):
            return self._set_field(inst, inst.index)
        if isinstance(inst, ir.StaticSetItem) and isinstance(inst.index, int):
            return self._set_row(inst, Constant(WORD, inst.index), signed=inst.index < 0)
        if isinstance(inst, ir.SetItem):
            index, number = self.plain(inst.index.name), self.plain(inst.value.name)
            if self.has_cell(number, self.typeof(inst.target.name), index):
                cell = self.cell_of(inst.target.name, inst.index.name)
                self.builder.store(self.loadvar(inst.value.name), cell)
                return True
            at = self.loadvar(inst.index.name) if index in INDICES else None
            return at is not None and self._set_row(inst, at, signed=index == types.int64)
        return False

    def lower_assign(self, ty: Any, inst: Any) -> Any:
        """Return the value that is assigned."""
        value = inst.value
        if ty == RANGE and isinstance(value, ir.Expr):
            self.note_step(inst.target.name, value)
        if isinstance(value, ir.Var):
            if self.typeof(value.name) == ty:
                return self.loadvar(value.name)
        elif isinstance(value, ir.Expr):
            return self.lower_expr(ty, value)
        elif isinstance(value, ir.Const | ir.Global | ir.FreeVar):
            if isinstance(ty, NAMES):
                return self.context.get_dummy_value()
            if isinstance(ty, types.Number | types.Boolean):
                return self._scalar(ty, value.value)
        return super().lower_assign(ty, inst)

    def _scalar(self, ty: Any, value: Any) -> Any:
        key = ty, repr(value)  # 0.0 and -0.0 are equal
        constant = _constants.get(key)
        if constant is None:
            constant = self.context.get_constant_generic(self.builder, ty, value)
            _constants[key] = constant
        return constant

    def _set_field(self, inst: Any, name: str) -> bool:
        kind, given = self.typeof(inst.target.name), self.plain(inst.value.name)
        if not isinstance(kind, types.Record):
            return False
        field = kind.typeof(name)
        at = self.pointer(self.loadvar(inst.target.name), kind, name)
        if at is None:
            return False
        value = self.loadvar(inst.value.name)
        if given != field:
            value = self.context.cast(self.builder, value, given, field)
        self.builder.store(value, at)
        return True

    def _set_row(self, inst: Any, at: Any, *, signed: bool) -> bool:
        kind, value = self.typeof(inst.target.name), self.plain(inst.value.name)
        if value in FIELDS and self.has_row(value, kind):
            row = self.row_at(inst.target.name, at, signed=signed)
            self.builder.store(self.loadvar(inst.value.name), row)
            return True
        composed = self.composed(value)
        if not composed or kind.dtype != value:
            return False
        row = self.row_at(inst.target.name, at, signed=signed)
        field_places.copy(self.builder, composed, row, self.loadvar(inst.value.name))
        return True

    def _find_singly_assigned_variable(self) -> None:
        self._singly_assigned_vars = local_variables(self.func_ir.blocks)
        self._blk_local_varmap = {}

    def storevar(self, value: Any, name: str, argidx: Any = None) -> None:
        """Keep a variable's value; nothing counts references to the one before."""
        if name in self._singly_assigned_vars:
            self._blk_local_varmap[name] = value
        else:
            self.builder.store(value, self.getvar(name))

    def create_cpython_wrapper(self, release_gil: Any = False) -> None:
        """Make what Python calls."""
        context = for_python(self.context)
        arguments = self.library, self.fndesc, self.env, self.call_helper
        context.create_cpython_wrapper(*arguments, release_gil=release_gil)

    def alloca_lltype(self, name: str, lltype: Any, datamodel: Any = None) -> Any:
        """Make room for a variable."""
        return cgutils.alloca_once(self.builder, lltype, name=name, zfill=False)


def is_direct(context: Any, flags: Any) -> bool:
    """Whether nothing is to be debugged or counted: then `KernelLower` makes the instructions."""
    explained = context.enable_debuginfo or flags.debuginfo or config.DEBUG_JIT  # type: ignore[attr-defined]
    return not (explained or context.enable_nrt)


def names_places() -> bool:
    """Whether parts of this process name the places of fields (`field_places`)."""
    return are_direct() and not config.BOUNDSCHECK  # type: ignore[attr-defined]


def are_direct() -> bool:
    """Whether `is_direct` of the kernels of this process, before any was compiled or loaded."""
    explained = config.DEBUG_JIT or config.DEBUGINFO_DEFAULT  # type: ignore[attr-defined]
    return OPTIONS.get("_nrt") is False and not explained


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(NativeLowering):
    """Numba's lowering pass, with `KernelLower` where nothing is to be debugged or counted."""

    _name = "kernel_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower the kernel."""
        context, flags = state.targetctx, state.flags
        self._class = KernelLower if is_direct(context, flags) else Lower
        return bool(super().run_pass(state))

    @property
    def lowering_class(self) -> Any:
        """Return the class that makes the instructions."""
        return self._class
