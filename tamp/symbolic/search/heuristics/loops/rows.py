"""Compressed sparse rows (CSR): lists of lists as two lists, the form that compiled code takes; and
what makes new ones.

The functions are Python that numba can compile, as those in kernels.py. Compiled, all lists are
arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, chain
from typing import NamedTuple, TypeVar

Integers = Sequence[int]
Reals = Sequence[float]
T = TypeVar("T")


class CsrRows(NamedTuple):
    """Row i is values[starts[i] : starts[i + 1]]."""

    starts: Integers
    values: Integers

    def lists(self) -> list[list[int]]:
        """Return the rows as lists."""
        values, starts = list(map(int, self.values)), self.starts
        return [values[starts[i] : starts[i + 1]] for i in range(len(starts) - 1)]


def csr_rows(lists: Sequence[Sequence[int]]) -> CsrRows:
    """Build compressed rows from lists."""
    return CsrRows(list(accumulate(map(len, lists), initial=0)), list(chain.from_iterable(lists)))


def full(size: int, value: T) -> list[T]:
    """Return so many times the value. Compiled it makes an array, so does `count_up`."""
    return [value] * size


def count_up(size: int) -> list[int]:
    """Return 0, 1, 2, ..."""
    return list(range(size))


def transposed(rows: CsrRows, size: int) -> CsrRows:
    """Transpose: row j of the result, of so many, lists the rows that contain j, in ascending
    order.
    """
    ends = full(size + 1, 0)
    for j in rows.values:
        ends[j + 1] += 1
    for j in range(size):
        ends[j + 1] += ends[j]
    places, listed = ends[:-1].copy(), full(len(rows.values), 0)
    for i in range(len(rows.starts) - 1):
        for k in range(rows.starts[i], rows.starts[i + 1]):
            j = rows.values[k]
            listed[places[j]] = i
            places[j] += 1
    return CsrRows(ends, listed)


def appended(rows: CsrRows, at: Integers, what: Integers, size: int) -> CsrRows:
    """Append what[k] to row at[k], in this order, in so many rows; those beyond the given ones
    start empty.
    """
    ends = full(size + 1, 0)
    count = len(rows.starts) - 1
    for i in range(count):
        ends[i + 1] = rows.starts[i + 1] - rows.starts[i]
    for i in at:
        ends[i + 1] += 1
    for i in range(size):
        ends[i + 1] += ends[i]
    places, joined = ends[:-1].copy(), full(ends[-1], 0)
    for i in range(count):
        for k in range(rows.starts[i], rows.starts[i + 1]):
            joined[places[i]] = rows.values[k]
            places[i] += 1
    for k in range(len(at)):
        joined[places[at[k]]] = what[k]
        places[at[k]] += 1
    return CsrRows(ends, joined)


def incremented(values: Reals, at: Integers, by: Reals, more: int) -> list[float]:
    """Return the values with by[k] added at at[k], and so many zeros behind them."""
    result = full(len(values) + more, 0.0)
    for i in range(len(values)):
        result[i] = values[i]
    for k in range(len(at)):
        result[at[k]] += by[k]
    return result
