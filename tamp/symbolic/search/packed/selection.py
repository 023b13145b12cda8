"""Selection of the loop: plain Python at first, the compiled one once it pays.

Both find the same plans, so the choice is about time alone.
"""

from __future__ import annotations

from pathlib import Path

from tamp.symbolic.search.compilation_threshold import CompilationThreshold, are_kept, digest_of

LOAD_THRESHOLD = 2_000_000
"""Entries of relaxed tasks, over all states that plain Python evaluated in this process, before the
compiled loop is loaded: about as long as loading takes."""

LOAD_BESIDE_NUMBA_THRESHOLD = 100_000
"""The same where numba has been imported already, as for any scene: loading takes 40 ms then."""

COMPILE_THRESHOLD = 4_000_000
"""Entries before it is compiled, where that has not been done: a second and a half, a sixth of what
that takes once, while every later run of such a task is the quicker for it."""

FOLDER = Path(__file__).resolve().parent
SOURCES = ("basics", "estimates", "states", "queues", "loops")
KEPT = ("run", "eliminate")


THRESHOLD = CompilationThreshold(
    "tamp.symbolic.search.packed.compiled",
    LOAD_THRESHOLD,
    COMPILE_THRESHOLD,
    LOAD_BESIDE_NUMBA_THRESHOLD,
)


def digest() -> str:
    """Return what names compiled loops: their sources' hash."""
    return digest_of(FOLDER, SOURCES)


def compiled_before() -> bool:
    """Check that numba's cache beside the sources has all loops, made of these sources."""
    return are_kept(FOLDER, SOURCES, KEPT)


def pays(entries: int) -> bool:
    """Check whether the compiled loop pays, after so much more work in plain Python."""
    return THRESHOLD.pays(entries, compiled_before)
