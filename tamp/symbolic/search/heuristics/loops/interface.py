"""The interface of the kernels: the inner loops of the heuristics, plain or compiled."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tamp.symbolic.search.heuristics.loops.rows import CsrRows, Integers, Reals, csr_rows

FOLDER = Path(__file__).resolve().parent
SOURCES = ("rows", "kernels", "landmark_queue", "landmark_cuts")
KEPT = ("explore", "relaxed_plan", "landmark_cut", "transposed", "appended", "incremented")


@dataclass(frozen=True, slots=True)
class Kernels:
    """The inner loops, and what makes the lists that they take."""

    explore: Callable[
        [CsrRows, CsrRows, CsrRows, Reals, Integers, Reals, Integers, bool], tuple[Reals, Integers]
    ]
    relaxed_plan: Callable[
        [Reals, Integers, CsrRows, CsrRows, Reals, Integers, int, Integers, int],
        tuple[float, Integers],
    ]
    landmark_cut: Callable[
        [CsrRows, CsrRows, CsrRows, CsrRows, Reals, Integers, Integers, CsrRows, int], float
    ]
    transposed: Callable[[CsrRows, int], CsrRows]
    appended: Callable[[CsrRows, Integers, Integers, int], CsrRows]
    incremented: Callable[[Reals, Integers, Reals, int], Reals]
    integers: Callable[[Sequence[int]], Integers]
    reals: Callable[[Sequence[float]], Reals]

    def rows(self, lists: Sequence[Sequence[int]]) -> CsrRows:
        """Return CsrRows from lists."""
        made = csr_rows(lists)
        return CsrRows(self.integers(made.starts), self.integers(made.values))
