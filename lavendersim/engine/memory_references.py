"""How kernels hand the engine's memory to each other: by where it lies, not array by array.

    workspace.collision.manifold.points    pointer -> within it -> within it -> data, length

A named tuple of arrays, and of such tuples, is made by Python and never changes while kernels run.
Numba would take it apart into some three hundred numbers for each call, and put it together again
in each kernel that is called: half of all instructions of a new plan, and most of their text. Like
`part_compiler` this leans on what numba keeps to itself.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant, IntType, Undefined
from numba.core import types
from numba.core.datamodel.manager import DataModelManager
from numba.core.datamodel.models import ArrayModel, PrimitiveModel
from numba.core.datamodel.registry import default_manager

from .field_places import composed_name
from .light_values import pointing_to

BYTES = IntType(8).as_pointer()
_size: Any = types.intp
WORD = IntType(_size.bitwidth)  # all that numba's value of an array consists of


def is_memory(kind: Any) -> bool:
    """Whether a type is a named tuple of arrays and of such tuples alone, and has an item.

    A tuple with a number in it is a value, which kernels make anew.
    """
    return isinstance(kind, types.BaseNamedTuple) and len(kind) > 0 and _holds_arrays(kind)


def _holds_arrays(kind: Any) -> bool:
    items: Any = kind
    if isinstance(kind, types.BaseTuple):
        return all(map(_holds_arrays, items))
    return isinstance(kind, types.Array)


class MemoryModel(PrimitiveModel):
    """Memory as kernels hold it: where it lies, in the layout of numba's own value."""

    def __init__(self, models: Any, kind: Any) -> None:
        super().__init__(models, kind, BYTES)


class RowsModel(ArrayModel):
    """Rows side by side, as kernels hand them to each other: where they begin, how many."""

    def get_argument_type(self) -> Any:
        """Return the types of both."""
        return self._models[self.get_field_position("data")].get_argument_type(), WORD

    def as_argument(self, builder: Any, value: Any) -> Any:
        """Return both."""
        count = builder.extract_value(value, (self.get_field_position("shape"), 0))
        return builder.extract_value(value, self.get_field_position("data")), count

    def from_argument(self, builder: Any, value: Any) -> Any:
        """Return the array."""
        return self.array(builder, *value)

    def array(self, builder: Any, data: Any, count: Any) -> Any:
        """Return the array that begins at `data`; all else of it is known."""
        known = {"meminfo": None, "parent": None, **_sizes(self._fe_type.dtype)}
        whole = self.get_value_type()
        fields = zip(self._fields, whole.elements, strict=True)
        array = Constant(whole, [Constant(of, known.get(name, Undefined)) for name, of in fields])
        for name, path in ("nitems", ()), ("shape", (0,)):
            place = self.get_field_position(name), *path
            array = builder.insert_value(array, count, place)
        return builder.insert_value(array, data, self.get_field_position("data"))


def _sizes(row: Any) -> dict[str, Any]:
    if composed_name(row):
        return {}  # those of a plan; nobody asks for them (`KernelLower.refuse_records`)
    size = row.size if isinstance(row, types.Record) else row.bitwidth // 8
    return {"itemsize": size, "strides": [size]}


def are_rows(kind: Any) -> bool:
    """Whether a type is an array of records or numbers side by side."""
    simple = isinstance(kind, types.Array) and kind.ndim == 1 and kind.layout == "C"
    return simple and isinstance(kind.dtype, types.Record | types.Float | types.Integer)


class _References(DataModelManager):
    """Numba's models of types, with memory by reference."""

    def lookup(self, fetype: Any) -> Any:
        """Return the model of a type."""
        known = self._cache.get(fetype)
        if known is None:
            own = MemoryModel if is_memory(fetype) else RowsModel if are_rows(fetype) else None
            known = own(self, fetype) if own else super().lookup(fetype)
            self._cache[fetype] = known
        return known


REFERENCES = _References(default_manager._handlers)


def item(builder: Any, kind: Any, memory: Any, index: int) -> Any:
    """Return one item of memory of a type: an array, or where the memory within lies."""
    found, begins = kind[index], sum(words(each) for each in list(kind)[:index])
    if is_memory(found):
        return moved(builder, memory, begins)
    model = REFERENCES[found]
    if not are_rows(found):
        return _constant(builder, memory, begins, model.get_value_type())
    first, count = (begins + model.get_field_position(name) for name in ("data", "shape"))
    data = _constant(builder, memory, first, model.get_argument_type()[0])
    return model.array(builder, data, _constant(builder, memory, count, WORD))


def words(kind: Any) -> int:
    """Return how long memory is, in numbers and pointers, which are of one size."""
    items: Any = kind
    if isinstance(kind, types.BaseTuple):
        return sum(words(each) for each in items)
    return len(default_manager[kind]._fields) + 2 * (int(kind.ndim) - 1)


def moved(builder: Any, memory: Any, count: int) -> Any:
    """Return the place so many numbers and pointers behind one of memory."""
    offset = count * WORD.width // 8
    return builder.gep(memory, (Constant(WORD, offset),), inbounds=True) if count else memory


def _constant(builder: Any, memory: Any, words: int, kind: Any) -> Any:
    """Return what lies at a place that no kernel writes to: it can be read when it is needed."""
    at = pointing_to(builder, moved(builder, memory, words), kind)
    value = builder.load(at)
    value.set_metadata("invariant.load", builder.module.add_metadata([]))
    return value
