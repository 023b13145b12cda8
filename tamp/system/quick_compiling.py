"""Shortcuts through numba's compiler: the same kernels, compiled in half of the time.

Each changes classes of numba's own, and leaves them as they are where a numba of another version
lacks what the shortcut needs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any

from numba.core import config
from numba.core.codegen import CPUCodeLibrary, JITCodeLibrary, JITCPUCodegen
from numba.core.targetconfig import TargetConfig

WRAPPERS = ("_ZN7cpython", "cfunc.")
"""How the names of those functions of a library begin that something other than compiled code
calls."""


NEEDED = {
    "_optimize_final_module",
    "_finalize_final_module",
    "_finalize_dynamic_globals",
    "_verify_declare_only_symbols",
    "get_defined_functions",
    "get_pointer_to_function",
    "serialize_using_object_code",
}
"""What this changes, or calls, of numba's code libraries."""


def compare_quickly() -> None:
    """Give numba's options a hash and a comparison of the same results in a tenth of the time.

    Typing looks every `a[i]` up in 14 tables whose keys hold the options, and each look compares
    all of those, one property at a time: a sixth of what compiling takes.
    """
    if not {"_values", "options", "values"} <= {*dir(TargetConfig)}:
        return

    hashes: dict[type, int] = {}

    def quick_hash(self: Any) -> int:
        kind = type(self)
        if kind not in hashes:
            hashes[kind] = hash(tuple(sorted(self.values())))  # numba's own: of the names alone
        return hashes[kind]

    def quick_eq(self: Any, other: object) -> Any:
        if not isinstance(other, TargetConfig):
            return NotImplemented
        if type(self) is type(other) and self._values == other._values:
            return True
        return _all_values(self) == _all_values(other)

    TargetConfig.__hash__ = quick_hash
    TargetConfig.__eq__ = quick_eq


def _all_values(config: Any) -> dict[str, Any]:
    """Return `TargetConfig.values` of an instance: what is set, and the defaults of the rest."""
    kind = type(config)
    if kind not in _DEFAULTS:
        _DEFAULTS[kind] = {name: option.default for name, option in kind.options.items()}
    return {**_DEFAULTS[kind], **config._values}


_DEFAULTS: dict[type, dict[str, Any]] = {}


def optimize_with_one_manager() -> None:
    """Run numba's passes over the functions of a module with one manager of passes, and over those
    alone that have a body: most of what a module names it only declares.
    """
    timed = getattr(config, "LLVM_PASS_TIMINGS", False)
    if timed or "_optimize_functions" not in dir(CPUCodeLibrary):
        return

    def optimize_functions(self: Any, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout
        passes, builder = self._codegen._function_pass_manager()
        for function in ll_module.functions:
            if not function.is_declaration:
                passes.run(function, builder)

    CPUCodeLibrary._optimize_functions = optimize_functions


@contextmanager
def code_when_called() -> Iterator[None]:
    """Optimize in full and generate machine code, within this context, of those functions alone
    that Python calls.
    """
    before, _KEEPING_BACK[0] = _KEEPING_BACK[0], True
    try:
        yield
    finally:
        _KEEPING_BACK[0] = before


_KEEPING_BACK = [False]


def generate_code_when_called() -> None:
    """Give numba's code libraries what `code_when_called` asks for.

    numba optimizes every function in full and generates its machine code, also of those that are
    only linked, as LLVM's intermediate representation, into the functions that call them, where
    they are optimized again: a quarter of what compiling takes. For these numba's cheap passes
    do, and code is kept back until somebody asks for an address in one, or for its machine code.
    """
    if not {*dir(JITCodeLibrary)} >= NEEDED:
        return

    generate = _with_environments(JITCodeLibrary._finalize_final_module)
    optimize = JITCodeLibrary._optimize_final_module
    address = JITCodeLibrary.get_pointer_to_function
    machine_code = JITCodeLibrary.serialize_using_object_code

    def optimize_if_called(self: Any) -> None:
        if not _KEEPING_BACK[0] or _is_called(self):
            optimize(self)
        else:
            _optimize_cheaply(self)

    def generate_if_called(self: Any) -> None:
        if not _KEEPING_BACK[0] or _is_called(self):
            generate(self)
            return
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized, self._kept_back = True, True

    def generate_if_kept_back(self: Any) -> None:
        if _is_kept_back(self):
            self._kept_back = False
            generate(self)

    @wraps(address)
    def generate_for_address(self: Any, name: str) -> int:
        # numba asks each for its wrapper, and takes 0 where there is none
        if _is_kept_back(self) and name not in _defined(self):
            return 0
        generate_if_kept_back(self)
        return address(self, name)

    @wraps(machine_code)
    def generate_for_machine_code(self: Any) -> Any:
        generate_if_kept_back(self)
        return machine_code(self)

    JITCodeLibrary._optimize_final_module = optimize_if_called
    JITCodeLibrary._finalize_final_module = generate_if_called
    JITCodeLibrary.get_pointer_to_function = generate_for_address
    JITCodeLibrary.serialize_using_object_code = generate_for_machine_code


def _optimize_cheaply(library: Any) -> None:
    """Run the first of the two rounds of passes that numba runs."""
    passes, builder = library._codegen._module_pass_manager(
        loop_vectorize=False, slp_vectorize=False, opt=0, cost="cheap"
    )
    passes.run(library._final_module, builder)


def _defined(library: Any) -> list[str]:
    return [function.name for function in library.get_defined_functions()]


def _is_called(library: Any) -> bool:
    """Check whether something other than compiled code calls a function of a code library."""
    # one that is loaded from a cache has machine code, and no functions to see
    names = _defined(library)
    return not names or any(name.startswith(WRAPPERS) for name in names)


def _is_kept_back(library: Any) -> bool:
    library._ensure_finalized()
    return getattr(library, "_kept_back", False)


def _with_environments(generate: Callable[[Any], None]) -> Callable[[Any], None]:
    """Return a generator of machine code after which the environments of what was linked into it
    are set: numba sets each when its function is compiled, which may be before there is code.
    """
    set_environment = JITCPUCodegen.set_env
    waiting: dict[str, Any] = {}

    def set_if_there(self: Any, env_name: str, env: Any) -> None:
        if self._engine.get_global_value_address(env_name):
            set_environment(self, env_name, env)
        else:
            waiting[env_name] = env

    def generate_and_set(library: Any) -> None:
        generate(library)
        environments = dict(waiting)
        waiting.clear()
        for name, environment in environments.items():
            set_if_there(library.codegen, name, environment)

    JITCPUCodegen.set_env = set_if_there
    return generate_and_set
