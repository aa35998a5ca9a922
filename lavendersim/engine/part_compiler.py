"""Numba's compiler for kernels: parts compiled once, linked and optimised in whole kernels.

The one place that leans on what numba keeps to itself. Where another numba does not have it, this
file cannot be imported, and `compile` takes plain `njit`: slower to compile, with the same bits.
"""

from __future__ import annotations

import itertools
from copy import copy
from functools import partial
from typing import Any, NamedTuple

from llvmlite import ir
from llvmlite.binding import (
    Linkage,
    create_new_function_pass_manager,
    llvm_version_info,
    parse_assembly,
)
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, DefaultPassBuilder
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.funcdesc import ExternalFunctionDescriptor, default_mangler
from numba.core.itanium_mangler import mangle
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.typed_passes import NativeLowering
from numba.core.typing.templates import make_concrete_template, signature

from lavendersim.garbage import collect_recent

from .compiler_shortcuts import function_types_of, nested, packer_of, shortened, without_algebra
from .field_places import composed_in, places_in
from .kernel_lowering import KernelLowering, is_direct, names_places
from .kernel_parts import STORE, KernelPart, key_of, symbol_of
from .kernel_typing import quick
from .memory_references import REFERENCES, are_rows
from .module_text import text_of
from .optimisation import optimise
from .separate_code import merge, separate_code
from .single_assignment import canonical

if llvm_version_info < (17, 0, 0):
    raise ImportError("pointers have types: a part serves one layout of records only")

_objects = itertools.count()
_kinds: set[bool] = set()  # of kernels compiled in this process: whether they are direct


class _Linking(JITCodeLibrary):
    """Code that calls parts: which ones is noted, and left to the whole kernel to link."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.parts: list[KernelPart] = []

    def add_linking_library(self, library: Any) -> None:
        """Note a part; link all else, as numba does."""
        if not isinstance(library, KernelPart):
            super().add_linking_library(library)
        elif library not in self.parts:
            self.parts.append(library)


def _is_success(returns: Any) -> bool:
    [status] = returns.operands
    return isinstance(status, ir.Constant) and status.constant == 0


# What makes a part's bitcode a third as long, for a tenth of the time that the whole takes.
SHORTENING = "add_sroa_pass", "add_instruction_combine_pass", "add_simplify_cfg_pass"


class PartCode(_Linking):
    """Code of a kernel that other kernels call: optimised in each whole kernel it is linked into.

    Numba would optimise and assemble every kernel by itself as well, with all that it calls. None
    of that is ever run, and it doubles the time an engine takes to compile.
    """

    def add_ir_module(self, ir_module: ir.Module) -> None:
        """Take the one module that a part is, and whether it may return anything but success."""
        self.raises = any(
            block.terminator.opname == "ret" and not _is_success(block.terminator)
            for function in ir_module.functions
            for block in function.blocks
        )
        self.places = places_in(ir_module)
        module = parse_assembly(text_of(ir_module))
        module.name, module.data_layout = ir_module.name, self._codegen._data_layout
        passes = create_new_function_pass_manager()
        for add in SHORTENING:
            getattr(passes, add)()
        builder = self._codegen._pass_builder()
        for function in module.functions:
            if not function.is_declaration:
                passes.run(function, builder)
        self._final_module = module

    def part(self, symbol: str, returns: Any, key: str, separate: int) -> KernelPart:
        """Return the part; of its symbols other code sees only its own."""
        module = self._final_module
        for library in self._linking_libraries:  # of numba's own functions
            module.link_in(library._get_module_for_linking(), preserve=True)
        module.verify()
        for function in module.functions:
            if not function.is_declaration and function.name != symbol:
                function.linkage = Linkage.internal
        bitcode = module.as_bitcode()
        called = tuple(self.parts)
        places = self.places
        return KernelPart(
            symbol, returns, bitcode, called, key, self.raises, places=places, separate=separate
        )


class KernelObject(_Linking):
    """Code of a kernel that Python calls, with all its parts."""

    records: dict[str, Any]  # that its plan composed, by name

    def finalize(self) -> None:
        """Link every part, directly called or not, once; call separate ones where they are."""
        self.separate = separate_code(self.parts, self.records, self._codegen)
        self._symbols = merge(self._final_module, self.parts, self.records, self._codegen)
        super().finalize()

    def serialize_using_object_code(self) -> tuple[str, str, tuple[bytes, bytes]]:
        """Return the object, and of its bitcode the names of its functions alone.

        Nothing links with a whole kernel that was loaded, and to read all takes half of loading it.
        """
        name, kind, (code, _) = super().serialize_using_object_code()
        defined = "".join(
            f'define void @"{function.name}"() {{\n  unreachable\n}}\n'
            for function in self.get_defined_functions()
            if function.linkage not in (Linkage.internal, Linkage.private)
        )
        return name, kind, (code, parse_assembly(defined).as_bitcode())

    def _optimize_final_module(self) -> None:
        """Optimise once."""
        optimise(self._final_module, self._symbols, self._codegen)


def _refuse_another(function: Any, direct: bool) -> None:
    """Refuse a kernel that hands the engine's memory on in another form than those before it.

    A caller that counts references hands it on array by array, one that does not by its address:
    linked with each other, either would read what the other does not give.
    """
    if _kinds - {direct}:
        does, do = ("does not", "do") if direct else ("does", "do not")
        raise RuntimeError(
            f"kernel {function.__qualname__} {does} count references or explain itself to a "
            f"debugger, and those compiled before {do}: a process has one kind of kernels"
        )
    _kinds.add(direct)


def _prepare(state: Any, function: Any, symbol: str) -> None:
    """Let numba call the code of `function` by `symbol`, and parts by theirs."""
    own = f"{function.__module__}.{function.__qualname__}"
    names = {own: symbol, f".NumbaEnv.{own}": f".NumbaEnv.{symbol}"}

    def mangler(name: str, argtypes: Any, *, abi_tags: Any = (), uid: Any = None) -> Any:
        if name in names:
            return mangle(names[name], ())
        return default_mangler(name, argtypes, abi_tags=abi_tags, uid=uid)

    def declare_function(module: Any, called: Any) -> Any:
        own = isinstance(called, ExternalFunctionDescriptor) or called.mangled_name == entry
        if not own and any(map(are_rows, called.argtypes)):
            # It would be handed seven numbers for each array, and read them as two.
            raise NotImplementedError(f"a kernel calls {called.qualname} of numba with an array")
        expected = context.call_conv.get_function_type(called.restype, called.argtypes)
        there = module.globals.get(called.mangled_name)
        if there is not None and there.function_type != expected:
            # Records of two layouts that look the same to a part are given to it. To LLVM all
            # pointers are alike, but llvmlite has one declaration for a name in a module.
            module = ir.Module(context=module.context)
        return type(context).declare_function(context, module, called)

    entry = mangle(symbol, ())
    context = state.targetctx  # made for this compilation alone
    context.mangler, context.declare_function = mangler, declare_function
    direct = is_direct(context, state.flags)
    _refuse_another(function, direct)
    if direct:
        context.data_model_manager = REFERENCES
    context.get_arg_packer = packer_of(context.data_model_manager)
    context.call_conv.get_function_type = function_types_of(context)
    state.typingctx = quick(state.typingctx, direct=direct)


# Passes of numba's that serve closures, generators, literal arguments, array expressions and
# functions to be inlined before typing, and those that only explain: no kernel has any of it.
NEEDLESS = frozenset(
    {
        "WithLifting",
        "InlineClosureLikes",
        "MakeFunctionToJitFunction",
        "InlineInlinables",
        "FindLiterallyCalls",
        "LiteralUnroll",
        "LiteralPropagationSubPipelinePass",
        "InlineOverloads",
        "NopythonRewrites",
        "NoPythonSupportedFeatureValidation",
        "IRLegalization",
        "AnnotateTypes",
        "DumpParforDiagnostics",
    }
)


class _Passes(PassManager):
    """Passes, one after the other; numba would describe each call of each one for its log."""

    def run(self, state: Any) -> None:
        """Run the passes."""
        state.func_id.is_kernel = True
        for compiler_pass, _ in self.passes:
            found = _pass_registry.get(compiler_pass)
            one = found.pass_inst
            one.analysis = self._analysis
            one.run_initialization(state)
            one.run_pass(state)
            one.run_finalizer(state)
            if found.mutates_CFG and compiler_pass is not KernelLowering:
                state.func_ir.blocks = canonical(state.func_ir)


_pipelines: dict[tuple[Any, ...], PassManager] = {}


def _pipeline(state: Any) -> PassManager:
    """Return numba's pipeline for a function in nopython mode, without what no kernel needs."""
    flags = state.flags
    asked = flags.auto_parallel.enabled, flags.no_rewrites, flags.enable_ssa, state.func_ir is None
    if asked not in _pipelines:
        _pipelines[asked] = _new_pipeline(state)
    return _pipelines[asked]


def _new_pipeline(state: Any) -> PassManager:
    whole, pipeline = DefaultPassBuilder.define_nopython_pipeline(state), _Passes("kernel")
    for compiler_pass, description in whole.passes:
        if compiler_pass is NativeLowering:
            pipeline.add_pass(KernelLowering, description)
        elif compiler_pass.__name__ not in NEEDLESS:
            pipeline.add_pass(compiler_pass, description)
    pipeline.finalize()
    return pipeline


def _nothing() -> None:
    pass


class _KernelCompiler(Compiler):
    """Numba's pipeline for kernels, without what none needs."""

    def __init__(
        self, function, symbol, typingctx, targetctx, library, args, return_type, flags, locals
    ):
        code = self.code(targetctx.codegen(), flags, args)
        self.learn(typingctx, targetctx)
        typing, target = copy(typingctx), copy(targetctx)
        typing.refresh = target.refresh = _nothing
        super().__init__(typing, target, code, args, return_type, flags, locals)
        self.state.typingctx = typingctx
        self.state.targetctx.__dict__.pop("refresh", None)
        _prepare(self.state, function, symbol)

    def define_pipelines(self):
        """Return the one pipeline there is."""
        return [_pipeline(self.state)]

    def code(self, codegen, flags, args):
        """Return the library that the code goes to."""
        raise NotImplementedError

    @staticmethod
    def learn(typing, target):
        """Let contexts take what numba has learned to compile: done by the whole kernel, once."""


class PartCompiler(_KernelCompiler):
    """For a kernel that only kernels call."""

    def code(self, codegen, flags, args):
        """Return a library that is linked into others."""
        flags.no_compile = flags.no_cpython_wrapper = True
        return PartCode(codegen, "part")


class ObjectCompiler(_KernelCompiler):
    """For a kernel that Python calls; its code can be kept on disk."""

    @staticmethod
    def learn(typing, target):
        """Take it. Code that is loaded needs none of it, which takes a quarter of a second."""
        with without_algebra():
            typing.refresh()
            target.refresh()

    def code(self, codegen, flags, args):
        """Return a library that links all that it calls."""
        whole = KernelObject(codegen, "whole")
        whole.records = composed_in(args)
        whole.enable_object_caching()
        return whole


class Linked(NamedTuple):
    """A part as kernels call it: what numba looks its code up by, and how it is called."""

    entry: object
    signature: Any
    called: ExternalFunctionDescriptor
    part: KernelPart


class Kernel(CPUDispatcher):
    """Compiled code of one function for each signature; a door to Python only where Python calls.

    One kernel in a hundred is called from Python (`overloads`); the others are parts of it.
    """

    _compiler: Any  # numba does not declare its own

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self.linked: dict[tuple[Any, ...], Linked] = {}  # by the types of the arguments
        self.separate = 0  # how it is optimised without its callers (`separate_code`)

    def signature_for(self, args: Any, kws: Any) -> Any:
        """Return how a kernel calls this one, which is compiled for it."""
        pysig, args = self._compiler.fold_argument_types(args, kws)
        return self._linked(tuple(args)).signature.replace(pysig=pysig)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Compile for a function of numba's that calls this one."""
        pysig, args = self._compiler.fold_argument_types(args, kws)
        args = tuple(args)
        self._linked(args)
        name = self.py_func.__name__
        signatures = [each.signature for each in self.linked.values()]
        template = make_concrete_template(f"CallTemplate({name})", key=name, signatures=signatures)
        return template, pysig, args, {}

    def _linked(self, args: tuple[Any, ...]) -> Linked:
        with global_compiler_lock:
            found = self.linked.get(args)
            if found is None:
                found = self.linked[args] = self._link(args)
        return found

    def get_overload(self, sig: Any) -> Any:
        """Return what the code that a kernel calls is looked up by."""
        return self.linked[tuple(normalize_signature(sig)[0])].entry

    def _link(self, args: tuple[Any, ...]) -> Linked:
        """Let kernels call this one, by a part that was there or is compiled now."""
        key = key_of(self, args, places=not names_places())
        part = STORE.find(key)
        if part is None:
            part = self._compiled(key, args)
            STORE.keep(part)
            collect_recent()  # what numba made for it holds itself, and is some megabytes
        entry = object()
        called = ExternalFunctionDescriptor(part.symbol, part.returns, args)
        self.targetctx.insert_user_function(entry, called, [part])
        return Linked(entry, signature(part.returns, *args), called, part)

    def _compiled(self, key: str, args: tuple[Any, ...]) -> KernelPart:
        symbol = symbol_of(self.py_func, key)
        self._compiler.pipeline_class = partial(PartCompiler, self.py_func, symbol)
        result = self._compiler.compile(args, None)
        part: KernelPart = result.library.part(
            result.fndesc.mangled_name, result.signature.return_type, key, self.separate
        )
        return part

    def compile(self, sig: Any) -> Any:
        """Compile for Python, which needs a door."""
        with global_compiler_lock, shortened(), nested():
            args = tuple(normalize_signature(sig)[0])
            # Code of one kernel may be in a process twice, loaded and compiled: each has its name.
            symbol = f"{symbol_of(self.py_func, key_of(self, args))}_{next(_objects)}"
            self._compiler.pipeline_class = partial(ObjectCompiler, self.py_func, symbol)
            return super().compile(sig)

    def has_door(self, args: tuple[Any, ...]) -> bool:
        """Whether Python can call the code compiled for these types."""
        return args in self.overloads
