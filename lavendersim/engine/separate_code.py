"""Code of separate parts: optimised once, kept as objects, loaded beside the kernels that call it.

    parts of a whole kernel      respond   refresh   [locate]   [solve]   turn ...
    optimised with the kernel    respond   refresh                        turn ...
    each by itself, with all     locate: turn ...
    that it calls                solve: factorise ...

LLVM's time goes with the code that it reads, and most of that is the same in many plans. What is
large and called a few times a step loses nothing by a call: such a part is optimised with what it
calls, without its callers, and plans that have it share the outcome. Whether a part is separate is
said where it is composed (`compile.separate`), never by what happens to be kept: the same plan has
the same code in a cache of any state.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from llvmlite.binding import (
    Linkage,
    ObjectFileRef,
    create_new_module_pass_manager,
    parse_assembly,
    parse_bitcode,
)

from .field_places import PREFIX, definitions, digest
from .identity import IN_VECTORS, SELDOM
from .kernel_parts import STORE, KernelPart, merged_into, separate_in, with_called
from .optimisation import SELDOM_SHORT, SHORT, optimise

# Behind the symbol of a part, with digits of the places of fields: the symbol of its object.
ENTRY = ".separate."
NAME = re.compile(r'%(?:[-\w.$]+|"[^"]*")')  # of a value in LLVM's text
_loaded: set[str] = set()  # symbols of separate parts that this process can call


def merge(
    module: Any, parts: Iterable[KernelPart], records: Mapping[str, Any], codegen: Any
) -> set[str]:
    """Link parts, directly called or not, once each into a module; return their symbols.

    Of a separate part, which is called from elsewhere, only what calls it is linked.
    records: that the plan composed, by name; they give the places of fields.
    """
    symbols = set()
    for part in merged_into(parts):
        symbols.add(part.symbol)
        if part.separate:
            text = _separate(part, records, codegen).adapter(part.symbol, inward=False)
            linked = parse_assembly(text)
        else:
            linked = parse_bitcode(part.bitcode)
        module.link_in(linked)
    places = [each.name for each in module.global_variables if each.name.startswith(PREFIX)]
    module.link_in(parse_assembly(definitions(places, records)))
    for place in module.global_variables:
        if place.name.startswith(PREFIX):
            place.linkage = Linkage.internal
    return symbols


class SeparateCode(NamedTuple):
    """A separate part as an object, which is called by those of its arguments that it reads."""

    entry: str  # its symbol
    types: tuple[str, ...]  # LLVM's, of all arguments
    read: tuple[int, ...]  # places of those that the object takes
    code: bytes

    def adapter(self, symbol: str, inward: bool) -> str:
        """Return the part's own function, which calls the object; inward: the other way round.

        Of some three hundred arguments, numbers of all arrays of the engine, a part reads some
        thirty: what is called inside of a module LLVM hands over no others, and so does this.
        """
        values = [f"{kind} %a{place}" for place, kind in enumerate(self.types)]
        handed = ", ".join(values[place] for place in self.read)
        if inward:
            given = [
                value if place in self.read else f"{kind} poison"
                for place, (kind, value) in enumerate(zip(self.types, values, strict=True))
            ]
            outer, inner = (handed, self.entry), (", ".join(given), symbol)
            types = self.types
        else:
            outer, inner = (", ".join(values), symbol), (handed, self.entry)
            types = tuple(self.types[place] for place in self.read)
        return (
            f'declare i32 @"{inner[1]}"({", ".join(types)})\n'
            f'define i32 @"{outer[1]}"({outer[0]}) alwaysinline {{\n'
            f'  %r = call i32 @"{inner[1]}"({inner[0]})\n  ret i32 %r\n}}\n'
        )


def _argument_names(function: Any) -> list[str]:
    """Return the names of a function's arguments as its text has them."""
    return [NAME.findall(str(argument))[-1] for argument in function.arguments]


def _compiled(
    part: KernelPart, entry: str, records: Mapping[str, Any], codegen: Any
) -> SeparateCode:
    """Return the code of a part with all that it calls, but for separate parts."""
    module = parse_bitcode(part.bitcode)
    module.name, module.data_layout = part.symbol, codegen._data_layout
    merged = merge(module, part.called, records, codegen)
    short = SELDOM_SHORT if part.separate == SELDOM else SHORT
    vectors = part.separate == IN_VECTORS
    optimise(module, merged - {part.symbol}, codegen, short=short, vectors=vectors)
    function = module.get_function(part.symbol)
    names = _argument_names(function)
    body = str(function).split("{", 1)[1]
    found = set(NAME.findall(body))
    types = tuple(str(argument.type) for argument in function.arguments)
    read = tuple(place for place, name in enumerate(names) if name in found)
    made = SeparateCode(entry, types, read, b"")
    module.link_in(parse_assembly(made.adapter(part.symbol, inward=True)))
    function = module.get_function(part.symbol)
    function.linkage = Linkage.internal
    function.add_function_attribute("alwaysinline")
    passes = create_new_module_pass_manager()
    passes.add_always_inliner_pass()
    passes.add_global_dead_code_eliminate_pass()
    passes.run(module, codegen._pass_builder())
    module.verify()
    return made._replace(code=codegen._tm.emit_object(module))


def _separate(part: KernelPart, records: Mapping[str, Any], codegen: Any) -> SeparateCode:
    """Return the code of a separate part, optimised for the places of fields that it touches."""
    places = digest({place for each in with_called([part]) for place in each.places}, records)
    key = f"{part.key}-{places}"
    found: SeparateCode | None = STORE.code(key)
    if found is None:
        found = _compiled(part, f"{part.symbol}{ENTRY}{places}", records, codegen)
        STORE.keep_code(key, found)
    return found


def separate_code(
    parts: Iterable[KernelPart], records: Mapping[str, Any], codegen: Any
) -> dict[str, bytes]:
    """Return the object code of every separate part that parts call, by symbol; load it, too."""
    found = [_separate(part, records, codegen) for part in separate_in(parts)]
    objects = {each.entry: each.code for each in found}
    load(objects, codegen)
    return objects


def load(objects: dict[str, bytes], codegen: Any) -> None:
    """Let kernels of this process call separate parts; what has one symbol is one code."""
    for symbol, code in objects.items():
        if symbol not in _loaded:
            _loaded.add(symbol)
            codegen._engine._ee.add_object_file(ObjectFileRef.from_data(code))
