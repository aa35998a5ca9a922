"""LLVM's instructions for the common expressions of kernels, the same that numba chooses.

Each has its instruction at hand; an expression that is none of them, or whose types are others, is
left to numba, which looks it up among all that could be meant. Like `part_compiler` this leans on
what numba keeps to itself.
"""

from __future__ import annotations

import operator
from typing import Any, Final

from llvmlite.ir import Constant, IntType
from numba.core import types
from numba.core.datamodel.registry import default_manager
from numba.core.lowering import Lower

from . import field_places
from .extremes import EXTREMES, extreme, extreme_of
from .field_places import FIELDS, composed_name
from .light_values import pointing_to, slot
from .matrix_cells import INDICES, WORD, cell_at, is_cell
from .memory_references import are_rows, is_memory, item
from .range_loops import ITERATOR, RANGE, begun, limits, next_of

INT32 = IntType(32)
HANDED_ON = "call", "build_tuple"  # expressions that leave records and arrays as they are

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


class ShortExpressions(Lower):
    """Numba's lowering with a short way for common expressions."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._steps: dict[str, int] = {}  # of the variables that are ranges, where they are known

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """Return the value of an expression."""
        short = SHORT.get(expr.op)
        value = short(self, resty, expr) if short else None
        if value is None and expr.op not in HANDED_ON:
            self.refuse_records(expr)
        return super().lower_expr(resty, expr) if value is None else value

    def refuse_records(self, what: Any) -> None:
        """Refuse what numba would compile with the places that fields have in one plan."""
        for variable in what.list_vars():
            if self.composed(field_places.record_of(self.typeof(variable.name))):
                name = self.func_ir.func_id.func_qualname
                raise NotImplementedError(f"kernel {name}: {what} of a record that plans compose")

    def plain(self, name: str) -> Any:
        """Return the type of a variable; that of a constant is the one its values have."""
        return types.unliteral(self.typeof(name))

    def binary(self, resty: Any, expr: Any, function: Any) -> Any:
        """Return a sum, a difference, a product, a quotient or a comparison of numbers."""
        left, right = self.plain(expr.lhs.name), self.plain(expr.rhs.name)
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

    def composed(self, kind: Any) -> str:
        """Return the name of a record whose fields lie where the whole kernel says, or ""."""
        return "" if self.context.enable_boundscheck else composed_name(kind)

    def pointer(self, record: Any, kind: Any, name: str) -> Any:
        """Return where a field of a record is; None where numba must say."""
        field = kind.typeof(name)
        if field not in FIELDS or not kind.aligned:
            return None
        if composed := self.composed(kind):
            at = field_places.pointer(self.builder, record, composed, name)
        else:
            offset = Constant(INT32, kind.offset(name))
            at = self.builder.gep(record, (Constant(INT32, 0), offset), inbounds=True)
        return pointing_to(self.builder, at, self.context.get_data_type(field))

    def attribute(self, resty: Any, expr: Any) -> Any:
        """Return a field of a record or a named tuple, or the shape of an array."""
        kind: Any = self.typeof(expr.value.name)
        if isinstance(kind, types.Record):
            return self._field(resty, expr.value.name, kind, expr.attr)
        if isinstance(kind, types.BaseNamedTuple):
            fields: Any = getattr(kind, "fields", ())
            return self._part_of(resty, expr, kind, fields.index(expr.attr))
        if isinstance(kind, types.Array) and expr.attr == "shape":
            place = default_manager[kind].get_field_position("shape")
            return self.builder.extract_value(self.loadvar(expr.value.name), place)
        return None

    def _field(self, resty: Any, record: str, kind: Any, name: str) -> Any:
        if kind.typeof(name) != resty:
            return None
        at = self.pointer(self.loadvar(record), kind, name)
        return None if at is None else self.builder.load(at)

    def static_item(self, resty: Any, expr: Any) -> Any:
        """Return an item of a tuple, a field of a record by its text, or a row by a constant."""
        kind, index = self.typeof(expr.value.name), expr.index
        if isinstance(kind, types.Record) and isinstance(index, str):
            return self._field(resty, expr.value.name, kind, index)
        if isinstance(index, int) and self.has_row(resty, kind):
            at = Constant(WORD, index)
            return self._value(resty, self.row_at(expr.value.name, at, signed=index < 0))
        if not isinstance(kind, types.BaseTuple) or not isinstance(index, int):
            return None
        return self._part_of(resty, expr, kind, index % len(kind))

    def _part_of(self, resty: Any, expr: Any, kind: Any, index: int) -> Any:
        if kind[index] != resty:
            return None
        value = self.loadvar(expr.value.name)
        if is_memory(kind):
            return item(self.builder, kind, value, index)
        return self.builder.extract_value(value, index)

    def row(self, resty: Any, expr: Any) -> Any:
        """Return a row of an array, a record or a number; a negative index counts from the end."""
        kind, index = self.typeof(expr.value.name), self.plain(expr.index.name)
        if self.has_cell(resty, kind, index):
            return self.builder.load(self.cell_of(expr.value.name, expr.index.name))
        if index not in INDICES or not self.has_row(resty, kind):
            return None
        at = self.loadvar(expr.index.name)
        row = self.row_at(expr.value.name, at, signed=index == types.int64)
        return self._value(resty, row)

    def _value(self, kind: Any, row: Any) -> Any:
        return row if isinstance(kind, types.Record) else self.builder.load(row)

    def has_row(self, row: Any, kind: Any) -> bool:
        """Whether a type is an array of such rows that are reached by their number alone."""
        if not are_rows(kind) or not kind.aligned or row != kind.dtype:
            return False
        plain = isinstance(row, (types.Record, *map(type, FIELDS)))
        return plain and not self.context.enable_boundscheck

    def has_cell(self, number: Any, kind: Any, index: Any) -> bool:
        """Whether a type is an array of such numbers that an index reaches one by one."""
        if self.context.enable_boundscheck or not is_cell(kind, index):
            return False
        return bool(kind.dtype == number)

    def cell_of(self, array: str, index: str) -> Any:
        """Return where the cell of an array is that a variable names."""
        kind, along = self.typeof(array), self.typeof(index)
        values, models = (self.loadvar(array), self.loadvar(index)), self.context.data_model_manager
        return cell_at(self.builder, models, kind, *values, along)

    def row_at(self, name: str, at: Any, *, signed: bool) -> Any:
        """Return where a row of an array is; a signed index may count from the end."""
        kind: Any = self.typeof(name)
        builder, rows = self.builder, self.loadvar(name)
        place = self.context.data_model_manager[kind].get_field_position
        if signed:
            count = builder.extract_value(rows, (place("shape"), 0))
            negative = builder.icmp_signed("<", at, Constant(at.type, 0))
            at = builder.select(negative, builder.add(at, count), at)
        data = builder.extract_value(rows, place("data"))
        if composed := self.composed(kind.dtype):
            return field_places.row(builder, data, composed, at)
        return builder.gep(data, (at,))

    def called(self, resty: Any, expr: Any) -> Any:
        """Return what a part returns, a range, or whether a number is not zero."""
        kind = self.typeof(expr.func.name)
        if isinstance(kind, types.Dispatcher):
            return self._of_kernel(resty, expr, kind.dispatcher)
        if not isinstance(kind, types.Function) or expr.kws or expr.vararg:
            return None
        if kind.typing_key is bool and len(expr.args) == 1:
            return self._truth(resty, expr.args[0].name)
        if kind.typing_key is range and resty == RANGE:
            return self._range(expr)
        if kind.typing_key in EXTREMES:
            return self._extreme(resty, kind.typing_key, expr)
        return None

    def _extreme(self, resty: Any, function: Any, expr: Any) -> Any:
        names = [each.name for each in expr.args]
        if extreme_of(function, [self.typeof(name) for name in names]) is None:
            return None
        return extreme(self.builder, function, resty, [self.loadvar(name) for name in names])

    def _truth(self, resty: Any, name: str) -> Any:
        kind = self.plain(name)
        if resty != types.boolean or kind not in (types.boolean, types.int64, types.float64):
            return None
        value = self.loadvar(name)
        if kind == types.boolean:
            return value
        zero = Constant(value.type, 0)
        if kind == types.int64:
            return self.builder.icmp_signed("!=", value, zero)
        return self.builder.fcmp_unordered("!=", value, zero)  # what is no number is not zero

    def note_step(self, name: str, expr: Any) -> None:
        """Note the step of the range that is assigned to a variable, where it is known."""
        if expr.op == "call":
            self._steps[name] = self._step(expr)

    def _step(self, expr: Any) -> int:
        """Return the step of a call of `range`; 0 where numba must make the range."""
        names = [each.name for each in expr.args]
        step = 1 if len(names) < 3 else getattr(self.typeof(names[2]), "literal_value", 0)
        return step if all(self.plain(name) == types.int64 for name in names) else 0

    def _range(self, expr: Any) -> Any:
        step = self._step(expr)
        if not step:
            return None
        ends = [self.loadvar(each.name) for each in expr.args[:2]]
        start = ends[0] if len(ends) == 2 else Constant(ends[0].type, 0)
        return limits(self.builder, start, ends[-1], step)

    def iterator(self, resty: Any, expr: Any) -> Any:
        """Return the iterator over a range with a known step."""
        step = self._steps.get(expr.value.name, 0)
        if not step or resty != ITERATOR:
            return None
        return begun(self.builder, self.loadvar(expr.value.name), step)

    def following(self, resty: Any, expr: Any) -> Any:
        """Return the next number of a range."""
        if self.typeof(expr.value.name) != ITERATOR:
            return None
        return next_of(self.builder, self.loadvar(expr.value.name), resty)

    def first(self, resty: Any, expr: Any) -> Any:
        """Return the first of a pair."""
        return self.builder.extract_value(self.loadvar(expr.value.name), 0)

    def second(self, resty: Any, expr: Any) -> Any:
        """Return the second of a pair."""
        return self.builder.extract_value(self.loadvar(expr.value.name), 1)

    def same(self, resty: Any, expr: Any) -> Any:
        """Return a value that is of the type it is cast to."""
        value = expr.value.name
        return self.loadvar(value) if self.typeof(value) == resty else None

    def _of_kernel(self, resty: Any, expr: Any, kernel: Any) -> Any:
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
        returned = slot(builder, kind)
        raised = slot(builder, function.function_type.args[1].pointee)
        packed = context.call_conv._get_arg_packer(called.argtypes).as_arguments(builder, values)
        builder.call(function, [returned, raised, *packed])
        context.active_code_library.add_linking_library(linked.part)
        return context.get_returned_value(builder, resty, builder.load(returned))


SHORT: Final = {
    "binop": lambda lower, resty, expr: lower.binary(resty, expr, expr.fn),
    "inplace_binop": lambda lower, resty, expr: lower.binary(resty, expr, expr.immutable_fn),
    "getattr": ShortExpressions.attribute,
    "getitem": ShortExpressions.row,
    "static_getitem": ShortExpressions.static_item,
    "cast": ShortExpressions.same,
    "call": ShortExpressions.called,
    "getiter": ShortExpressions.iterator,
    "iternext": ShortExpressions.following,
    "pair_first": ShortExpressions.first,
    "pair_second": ShortExpressions.second,
}
