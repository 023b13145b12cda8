"""A shortcut through numba's overloads: calls that are an instruction or two where they are made.

numba compiles `max` and `min` of two numbers, `int` of one and `np.empty` as functions of their
own, again for each set of options: a tenth of what compiling takes. Here they are written into who
calls them; the instructions are the same.
"""

from __future__ import annotations

from typing import Any

from numba.core import types
from numba.core.imputils import lower_builtin
from numba.core.types.functions import BaseFunction
from numba.core.typing.templates import signature

NEEDED = frozenset({"_empty_nd_impl", "_parse_empty_args"})
"""What allocating an array calls of numba's module of arrays, which only compiling imports."""

NUMBERS: dict[Any, tuple[tuple[Any, ...], Any, str]] = {
    max: ((types.float64, types.float64), types.float64, "tamp.larger"),
    min: ((types.float64, types.float64), types.float64, "tamp.smaller"),
    int: ((types.float64,), types.intp, "tamp.truncated"),
}
"""Of what types each is called, what it returns, and under which name it is implemented."""


@lower_builtin("tamp.larger", types.float64, types.float64)
def _larger(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    first, second = arguments
    return builder.select(builder.fcmp_ordered(">", second, first), second, first)


@lower_builtin("tamp.smaller", types.float64, types.float64)
def _smaller(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    first, second = arguments
    return builder.select(builder.fcmp_ordered("<", second, first), second, first)


@lower_builtin("tamp.truncated", types.float64)
def _truncated(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    return context.cast(builder, arguments[0], types.float64, types.intp)


@lower_builtin("tamp.allocated", types.VarArg(types.Any))
def _allocated(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    from numba.np import arrayobj

    kind, shape = arrayobj._parse_empty_args(context, builder, signature, arguments)
    return arrayobj._empty_nd_impl(context, builder, kind, shape)._getvalue()


def call_directly() -> None:
    """Have numba write these calls into who makes them."""
    if "get_call_type" not in dir(BaseFunction):
        return

    typed = BaseFunction.get_call_type

    def get_call_type(self: Any, context: Any, args: Any, kws: Any) -> Any:
        direct = None if kws else _direct(self.key[0], tuple(args))
        if direct is None:
            return typed(self, context, args, kws)
        answer, name = direct
        self._impl_keys[answer.args] = name
        return answer

    BaseFunction.get_call_type = get_call_type


def _direct(function: Any, arguments: tuple[Any, ...]) -> tuple[Any, str] | None:
    """Return a call's signature and its implementation's name, if it is one of these calls."""
    if _is_empty(function) and 1 <= len(arguments) <= 2:
        array = _array(*(types.unliteral(argument) for argument in arguments))
        plain = (types.unliteral(argument) for argument in arguments)
        return None if array is None else (signature(array, *plain), "tamp.allocated")

    taken, returned, name = NUMBERS.get(function, (None, None, ""))
    return (signature(returned, *arguments), name) if arguments == taken else None


def _is_empty(function: Any) -> bool:
    """Check whether a function is np.empty, without importing numpy."""
    names = getattr(function, "__module__", None), getattr(function, "__name__", None)
    return names == ("numpy", "empty")


def _array(shape: Any, kind: Any = None) -> Any:
    """Return the type of np.empty(shape, kind), None where numba shall find it itself."""
    from numba.np import arrayobj

    sides = shape.count if isinstance(shape, types.UniTuple) else 1
    side = shape.dtype if isinstance(shape, types.UniTuple) else shape
    if not vars(arrayobj).keys() >= NEEDED or side != types.intp:
        return None
    if kind is not None and not isinstance(kind, types.NumberClass):
        return None
    return types.Array(types.float64 if kind is None else kind.dtype, sides, "C")
