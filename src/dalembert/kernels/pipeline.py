"""Numba's compiler with only the passes that kernels need, and with faster comparisons: a third less time.

Kernels have no closures, no array expressions, no ``with``, no exceptions, and no literal loops. These passes and
shortcuts are internals of Numba. With versions that were not tried, Numba's own passes compile the kernels.
"""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numba
from numba.core import event, ir, types
from numba.core import lowering as _lowering
from numba.core import typeinfer as _typeinfer
from numba.core.base import BaseContext
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import PassManager
from numba.core.errors import NumbaError
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.transforms import canonicalize_cfg
from numba.core.typed_passes import (
    AnnotateTypes,
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.types.functions import BaseFunction
from numba.core.untyped_passes import (
    DeadBranchPrune,
    FixupArgs,
    GenericRewrites,
    IRProcessing,
    ReconstructSSA,
    RewriteSemanticConstants,
    TranslateByteCode,
)
from numba.np import arrayobj as _arrayobj

from dalembert.kernels.powers import IntegerPowers

arrayobj: Any = _arrayobj
lowering: Any = _lowering
typeinfer: Any = _typeinfer
# Numba's `InlineOverloads` is left out: it removes dead code, and takes writes through a field of a tuple, as of
# `state.x[0]`, for dead. `IntegerPowers` comes before types are inferred, so that its products are typed like all
# others.
_PASSES = (
    TranslateByteCode, FixupArgs, IRProcessing, IntegerPowers, RewriteSemanticConstants, DeadBranchPrune,
    GenericRewrites, ReconstructSSA, NopythonTypeInference, PreLowerStripPhis, IRLegalization, AnnotateTypes,
    NativeLowering, NoPythonBackend,
)  # fmt: skip


class Pipeline(CompilerBase):
    """The passes that kernels need."""

    def define_pipelines(self) -> list[PassManager]:
        """One list of passes."""
        manager = PassManager("nopython")
        for entry in _PASSES:
            manager.add_pass(entry, entry.__name__)
        manager.finalize()
        return [manager]


class NumbaPasses(CompilerBase):
    """All passes of Numba, and the one that kernels need for exact derivatives of powers."""

    def define_pipelines(self) -> list[PassManager]:
        """Numba's list, with :class:`IntegerPowers` where :class:`Pipeline` has it."""
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.add_pass_after(IntegerPowers, IRProcessing)
        manager.finalize()
        return [manager]


TRIED = (0, 62), (0, 68)
"""First and last version of Numba that the tests ran with; `pyproject.toml` has the same bounds."""


def is_tried(version: tuple[int, int]) -> bool:
    """Whether this module's passes and shortcuts are known to work with a version of Numba; warn if they are not."""
    first, last = TRIED
    if first <= version <= last:
        return True
    first, last, this = (".".join(map(str, numbers)) for numbers in (first, last, version))
    warnings.warn(
        f"Numba {this} was not tried with dalembert, so kernels compile more slowly, by Numba's own passes. "
        f"Install a version from {first} to {last}.",
        stacklevel=2,
    )
    return False


_SHORTENED = is_tried(numba.version_info[:2])
PIPELINE: Any = Pipeline if _SHORTENED else NumbaPasses


def _same_flags(self: Any, other: object) -> Any:
    return self._values == other._values if isinstance(other, Flags) else NotImplemented


def _flags_hash(self: Any) -> int:
    return len(self.options)  # Numba's hash has the same value for all flags, but reads each of them


# The signature for arguments of these types depends on the types alone.
_SCALARS = (types.Number, types.Boolean, types.IntegerLiteral, types.Array)
_resolve = BaseFunction.get_call_type
_resolved: dict[Any, Any] = {}


def _call_type(self: Any, context: Any, args: Any, kws: Any) -> Any:
    """The signature of a function of scalars and arrays, which Numba would look for at each call of the source."""
    if kws or not all(isinstance(kind, _SCALARS) for kind in args):
        return _resolve(self, context, args, kws)
    # The key has all types, so that the answer is the one that Numba would give again.
    key = self, context, tuple(args)
    if key not in _resolved:
        _resolved[key] = _resolve(self, context, args, kws)
    return _resolved[key]


class _Fields:
    """Fields of a value that is only read, without Numba's copy of it on the stack for each access."""

    def __init__(self, context: Any, builder: Any, kind: Any, value: Any) -> None:
        self._builder, self._value = builder, value
        self._place = context.data_model_manager[kind].get_field_position

    def __getattr__(self, name: str) -> Any:
        return self._builder.extract_value(self._value, self._place(name))

    def _getvalue(self) -> Any:
        return self._value


_make_array = arrayobj.make_array


def _array_fields(kind: Any) -> Any:
    def made(context: Any, builder: Any, value: Any = None, ref: Any = None) -> Any:
        # Arrays that are made, not read, need the copy on the stack.
        if value is None or not isinstance(kind, types.Array):
            return _make_array(kind)(context, builder, value=value, ref=ref)
        return _Fields(context, builder, kind, value)

    return made


_make_complex = BaseContext.make_complex


def _complex_parts(self: Any, builder: Any, typ: Any, value: Any = None) -> Any:
    return _make_complex(self, builder, typ) if value is None else _Fields(self, builder, typ, value)


_post_process: Any = PostProcessor.run


def _lifetimes(self: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    """Numba's analysis after a pass, without what is alive in each block, which only generators need."""
    self.func_ir.blocks = canonicalize_cfg(self.func_ir.blocks)
    self.func_ir.variable_lifetime, self.func_ir.generator_info = VariableLifetime(self.func_ir.blocks), None
    if emit_dels:
        self._insert_var_dels(extend_lifetimes=extend_lifetimes)


_ATOMS = frozenset({str, int, float, bool, type(None), ir.Loc})
_list_variables: Any = ir.Inst._rec_list_vars
_start_event, _end_event = event.start_event, event.end_event


def _variables(self: Any, value: Any) -> list[Any]:
    """Variables in an instruction or in its parts. Numba's tries each part against five types."""
    found: list[Any] = []
    _collect(value, found)
    return found


def _collect(value: Any, found: list[Any]) -> None:
    kind = type(value)
    if kind is ir.Var:
        found.append(value)
    elif kind in (dict, list, tuple):
        # Most parts are names and locations, whose types decide at once.
        for part in value.values() if kind is dict else value:
            if type(part) not in _ATOMS:
                _collect(part, found)
    elif isinstance(value, ir.Inst):
        found += value.list_vars()


_error_context = lowering.new_error_context


class _ErrorContext:
    """What Numba adds to the message of an error, without a generator for each instruction."""

    __slots__ = ("_arguments", "_text")

    def __init__(self, text: str, *arguments: Any, **named: Any) -> None:
        self._text, self._arguments = text, (arguments, named)

    def __enter__(self) -> None: ...

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        if isinstance(error, NumbaError):
            positional, named = self._arguments
            error.add_context(self._text.format(*positional, **named))


def _no_event(kind: Any, data: Any = None, exc_details: Any = None) -> None:
    """Numba reports each call of LLVM to listeners: there are none."""


@contextmanager
def hastened() -> Iterator[None]:
    """Compare flags, resolve calls, read arrays, list variables and analyse lifetimes at less cost in this block.

    The optimised code stays the same. Nothing changes with a version of Numba that was not tried.
    """
    if not _SHORTENED:
        yield
        return
    # Numba has no hooks here, so that its methods are exchanged, and restored whatever happens in the block.
    flags: Any = Flags
    usual = flags.__eq__, flags.__hash__
    flags.__eq__, flags.__hash__ = _same_flags, _flags_hash
    BaseFunction.get_call_type, arrayobj.make_array = _call_type, _array_fields
    BaseContext.make_complex, PostProcessor.run = _complex_parts, _lifetimes
    instructions: Any = ir.Inst
    instructions._rec_list_vars = _variables
    event.start_event = event.end_event = _no_event
    lowering.new_error_context = typeinfer.new_error_context = _ErrorContext
    try:
        yield
    finally:
        flags.__eq__, flags.__hash__ = usual
        BaseFunction.get_call_type, arrayobj.make_array = _resolve, _make_array
        BaseContext.make_complex, PostProcessor.run = _make_complex, _post_process
        instructions._rec_list_vars = _list_variables
        event.start_event, event.end_event = _start_event, _end_event
        lowering.new_error_context = typeinfer.new_error_context = _error_context
