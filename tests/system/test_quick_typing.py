"""Shortcuts through numba's typing: the same answers, and nobody who listens or extends is lost."""

from __future__ import annotations

import operator
import subprocess
import sys
from typing import Any

import numba
import numpy as np
import pytest
from llvmlite import ir as llvm
from numba import types
from numba.core import base, event, ir, targetconfig
from numba.core.registry import cpu_target
from numba.core.types.functions import BaseFunction
from numba.extending import overload

from tamp.system import compilation, quick_typing

ADDED = (types.float64, types.float64)
TARGET: Any = cpu_target.target_context
TYPING: Any = cpu_target.typing_context
ROW = types.Array(types.float64, 1, "C")


@pytest.mark.parametrize(
    ("operation", "arguments", "result"),
    [
        (operator.add, (types.int64, types.float64), types.float64),
        (operator.truediv, (types.int64, types.int64), types.float64),
        (operator.lt, ADDED, types.boolean),
        (operator.getitem, (ROW, types.int64), types.float64),
        (operator.getitem, (ROW, types.literal(3)), types.float64),
    ],
)
def test_an_operator_is_typed_once(
    monkeypatch: pytest.MonkeyPatch, operation: object, arguments: tuple, result: object
) -> None:
    TARGET.refresh()
    first = TYPING.resolve_function_type(operation, arguments, {})

    asked: list[tuple] = []
    for template in TYPING.resolve_value_type(operation).templates:
        monkeypatch.setattr(template, "apply", lambda self, args, kws: asked.append(args))
    again = TYPING.resolve_function_type(operation, arguments, {})
    assert first.return_type == result and again == first and asked == []


def test_an_overload_is_chosen_by_the_options_of_who_calls_it() -> None:
    """Division by zero: an error under Python's model of errors, infinite under numpy's."""

    def inverse(x):
        raise NotImplementedError(x)

    @overload(inverse)
    def inverted(x):
        return lambda x: 1.0 / x

    quiet = compilation.njit(error_model="numpy")(lambda x: inverse(x))
    strict = compilation.njit(error_model="python")(lambda x: inverse(x) + 1.0)
    again = compilation.njit(error_model="numpy")(lambda x: inverse(x) - 1.0)
    assert quiet(0.0) == np.inf
    with pytest.raises(ZeroDivisionError):
        strict(0.0)
    assert again(0.0) == np.inf


def test_what_is_registered_later_is_found() -> None:
    compilation.njit("int64(int64)")(lambda x: x + 1)  # the registries have been looked through

    class Pair:
        pass

    def halved(x):
        raise NotImplementedError(x)

    @overload(halved)
    def implementation(x):
        return lambda x: x / 2

    assert compilation.njit()(lambda x: halved(x))(3.0) == 1.5


def test_registries_are_looked_through_only_when_they_have_grown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    TARGET.refresh()
    looked: list[object] = []
    monkeypatch.setattr(
        type(TARGET), "load_additional_registries", lambda self: looked.append(self)
    )
    TARGET.refresh()
    assert looked == []
    monkeypatch.setattr(quick_typing, "ITEMS", ())  # another number than before
    TARGET.refresh()
    assert looked == [TARGET]


def test_who_listens_is_told_of_all() -> None:
    kinds = ("numba:llvm_lock", "numba:compiler_lock", "numba:run_pass", "numba:compile")
    heard = {}
    for kind in kinds:
        with event.install_recorder(kind) as recorder:
            numba.njit("int64(int64)")(lambda x: x + 1)
        heard[kind] = [one.is_start for _, one in recorder.buffer]
    assert all(told.count(True) == told.count(False) > 0 for told in heard.values()), heard


def test_all_variables_of_an_instruction_are_listed() -> None:
    place = ir.Loc("file", 1)
    scope = ir.Scope(None, place)
    a, b, c = (scope.define(name, place) for name in "abc")
    call = ir.Expr.call(a, [b], (("name", c),), place)
    assert ir.Assign(call, a, place).list_vars() == [a, b, c, a]
    assert ir.Expr.build_map([(a, b), (c, a)], 2, {}, {}, place).list_vars() == [a, b, c, a]
    assert ir.Return(a, place).list_vars() == [a]
    assert ir.Jump(3, place).list_vars() == []
    assert ir.Expr.getattr(b, "shape", place).list_vars() == [b]


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        (llvm.IntType(8), 1),
        (llvm.DoubleType(), 8),
        (llvm.LiteralStructType([llvm.IntType(8), llvm.DoubleType()]), 16),
        (llvm.ArrayType(llvm.IntType(32), 3), 12),
    ],
)
def test_sizes_are_those_of_llvm(kind: llvm.Type, size: int) -> None:
    assert [TARGET.get_abi_sizeof(kind) for _ in range(2)] == [size, size]


WITHOUT_SCIPY = """
import sys
import numpy as np
from tamp.system.compilation import njit
assert njit("int64(int64)")(lambda x: x + 1)(2) == 3
print("scipy.linalg" in sys.modules)
print(njit()(lambda a: np.dot(a, a))(np.array([3.0, 4.0])))
print("scipy.linalg" in sys.modules)
"""


def test_linear_algebra_is_imported_by_who_calls_it() -> None:
    done = subprocess.run([sys.executable, "-c", WITHOUT_SCIPY], capture_output=True, text=True)
    assert done.stdout.split() == ["False", "25.0", "True"], done.stderr


def test_numba_has_what_the_shortcuts_change() -> None:
    assert BaseFunction.get_call_type.__module__ == quick_typing.__name__
    assert base.BaseContext.refresh.__module__ == quick_typing.__name__
    assert base.BaseContext.get_abi_sizeof.__module__ == quick_typing.__name__
    assert ir.Inst._rec_list_vars.__module__ == quick_typing.__name__
    assert event.start_event.__module__ == quick_typing.__name__
    assert targetconfig.TargetConfig.__eq__.__module__ == "tamp.system.quick_compiling"
