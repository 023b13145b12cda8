"""Heaps, and what holds in a state, over the two arrays of the packed search, for numba.

In Python that numba compiles, see `compiled`.
"""

# pyright: basic

from __future__ import annotations

NODES, ENTRIES, PUSHED, EXPANDED, EVALUATED, AT, GOAL_NODE = 0, 1, 2, 3, 4, 5, 6
"""Places of the counters."""

UNTIL, LIMIT, BOOST, ACHIEVERS, RANDOM = 7, 8, 9, 10, 11
"""Places of what is given: expanded states until a pause, at most, turns after progress, whether
what reaches a landmark is preferred, and the state of the generator that shuffles; 0: none does."""

SIZES = 12
"""From here on the sizes of the open lists, the usual and the preferred ones, then their turns."""


GOAL_ENTRY = -2
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


def list_push(ints, reals, space, k, key, tie, entry):
    """Push an entry onto the k-th open list."""
    base, size = k * space.entries, ints[SIZES + k]
    keys, ties, items = space.keys + base, space.ties + base, space.items + base
    heap_push(ints, reals, keys, ties, items, size, key, tie, entry)
    ints[SIZES + k] += 1


def heap_pop(ints, reals, keys, ties, items, size):
    """Remove the first of a heap of so many: its item is read before."""
    last = size - 1
    key, tie, item = reals[keys + last], ints[ties + last], ints[items + last]

    k = 0
    while True:
        child = 2 * k + 1
        if child >= last:
            break
        if child + 1 < last:
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


def push_goal(ints, reals, t, space, node, cost, key):
    """Push a goal state that costs something to derive: it waits for what is cheaper than it."""
    kinds = t.heuristics
    entry = ints[ENTRIES]
    ints[ENTRIES] += 1
    ints[PUSHED] += 1
    ints[GOAL_NODE] = node

    reals[space.entry_cost + entry], ints[space.entry_parent + entry] = cost, node
    ints[space.entry_operator + entry] = GOAL_ENTRY
    for k in (0, kinds):
        if k == 0 or ints[SIZES + k]:
            list_push(ints, reals, space, k, key, ints[PUSHED], entry)
