"""Heaps, and what holds in a state, over the two arrays of the packed search, for numba.

In Python that numba compiles, see `compiled`.
"""

# pyright: basic

from __future__ import annotations

NODES, GROUPS, MEMBERS, PUSHED, EXPANDED, EVALUATED, AT, GOAL_NODE = 0, 1, 2, 3, 4, 5, 6, 7
"""Places of the counters."""

PROGRESS = 8
"""Place of the number of states that were expanded when an estimate was a new low."""

UNTIL, LIMIT, BOOST, ACHIEVERS, RANDOM, ENDURANCE, FORGIVING = 9, 10, 11, 12, 13, 14, 15
"""Places of what is given: expanded states until a pause, at most, turns after progress, whether
what reaches a landmark is preferred, the state of the generator that shuffles (0: none does),
expanded states since progress at most, and whether estimates forgive the price of a guard whose
facts the relaxed plan removes."""

SIZES = 16
"""From here on the sizes of the open lists, the usual and the preferred ones, then their turns."""


GOAL_ENTRY = -2
DETOUR, ROOT = 21, 41
"""As in `open_lists`."""


def heap_push(ints, reals, keys, ties, items, size, key, tie, item):
    """Push an item onto a heap of so many: the lowest key is first, among equals the lowest tie."""
    k = size
    while k > 0:
        parent = (k - 1) >> 1
        other = reals[keys + parent]
        if other < key or (other == key and ints[ties + parent] <= tie):
            break
        reals[keys + k] = other
        ints[ties + k] = ints[ties + parent]
        ints[items + k] = ints[items + parent]
        k = parent
    reals[keys + k] = key
    ints[ties + k] = tie
    ints[items + k] = item


def heap_sift(ints, reals, keys, ties, items, size, key, tie, item):
    """Put an item in the place of the first of a heap of so many, and the heap in order."""
    k = 0
    while True:
        child = 2 * k + 1
        if child >= size:
            break
        if child + 1 < size:
            one, two = reals[keys + child], reals[keys + child + 1]
            if two < one or (two == one and ints[ties + child + 1] < ints[ties + child]):
                child += 1
        other = reals[keys + child]
        if not (other < key or (other == key and ints[ties + child] < tie)):
            break
        reals[keys + k] = other
        ints[ties + k] = ints[ties + child]
        ints[items + k] = ints[items + child]
        k = child
    reals[keys + k] = key
    ints[ties + k] = tie
    ints[items + k] = item


def heap_pop(ints, reals, keys, ties, items, size):
    """Remove the first of a heap of so many: its item is read before."""
    last = size - 1
    key, tie, item = reals[keys + last], ints[ties + last], ints[items + last]
    heap_sift(ints, reals, keys, ties, items, last, key, tie, item)


def holds(ints, starts, words, need, absent, i, state):
    """Check a condition in a state."""
    for k in range(ints[starts + i], ints[starts + i + 1]):
        word = ints[state + ints[words + k]]
        if word & ints[need + k] != ints[need + k] or word & ints[absent + k] != 0:
            return False
    return True


def has(ints, state, fact):
    """Check that a fact is in a state."""
    return (ints[state + (fact >> 6)] >> (fact & 63)) & 1


def contains(ints, starts, facts, i, state):
    """Check that a state has all facts of row i."""
    for k in range(ints[starts + i], ints[starts + i + 1]):
        if not has(ints, state, ints[facts + k]):
            return False
    return True
