"""LLVM's instructions for a kernel: the common ones directly, all others by numba's own lowering.

Nine of ten instructions of a kernel are sums and comparisons of scalars, fields of records, rows of
arrays, constants and calls of other kernels. Numba looks each of them up among all that could be
meant, and writes it out as a text for its log; that was half the time of a new plan. Here each has
its instruction at hand, the same that numba chooses. Like `part_compiler` this leans on what numba
keeps to itself.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite.ir import Constant, IntType
from numba.core import cgutils, config, ir, types
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.typed_passes import NativeLowering

INT32 = IntType(32)
FIELDS = types.float64, types.int64, types.uint64  # that records have
# Constants of these types are never read: what they stand for is known by their type.
NAMES = types.Dispatcher, types.Function, types.Module, types.NumberClass, types.NamedTupleClass

_FLOAT = {
    operator.add: "fadd",
    operator.sub: "fsub",
    operator.mul: "fmul",
    operator.truediv: "fdiv",  # error_model numpy: by zero it is infinite
}
# `nsw`, as numba has it: counters do not reach 2^63.
_INTEGER = {operator.add: "add", operator.sub: "sub", operator.mul: "mul"}
_COMPARED = {
    operator.lt: "<",
    operator.le: "<=",
    operator.gt: ">",
    operator.ge: ">=",
    operator.eq: "==",
    operator.ne: "!=",
}
_constants: dict[tuple[Any, str], Any] = {}


class KernelLower(Lower):
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
        elif not (isinstance(inst, ir.SetAttr) and self._set_field(inst)):
            super().lower_inst(inst)

    def lower_assign(self, ty: Any, inst: Any) -> Any:
        """Return the value that is assigned."""
        value = inst.value
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

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """Return the value of an expression."""
        op = expr.op
        value = None
        if op == "binop":
            value = self._binary(resty, expr, expr.fn)
        elif op == "inplace_binop":
            value = self._binary(resty, expr, expr.immutable_fn)
        elif op == "getattr":
            value = self._field(resty, expr)
        elif op == "getitem":
            value = self._row(resty, expr)
        elif op == "cast" and self.typeof(expr.value.name) == resty:
            value = self.loadvar(expr.value.name)
        elif op == "call":
            value = self._call(resty, expr)
        return super().lower_expr(resty, expr) if value is None else value

    def _binary(self, resty: Any, expr: Any, function: Any) -> Any:
        left, right = self.typeof(expr.lhs.name), self.typeof(expr.rhs.name)
        if left == right == types.float64:
            named, floating = _FLOAT.get(function), True
        elif left == right == types.int64:
            named, floating = _INTEGER.get(function), False
        else:
            return None
        if named is not None and resty == left:
            operands = self.loadvar(expr.lhs.name), self.loadvar(expr.rhs.name)
            flags = () if floating else ("nsw",)
            return getattr(self.builder, named)(*operands, flags=flags)
        compared = _COMPARED.get(function)
        if compared is None or resty != types.boolean:
            return None
        operands = self.loadvar(expr.lhs.name), self.loadvar(expr.rhs.name)
        if not floating:
            return self.builder.icmp_signed(compared, *operands)
        # What is not a number differs from everything, and is neither less nor more.
        compare = self.builder.fcmp_unordered if compared == "!=" else self.builder.fcmp_ordered
        return compare(compared, *operands)

    def _pointer(self, record: Any, kind: Any, name: str) -> Any:
        """Return where a field is; None where numba must say."""
        field = kind.typeof(name)
        if field not in FIELDS or not kind.aligned:
            return None
        offset = Constant(INT32, kind.offset(name))
        at = self.builder.gep(record, (Constant(INT32, 0), offset), inbounds=True)
        return self.builder.bitcast(at, self.context.get_data_type(field).as_pointer())

    def _field(self, resty: Any, expr: Any) -> Any:
        kind = self.typeof(expr.value.name)
        if not isinstance(kind, types.Record) or kind.typeof(expr.attr) != resty:
            return None
        at = self._pointer(self.loadvar(expr.value.name), kind, expr.attr)
        return None if at is None else self.builder.load(at)

    def _set_field(self, inst: Any) -> bool:
        kind, value = self.typeof(inst.target.name), self.typeof(inst.value.name)
        if not isinstance(kind, types.Record) or value != kind.typeof(inst.attr):
            return False
        at = self._pointer(self.loadvar(inst.target.name), kind, inst.attr)
        if at is None:
            return False
        self.builder.store(self.loadvar(inst.value.name), at)
        return True

    def _row(self, resty: Any, expr: Any) -> Any:
        """Return a row of an array, a record or a number; a negative index counts from the end."""
        kind, index = self.typeof(expr.value.name), self.typeof(expr.index.name)
        simple = isinstance(kind, types.Array) and kind.ndim == 1 and kind.layout == "C"
        if not simple or index not in (types.int64, types.uint64) or not kind.aligned:
            return None
        if resty != kind.dtype or not isinstance(resty, (types.Record, *map(type, FIELDS))):
            return None
        if self.context.enable_boundscheck:
            return None
        builder, rows = self.builder, self.loadvar(expr.value.name)
        at = self.loadvar(expr.index.name)
        place = self.context.data_model_manager[kind].get_field_position
        if index == types.int64:
            count = builder.extract_value(rows, (place("shape"), 0))
            negative = builder.icmp_signed("<", at, Constant(at.type, 0))
            at = builder.select(negative, builder.add(at, count), at)
        row = builder.gep(builder.extract_value(rows, place("data")), (at,))
        return row if isinstance(resty, types.Record) else builder.load(row)

    def _call(self, resty: Any, expr: Any) -> Any:
        kind = self.typeof(expr.func.name)
        if isinstance(kind, types.Dispatcher):
            return self._call_kernel(resty, expr, kind.dispatcher)
        signature = self.fndesc.calltypes[expr]
        plain = not (expr.kws or expr.vararg) and len(expr.args) == 1
        if plain and isinstance(kind, types.Function) and kind.typing_key is bool:
            [value] = expr.args
            if self.typeof(value.name) == resty == types.boolean == signature.return_type:
                return self.loadvar(value.name)
        return None

    def _call_kernel(self, resty: Any, expr: Any, kernel: Any) -> Any:
        """Call a part; what numba calls is None for it.

        Where the part raises nothing, nothing is asked of its status.
        """
        signature = self.fndesc.calltypes[expr]
        linked = getattr(kernel, "linked", {}).get(tuple(signature.args))
        if linked is None or linked.part.raises or signature.return_type != resty:
            return None
        values = self.fold_call_args(kernel._type, signature, expr.args, expr.vararg, expr.kws)
        context, builder, called = self.context, self.builder, linked.called
        function = context.declare_function(self.module, called)
        kind = context.call_conv.get_return_type(called.restype).pointee
        returned = cgutils.alloca_once(builder, kind)
        raised = cgutils.alloca_once(builder, function.function_type.args[1].pointee)
        packed = context.call_conv._get_arg_packer(called.argtypes).as_arguments(builder, values)
        builder.call(function, [returned, raised, *packed])
        context.active_code_library.add_linking_library(linked.part)
        return context.get_returned_value(builder, resty, builder.load(returned))

    def storevar(self, value: Any, name: str, argidx: Any = None) -> None:
        """Keep a variable's value; nothing counts references to the one before."""
        if name in self._singly_assigned_vars:
            self._blk_local_varmap[name] = value
        else:
            self.builder.store(value, self.getvar(name))

    def alloca_lltype(self, name: str, lltype: Any, datamodel: Any = None) -> Any:
        """Make room for a variable."""
        return cgutils.alloca_once(self.builder, lltype, name=name, zfill=False)


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(NativeLowering):
    """Numba's lowering pass, with `KernelLower` where nothing is to be debugged or counted."""

    _name = "kernel_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower the kernel."""
        context, flags = state.targetctx, state.flags
        explained = context.enable_debuginfo or flags.debuginfo or config.DEBUG_JIT  # type: ignore[attr-defined]
        self._class = Lower if explained or context.enable_nrt else KernelLower
        return bool(super().run_pass(state))

    @property
    def lowering_class(self) -> Any:
        """Return the class that makes the instructions."""
        return self._class
