"""Kernels from numba's cache: an unreadable file is an empty one, and a strange numba is left alone."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from numba.core.caching import Cache, IndexDataCacheFile

from tamp.system import quick_loading
from tamp.system.quick_loading import compile_what_cannot_be_read, load_without_compiler


@pytest.fixture
def numbas(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """Changes to numba's classes, undone after the test."""
    with monkeypatch.context() as patch:
        for owner, name in (
            (IndexDataCacheFile, "_load_index"),
            (IndexDataCacheFile, "load"),
            (Cache, "load_overload"),
        ):
            patch.setattr(owner, name, getattr(owner, name))
        yield patch


@pytest.mark.parametrize(
    "error",
    [AttributeError, ImportError, EOFError, pickle.UnpicklingError, ValueError, TypeError],
)
def test_an_unreadable_file_is_an_empty_one(
    error: type[Exception], numbas: pytest.MonkeyPatch
) -> None:
    def broken(self: Any, *arguments: Any) -> Any:
        raise error("cut off")

    numbas.setattr(IndexDataCacheFile, "_load_index", broken)
    numbas.setattr(IndexDataCacheFile, "load", broken)
    compile_what_cannot_be_read()
    file = IndexDataCacheFile.__new__(IndexDataCacheFile)
    assert file._load_index() == {}
    assert file.load(("int64",)) is None


def test_what_can_be_read_is_read_and_other_errors_are_not_hidden(
    numbas: pytest.MonkeyPatch,
) -> None:
    def load(self: Any, key: Any) -> Any:
        if key == "full":
            raise OSError("no space")
        return f"kernel of {key}"

    numbas.setattr(IndexDataCacheFile, "load", load)
    compile_what_cannot_be_read()
    file = IndexDataCacheFile.__new__(IndexDataCacheFile)
    assert file.load("int64") == "kernel of int64"
    with pytest.raises(OSError, match="no space"):
        file.load("full")


def test_indices_are_not_shared(numbas: pytest.MonkeyPatch) -> None:
    def broken(self: Any) -> Any:
        raise EOFError

    numbas.setattr(IndexDataCacheFile, "_load_index", broken)
    compile_what_cannot_be_read()
    file = IndexDataCacheFile.__new__(IndexDataCacheFile)
    file._load_index()["key"] = "kernel"
    assert file._load_index() == {}


def test_a_kernel_is_loaded_with_the_runtime_and_without_the_compiler(
    numbas: pytest.MonkeyPatch,
) -> None:
    def numbas_own(self: Any, sig: Any, target_context: Any) -> Any:
        target_context.refresh()
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    ready: list[object] = []
    numbas.setattr(Cache, "load_overload", numbas_own)
    numbas.setattr(quick_loading, "rtsys", SimpleNamespace(initialize=ready.append))
    load_without_compiler()

    class Kept:
        guarded = False

        def _guard_against_spurious_io_errors(self) -> Kept:
            return self

        def __enter__(self) -> None:
            self.guarded = True

        def __exit__(self, *_: object) -> None:
            self.guarded = False

        def _load_overload(self, sig: str, context: object) -> tuple[str, object]:
            assert self.guarded
            return sig, context

    context = object()  # it has no `refresh`: the compiler is not made ready
    assert Cache.load_overload(Kept(), "int64", context) == ("int64", context)
    assert ready == [context]


def test_a_numba_that_loads_in_another_way_is_left_alone(numbas: pytest.MonkeyPatch) -> None:
    def another_way(self: Any, sig: Any, target_context: Any) -> Any:
        return self._load_overload(sig, target_context)

    numbas.setattr(Cache, "load_overload", another_way)
    load_without_compiler()
    assert Cache.load_overload is another_way
