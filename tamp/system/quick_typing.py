"""Shortcuts through what numba does before LLVM: what was asked before is remembered, and nobody
is told who does not listen.

Each changes classes of numba's own, and leaves them as they are where a numba of another version
lacks what the shortcut needs. None changes what is compiled.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from numba.core import base, event, ir, types
from numba.core.types.functions import BaseFunction

PLAIN = (types.Number, types.Boolean, types.Array, types.UniTuple, types.Literal)
"""Types of arguments that say all about themselves."""

ITEMS = ("functions", "getattrs", "setattrs", "casts", "constants", "attributes", "globals")
"""Lists of a numba registry, of implementations and of types."""


LOCKS = ("numba:compiler_lock", "numba:llvm_lock")
"""Events that numba times for each function that it compiles."""


def type_operators_once() -> None:
    """Remember the types of a built-in operator's result.

    numba tries all templates of `+` or `a[i]` anew, those of numpy's universal functions first,
    for each place that has one: a seventh of what compiling takes. What an `@overload` supplies is
    asked anew, since it depends on more than the types.
    """
    if not {"get_call_type", "get_impl_key"} <= {*dir(BaseFunction)}:
        return

    typed = BaseFunction.get_call_type
    answers: dict[tuple[Any, ...], tuple[Any, Any]] = {}

    def get_call_type(self: Any, context: Any, args: Any, kws: Any) -> Any:
        if kws or not all(isinstance(argument, PLAIN) for argument in args):
            return typed(self, context, args, kws)

        question = (context, self, tuple(args))
        if question in answers:
            signature, implementation = answers[question]
            self._impl_keys[signature.args] = implementation
            return signature
        signature = typed(self, context, args, kws)
        implementation = self.get_impl_key(signature)
        if implementation is self.key[0]:
            answers[question] = signature, implementation
        return signature

    BaseFunction.get_call_type = get_call_type


def refresh_when_there_is_more() -> None:
    """Have numba look through its registries only when one of them has grown.

    It does before each function, and whenever it meets an operator for the first time; that
    nothing was added takes it three hundred imports and loops to find out.
    """
    if not {"refresh", "install_registry"} <= {*dir(base.BaseContext)}:
        return

    refresh = base.BaseContext.refresh
    seen: dict[Any, tuple[int, int]] = {}

    def refresh_if_grown(self: Any) -> None:
        if self in seen and seen[self] == _registered(self):
            return
        with _linear_algebra_taken_on_trust():
            refresh(self)
        seen[self] = _registered(self)

    base.BaseContext.refresh = refresh_if_grown


def _registered(context: Any) -> tuple[int, int]:
    """Count the registries of a numba context and of its typing context, and what is in them."""
    registries = [*context._registries, *context.typing_context._registries]
    items = sum(len(getattr(one, name, ())) for one in registries for name in ITEMS)
    return len(registries), items


@contextmanager
def _linear_algebra_taken_on_trust() -> Iterator[None]:
    """Spare numba's array mathematics the import of scipy.linalg by which it checks at its own
    import that there is one; who calls a function of linear algebra checks again.
    """
    from numba.np import linalg

    check = getattr(linalg, "ensure_blas", None)
    if check is None or importlib.util.find_spec("scipy") is None:
        yield
        return
    linalg.ensure_blas = lambda: None
    try:
        yield
    finally:
        linalg.ensure_blas = check


def tell_only_listeners() -> None:
    """Have numba make no event of which nobody is told: it makes two for each call of LLVM.

    Nor does it listen to itself, once more for each function that is being compiled, to say how
    long locks were held (`get_metadata`).
    """
    if not {"_registered", "start_event", "end_event", "install_timer"} <= {*dir(event)}:
        return

    start, end = event.start_event, event.end_event
    listeners, timed = event._registered, event.install_timer

    def start_event(kind: str, data: Any = None) -> None:
        if listeners.get(kind):
            start(kind, data)

    def end_event(kind: str, data: Any = None, exc_details: Any = None) -> None:
        if listeners.get(kind):
            end(kind, data, exc_details)

    @contextmanager
    def install_timer(kind: str, callback: Any) -> Iterator[Any]:
        if kind in LOCKS:
            yield None
            return
        with timed(kind, callback) as timer:
            yield timer

    event.start_event, event.end_event = start_event, end_event
    event.install_timer = install_timer


def list_variables_quickly() -> None:
    """List the variables of an instruction with fewer questions about each of its fields.

    Liveness is analysed ten times for each function, and asks a million times.
    """
    if "_rec_list_vars" not in dir(ir.Inst):
        return

    variable, instruction = ir.Var, ir.Inst
    without = {str, int, float, bool, type(None), ir.Loc}

    def listed(value: Any, found: list[Any]) -> None:
        kind = type(value)
        if kind in without:
            return
        if isinstance(value, variable):
            found.append(value)
        elif isinstance(value, instruction):
            found.extend(value.list_vars())
        elif isinstance(value, (list, tuple)):
            for each in value:
                listed(each, found)
        elif isinstance(value, dict):
            for each in value.values():
                listed(each, found)

    def list_vars(self: Any, val: Any) -> list[Any]:
        found: list[Any] = []
        listed(val, found)
        return found

    ir.Inst._rec_list_vars = list_vars


def measure_types_once() -> None:
    """Remember the size of a type of LLVM's, for which a module is written and parsed each time."""
    if "get_abi_sizeof" not in dir(base.BaseContext):
        return

    measured = base.BaseContext.get_abi_sizeof
    sizes: dict[tuple[Any, str], int] = {}

    def get_abi_sizeof(self: Any, ty: Any) -> int:
        key = self.target_data, str(ty)
        if key not in sizes:
            sizes[key] = measured(self, ty)
        return sizes[key]

    base.BaseContext.get_abi_sizeof = get_abi_sizeof
