"""The loop of lazy search over packed states, for numba: what `lazy` and `open_lists` do.

In Python that numba compiles, see `compiled`. Ties are broken alike, so that it does not matter
for the plan which of the two runs.
"""

# pyright: basic

from __future__ import annotations

import math

from tamp.symbolic.search.packed.basics import (
    ACHIEVERS,
    AT,
    BOOST,
    ENTRIES,
    EVALUATED,
    EXPANDED,
    GOAL_ENTRY,
    GOAL_NODE,
    LIMIT,
    NODES,
    PUSHED,
    RANDOM,
    SIZES,
    UNTIL,
    heap_pop,
    list_push,
)  # fmt: skip
from tamp.symbolic.search.packed.estimates import (
    explore,
    landmarks,
    paid,
    relax,
    relaxed_plan,
    trigger,
)
from tamp.symbolic.search.packed.states import (
    achievers,
    applicable,
    apply,
    close_state,
    covers,
    place_of,
    preferred,
    shuffle,
)

EXHAUSTED, GOAL, GROW, PAUSE, FOUND, LIMITED = 0, 1, 2, 3, 4, 5
"""Why the loop stops: no entry is left, a goal state came, arrays are full, it is time to look
around, the goal state's turn has come, no more states may be expanded."""


def pop(ints, reals, t, space, greedy):
    """Pop the first entry of the open list whose turn it is; -1 when all are empty."""
    kinds = t.heuristics
    capacity = space.entries
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
    if chosen < 0:
        return -1
    ints[turns + chosen] += 1
    entry = ints[space.items + chosen * capacity]
    heap_pop(
        ints,
        reals,
        space.keys + chosen * capacity,
        space.ties + chosen * capacity,
        space.items + chosen * capacity,
        ints[SIZES + chosen],
    )
    ints[SIZES + chosen] -= 1
    return entry


def push(ints, reals, t, r, x, space, node, i, reached, order, prefer, weight):
    """Push a successor onto the lists of all heuristics, under its parent's estimates."""
    kinds, greedy = t.heuristics, weight == math.inf
    cost, step = reals[space.cost + node], reals[t.costs + i]
    entry = ints[ENTRIES]
    ints[ENTRIES] += 1
    reals[space.entry_cost + entry], ints[space.entry_parent + entry] = reached, node
    ints[space.entry_operator + entry] = i

    dearer = reached - cost - step
    for k in range(kinds):
        h = reals[space.values + node * kinds + k]
        extra = dearer
        if dearer != 0.0 and ints[t.kinds + k] == 0 and ints[x.in_plan + i]:
            extra = dearer - paid(ints, reals, r, x, i)
        key = h + extra if greedy else cost + step + extra + weight * h
        list_push(ints, reals, space, k, key, order, entry)
        if prefer and extra <= step:
            key = h if greedy else cost + weight * h
            list_push(ints, reals, space, kinds + k, key, order, entry)


def evaluate(ints, reals, t, r, x, space, node, parent):
    """Evaluate a state by all heuristics, its relaxed plan into x.plan; return the plan's length.

    A state that comes again keeps its values.
    """
    known = ints[space.evaluated + node]
    length = 0
    for k in range(t.heuristics):
        at = node * t.heuristics + k
        if ints[t.kinds + k] == 0:
            relax(ints, reals, t, r, x, x.closed)
            explore(ints, reals, t, r, x, x.closed)
            reals[space.values + at], length = relaxed_plan(ints, reals, t, r, x)
        elif not known:
            reals[space.values + at] = landmarks(ints, reals, r, x, space, x.closed, node, parent)
    if not known:
        ints[space.evaluated + node] = 1
        ints[EVALUATED] += 1
    for k in range(length):
        ints[x.in_plan + ints[x.plan + k]] = 1
    return length


def expand(ints, reals, t, r, x, space, node, length, weight, below):
    """Expand a state: push its successors, those by preferred operators first."""
    greedy = weight == math.inf
    kinds = t.heuristics
    ints[EXPANDED] += 1
    for k in range(kinds):
        if reals[space.values + node * kinds + k] < reals[k]:
            reals[k] = reals[space.values + node * kinds + k]
            for other in range(kinds):
                ints[SIZES + 3 * kinds + other] -= ints[BOOST]
    count = applicable(ints, t, x, x.closed)
    for k in range(count):
        ints[x.is_applicable + ints[x.applicable + k]] = 1
    if ints[RANDOM]:
        ints[RANDOM] = shuffle(ints, ints[RANDOM], x.applicable, count)
        ints[RANDOM] = shuffle(ints, ints[RANDOM], x.plan, length)
    first = preferred(ints, t, x, space, node, x.closed, length)
    if ints[ACHIEVERS]:
        first = achievers(ints, t, r, x, space, node, first, count)

    cost, spent = reals[space.cost + node], reals[space.spent + node]
    base = ints[EXPANDED] * t.operators
    for rank in range(first + count):
        i = ints[x.helpful + rank] if rank < first else ints[x.applicable + rank - first]
        if rank >= first and ints[x.is_helpful + i]:
            continue
        if spent + reals[t.own + i] >= below:
            continue
        apply(ints, t, i, space.states + node * t.words, x.closed, x.after)
        known = ints[
            space.table + (place_of(ints, t.words, x.after, space.states, space.table, space.mask))
        ]
        if known >= 0 and (greedy or cost + reals[t.costs + i] >= reals[space.cost + known]):
            continue
        reached = cost + (
            reals[t.costs + i] + reals[x.extras + i] if ints[t.guarded + i] else reals[t.costs + i]
        )
        if reached == math.inf or (known >= 0 and reached >= reals[space.cost + known]):
            continue
        ints[PUSHED] += 1
        # among equals greedy search goes on from the state just expanded, weighted A* takes the
        # older
        order = rank - base if greedy and not ints[RANDOM] else ints[PUSHED]
        push(ints, reals, t, r, x, space, node, i, reached, order, rank < first, weight)

    for k in range(count):
        ints[x.is_applicable + ints[x.applicable + k]] = 0
    for k in range(first):
        ints[x.is_helpful + ints[x.helpful + k]] = 0


def arrive(ints, reals, t, x, space, i, parent, reached, greedy):
    """Go by an operator from a state to the next, into x.after, and close it, or open it again.

    Returns:
        Its node; -1 where it was closed at no higher cost.
    """
    if parent < 0:
        for w in range(t.words):
            ints[x.after + w] = ints[t.initial + w]
    else:
        if ints[t.con_starts + i] < ints[t.con_starts + i + 1]:
            for w in range(t.words):
                ints[x.other + w] = ints[space.states + parent * t.words + w]
            close_state(ints, t, x.other)
        apply(ints, t, i, space.states + parent * t.words, x.other, x.after)
    place = place_of(ints, t.words, x.after, space.states, space.table, space.mask)
    node = ints[space.table + place]
    if node >= 0 and (greedy or reached >= reals[space.cost + node]):
        return -1

    if node < 0:
        node = ints[NODES]
        ints[NODES] += 1
        ints[space.table + place] = node
        for w in range(t.words):
            ints[space.states + node * t.words + w] = ints[x.after + w]
    reals[space.cost + node], ints[space.parent + node] = reached, parent
    ints[space.operator + node] = i
    reals[space.spent + node] = (
        reals[space.spent + parent] + reals[t.own + i] if parent >= 0 else 0.0
    )
    return node


def run(ints, reals, t, r, x, space, weight, below):
    """Search until something is to be told; x.closed and ints[AT] are about the state at hand."""
    kinds, greedy = t.heuristics, weight == math.inf
    while True:
        if ints[NODES] + 1 >= space.nodes:
            return GROW
        if ints[ENTRIES] + t.operators + kinds >= space.entries:
            return GROW
        if ints[EXPANDED] >= ints[UNTIL]:
            return PAUSE
        entry = pop(ints, reals, t, space, greedy)
        if entry < 0:
            return EXHAUSTED

        i, parent, reached = (
            ints[space.entry_operator + entry],
            ints[space.entry_parent + entry],
            reals[space.entry_cost + entry],
        )
        if i == GOAL_ENTRY:
            if parent == ints[GOAL_NODE]:
                return FOUND
            continue
        node = arrive(ints, reals, t, x, space, i, parent, reached, greedy)
        if node < 0:
            continue
        for w in range(t.words):
            ints[x.closed + w] = ints[x.after + w]
        trigger(ints, reals, t, x, x.closed)
        close_state(ints, t, x.closed)
        if covers(ints, t, x.closed):
            ints[AT] = node
            return GOAL

        length = evaluate(ints, reals, t, r, x, space, node, parent)
        dead = False
        for k in range(kinds):
            dead = dead or reals[space.values + node * kinds + k] == math.inf
        if not dead:
            if ints[EXPANDED] >= ints[LIMIT]:
                return LIMITED
            expand(ints, reals, t, r, x, space, node, length, weight, below)
        for k in range(length):
            ints[x.in_plan + ints[x.plan + k]] = 0
