"""LLVM's text of a module as it is parsed again: common instructions written out directly.

llvmlite writes every instruction through three calls and keeps the text, which took half as long as
LLVM's passes over it. What is not common, or carries metadata, is written by llvmlite. Like
`part_compiler` this leans on what llvmlite keeps to itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from llvmlite.ir import Module, instructions


def _name(value: Any) -> str:
    """Return what a value is called by."""
    name = getattr(value, "_name", "")
    if not name or '"' in name or "\\" in name:  # constants have none
        return str(value.get_reference())
    return f'{value.name_prefix}"{name}"'


class _Writer:
    """The text of one module's instructions; each type is asked for its text once."""

    def __init__(self) -> None:
        self._types: dict[int, str] = {}  # by identity: values hold their types meanwhile

    def of_type(self, kind: Any) -> str:
        """Return a type's text."""
        found = self._types.get(id(kind))
        if found is None:
            found = self._types[id(kind)] = str(kind)
        return found

    def typed(self, value: Any) -> str:
        """Return a value with its type before it."""
        return f"{self.of_type(value.type)} {_name(value)}"

    def line(self, it: Any) -> str:
        """Return an instruction."""
        write = WRITTEN.get(type(it))
        return str(it) if write is None or it.metadata else write(self, it)

    def operation(self, it: Any) -> str:
        """Return an operation on one value, or two, of its own type."""
        name = " ".join([it.opname, *it.flags]) if it.flags else it.opname
        return f"{_name(it)} = {name} {self.of_type(it.type)} {', '.join(map(_name, it.operands))}"

    def room(self, it: Any) -> str:
        """Return room for a value."""
        count = "".join(f", {self.typed(each)}" for each in it.operands)
        kind, align = self.of_type(it.allocated_type), _aligned(it)
        return f"{_name(it)} = alloca {kind}{count}{align}"

    def load(self, it: Any) -> str:
        """Return a load."""
        kind, at = self.of_type(it.type), self.typed(it.operands[0])
        return f"{_name(it)} = load {kind}, {at}{_aligned(it)}"

    def store(self, it: Any) -> str:
        """Return a store."""
        value, at = it.operands
        return f"store {self.typed(value)}, {self.typed(at)}{_aligned(it)}"

    def place(self, it: Any) -> str:
        """Return an address worked out."""
        name = "getelementptr inbounds" if it.inbounds else "getelementptr"
        indices = ", ".join(map(self.typed, it.indices))
        kind, at = self.of_type(it.source_etype), self.typed(it.pointer)
        return f"{_name(it)} = {name} {kind}, {at}, {indices}"

    def extracted(self, it: Any) -> str:
        """Return what is taken from a structure."""
        path = ", ".join(map(str, it.indices))
        return f"{_name(it)} = extractvalue {self.typed(it.aggregate)}, {path}"

    def inserted(self, it: Any) -> str:
        """Return a structure with a new item."""
        path, whole = ", ".join(map(str, it.indices)), self.typed(it.aggregate)
        return f"{_name(it)} = insertvalue {whole}, {self.typed(it.value)}, {path}"

    def compared(self, it: Any) -> str:
        """Return a comparison."""
        left, right = it.operands
        name = " ".join([it.opname, *it.flags, it.op])
        return f"{_name(it)} = {name} {self.typed(left)}, {_name(right)}"

    def selected(self, it: Any) -> str:
        """Return a choice of two values."""
        values = ", ".join(map(self.typed, it.operands))
        return f"{_name(it)} = select {' '.join(it.flags)} {values}"

    def cast(self, it: Any) -> str:
        """Return a value of another type."""
        value = self.typed(it.operands[0])
        return f"{_name(it)} = {it.opname} {value} to {self.of_type(it.type)}"

    def end(self, it: Any) -> str:
        """Return a jump, a branch or a return."""
        return f"{it.opname} {', '.join(map(self.typed, it.operands))}"


def _aligned(it: Any) -> str:
    return "" if it.align is None else f", align {it.align}"


WRITTEN: Final[dict[type, Callable[[_Writer, Any], str]]] = {
    instructions.Instruction: _Writer.operation,
    instructions.AllocaInstr: _Writer.room,
    instructions.LoadInstr: _Writer.load,
    instructions.StoreInstr: _Writer.store,
    instructions.GEPInstr: _Writer.place,
    instructions.ExtractValue: _Writer.extracted,
    instructions.InsertValue: _Writer.inserted,
    instructions.ICMPInstr: _Writer.compared,
    instructions.FCMPInstr: _Writer.compared,
    instructions.CastInstr: _Writer.cast,
    instructions.SelectInstr: _Writer.selected,
    instructions.Branch: _Writer.end,
    instructions.ConditionalBranch: _Writer.end,
    instructions.Ret: _Writer.end,
}


def text_of(module: Module) -> str:
    """Return the text of a module, which is parsed to what `str(module)` is parsed to."""
    lines = [
        f'; ModuleID = "{module.name}"',
        f'target triple = "{module.triple}"',
        f'target datalayout = "{module.data_layout}"',
        *(kind.get_declaration() for kind in module.get_identified_types().values()),
    ]
    writer = _Writer()
    for each in module.globals.values():
        if not getattr(each, "blocks", ()):
            lines.append(str(each))
            continue
        prototype: list[str] = []
        each.descr_prototype(prototype)
        lines += ["".join(prototype), "{"]
        for block in each.blocks:
            lines.append(f"{block._format_name()}:")
            lines += map(writer.line, block.instructions)
        lines.append("}")
    return "\n".join([*lines, *module._get_metadata_lines(), ""])
