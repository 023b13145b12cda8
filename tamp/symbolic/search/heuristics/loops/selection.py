"""Selection of the kernels: plain Python at first, compiled ones once they pay, or where they are
loaded anyway.

numba takes longer to load than a small task to solve, and much longer to compile. Both give the
same numbers.
"""

from __future__ import annotations

from tamp.symbolic.search.compilation_threshold import CompilationThreshold, are_kept
from tamp.symbolic.search.heuristics.loops import kernels, landmark_cuts, rows
from tamp.symbolic.search.heuristics.loops.interface import FOLDER, KEPT, SOURCES, Kernels

LOAD_THRESHOLD = 2_000_000
"""Entries that plain Python goes through before the compiled loops are loaded: about as long as
loading takes.
"""

LOAD_BESIDE_NUMBA_THRESHOLD = 100_000
"""The same where numba has been imported already, as for any scene: loading takes 40 ms then."""

COMPILE_THRESHOLD = 2_000_000
"""Entries before they are compiled, where that has not been done yet: half a second, a fifth of
what that takes once, while every later run of such a task is the quicker for it.
"""

PLAIN = Kernels(
    explore=kernels.explore,
    relaxed_plan=kernels.relaxed_plan,
    landmark_cut=landmark_cuts.landmark_cut,
    transposed=rows.transposed,
    appended=rows.appended,
    incremented=rows.incremented,
    integers=list,
    reals=list,
)
"""Plain Python."""


THRESHOLD = CompilationThreshold(
    "tamp.symbolic.search.heuristics.loops.compiled",
    LOAD_THRESHOLD,
    COMPILE_THRESHOLD,
    LOAD_BESIDE_NUMBA_THRESHOLD,
)


def load() -> Kernels:
    """Load the compiled kernels now, and compile them where that has not been done."""
    from tamp.symbolic.search.heuristics.loops.compiled import COMPILED

    return COMPILED


def load_kept() -> None:
    """Load the compiled kernels where that is all there is to do: for who has numba loaded
    anyway.
    """
    if compiled_before():
        load()


def prepare() -> None:
    """Compile the kernels where that has not been done, before processes start that would each
    do it.
    """
    if not compiled_before():
        load()


def compiled_before() -> bool:
    """Check that numba's cache beside the sources has all kernels, made of these sources."""
    return are_kept(FOLDER, SOURCES, KEPT)


def choose(entries: int) -> Kernels:
    """Choose the kernels for a piece of work that goes through so many entries."""
    return load() if THRESHOLD.pays(entries, compiled_before) else PLAIN
