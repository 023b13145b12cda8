"""Lists of lists of integers as two arrays, the form in which compiled code takes them."""

# pyright: basic

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import accumulate, chain, pairwise

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

Integers = NDArray[np.int64]
Reals = NDArray[np.float64]

_I = types.int64[::1]


def integers(values: Iterable[int]) -> Integers:
    """An array of them."""
    return np.fromiter(values, dtype=np.int64)


def reals(values: Sequence[float]) -> Reals:
    """An array of them."""
    return np.array(values, dtype=np.float64)


def raised(values: Reals, at: Sequence[int], by: Sequence[float]) -> Reals:
    """The values, those at the places `at` raised, as often as a place is named."""
    if not at:
        return values
    result = values.copy()
    np.add.at(result, integers(at), reals(by))
    return result


def extended(values: Reals, more: int) -> Reals:
    """The values and so many zeros."""
    return np.concatenate((values, np.zeros(more)))


@dataclass(frozen=True, slots=True)
class Rows:
    """Row i is values[starts[i] : starts[i + 1]]."""

    starts: Integers
    values: Integers

    @classmethod
    def of(cls, rows: Sequence[Sequence[int]]) -> Rows:
        """From lists."""
        return cls(integers(accumulate(map(len, rows), initial=0)), integers(chain.from_iterable(rows)))

    def __len__(self) -> int:
        return len(self.starts) - 1

    def empty(self) -> list[int]:
        """The numbers of the rows without entries."""
        return np.flatnonzero(np.diff(self.starts) == 0).tolist()

    def lists(self) -> list[list[int]]:
        """As lists."""
        values, starts = self.values.tolist(), self.starts.tolist()
        return [values[first:last] for first, last in pairwise(starts)]

    def transposed(self, rows: int) -> Rows:
        """Row j of the result, of so many, lists the rows that contain j, in ascending order."""
        return Rows(*_transpose(self.starts, self.values, rows))

    def with_more(self, at: Sequence[int], what: Sequence[int], rows: int) -> Rows:
        """what[k] appended to row at[k], in this order, in so many rows; those beyond the present ones start empty."""
        return Rows(*_append(self.starts, self.values, integers(at), integers(what), rows))


@njit(types.Tuple((_I, _I))(_I, _I, types.int64), cache=True, nogil=True)
def _transpose(starts, values, rows):
    """See `Rows.transposed`."""
    ends = np.zeros(rows + 1, dtype=np.int64)
    for j in values:
        ends[j + 1] += 1
    for j in range(rows):
        ends[j + 1] += ends[j]
    places, listed = ends[:-1].copy(), np.empty(values.size, dtype=np.int64)
    for i in range(starts.size - 1):
        for k in range(starts[i], starts[i + 1]):
            j = values[k]
            listed[places[j]] = i
            places[j] += 1
    return ends, listed


@njit(types.Tuple((_I, _I))(_I, _I, _I, _I, types.int64), cache=True, nogil=True)
def _append(starts, values, at, what, rows):
    """See `Rows.with_more`."""
    ends = np.zeros(rows + 1, dtype=np.int64)
    known = starts.size - 1
    for i in range(known):
        ends[i + 1] = starts[i + 1] - starts[i]
    for i in at:
        ends[i + 1] += 1
    for i in range(rows):
        ends[i + 1] += ends[i]
    places, joined = ends[:-1].copy(), np.empty(values.size + what.size, dtype=np.int64)
    for i in range(known):
        for k in range(starts[i], starts[i + 1]):
            joined[places[i]] = values[k]
            places[i] += 1
    for k in range(at.size):
        joined[places[at[k]]] = what[k]
        places[at[k]] += 1
    return ends, joined
