"""Kernels as plain Python: nothing is compiled, and a test may put a toy in the place of a callee."""

from __future__ import annotations

from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any


def plain(*modules: ModuleType, **toys: Any) -> Any:
    """All names of some modules, the compiled functions among them as Python ones that see each
    other by their names; `toys` stand in for names.
    """
    names: dict[str, Any] = {}
    for module in modules:
        names |= vars(module)
    for name, value in list(names.items()):
        python = getattr(value, "py_func", None)
        if isinstance(python, FunctionType):
            names[name] = FunctionType(python.__code__, names, name, None, python.__closure__)
    names |= toys
    return SimpleNamespace(**{name: value for name, value in names.items() if name != "__name__"})
