"""Rows of named numbers that NumPy has no type for, dual numbers and lanes: columns are read by their names."""

import operator
from typing import Any

from numba import types
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import lower_getattr_generic, models, overload, register_model

from dalembert.kernels.lanes import without_python
from dalembert.kernels.views import WORD, intrinsic


class NamedRowType(types.Type):
    """Named numbers of one type side by side in memory, by their address."""

    def __init__(self, item: types.Type, names: tuple[str, ...]) -> None:
        self.item, self.names = item, names
        super().__init__(f"NamedRow({item}: {', '.join(names)})")


class NamedRowsType(types.Type):
    """Rows of named numbers, by their address."""

    def __init__(self, item: types.Type, names: tuple[str, ...]) -> None:
        self.row = NamedRowType(item, names)
        super().__init__(f"NamedRows({item}: {', '.join(names)})")


@register_model(NamedRowType)
@register_model(NamedRowsType)
class _AddressModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, WORD)


class _Columns(AttributeTemplate):
    key = NamedRowType

    def generic_resolve(self, kind: NamedRowType, name: str) -> Any:
        # None tells Numba that there is no such column; it then reports the name and the line.
        return kind.item if name in kind.names else None


infer_getattr(_Columns)


@lower_getattr_generic(NamedRowType)
def _column(context: Any, builder: Any, kind: NamedRowType, address: Any, name: str) -> Any:
    model = context.data_model_manager[kind.item]
    item = model.get_data_type()
    place = builder.add(address, WORD(context.get_abi_sizeof(item) * kind.names.index(name)))
    return model.load_from_data_pointer(builder, builder.inttoptr(place, item.as_pointer()))


@intrinsic(without_python)
def _row(typingctx, rows, e):
    def generate(context, builder, signature, arguments):
        item = context.data_model_manager[rows.row.item].get_data_type()
        size = WORD(context.get_abi_sizeof(item) * len(rows.row.names))
        return builder.add(arguments[0], builder.mul(arguments[1], size))

    return rows.row(rows, types.int64), generate


@overload(operator.getitem)
def _row_of(rows, e):
    return (lambda rows, e: _row(rows, e)) if isinstance(rows, NamedRowsType) else None  # noqa: PLW0108 - Numba's form


def named_rows(dtype: Any, names: tuple[str, ...]) -> Any:
    """An intrinsic: rows of named dual numbers or lanes at an address."""
    kind = NamedRowsType(dtype.numba, names)

    @intrinsic(without_python)
    def rows(typingctx, address, count):
        """The rows at an address."""
        return kind(types.int64, types.int64), lambda context, builder, signature, arguments: arguments[0]

    return rows
