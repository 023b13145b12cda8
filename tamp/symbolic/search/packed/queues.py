"""The open lists over the two arrays of the packed search, for numba: what `open_lists` does.

An expanded state pushes its successors as a few groups of one key each, and a list holds groups:
the member whose turn it is stands for the others, which follow in their order. A member takes 16
bytes and no place in a heap; most of them never get their turn.

In Python that numba compiles, see `compiled`.
"""

# pyright: basic

from __future__ import annotations

import math

from tamp.symbolic.search.packed.basics import (
    DETOUR,
    GOAL_ENTRY,
    GOAL_NODE,
    GROUPS,
    MEMBERS,
    PUSHED,
    SIZES,
    heap_push,
    heap_sift,
)

RECENT = 8
"""Classes of successors that a new one is compared with; more classes than need be do no harm."""


def list_push(ints, reals, space, k, key, tie, group):
    """Push a group onto the k-th open list, under its first member's tie."""
    base, size = k * space.groups, ints[SIZES + k]
    keys, ties, items = space.keys + base, space.ties + base, space.items + base
    heap_push(ints, reals, keys, ties, items, size, key, tie, group)
    ints[SIZES + k] += 1


def tie_of(ints, space, group, member, greedy):
    """Return what decides among equal keys when a member's turn has come."""
    order = ints[space.members + member] >> 32
    return ints[space.group_base + group] + (order << DETOUR if greedy else order)


def add_group(ints, reals, space, k, key, parent, first, last, base, greedy):
    """Push the members from `first` up to `last` as a group onto the k-th open list."""
    group = ints[GROUPS]
    ints[GROUPS] += 1
    ints[space.group_parent + group], ints[space.group_base + group] = parent, base
    ints[space.group_next + group], ints[space.group_end + group] = first, last
    tie = tie_of(ints, space, group, first, greedy)
    list_push(ints, reals, space, k, key, tie, group)


def add_member(ints, reals, space, order, operator, reached):
    """Note a successor: its order among those of its parent, the operator, the cost with prices."""
    member = ints[MEMBERS]
    ints[MEMBERS] += 1
    ints[space.members + member] = order << 32 | (operator - GOAL_ENTRY)
    reals[space.member_cost + member] = reached
    return member


def push_goal(ints, reals, t, space, node, cost, key, greedy):
    """Push a goal state that costs something to derive: it waits for what is cheaper than it."""
    kinds = t.heuristics
    ints[PUSHED] += 1
    ints[GOAL_NODE] = node
    member = add_member(ints, reals, space, 0, GOAL_ENTRY, cost)
    for k in (0, kinds):
        if k == 0 or ints[SIZES + k]:
            add_group(ints, reals, space, k, key, node, member, member + 1, ints[PUSHED], greedy)


def turn(ints, reals, t, space, greedy):
    """Choose the open list whose turn it is, and count it; -1 when all are empty."""
    kinds = t.heuristics
    capacity = space.groups
    turns = SIZES + 2 * kinds
    usual, chosen = -1, -1

    for k in range(kinds):
        if ints[SIZES + k] and (usual < 0 or ints[turns + k] < ints[turns + usual]):
            usual = k
    for k in range(kinds, 2 * kinds):
        if ints[SIZES + k] and (chosen < 0 or ints[turns + k] < ints[turns + chosen]):
            chosen = k
    if chosen >= 0 and not greedy and ints[SIZES + chosen - kinds]:
        usually = reals[space.keys + (chosen - kinds) * capacity]
        dear = reals[space.keys + chosen * capacity] > 2.0 * usually
        chosen = -1 if dear else chosen  # preferred, but by far too dear: a price was learned
    if chosen < 0 or (usual >= 0 and ints[turns + chosen] > ints[turns + usual]):
        chosen = usual
    if chosen >= 0:
        ints[turns + chosen] += 1
    return chosen


def pop(ints, reals, space, k, greedy):
    """Pop the first member of the k-th open list: its parent, and the member."""
    base = k * space.groups
    keys, ties, items = space.keys + base, space.ties + base, space.items + base
    group = ints[items]
    member = ints[space.group_next + group]
    ints[space.group_next + group] += 1

    if member + 1 < ints[space.group_end + group]:
        tie = tie_of(ints, space, group, member + 1, greedy)
        heap_sift(ints, reals, keys, ties, items, ints[SIZES + k], reals[keys], tie, group)
    else:
        ints[SIZES + k] -= 1
        last = ints[SIZES + k]
        key, tie, item = reals[keys + last], ints[ties + last], ints[items + last]
        heap_sift(ints, reals, keys, ties, items, last, key, tie, item)
    return ints[space.group_parent + group], member


def collect(ints, reals, x, found, classes, order, i, reached, step, dearer, paid):
    """Collect a successor into the class of those that look alike to all lists; count classes."""
    c = classes - 1
    while c >= 0 and c >= classes - RECENT:
        if (
            reals[x.class_dearer + c] == dearer
            and reals[x.class_paid + c] == paid
            and reals[x.class_step + c] == step
        ):
            break
        c -= 1
    if c < 0 or c < classes - RECENT:
        c = classes
        classes += 1
        ints[x.class_size + c] = 0
        reals[x.class_dearer + c], reals[x.class_paid + c] = dearer, paid
        reals[x.class_step + c] = step
    ints[x.class_size + c] += 1
    ints[x.found + found], ints[x.found_order + found] = i, order
    ints[x.found_class + found], reals[x.found_cost + found] = c, reached
    return classes


def push(ints, reals, t, x, space, node, found, helpful, classes, base, weight):
    """Push what was collected of a state onto the lists of all heuristics, under its estimates.

    The first `helpful` of those found are by preferred operators.
    """
    kinds, greedy, cost = t.heuristics, weight == math.inf, reals[space.cost + node]
    at = ints[MEMBERS]
    for c in range(classes):
        ints[x.class_at + c] = at
        at += ints[x.class_size + c]
    for f in range(found):
        c = ints[x.found_class + f]
        ints[MEMBERS] = ints[x.class_at + c]
        add_member(
            ints, reals, space,
            ints[x.found_order + f], ints[x.found + f], reals[x.found_cost + f],
        )  # fmt: skip
        ints[x.class_at + c] += 1
    ints[MEMBERS] = at

    for k in range(kinds):
        h, planned = reals[space.values + node * kinds + k], ints[t.kinds + k] == 0
        for c in range(classes):
            extra = reals[x.class_dearer + c]
            if planned:
                extra = extra - reals[x.class_paid + c]
            key = h + extra if greedy else cost + reals[x.class_step + c] + extra + weight * h
            last = ints[x.class_at + c]
            add_group(
                ints, reals, space, k, key, node, last - ints[x.class_size + c], last, base, greedy
            )
        first = ints[MEMBERS]
        for f in range(helpful):
            c = ints[x.found_class + f]
            extra = reals[x.class_dearer + c]
            if planned:
                extra = extra - reals[x.class_paid + c]
            if extra <= reals[t.costs + ints[x.found + f]]:
                add_member(
                    ints, reals, space,
                    ints[x.found_order + f], ints[x.found + f], reals[x.found_cost + f],
                )  # fmt: skip
        if ints[MEMBERS] > first:
            key = h if greedy else cost + weight * h
            add_group(ints, reals, space, kinds + k, key, node, first, ints[MEMBERS], base, greedy)
