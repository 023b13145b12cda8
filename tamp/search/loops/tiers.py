"""Which loops run: plain Python at first, compiled ones once they pay, or where they are loaded anyway.

numba takes longer to load than a small task to solve. Both give the same numbers.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tamp.search.loops import kernels, rows
from tamp.search.loops.rows import Integers, Reals, Rows

ENOUGH = 2_000_000
"""Entries that plain Python goes through before the compiled loops are loaded: about as long as loading takes."""


@dataclass(frozen=True, slots=True)
class Loops:
    """The loops, and what makes the lists that they take."""

    explore: Callable[[Rows, Rows, Rows, Reals, Integers, Reals, Integers, bool], tuple[Reals, Integers]]
    relaxed_plan: Callable[[Reals, Integers, Rows, Rows, Reals, Integers, int, Integers, int], tuple[float, Integers]]
    landmark_cut: Callable[[Rows, Rows, Rows, Rows, Reals, Integers, Integers, Rows, int], float]
    transposed: Callable[[Rows, int], Rows]
    appended: Callable[[Rows, Integers, Integers, int], Rows]
    raised: Callable[[Reals, Integers, Reals, int], Reals]
    integers: Callable[[Sequence[int]], Integers]
    reals: Callable[[Sequence[float]], Reals]

    def rows(self, lists: Sequence[Sequence[int]]) -> Rows:
        """Rows from lists."""
        made = rows.rows_of(lists)
        return Rows(self.integers(made.starts), self.integers(made.values))


PLAIN = Loops(
    explore=kernels.explore,
    relaxed_plan=kernels.relaxed_plan,
    landmark_cut=kernels.landmark_cut,
    transposed=rows.transposed,
    appended=rows.appended,
    raised=rows.raised,
    integers=list,
    reals=list,
)
"""Plain Python."""


class _Meter:
    """What plain Python has gone through in this process. It decides about time alone, never about a result."""

    entries = 0


_METER = _Meter()


def choose(entries: int) -> Loops:
    """The loops for a piece of work that goes through so many entries."""
    _METER.entries += entries
    if _METER.entries > ENOUGH or "tamp.search.loops.compiled" in sys.modules:
        from tamp.search.loops.compiled import LOOPS

        return LOOPS
    return PLAIN
