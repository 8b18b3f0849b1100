"""From a Python function to an object file with one C function, by Numba and LLVM.

Numba optimises each inner function and generates machine code for it, although only its copy inside its callers is
used. Here inner functions are not optimised, and the whole of a kernel is optimised once.
"""

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import SimpleNamespace
from typing import Any

import llvmlite.binding as ll
from llvmlite import ir
from numba import types
from numba.core import cgutils, compiler
from numba.core.codegen import CPUCodeLibrary
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher
from numba.core.registry import cpu_target as _cpu_target
from numba.core.typing.templates import AbstractTemplate, infer_global, make_concrete_template
from numba.extending import lower_builtin

from dalembert.kernels.arguments import accepted, load_words, numba_type, read_words, store_words
from dalembert.kernels.pipeline import PIPELINE, hastened
from dalembert.kernels.processor import processor
from dalembert.kernels.refusals import refusals
from dalembert.kernels.views import WORD, intrinsic
from dalembert.kernels.words import count

cpu_target: Any = _cpu_target  # its type stubs lack the contexts
_OPTIMISATION = 3


#: What Numba's environments of Python objects are given to: kernels have none.
_NO_ENVIRONMENT = SimpleNamespace(set_env=lambda name, environment: None)


class _Library(CPUCodeLibrary):
    """Code that is not optimised before it is linked into a kernel."""

    def _optimize_functions(self, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self) -> None:
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        return 0  # it has no machine code

    @property
    def codegen(self) -> Any:
        return _NO_ENVIRONMENT

    def _get_module_for_linking(self) -> Any:  # for a function compiled elsewhere that shares some of the inner ones
        if self._shared_module is None:
            self._shared_module = _linked(self)
        return self._shared_module


def _linked(library: CPUCodeLibrary) -> Any:
    """One module of a library and of all that it calls."""
    whole = ll.parse_assembly(str(library._codegen._create_empty_module(library.name)))
    # Parts are cloned, because linking moves a module into another one and leaves it empty.
    for part in _reached(library):
        module = part._final_module.clone() if isinstance(part, _Library) else part._get_module_for_linking().clone()
        for function in module.functions:
            if not function.is_declaration and function.linkage == ll.Linkage.external:
                # Two parts may define the same inner function; with this linkage LLVM keeps one definition.
                function.linkage = "weak_odr"
        whole.link_in(module)
    return whole


def _reached(library: CPUCodeLibrary) -> list[CPUCodeLibrary]:
    reached, ahead = [], [library]
    while ahead:
        own = ahead.pop()
        if own not in reached:
            reached.append(own)
            ahead += own._linking_libraries
    return reached


@contextmanager
def _apart() -> Iterator[None]:
    """Compile without machine code for inner functions, and without collecting garbage (a seventh of the time)."""
    codegen = cpu_target.target_context.codegen()
    usual, collects = codegen._library_class, gc.isenabled()
    codegen._library_class = _Library
    gc.disable()
    try:
        yield
    finally:
        codegen._library_class = usual
        if collects:
            gc.enable()


class Inner(CPUDispatcher):
    """A function for kernels. It is not specialised by literal arguments; from Python it is the function itself."""

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        return self.py_func(*arguments, **named)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """One signature, that of these arguments. Numba would also try others, and treat all records as equal."""
        own: Any = self
        positional, named = map(types.unliteral, args), {name: types.unliteral(kind) for name, kind in kws.items()}
        folded, given = own._compiler.fold_argument_types(tuple(positional), named)
        self.compile(tuple(given))
        signature = self.overloads[tuple(given)].signature
        template = make_concrete_template(
            f"CallTemplate({self.py_func.__name__})", key=self.py_func.__name__, signatures=[signature]
        )
        return template, folded, given, {}


def _compiled_only(*_: Any) -> Any:
    raise NotImplementedError


def entry_point(function: Callable, arguments: tuple[Any, ...], result: Any, first: tuple[Any, ...] = ()) -> Callable:
    """A function of one address: of the words of the arguments; it writes the words of the result after them.

    ``first`` is empty, or a function whose value the other one takes before these arguments.
    """
    kinds = types.Tuple([numba_type(annotation) for annotation in arguments])
    behind = sum(map(count, arguments))

    @intrinsic(_compiled_only)
    def load(typingctx, address):
        def generate(context, builder, signature, values):
            words, at, loaded = builder.inttoptr(values[0], WORD.as_pointer()), 0, []
            for annotation in arguments:
                loaded.append(load_words(context, builder, annotation, words, at))
                at += count(annotation)
            return context.make_tuple(builder, kinds, loaded)

        return kinds(types.int64), generate

    @intrinsic(_compiled_only)
    def store(typingctx, address, value):
        if result is None:
            return types.void(types.int64, value), lambda context, *_: context.get_dummy_value()
        kind = numba_type(result)

        def generate(context, builder, signature, values):
            words = builder.inttoptr(values[0], WORD.as_pointer())
            store_words(context, builder, result, kind, values[1], words, behind)
            return context.get_dummy_value()

        return types.void(types.int64, kind), generate

    def entry(address):
        store(address, function(*load(address)))

    def entry_of_first(address):
        store(address, function(other(), *load(address)))

    other: Any = first[0] if first else None
    return entry_of_first if first else entry


def caller(handle: Any, symbol: str | None, arguments: tuple[Any, ...], result: Any) -> None:
    """Let compiled functions call a kernel, as ``handle`` in their source: by its symbol, or by an address before all.

    The words are written to the stack of the caller.
    """
    leading = () if symbol else (types.int64,)
    answer = types.none if result is None else numba_type(result)
    behind = sum(map(count, arguments))
    size = behind + (0 if result is None else count(result))

    class Template(AbstractTemplate):
        key = handle

        def generic(self, args: Any, kws: Any) -> Any:
            if len(args) != len(leading) + len(arguments):
                return None
            given = args[len(leading) :]
            return answer(*leading, *map(accepted, arguments, given))

    @lower_builtin(handle, types.VarArg(types.Any))
    def lower(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        # In the entry block the cells are made once a call of the caller, not once an iteration of its loops.
        with builder.goto_entry_block():
            words = builder.alloca(WORD, size=max(size, 1))
        at, kinds = 0, signature.args[len(leading) :]
        for annotation, kind, value in zip(arguments, kinds, values[len(leading) :], strict=True):
            store_words(context, builder, annotation, kind, value, words, at)
            at += count(annotation)
        kind = ir.FunctionType(ir.VoidType(), [WORD])
        if symbol:
            # The linker of the process resolves the symbol, when the object of the caller is loaded.
            function = cgutils.get_or_insert_function(builder.module, kind, symbol)
        else:
            function = builder.inttoptr(values[0], kind.as_pointer())
        builder.call(function, [builder.ptrtoint(words, WORD)])
        if result is None:
            return context.get_dummy_value()
        return read_words(context, builder, result, words, behind)

    infer_global(handle, types.Function(Template))


def _flags() -> Any:
    flags: Any = compiler.Flags()
    # Kernels allocate nothing, so that they need no reference counts.
    flags.nrt = False
    flags.release_gil = True
    # A division by zero gives inf or nan; Python's error would be an exception.
    flags.error_model = "numpy"
    flags.no_cpython_wrapper = True
    flags.no_cfunc_wrapper = True
    return flags


@global_compiler_lock
def optimised(function: Callable, symbol: str, addresses: int, cpu: str | None = None) -> Any:
    """LLVM's module of a function of ``addresses`` addresses that returns nothing, optimised for a processor."""
    with _apart(), hastened(), refusals(function):
        context = cpu_target.target_context
        # Declarations that were made since the last compilation, such as those of `caller`, become known here.
        context.refresh()
        cpu_target.typing_context.refresh()
        arguments = (types.int64,) * addresses
        compiled = compiler.compile_extra(
            cpu_target.typing_context, context, function, arguments, types.none, _flags(), {}, pipeline_class=PIPELINE
        )
        module = _linked(compiled.library)
        _add_entry(module, compiled.fndesc.llvm_func_name, symbol, addresses)
        _optimise(module, cpu)
        return module


def object_code(function: Callable, symbol: str, addresses: int) -> bytes:
    """Machine code of the same function for this processor."""
    return target_machine().emit_object(optimised(function, symbol, addresses))


def _add_entry(module: Any, native: str, symbol: str, addresses: int) -> None:
    """Add a plain C function around the native one, the only exported one."""
    given = ", ".join(f"i64 %{k}" for k in range(addresses))
    stub = ll.parse_assembly(
        f'declare i32 @"{native}"(ptr, ptr{", i64" * addresses})\n'
        f'define void @"{symbol}"({given}) {{\n'
        f"  %r = alloca ptr\n  %e = alloca ptr\n"
        f'  %s = call i32 @"{native}"(ptr %r, ptr %e, {given})\n  ret void\n}}'
    )
    # LLVM refuses to link modules of different layouts.
    stub.triple, stub.data_layout = module.triple, module.data_layout
    module.link_in(stub)
    for entry in (*module.functions, *module.global_variables):
        if not entry.is_declaration and entry.name != symbol:
            # Internal functions may be inlined and removed, and symbols of different objects cannot collide.
            entry.linkage = "internal"


def _optimise(module: Any, cpu: str | None) -> None:
    options = ll.create_pipeline_tuning_options(speed_level=_OPTIMISATION)
    # SLP vectorisation stays off. Loop vectorisation without fast-math leaves the order of sums.
    options.loop_vectorization, options.slp_vectorization = True, False
    builder = ll.create_pass_builder(target_machine(cpu), options)
    builder.getModulePassManager().run(module, builder)


@cache
def target_machine(cpu: str | None = None) -> Any:
    """LLVM's description of a processor: of this one, or of the named one of the same family. The code model is that of
    code whose sections are loaded anywhere: a usual one reaches other sections by relative addresses of 2 GB, and LLVM
    ends the process where a large process has them further apart.
    """
    ll.initialize_native_target()
    ll.initialize_native_asmprinter()
    target = ll.Target.from_triple(ll.get_process_triple())
    name, features = (cpu, "") if cpu else processor()
    return target.create_target_machine(
        cpu=name, features=features, opt=_OPTIMISATION, codemodel="jitdefault", jit=True
    )
