"""Shapes of arrays in the geometric wing, checked while its tests run: `Float[Array, "n 7"]` by jaxtyping and beartype.

The product knows these annotations as text only, and imports neither. Here modules of the wing are compiled with the
functions that name shapes wrapped, and with all else in them as it is written; their other annotations are left alone.
"""

from __future__ import annotations

import ast
import importlib.machinery
import sys
from collections.abc import Callable, Sequence
from functools import wraps
from importlib.abc import MetaPathFinder
from pathlib import Path
from types import CodeType, ModuleType
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

WING = "tamp.geometric."
SHAPES = ("Float", "Int")
WRAPPABLE = ("property", "cached_property", "classmethod", "staticmethod", "cache")
"""Decorators that may stand above the check; a compiled kernel's would compile it, too."""

CALLS = 100
"""Calls of one function that are checked in one test; a check takes longer than most of them do."""

NAMES = "_shape_checks"
"""The name under which a checked module knows this one."""


def names_shapes(annotation: ast.expr | None) -> bool:
    """Whether an annotation gives a shape."""
    nodes = [] if annotation is None else list(ast.walk(annotation))
    return any(isinstance(node, ast.Name) and node.id in SHAPES for node in nodes)


class _Concrete(ast.NodeTransformer):
    """Names what an annotation means at run time."""

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        if isinstance(node.value, ast.Name) and node.value.id == "NDArray":
            return _attribute("Array")
        self.generic_visit(node)
        return node

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return _attribute(node.id) if node.id in (*SHAPES, "Array") else node


def _attribute(name: str) -> ast.expr:
    return ast.Attribute(ast.Name(NAMES, ast.Load()), name, ast.Load())


class _Wrapped(ast.NodeTransformer):
    """Wraps the functions that name shapes."""

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        self.generic_visit(node)
        arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
        shaped = any(names_shapes(one.annotation) for one in arguments) or names_shapes(
            node.returns
        )
        known = all(
            isinstance(one, ast.Name) and one.id in WRAPPABLE for one in node.decorator_list
        )
        if not shaped or not known:
            return node

        for one in arguments:
            one.annotation = _checked(one.annotation)
        node.returns = _checked(node.returns)
        node.decorator_list.append(_attribute("checked"))
        return node


def _checked(annotation: ast.expr | None) -> ast.expr | None:
    return (
        _Concrete().visit(annotation)
        if annotation is not None and names_shapes(annotation)
        else None
    )


def instrumented(source: str, path: str) -> CodeType:
    """Compile a module with its shapes checked; lines keep their numbers."""
    tree = _Wrapped().visit(ast.parse(source, path))
    after = next(
        number
        for number, node in enumerate(tree.body, 1)
        if isinstance(node, ast.ImportFrom) and node.module == "__future__"
    )
    tree.body.insert(after, ast.parse(f"import tests.shape_checks as {NAMES}").body[0])
    return compile(ast.fix_missing_locations(tree), path, "exec", dont_inherit=True)


class _Loader(importlib.machinery.SourceFileLoader):
    """Neither reads nor writes compiled files: they are the product's."""

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        return instrumented(Path(path).read_text(encoding="utf-8"), path)


class Finder(MetaPathFinder):
    """Finds the wing's modules that name shapes."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if not fullname.startswith(WING):
            return None
        spec = importlib.machinery.PathFinder.find_spec(fullname, path, target)
        if (
            spec is None
            or spec.origin is None
            or "from jaxtyping import" not in Path(spec.origin).read_text("utf-8")
        ):
            return None
        spec.loader = _Loader(fullname, spec.origin)
        return spec


def install() -> None:
    """Check shapes in all that is imported from now on."""
    early = [name for name in sys.modules if name.startswith(WING)]
    if early:
        raise RuntimeError(f"imported before shapes were checked: {early[0]}")
    sys.meta_path.insert(0, Finder())


def __getattr__(name: str) -> object:
    """What the checked modules ask for; imported only where shapes are checked."""
    if name == "Array":
        import numpy

        return numpy.ndarray
    if name in SHAPES:
        import jaxtyping

        return getattr(jaxtyping, name)
    raise AttributeError(name)


_budgets: list[dict[int, int]] = [{}]
"""The calls that are still checked in this test, of each function that was called."""


def begin_test() -> None:
    """Check the first calls of each function again."""
    _budgets[0] = {}


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Wrap a function so that its first calls in each test are checked."""
    from beartype import beartype
    from jaxtyping import jaxtyped

    slow, key = jaxtyped(typechecker=beartype)(function), id(function)

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        left = _budgets[0].get(key, CALLS)
        if left == 0:
            return function(*args, **kwargs)
        _budgets[0][key] = left - 1
        return slow(*args, **kwargs)

    return call
